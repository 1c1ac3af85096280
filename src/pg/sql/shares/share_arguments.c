/*
 * share_arguments.c: how a mesh is cut into parts, as arguments of several functions.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/mesh/header.h"
#include "pg/sql/shares/share_arguments.h"

/* Finds the attribute or label that weighs the simplices. */
static void
weight_argument(FunctionCallInfo fcinfo, int weight, abacus_names names, abacus_cut *cut)
{
	char	   *name;
	int			label;

	cut->weight = ABACUS_WEIGHT_ONE;
	if (PG_ARGISNULL(weight))
		return;
	name = text_to_cstring(PG_GETARG_TEXT_PP(weight));
	label = header_label(names, name);
	if (label < 0 && header_attribute(names, name) < 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("mesh has no attribute or label \"%s\"", name),
				 errhint("weight names an attribute of the vertices or a label of the simplices; "
						 "without it, all simplices count the same.")));
	cut->weight = label >= 0 ? ABACUS_WEIGHT_LABEL : ABACUS_WEIGHT_ATTRIBUTE;
	cut->column = (uint32) (label >= 0 ? label : header_attribute(names, name));
	pfree(name);
}

/* The number of parts, and what they have equal sums of. */
void
cut_arguments(FunctionCallInfo fcinfo, int parts, int weight, abacus_names names, abacus_cut *cut)
{
	int32		count = PG_GETARG_INT32(parts);

	if (count < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("parts must be at least 1, not %d", count),
				 errhint("parts is the number of ranks that share the mesh.")));
	cut->parts = (uint32) count;
	weight_argument(fcinfo, weight, names, cut);
}

/* One of the parts. */
uint32
part_argument(FunctionCallInfo fcinfo, int part, const abacus_cut *cut)
{
	int32		number = PG_GETARG_INT32(part);

	if (number < 0 || (uint32) number >= cut->parts)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("part must be between 0 and %u, not %d", cut->parts - 1, number),
				 errhint("Parts are numbered from 0, as ranks are.")));
	return (uint32) number;
}

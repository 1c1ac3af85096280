/*
 * step_argument.c: the argument step, a step of a solution to be read in place of the attributes.
 */
#include "postgres.h"

#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/steps/step.h"

/* If it is given, attributes of the reader and of its header are from here on the values of the step. */
void
step_argument(FunctionCallInfo fcinfo, int argument, Reader *reader)
{
	Oid			mesh = mesh_pages(reader->host)->mesh;

	if (PG_ARGISNULL(argument))
		return;
	if (reader->header.facts.form.type != ABACUS_MESH)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("octree \"%s\" has no steps", get_rel_name(mesh)),
				 errhint("Leave out step, which is for meshes.")));
	step_replaces_attributes(step_open(mesh, &reader->header, PG_GETARG_INT64(argument), reader->host->home),
							 reader->host, &reader->header);
}

/* The number of the attribute that is drawn, -1 for none; of a step with one value, which is drawn anyway, this one. */
int
step_or_attribute(FunctionCallInfo fcinfo, int step, int attribute, abacus_names names)
{
	if (PG_ARGISNULL(step))
		return attribute_or_none(fcinfo, attribute, names);
	return (int) attribute_argument(fcinfo, attribute, names);
}

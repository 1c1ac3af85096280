/*
 * interpolation.c: the optional arguments of functions that interpolate.
 *
 * NULL means the same as omitting an argument.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/mesh/header.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/word.h"

/* In the order of the core's numbers */
static const char *const methods[] = {"linear", "natural", "nearest", NULL};
static const char *const outsides[] = {"null", "nearest", NULL};

/* Whether the mesh or one of the `given` coordinates is NULL: then the answer is NULL. */
bool
interpolation_of_null(FunctionCallInfo fcinfo, int given)
{
	for (int i = 0; i <= given; i++)
		if (PG_ARGISNULL(i))
			return true;
	return false;
}

/* Reads the arguments method and outside, which follow one another. */
void
interpolation_how(FunctionCallInfo fcinfo, int method, abacus_interpolation *how)
{
	how->method = word_argument(fcinfo, method, methods, "method", "Use linear, natural or nearest.");
	how->outside = word_argument(fcinfo, method + 1, outsides, "outside",
						"Use null, or nearest for the value of the nearest vertex.");
}

/* One attribute, by its name; if no name is given, the only one. */
void
interpolation_attribute(FunctionCallInfo fcinfo, int argument, abacus_names names,
						abacus_interpolation *how)
{
	how->attributes = 1;
	how->attribute[0] = attribute_argument(fcinfo, argument, names);
}

/*
 * Names of attributes: an array, or an array written as a text, or a text that is a name.
 * PostgreSQL takes a quoted argument for a text if there is a form of the function with a text.
 */
static ArrayType *
names_argument(FunctionCallInfo fcinfo, int argument)
{
	char	   *given;
	Oid			input;
	Oid			parameter;
	Datum		name;

	if (get_fn_expr_argtype(fcinfo->flinfo, argument) != TEXTOID)
		return PG_GETARG_ARRAYTYPE_P(argument);
	given = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	name = CStringGetTextDatum(given);
	if (given[0] != '{')
		return construct_array(&name, 1, TEXTOID, -1, false, TYPALIGN_INT);
	getTypeInputInfo(TEXTARRAYOID, &input, &parameter);
	return DatumGetArrayTypeP(OidInputFunctionCall(input, given, parameter, -1));
}

/* Any number of attributes, in the order of their names; if none are given, all of them. */
void
interpolation_attributes(FunctionCallInfo fcinfo, int argument, abacus_names names,
						 abacus_interpolation *how)
{
	Datum	   *given;
	int			count;

	if (PG_ARGISNULL(argument))
	{
		header_require_attributes(names.facts);
		how->attributes = names.facts->columns.attributes;
		for (uint32 i = 0; i < names.facts->columns.attributes; i++)
			how->attribute[i] = i;
		return;
	}
	given = shape_names(names_argument(fcinfo, argument), "attributes", &count);
	if (count > ABACUS_MAX_ATTRIBUTES)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("at most %d attributes can be requested", ABACUS_MAX_ATTRIBUTES)));
	how->attributes = (uint32) count;
	for (int i = 0; i < count; i++)
		how->attribute[i] = (uint32) header_find_attribute(names, TextDatumGetCString(given[i]));
}

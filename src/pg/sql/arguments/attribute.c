/*
 * attribute.c: an attribute that a function takes by its name.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/mesh/header.h"
#include "pg/sql/arguments/attribute.h"

/* The number of the attribute; -1 if none is given. */
int
attribute_or_none(FunctionCallInfo fcinfo, int argument, abacus_names names)
{
	char	   *name;
	int			number;

	if (PG_ARGISNULL(argument))
		return -1;
	name = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	number = header_find_attribute(names, name);
	pfree(name);
	return number;
}

/* If none is given and the mesh has only one attribute, this one. */
uint32
attribute_argument(FunctionCallInfo fcinfo, int argument, abacus_names names)
{
	int			number = attribute_or_none(fcinfo, argument, names);

	return (uint32) (number < 0 ? header_only_attribute(names) : number);
}

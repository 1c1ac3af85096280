/*
 * fn_wrapper.c: the functions by which PostgreSQL uses the foreign-data wrapper, and the functions
 * in the definitions of its tables.
 */
#include "postgres.h"

#include "access/reloptions.h"
#include "catalog/pg_attribute.h"
#include "catalog/pg_foreign_table.h"
#include "commands/defrem.h"

#include "pg/base/sql_function.h"
#include "pg/fdw/published.h"
#include "pg/fdw/wrapper.h"

SQL_FUNCTION(abacus_sql_fdw_handler);
SQL_FUNCTION(abacus_sql_fdw_validator);
SQL_FUNCTION(abacus_sql_published);

/* abacus_fdw_handler() -> fdw_handler */
Datum
abacus_sql_fdw_handler(PG_FUNCTION_ARGS)
{
	FdwRoutine *routine = makeNode(FdwRoutine);

	wrapper_set_planner(routine);
	wrapper_set_executor(routine);
	wrapper_set_analyze(routine);
	PG_RETURN_POINTER(routine);
}

/* Whether an option may stand in this catalogue with this value. */
static bool
is_valid(Oid catalogue, const char *name, const char *value)
{
	Content		content;
	Column		column;

	if (catalogue == ForeignTableRelationId && strcmp(name, OPTION_CONTENT) == 0)
		return published_content(value, &content);
	if (catalogue == AttributeRelationId && strcmp(name, OPTION_HOLDS) == 0)
		return published_holds(value, &column);
	if (catalogue == AttributeRelationId && strcmp(name, OPTION_Z) == 0)
		return published_number(value) >= 0;
	if (catalogue == AttributeRelationId && strcmp(name, OPTION_DROPPED) == 0)
		return published_dropped(value) >= 0;
	return false;
}

/* abacus_fdw_validator(text[], oid) -> void */
Datum
abacus_sql_fdw_validator(PG_FUNCTION_ARGS)
{
	List	   *options = untransformRelOptions(PG_GETARG_DATUM(0));
	Oid			catalogue = PG_GETARG_OID(1);
	ListCell   *cell;

	foreach(cell, options)
	{
		DefElem    *option = lfirst(cell);

		if (!is_valid(catalogue, option->defname, defGetString(option)))
			ereport(ERROR,
					(errcode(ERRCODE_FDW_INVALID_OPTION_NAME),
					 errmsg("invalid option \"%s\" with value \"%s\"", option->defname, defGetString(option)),
					 errhint("Make foreign tables with abacus_publish(), which sets their options.")));
	}
	PG_RETURN_VOID();
}

/*
 * abacus_published(regclass) -> boolean: always true; a constraint names the table's mesh with it
 */
Datum
abacus_sql_published(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(true);
}

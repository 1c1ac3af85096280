/*
 * fn_edit.c: abacus_insert and abacus_delete, points into a mesh and out of it,
 * without vertex pages between.
 *
 * All pages are written before the function returns, once each. A point costs the pages
 * that its cavity or star touches; many points in one call share them.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"

SQL_FUNCTION(abacus_sql_insert);
SQL_FUNCTION(abacus_sql_delete);

/* What becomes of a point at the place of another, as an argument says. */
static abacus_on_duplicate
on_duplicate(text *given)
{
	static const char *const names[] = {
		[ABACUS_KEEP] = "keep", [ABACUS_REPLACE] = "replace", [ABACUS_REFUSE] = "error"
	};
	char	   *name = text_to_cstring(given);

	for (int i = 0; i < lengthof(names); i++)
		if (strcmp(name, names[i]) == 0)
			return (abacus_on_duplicate) i;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("on_duplicate must not be \"%s\"", name),
			 errhint("It is 'keep', 'replace' or 'error'.")));
	return ABACUS_KEEP;			/* not reached */
}

/* Inserts the points of a prepared query; returns how many there were. */
static uint64
insert_query(Oid mesh, Source *source, abacus_on_duplicate how)
{
	Change	   *change = change_begin(mesh, "abacus_insert()");
	uint64		points;

	change->on_duplicate = how;
	change->may_replace = true;
	change_read(change, source);
	change_insert(change);
	points = change->points;
	change_end(change);
	return points;
}

/* abacus_insert(mesh regclass, query text, on_duplicate text) -> bigint */
Datum
abacus_sql_insert(PG_FUNCTION_ARGS)
{
	abacus_on_duplicate how = on_duplicate(PG_GETARG_TEXT_PP(2));
	Source		source;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	points = insert_query(PG_GETARG_OID(0), &source, how);
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}

/* Takes the points of a prepared query away; returns how many there were. */
static uint64
delete_query(Oid mesh, Source *source)
{
	Change	   *change = change_begin(mesh, "abacus_delete()");
	abacus_header *shape = palloc(sizeof(abacus_header));
	uint64		deleted;

	/* id and coordinates say which points; attributes may follow, as in abacus_insert() */
	*shape = *change->writer.header;
	if (source_columns(source) == source_first_attribute(source, shape->dimension))
		shape->attributes = 0;
	change_read_gone(change, source, shape);
	deleted = change_delete(change, false);
	change_end(change);
	return deleted;
}

/* abacus_delete(mesh regclass, query text) -> bigint */
Datum
abacus_sql_delete(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		deleted;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	deleted = delete_query(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) deleted);
}

/*
 * fn_edit.c: abacus_insert and abacus_delete, points into a mesh and out of it,
 * without vertex pages between.
 *
 * All pages are written before the function returns, once each: a point costs
 * the pages that its cavity or star touches, many points in one call share
 * them.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/build.h"
#include "pg/sql_function.h"

SQL_FUNCTION(abacus_sql_insert);
SQL_FUNCTION(abacus_sql_delete);

/* Inserts the points of a prepared query; *header is the new one. Returns their number. */
uint64
edit_insert(Oid mesh, Source *source, const char *command, abacus_header *header)
{
	Change	   *change = change_begin(mesh, command);
	uint64		points;

	change_read(change, source, change->writer.header);
	change_insert(change);
	points = change->points;
	*header = *change->writer.header;
	change_end(change);
	return points;
}

/* abacus_insert(mesh regclass, query text) -> bigint */
Datum
abacus_sql_insert(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc(sizeof(abacus_header));
	Source		source;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	points = edit_insert(PG_GETARG_OID(0), &source, "abacus_insert()", header);
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}

/* Takes the points of a prepared query away; returns how many there were. */
static uint64
edit_delete(Oid mesh, Source *source)
{
	Change	   *change = change_begin(mesh, "abacus_delete()");
	abacus_header *shape = palloc(sizeof(abacus_header));
	uint64		deleted;

	/* id and coordinates say which points; attributes may follow, as in abacus_insert() */
	*shape = *change->writer.header;
	if (source_columns(source) == (int) (1 + shape->dimension))
		shape->attributes = 0;
	change_read(change, source, shape);
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
	deleted = edit_delete(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) deleted);
}

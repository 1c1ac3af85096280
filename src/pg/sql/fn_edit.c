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

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"

SQL_FUNCTION(abacus_sql_insert);
SQL_FUNCTION(abacus_sql_delete);

/* abacus_insert(mesh regclass, query text) -> bigint */
Datum
abacus_sql_insert(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc(sizeof(abacus_header));
	Source		source;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	points = change_insert_query(PG_GETARG_OID(0), &source, "abacus_insert()", header);
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
	deleted = delete_query(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) deleted);
}

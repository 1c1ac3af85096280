/*
 * fn_edit.c: abacus_insert, points into a mesh at once, without vertex pages
 * between.
 *
 * All pages are written before the function returns, once each: a point costs
 * the pages that its cavity touches, many points in one call cost each page
 * once.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/build.h"
#include "pg/sql_function.h"

SQL_FUNCTION(abacus_sql_insert);

/* Inserts the points of a prepared query; *header is the new one. Returns their number. */
uint64
edit_insert(Oid mesh, Source *source, const char *command, abacus_header *header)
{
	Change	   *change = change_begin(mesh, command);
	Host	   *host = change->writer.host;
	uint64		points;

	change_read(change, source, change->writer.header);
	host_run(host, abacus_stage_end(change->stage, change->writer.header, &host->failure));
	change_open_build(change);
	host_run(host, abacus_build_insert(change->build, change->stage, change->writer.header,
									   &host->failure));
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

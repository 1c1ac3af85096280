/*
 * fn_stage.c: abacus_stage, points from a query into vertex pages.
 *
 * Rows go from the executor in batches of a thousand into the core's stage,
 * which sorts them into insertion order within maintenance_work_mem (beyond
 * it in temporary files) and writes the vertex pages at the end.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "utils/builtins.h"

#include "pg/build.h"
#include "pg/sql_function.h"
#include "pg/writer.h"

SQL_FUNCTION(abacus_sql_stage);

/* Stages the rows of a prepared query; returns how many. */
uint64
build_stage(Oid mesh, Source *source)
{
	Writer		writer;
	Host	   *host;
	abacus_stage *stage = NULL;
	const uint64 *points;
	size_t		count;
	uint64		before;

	writer_begin(&writer, mesh, "abacus_stage()");
	host = writer.host;
	before = writer.header->points;
	source_open(source, writer.header);
	host_run(host, abacus_stage_open(&host->table, writer.header,
									 (size_t) maintenance_work_mem * 1024, &stage,
									 &host->failure));
	host_own(host, stage, (void (*) (void *)) abacus_stage_close);
	while ((count = source_fetch(source, &points)) > 0)
		host_run(host, abacus_stage_add(stage, points, count, &host->failure));
	source_close(source);
	host_run(host, abacus_stage_finish(stage, writer.header, &host->failure));
	before = writer.header->points - before;
	writer_end(&writer);
	return before;
}

/* abacus_stage(mesh regclass, query text) -> bigint */
Datum
abacus_sql_stage(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		count;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	count = build_stage(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) count);
}

/*
 * fn_spanning_tree.c: abacus_spanning_tree, the shortest edges that join all
 * vertices of a mesh.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/shapes.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/temp_room.h"
#include "pg/mesh/reader.h"
#include "pg/sql/rows/answers.h"

SQL_FUNCTION(abacus_sql_spanning_tree);

/* Columns */
enum
{
	EDGE_V0,
	EDGE_V1,
	EDGE_LENGTH,
	EDGE_COLUMNS
};

/* Adds an edge; called by the core. */
static abacus_host_status
put_edge(void *context, const abacus_edge *edge)
{
	Answers    *answers = context;
	Datum		values[EDGE_COLUMNS];
	bool		isnull[EDGE_COLUMNS] = {false};

	values[EDGE_V0] = Int64GetDatum(edge->id[0]);
	values[EDGE_V1] = Int64GetDatum(edge->id[1]);
	values[EDGE_LENGTH] = Float8GetDatum(edge->length);
	return answers_put(answers, values, isnull);
}

/* abacus_spanning_tree(mesh regclass) -> v0, v1, length */
Datum
abacus_sql_spanning_tree(PG_FUNCTION_ARGS)
{
	Reader	   *reader;
	const abacus_census *census;
	Host	   *host;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	census = &reader->header.facts.census;
	host = answers.host = reader->host;
	temp_room_require_rows((double) census->vertices - (double) census->split - 1,
						   EDGE_COLUMNS * (int) sizeof(Datum));
	progress_begin(&host->progress, PG_GETARG_OID(0));
	host_run(host, abacus_spanning_tree, &host->table, &reader->header.facts, setting_query_sort_bytes(),
			 setting_cache_bytes(), put_edge, &answers);
	progress_end(&host->progress);
	host_release(host);
	host_destroy(host);
	PG_RETURN_NULL();
}

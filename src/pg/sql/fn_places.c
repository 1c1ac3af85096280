/*
 * fn_places.c: abacus_locate for the places of a query, many at once.
 *
 * All places are read before the first is located, since they are sorted along the
 * curve. So the rows go into a tuplestore, as those of a function in FROM do anyway.
 * The session's cache is not used: the core looks for all places of a page together,
 * and keeps no page.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/read.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/input/source.h"
#include "pg/mesh/reader.h"
#include "pg/sql/simplex_row.h"

SQL_FUNCTION(abacus_sql_locate_places);

/* Columns of the result: the id of a place, then those of abacus_simplex */
enum
{
	PLACE_ID,
	PLACE_SIMPLEX,
	PLACE_COLUMNS = PLACE_SIMPLEX + SIMPLEX_COLUMNS
};

typedef struct Answers
{
	Host	   *host;
	ReturnSetInfo *set;
	uint32		dimension;
} Answers;

/* Adds the row of a place; called by the core. */
static abacus_host_status
put_answer(void *context, int64_t id, const abacus_simplex *simplex)
{
	Answers    *answers = context;
	Datum		values[PLACE_COLUMNS] = {0};
	bool		isnull[PLACE_COLUMNS];

	memset(isnull, true, sizeof(isnull));
	isnull[PLACE_ID] = false;
	values[PLACE_ID] = Int64GetDatum(id);
	if (simplex != NULL)
		simplex_columns(simplex, answers->dimension, values + PLACE_SIMPLEX,
						isnull + PLACE_SIMPLEX);
	GUARD_BEGIN();
	tuplestore_putvalues(answers->set->setResult, answers->set->setDesc, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/* Reads the places of a query. */
static void
read_places(Host *host, Source *source, const abacus_header *header)
{
	const uint64 *records;
	size_t		count;

	source_open_places(source, header);
	while ((count = source_fetch(source, &records)) > 0)
		host_run(host, abacus_places_add, host->handle, records, count);
	source_close(source);
}

/*
 * abacus_locate(mesh regclass, query text)
 *     -> id, code, v0, v1, v2, v3
 */
Datum
abacus_sql_locate_places(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	Source		source;
	Reader	   *reader;
	Host	   *host;
	abacus_places *places = NULL;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	reader = reader_open(mesh, CurrentMemoryContext);
	answers.host = host = reader->host;
	answers.dimension = reader->header.dimension;

	progress_begin(&host->progress, mesh);
	host_run(host, abacus_places_open, &host->table, &reader->header, setting_query_sort_bytes(),
			 setting_cache_bytes(), &places);
	host_own(host, places, (void (*) (void *)) abacus_places_close);
	read_places(host, &source, &reader->header);
	host_run(host, abacus_places_locate, places, put_answer, &answers);
	progress_end(&host->progress);
	host_release(host);
	host_destroy(host);
	source_finish(&source);
	PG_RETURN_NULL();
}

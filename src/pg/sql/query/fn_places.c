/*
 * fn_places.c: abacus_locate for the places of a query, all together.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/host/temp_room.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/places.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_locate_places);

/* Columns of the result: the id of a place, those of abacus_simplex, and its labels */
enum
{
	PLACE_ID,
	PLACE_SIMPLEX,
	PLACE_LABELS = PLACE_SIMPLEX + SIMPLEX_COLUMNS,
	PLACE_COLUMNS
};

/* Adds the row of a place; called by the core. Attributes of a row are labels of its simplex. */
static abacus_host_status
put_answer(void *context, int64_t id, const abacus_simplex *simplex, const double *labels)
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
	isnull[PLACE_LABELS] = simplex == NULL || answers->attributes == 0;
	GUARD_BEGIN();
	if (!isnull[PLACE_LABELS])
		values[PLACE_LABELS] = answers_array(answers, labels, answers->attributes);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_locate(mesh regclass, query text)
 *     -> id, code, v0, v1, v2, v3, labels
 */
Datum
abacus_sql_locate_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (is_over_shards(fcinfo))
		return shard_read_places(fcinfo, true);
	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), ABACUS_MESH, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	answers.host = read.host;
	answers.dimension = read.dimension;
	answers_have_arrays(&answers, read.names.facts->columns.labels);
	temp_room_require_rows((double) read.count, (int) sizeof(Datum));
	host_run(read.host, abacus_places_locate, read.places, put_answer, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

/*
 * fn_places.c: abacus_locate for the places of a query, many at once.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/sql/answers.h"
#include "pg/sql/places.h"
#include "pg/sql/result.h"
#include "pg/sql/simplex_row.h"

SQL_FUNCTION(abacus_sql_locate_places);

/* Columns of the result: the id of a place, those of abacus_simplex, and its labels */
enum
{
	PLACE_ID,
	PLACE_SIMPLEX,
	PLACE_LABELS = PLACE_SIMPLEX + SIMPLEX_COLUMNS,
	PLACE_COLUMNS
};

/* Simplices come with their labels. */
typedef struct PlaceAnswers
{
	Answers		rows;
	uint32		labels;
} PlaceAnswers;

/* Adds the row of a place; called by the core. */
static abacus_host_status
put_answer(void *context, int64_t id, const abacus_simplex *simplex, const double *labels)
{
	PlaceAnswers *located = context;
	Answers    *answers = &located->rows;
	Datum		values[PLACE_COLUMNS] = {0};
	bool		isnull[PLACE_COLUMNS];

	memset(isnull, true, sizeof(isnull));
	isnull[PLACE_ID] = false;
	values[PLACE_ID] = Int64GetDatum(id);
	if (simplex != NULL)
		simplex_columns(simplex, answers->dimension, values + PLACE_SIMPLEX,
						isnull + PLACE_SIMPLEX);
	if (simplex == NULL || located->labels == 0)
		return answers_put(answers, values, isnull);
	GUARD_BEGIN();
	isnull[PLACE_LABELS] = false;
	values[PLACE_LABELS] = attribute_array(labels, (int) located->labels);
	tuplestore_putvalues(answers->set->setResult, answers->set->setDesc, values, isnull);
	pfree(DatumGetPointer(values[PLACE_LABELS]));
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
	PlaceAnswers located = {.rows.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), text_to_cstring(PG_GETARG_TEXT_PP(1)));
	located.rows.host = read.host;
	located.rows.dimension = read.dimension;
	located.labels = read.header->labels;
	host_run(read.host, abacus_places_locate, read.places, put_answer, &located);
	places_done(&read);
	PG_RETURN_NULL();
}

/*
 * fn_places.c: abacus_locate for the places of a query, many at once.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/sql/answers.h"
#include "pg/sql/places.h"
#include "pg/sql/simplex_row.h"

SQL_FUNCTION(abacus_sql_locate_places);

/* Columns of the result: the id of a place, then those of abacus_simplex */
enum
{
	PLACE_ID,
	PLACE_SIMPLEX,
	PLACE_COLUMNS = PLACE_SIMPLEX + SIMPLEX_COLUMNS
};

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
	return answers_put(answers, values, isnull);
}

/*
 * abacus_locate(mesh regclass, query text)
 *     -> id, code, v0, v1, v2, v3
 */
Datum
abacus_sql_locate_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), ABACUS_MESH, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	answers.host = read.host;
	answers.dimension = read.dimension;
	host_run(read.host, abacus_places_locate, read.places, put_answer, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

/*
 * fn_nearest.c: abacus_nearest, the vertices nearest to one place or to many.
 *
 * One place is answered from the session's cache, as in abacus_locate; many are sorted along the
 * curve first (places.c says why).
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/locate.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/places.h"
#include "pg/sql/rows/answers.h"

SQL_FUNCTION(abacus_sql_nearest);
SQL_FUNCTION(abacus_sql_nearest_places);

/* Columns of a vertex near one place */
enum
{
	NEAR_VERTEX,
	NEAR_X,
	NEAR_ATTRIBUTES = NEAR_X + ABACUS_MAX_DIMENSION,
	NEAR_DISTANCE,
	NEAR_COLUMNS
};

/* Columns of a vertex near one of many places */
enum
{
	RANKED_PLACE,
	RANKED_RANK,
	RANKED_VERTEX,
	RANKED_DISTANCE,
	RANKED_COLUMNS
};

/* Adds a vertex near one given place; called by the core. */
static abacus_host_status
put_near(void *context, int64_t place, uint64_t rank, const abacus_vertex *vertex, double distance)
{
	Answers    *answers = context;
	Datum		values[NEAR_COLUMNS];
	bool		isnull[NEAR_COLUMNS] = {false};

	GUARD_BEGIN();
	values[NEAR_VERTEX] = Int64GetDatum(vertex->id);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[NEAR_X + i] = i >= answers->dimension;
		values[NEAR_X + i] = Float8GetDatum(vertex->point[i]);
	}
	values[NEAR_ATTRIBUTES] = answers_array(answers, vertex->attributes, answers->attributes);
	values[NEAR_DISTANCE] = Float8GetDatum(distance);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_nearest(mesh regclass, x float8, y float8[, z float8], k int)
 *     -> vertex, x, y, z, attributes, distance
 */
Datum
abacus_sql_nearest(PG_FUNCTION_ARGS)
{
	int			given = PG_NARGS() - 2;
	uint64		k = place_count_argument(fcinfo, 1 + given, "vertices");
	double		point[ABACUS_MAX_DIMENSION];
	CachedMesh *cached;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (is_over_shards(fcinfo))
		return shard_read_nearest(fcinfo, given);
	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get(PG_GETARG_OID(0));
	place_require_z(given, &cached->header.facts.form);
	place_arguments_finite(fcinfo, given, &cached->header.facts.form, point);
	answers.host = cached->host;
	answers.dimension = cached->dimension;
	answers_have_arrays(&answers, cached->header.facts.columns.attributes);
	host_run(cached->host, abacus_mesh_nearest, cached->mesh, point, k, put_near, &answers);
	host_release(cached->host);
	PG_RETURN_NULL();
}

/* Adds a vertex near one of many places; called by the core. */
static abacus_host_status
put_ranked(void *context, int64_t place, uint64_t rank, const abacus_vertex *vertex,
		   double distance)
{
	Answers    *answers = context;
	Datum		values[RANKED_COLUMNS];
	bool		isnull[RANKED_COLUMNS] = {false};

	values[RANKED_PLACE] = Int64GetDatum(place);
	values[RANKED_RANK] = Int64GetDatum((int64) rank);
	values[RANKED_VERTEX] = Int64GetDatum(vertex->id);
	values[RANKED_DISTANCE] = Float8GetDatum(distance);
	return answers_put(answers, values, isnull);
}

/* abacus_nearest(mesh regclass, query text, k int) -> id, rank, vertex, distance */
Datum
abacus_sql_nearest_places(PG_FUNCTION_ARGS)
{
	uint64		k = place_count_argument(fcinfo, 2, "vertices");
	PlacesRead	read;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (is_over_shards(fcinfo))
		return shard_read_nearest_places(fcinfo);
	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), ABACUS_MESH, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	answers.host = read.host;
	host_run(read.host, abacus_places_nearest, read.places, k, put_ranked, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

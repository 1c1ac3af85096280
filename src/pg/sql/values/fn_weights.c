/*
 * fn_weights.c: abacus_weights, the weights of the vertices in a value between them.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/places.h"
#include "pg/sql/rows/answers.h"

SQL_FUNCTION(abacus_sql_weights);
SQL_FUNCTION(abacus_sql_weights_places);

/* Arguments: the mesh and the coordinates, then these */
enum
{
	HOW_METHOD,
	HOW_OUTSIDE,
	HOW_MAX_EDGE,
	HOW_WITHIN,
	HOW_ARGUMENTS
};

/*
 * abacus_weights(mesh regclass, x float8, y float8[, z float8],
 *                method text, outside text, max_edge float8, within text)
 *     -> vertex, weight
 */
Datum
abacus_sql_weights(PG_FUNCTION_ARGS)
{
	int			given = PG_NARGS() - HOW_ARGUMENTS - 1;
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	double		point[ABACUS_MAX_DIMENSION];
	abacus_interpolation how = {.attributes = 0};
	CachedMesh *cached;
	const abacus_weight *weights;
	size_t		count;
	abacus_status status;

	InitMaterializedSRF(fcinfo, 0);
	if (interpolation_of_null(fcinfo, given))
		PG_RETURN_NULL();
	cached = mesh_cache_get(PG_GETARG_OID(0));
	interpolation_how(fcinfo, 1 + given + HOW_METHOD, &how);
	extent_arguments(fcinfo, 1 + given + HOW_MAX_EDGE, 1 + given + HOW_WITHIN, PG_GETARG_OID(0),
					 &cached->header, NULL, &how.extent);
	if (!place_arguments(fcinfo, given, &cached->header.facts.form, point))
		PG_RETURN_NULL();
	status = host_run(cached->host, abacus_mesh_weigh, cached->mesh, &how, point, &weights,
					  &count);
	host_release(cached->host);
	if (status == ABACUS_END)
		PG_RETURN_NULL();
	for (size_t i = 0; i < count; i++)
	{
		Datum		values[] = {Int64GetDatum(weights[i].vertex), Float8GetDatum(weights[i].weight)};
		bool		isnull[] = {false, false};

		tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	}
	PG_RETURN_NULL();
}

/* Adds the rows of a place; called by the core. */
static abacus_host_status
put_weights(void *context, int64_t id, const abacus_weight *weights, size_t count)
{
	Answers    *answers = context;

	GUARD_BEGIN();
	for (size_t i = 0; i < count; i++)
	{
		Datum		values[] = {Int64GetDatum(id), Int64GetDatum(weights[i].vertex),
								Float8GetDatum(weights[i].weight)};
		bool		isnull[] = {false, false, false};

		tuplestore_putvalues(answers->set->setResult, answers->set->setDesc, values, isnull);
	}
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_weights(mesh regclass, query text, method text, outside text, max_edge float8, within text)
 *     -> id, vertex, weight
 */
Datum
abacus_sql_weights_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	abacus_interpolation how = {.attributes = 0};
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (shard_can_answer(fcinfo))
		return shard_read_places(fcinfo, false);
	InitMaterializedSRF(fcinfo, 0);
	if (interpolation_of_null(fcinfo, 1))
		PG_RETURN_NULL();
	places_open(&read, PG_GETARG_OID(0), ABACUS_MESH, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	interpolation_how(fcinfo, 2 + HOW_METHOD, &how);
	how.extent.max_edge = extent_max_edge(fcinfo, 2 + HOW_MAX_EDGE);
	extent_within(fcinfo, 2 + HOW_WITHIN, PG_GETARG_OID(0), read.names.facts, 0, read.host, &how.extent);
	places_fetch(&read);
	answers.host = read.host;
	host_run(read.host, abacus_places_weigh, read.places, &how, put_weights, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

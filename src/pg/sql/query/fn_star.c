/*
 * fn_star.c: abacus_star and abacus_neighbours, the simplices around a place and those near a
 * simplex; both use the session's cache.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/locate.h"
#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_star);
SQL_FUNCTION(abacus_sql_neighbours);

/* Adds a simplex; called by the core. */
static abacus_host_status
put_simplex(void *context, const abacus_simplex *simplex)
{
	Answers    *answers = context;
	Datum		values[SIMPLEX_COLUMNS];
	bool		isnull[SIMPLEX_COLUMNS];

	simplex_columns(simplex, answers->dimension, values, isnull);
	return answers_put(answers, values, isnull);
}

/* abacus_star(mesh regclass, x float8, y float8[, z float8]) -> SETOF abacus_simplex */
Datum
abacus_sql_star(PG_FUNCTION_ARGS)
{
	double		point[ABACUS_MAX_DIMENSION];
	CachedMesh *cached;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get(PG_GETARG_OID(0));
	answers.host = cached->host;
	answers.dimension = cached->dimension;
	if (!place_arguments(fcinfo, PG_NARGS() - 1, &cached->header.facts.form, point))
		PG_RETURN_NULL();		/* outside every hull */
	host_run(answers.host, abacus_mesh_star, cached->mesh, point, put_simplex, &answers);
	host_release(answers.host);
	PG_RETURN_NULL();
}

/*
 * abacus_neighbours(mesh regclass, simplex abacus_simplex, steps int)
 *     -> SETOF abacus_simplex
 */
Datum
abacus_sql_neighbours(PG_FUNCTION_ARGS)
{
	int32		steps = PG_GETARG_INT32(2);
	int64		ids[ABACUS_MAX_DIMENSION + 1];
	uint64		code;
	CachedMesh *cached;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (steps < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("steps must be at least 0, not %d", steps),
				 errhint("steps is the number of facets that may be crossed.")));
	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get(PG_GETARG_OID(0));
	answers.host = cached->host;
	answers.dimension = cached->dimension;
	if (!simplex_from_row(PG_GETARG_DATUM(1), answers.set->setDesc, cached->dimension, &code, ids))
		PG_RETURN_NULL();
	host_run(answers.host, abacus_mesh_neighbours, cached->mesh, code, ids, (uint32) steps,
			 put_simplex, &answers);
	host_release(answers.host);
	PG_RETURN_NULL();
}

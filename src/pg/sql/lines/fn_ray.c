/*
 * fn_ray.c: abacus_ray, the simplices that a ray meets.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/lines.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/line.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_ray);

/* Columns: these, those of a simplex, and its labels */
enum
{
	RAY_ENTERS,
	RAY_LEAVES,
	RAY_SIMPLEX,
	RAY_LABELS = RAY_SIMPLEX + SIMPLEX_COLUMNS,
	RAY_COLUMNS
};

/* Adds a simplex; called by the core. Attributes of a row are its labels. */
static abacus_host_status
put_simplex(void *context, double enters, double leaves, const abacus_simplex *simplex,
			const double *labels)
{
	Answers    *answers = context;
	Datum		values[RAY_COLUMNS] = {0};
	bool		isnull[RAY_COLUMNS] = {false};

	values[RAY_ENTERS] = Float8GetDatum(enters);
	values[RAY_LEAVES] = Float8GetDatum(leaves);
	simplex_columns(simplex, answers->dimension, values + RAY_SIMPLEX, isnull + RAY_SIMPLEX);
	isnull[RAY_LABELS] = answers->attributes == 0;
	GUARD_BEGIN();
	if (!isnull[RAY_LABELS])
		values[RAY_LABELS] = answers_array(answers, labels, answers->attributes);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_ray(mesh regclass, origin float8[], direction float8[])
 *     -> enters, leaves, code, v0, v1, v2, v3, labels
 */
Datum
abacus_sql_ray(PG_FUNCTION_ARGS)
{
	double		origin[ABACUS_MAX_DIMENSION];
	double		direction[ABACUS_MAX_DIMENSION] = {0};
	CachedMesh *cached;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get(PG_GETARG_OID(0));
	answers.host = cached->host;
	answers.dimension = cached->dimension;
	answers_have_arrays(&answers, cached->header.facts.columns.labels);
	line_place(fcinfo, 1, "origin", cached->dimension, origin);
	line_place(fcinfo, 2, "direction", cached->dimension, direction);
	if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("direction must not have length 0"),
				 errhint("Use abacus_star() for the simplices around one place.")));
	host_run(answers.host, abacus_mesh_ray, cached->mesh, origin, direction, put_simplex,
			 &answers);
	host_release(answers.host);
	PG_RETURN_NULL();
}

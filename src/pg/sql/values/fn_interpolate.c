/*
 * fn_interpolate.c: abacus_interpolate, values of attributes between the vertices.
 *
 * The form for one place is called for every row of a query, and works as abacus_locate does; the
 * form for a query answers all places together.
 */
#include "postgres.h"

#include <math.h>

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/places.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/sql/rows/answers.h"
#include "pg/steps/step.h"

SQL_FUNCTION(abacus_sql_interpolate);
SQL_FUNCTION(abacus_sql_interpolate_places);

/* Arguments: the mesh and the coordinates, then these */
enum
{
	HOW_ATTRIBUTE,
	HOW_METHOD,
	HOW_OUTSIDE,
	HOW_MAX_EDGE,
	HOW_WITHIN,
	HOW_STEP,
	HOW_ARGUMENTS
};

/*
 * The value at a place of a step: from the weights of the vertices around it, whose values are found when the
 * core has returned. So queries of the step may use the session's cache. ABACUS_END outside.
 */
static abacus_status
value_of_step(CachedMesh *cached, Step *step, const abacus_interpolation *how, const double *point, double *value)
{
	abacus_interpolation weigh = {.method = how->method,.outside = how->outside,.extent = how->extent};
	const abacus_weight *found;
	abacus_weight *weights;
	double	   *row = palloc(step_names(step).facts->columns.attributes * sizeof(double));
	double	   *values;
	size_t		count;

	if (host_run(cached->host, abacus_mesh_weigh, cached->mesh, &weigh, point, &found, &count) == ABACUS_END)
		return ABACUS_END;
	weights = palloc(count * sizeof(*weights));
	values = palloc(count * sizeof(*values));
	memcpy(weights, found, count * sizeof(*weights));
	host_release(cached->host);
	for (size_t i = 0; i < count; i++)
	{
		(void) step_find(step, weights[i].vertex, row);
		values[i] = row[how->attribute[0]];
	}
	*value = abacus_weighted_mean(weights, values, count);
	return ABACUS_OK;
}

/*
 * abacus_interpolate(mesh regclass, x float8, y float8[, z float8], attribute text,
 *                    method text, outside text, max_edge float8, within text, step int8) -> float8
 */
Datum
abacus_sql_interpolate(PG_FUNCTION_ARGS)
{
	int			first = PG_NARGS() - HOW_ARGUMENTS;
	double		point[ABACUS_MAX_DIMENSION];
	abacus_interpolation how;
	CachedMesh *cached;
	Step	   *step = NULL;
	double		value;
	abacus_status status;

	if (interpolation_of_null(fcinfo, first - 1))
		PG_RETURN_NULL();
	cached = mesh_cache_get(PG_GETARG_OID(0));
	if (!PG_ARGISNULL(first + HOW_STEP))
	{
		/* its queries may use the session's cache */
		step = step_of_call(fcinfo, PG_GETARG_OID(0), &cached->header, PG_GETARG_INT64(first + HOW_STEP));
		cached = mesh_cache_get(PG_GETARG_OID(0));
	}
	interpolation_attribute(fcinfo, first + HOW_ATTRIBUTE,
							step != NULL ? step_names(step) : abacus_names_of(&cached->header), &how);
	interpolation_how(fcinfo, first + HOW_METHOD, &how);
	extent_arguments(fcinfo, first + HOW_MAX_EDGE, first + HOW_WITHIN, PG_GETARG_OID(0), &cached->header, NULL,
					 &how.extent);
	if (!place_arguments(fcinfo, first - 1, &cached->header.facts.form, point))
		PG_RETURN_NULL();
	if (step != NULL)
		status = value_of_step(cached, step, &how, point, &value);
	else
		status = host_run(cached->host, abacus_mesh_interpolate, cached->mesh, &how, point, &value);
	if (step == NULL || status == ABACUS_END)
		host_release(cached->host);
	if (status == ABACUS_END || isnan(value))
		PG_RETURN_NULL();
	PG_RETURN_FLOAT8(value);
}

/*
 * abacus_interpolate(mesh regclass, query text, attributes text[],
 *                    method text, outside text, max_edge float8, within text, step int8)
 *     -> id, values
 */
Datum
abacus_sql_interpolate_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	abacus_interpolation how;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	if (shard_can_answer(fcinfo))
		return shard_read_places(fcinfo, true);
	InitMaterializedSRF(fcinfo, 0);
	if (interpolation_of_null(fcinfo, 1))
		PG_RETURN_NULL();
	places_open(&read, PG_GETARG_OID(0), ABACUS_MESH, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	step_argument(fcinfo, 2 + HOW_STEP, read.reader);
	interpolation_attributes(fcinfo, 2 + HOW_ATTRIBUTE, read.names, &how);
	interpolation_how(fcinfo, 2 + HOW_METHOD, &how);
	how.extent.max_edge = extent_max_edge(fcinfo, 2 + HOW_MAX_EDGE);
	extent_within(fcinfo, 2 + HOW_WITHIN, PG_GETARG_OID(0), read.names.facts, 0, read.host, &how.extent);
	places_fetch(&read);
	answers.host = read.host;
	answers_have_arrays(&answers, how.attributes);
	host_run(read.host, abacus_places_interpolate, read.places, &how, answers_put_values, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

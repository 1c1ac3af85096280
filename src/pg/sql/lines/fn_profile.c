/*
 * fn_profile.c: abacus_profile, an attribute along a path.
 */
#include "postgres.h"

#include <math.h>

#include "funcapi.h"

#include "abacus/lines.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/line.h"
#include "pg/sql/rows/answers.h"

SQL_FUNCTION(abacus_sql_profile);

/* Columns */
enum
{
	PROFILE_DISTANCE,
	PROFILE_X,
	PROFILE_VALUE = PROFILE_X + ABACUS_MAX_DIMENSION,
	PROFILE_COLUMNS
};

/* Adds a place; called by the core. */
static abacus_host_status
put_place(void *context, double distance, const double *place, double value)
{
	Answers    *answers = context;
	Datum		values[PROFILE_COLUMNS];
	bool		isnull[PROFILE_COLUMNS] = {false};

	values[PROFILE_DISTANCE] = Float8GetDatum(distance);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[PROFILE_X + i] = i >= answers->dimension;
		values[PROFILE_X + i] = isnull[PROFILE_X + i] ? (Datum) 0 : Float8GetDatum(place[i]);
	}
	isnull[PROFILE_VALUE] = isnan(value) != 0;
	values[PROFILE_VALUE] = Float8GetDatum(value);
	return answers_put(answers, values, isnull);
}

/* The places of a path: x, y and, in space, z of each. */
static double *
path_argument(FunctionCallInfo fcinfo, int argument, uint32 dimension, size_t *corners)
{
	size_t		count;
	double	   *path = line_places(fcinfo, argument, "path", &count);

	if (count % dimension != 0 || count < 2 * dimension)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("path has %zu elements, but needs %u for each of two or more places",
						count, dimension),
				 errhint("Give the coordinates of its corners one after the other, as in "
						 "'{x, y, x, y}'.")));
	*corners = count / dimension;
	return path;
}

/*
 * abacus_profile(mesh regclass, path float8[], attribute text, max_edge float8, within text)
 *     -> distance, x, y, z, value
 */
Datum
abacus_sql_profile(PG_FUNCTION_ARGS)
{
	abacus_interpolation how;
	CachedMesh *cached;
	double	   *path;
	size_t		corners;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	if (interpolation_of_null(fcinfo, 1))
		PG_RETURN_NULL();
	cached = mesh_cache_get(PG_GETARG_OID(0));
	answers.host = cached->host;
	answers.dimension = cached->dimension;
	interpolation_attribute(fcinfo, 2, abacus_names_of(&cached->header), &how);
	extent_arguments(fcinfo, 3, 4, PG_GETARG_OID(0), &cached->header, NULL, &how.extent);
	path = path_argument(fcinfo, 1, cached->dimension, &corners);
	host_run(answers.host, abacus_mesh_profile, cached->mesh, how.attribute[0], &how.extent, path,
			 corners, put_place, &answers);
	host_release(answers.host);
	PG_RETURN_NULL();
}

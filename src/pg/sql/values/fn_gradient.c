/*
 * fn_gradient.c: abacus_gradient and abacus_slope, how an attribute changes where
 * it varies linearly.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"

#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/units.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_gradient);
SQL_FUNCTION(abacus_sql_slope);

/* Arguments: the mesh and the coordinates, then these */
enum
{
	HOW_ATTRIBUTE,
	HOW_MAX_EDGE,
	HOW_WITHIN,
	HOW_ARGUMENTS
};

/* An error unless the mesh is in the plane: a slope needs a surface over it. */
static void
require_plane(FunctionCallInfo fcinfo)
{
	if (!PG_ARGISNULL(0))
		header_require_dimension(&mesh_cache_get(PG_GETARG_OID(0))->header.facts.form, 2,
								 "In space, use abacus_gradient().");
}

/*
 * Sets the gradient and returns the number of its components; 0 if there is none. If `exponent` is not null, the
 * gradient is to be multiplied by 2^exponent.
 */
static int
find_gradient(FunctionCallInfo fcinfo, double *gradient, int *exponent)
{
	int			first = PG_NARGS() - HOW_ARGUMENTS;
	double		point[ABACUS_MAX_DIMENSION];
	abacus_interpolation how = {.method = ABACUS_LINEAR};
	CachedMesh *cached;
	abacus_status status;

	if (interpolation_of_null(fcinfo, first - 1))
		return 0;
	cached = mesh_cache_get(PG_GETARG_OID(0));
	interpolation_attribute(fcinfo, first + HOW_ATTRIBUTE, abacus_names_of(&cached->header), &how);
	extent_arguments(fcinfo, first + HOW_MAX_EDGE, first + HOW_WITHIN, PG_GETARG_OID(0), &cached->header, NULL,
					 &how.extent);
	units_tell_slopes(&cached->header.facts.form);
	if (!place_arguments(fcinfo, first - 1, &cached->header.facts.form, point))
		return 0;
	status = host_run(cached->host, abacus_mesh_gradient, cached->mesh, &how, point, gradient, exponent);
	host_release(cached->host);
	return status == ABACUS_END || isnan(gradient[0]) ? 0 : (int) cached->dimension;
}

/*
 * abacus_gradient(mesh regclass, x float8, y float8[, z float8], attribute text,
 *                 max_edge float8, within text) -> float8[]
 */
Datum
abacus_sql_gradient(PG_FUNCTION_ARGS)
{
	double		gradient[ABACUS_MAX_DIMENSION];
	int			count;

	count = find_gradient(fcinfo, gradient, NULL);
	if (count == 0)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(attribute_array(gradient, count));
}

/*
 * The direction in which a gradient leads downhill: degrees from north, clockwise, 0 to less than
 * 360.
 */
static double
downhill(const double *gradient)
{
	double		degrees = atan2(-gradient[0], -gradient[1]) * (180 / M_PI);

	/* neither -0 nor 360, to which the sum may round */
	degrees = degrees < 0 ? degrees + 360 : degrees + 0.0;
	return degrees < 360 ? degrees : 0;
}

/*
 * abacus_slope(mesh regclass, x float8, y float8, attribute text, max_edge float8, within text)
 *     -> slope, aspect
 */
Datum
abacus_sql_slope(PG_FUNCTION_ARGS)
{
	double		gradient[ABACUS_MAX_DIMENSION];
	double		steepness;
	int			exponent;
	Datum		values[2];
	bool		isnull[2] = {false, false};

	require_plane(fcinfo);
	if (find_gradient(fcinfo, gradient, &exponent) == 0)
		PG_RETURN_NULL();
	steepness = hypot(gradient[0], gradient[1]);
	isnull[1] = steepness == 0; /* level ground faces nowhere */
	values[0] = Float8GetDatum(atan(scalbn(steepness, exponent)) * (180 / M_PI));
	values[1] = Float8GetDatum(downhill(gradient));
	PG_RETURN_DATUM(HeapTupleGetDatum(heap_form_tuple(result_row_type(fcinfo), values, isnull)));
}

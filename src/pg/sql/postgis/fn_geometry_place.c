/*
 * fn_geometry_place.c: functions of the extension abacus_postgis that take a point of
 * PostGIS in place of coordinates.
 *
 * Each calls the function of the extension abacus with the coordinates of the point. If the point
 * is NULL or empty, there is no answer.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "nodes/execnodes.h"
#include "utils/array.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/postgis/geometry_place.h"
#include "pg/sql/rows/result.h"

#define MOST_ARGUMENTS 10

/* NULL, or no rows if the function returns a set. */
static Datum
no_answer(FunctionCallInfo fcinfo)
{
	if (fcinfo->resultinfo != NULL && IsA(fcinfo->resultinfo, ReturnSetInfo))
		((ReturnSetInfo *) fcinfo->resultinfo)->isDone = ExprEndResult;
	PG_RETURN_NULL();
}

/* Calls a function with this many arguments, which are in `inner`, in place of this one. */
static Datum
call(FunctionCallInfo fcinfo, PGFunction function, FunctionCallInfo inner, int arguments)
{
	Datum		result;

	Assert(arguments <= MOST_ARGUMENTS);
	InitFunctionCallInfoData(*inner, fcinfo->flinfo, arguments, fcinfo->fncollation,
							 fcinfo->context, fcinfo->resultinfo);
	result = function(inner);
	fcinfo->isnull = inner->isnull;
	return result;
}

/* Calls a function of (mesh, x, y[, z], ...) with the arguments (mesh, point, ...). */
static Datum
with_place(FunctionCallInfo fcinfo, PGFunction function)
{
	LOCAL_FCINFO(inner, MOST_ARGUMENTS);
	const abacus_facts *facts;
	double		place[ABACUS_MAX_DIMENSION];
	int			count = 0;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		return no_answer(fcinfo);
	facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	if (!geometry_place(fcinfo, 1, "the geometry", &facts->form, place))
		return no_answer(fcinfo);
	inner->args[count++] = fcinfo->args[0];
	for (uint32 i = 0; i < facts->form.dimension; i++)
		inner->args[count++] = (NullableDatum) {Float8GetDatum(place[i]), false};
	for (int i = 2; i < PG_NARGS(); i++)
		inner->args[count++] = fcinfo->args[i];
	return call(fcinfo, function, inner, count);
}

#define WITH_PLACE(name) \
	SQL_FUNCTION(name ## _geometry); \
	extern Datum name(PG_FUNCTION_ARGS); \
	Datum \
	name ## _geometry(PG_FUNCTION_ARGS) \
	{ \
		return with_place(fcinfo, name); \
	} \
	extern Datum name(PG_FUNCTION_ARGS)

WITH_PLACE(abacus_sql_locate);
WITH_PLACE(abacus_sql_star);
WITH_PLACE(abacus_sql_nearest);
WITH_PLACE(abacus_sql_interpolate);
WITH_PLACE(abacus_sql_weights);
WITH_PLACE(abacus_sql_gradient);
WITH_PLACE(abacus_sql_slope);

SQL_FUNCTION(abacus_sql_visible_geometry);
extern Datum abacus_sql_visible(PG_FUNCTION_ARGS);

/* abacus_visible(mesh regclass, observer geometry, target geometry, ...) */
Datum
abacus_sql_visible_geometry(PG_FUNCTION_ARGS)
{
	static const char *const names[] = {NULL, "the observer", "the target"};
	LOCAL_FCINFO(inner, MOST_ARGUMENTS);
	const abacus_facts *facts;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2))
		return no_answer(fcinfo);
	facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	for (int i = 0; i < PG_NARGS(); i++)
		inner->args[i] = fcinfo->args[i];
	for (int i = 1; i <= 2; i++)
	{
		double		place[ABACUS_MAX_DIMENSION];

		if (!geometry_place(fcinfo, i, names[i], &facts->form, place))
			return no_answer(fcinfo);
		inner->args[i].value = attribute_array(place, (int) facts->form.dimension);
	}
	return call(fcinfo, abacus_sql_visible, inner, PG_NARGS());
}

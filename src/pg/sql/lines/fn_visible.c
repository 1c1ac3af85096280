/*
 * fn_visible.c: abacus_visible, whether one place is visible from another over a terrain.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/lines.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/line.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_visible);

/* Arguments */
enum
{
	SIGHT_MESH,
	SIGHT_OBSERVER,
	SIGHT_TARGET,
	SIGHT_ATTRIBUTE,
	SIGHT_OBSERVER_HEIGHT,
	SIGHT_TARGET_HEIGHT,
	SIGHT_MAX_EDGE,
	SIGHT_WITHIN
};

/* Columns */
enum
{
	SIGHT_VISIBLE,
	SIGHT_X,
	SIGHT_COLUMNS = SIGHT_X + 3
};

/* One end: [x, y] stands on the ground, or above it by a height; [x, y, z] does not. */
static void
end_argument(FunctionCallInfo fcinfo, int argument, int height_argument, const char *name,
			 abacus_sight_end *end)
{
	size_t		count;
	double	   *place = line_places(fcinfo, argument, name, &count);
	double		height = PG_ARGISNULL(height_argument) ? 0 : PG_GETARG_FLOAT8(height_argument);

	if (count != 2 && count != 3)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s has %zu elements, not 2 or 3", name, count),
				 errhint("Give [x, y] on the ground, or [x, y, z].")));
	if (!isfinite(height))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s_height must be finite", name)));
	if (count == 3 && height != 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has z, so %s_height must not be given", name, name),
				 errhint("Give a height above the ground only for an end without z.")));
	end->place[0] = place[0];
	end->place[1] = place[1];
	end->stands = count == 2;
	end->height = count == 2 ? height : place[2];
}

/*
 * abacus_visible(mesh regclass, observer float8[], target float8[], attribute text,
 *                observer_height float8, target_height float8, max_edge float8,
 *                within text)
 *     -> visible, x, y, z
 */
Datum
abacus_sql_visible(PG_FUNCTION_ARGS)
{
	abacus_interpolation how;
	abacus_sight_end observer;
	abacus_sight_end target;
	abacus_sight sight;
	CachedMesh *cached;
	Datum		values[SIGHT_COLUMNS];
	bool		isnull[SIGHT_COLUMNS];

	if (interpolation_of_null(fcinfo, SIGHT_TARGET))
		PG_RETURN_NULL();
	cached = mesh_cache_get(PG_GETARG_OID(SIGHT_MESH));
	header_require_dimension(&cached->header.facts.form, 2,
							 "Use a terrain: a mesh in the plane with the height as an attribute.");
	interpolation_attribute(fcinfo, SIGHT_ATTRIBUTE, abacus_names_of(&cached->header), &how);
	extent_arguments(fcinfo, SIGHT_MAX_EDGE, SIGHT_WITHIN, PG_GETARG_OID(SIGHT_MESH), &cached->header, NULL,
					 &how.extent);
	end_argument(fcinfo, SIGHT_OBSERVER, SIGHT_OBSERVER_HEIGHT, "observer", &observer);
	end_argument(fcinfo, SIGHT_TARGET, SIGHT_TARGET_HEIGHT, "target", &target);
	host_run(cached->host, abacus_mesh_look, cached->mesh, how.attribute[0], &how.extent, &observer,
			 &target, &sight);
	host_release(cached->host);
	values[SIGHT_VISIBLE] = BoolGetDatum(sight.kind == ABACUS_SIGHT_FREE);
	isnull[SIGHT_VISIBLE] = sight.kind == ABACUS_SIGHT_UNKNOWN;
	for (int i = 0; i < 3; i++)
	{
		values[SIGHT_X + i] = Float8GetDatum(sight.place[i]);
		isnull[SIGHT_X + i] = sight.kind != ABACUS_SIGHT_BLOCKED;
	}
	PG_RETURN_DATUM(HeapTupleGetDatum(heap_form_tuple(result_row_type(fcinfo), values, isnull)));
}

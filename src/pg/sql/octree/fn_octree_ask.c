/*
 * fn_octree_ask.c: leaves and values at places of an octree: abacus_octree_neighbours,
 * abacus_octree_nearest, abacus_octree_interpolate, and abacus_octree_locate of many places.
 *
 * One place is answered from the session's cache; many are sorted along the curve first.
 */
#include "postgres.h"

#include <math.h>

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/places.h"
#include "pg/sql/octree/octant_row.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_octree_neighbours);
SQL_FUNCTION(abacus_sql_octree_nearest);
SQL_FUNCTION(abacus_sql_octree_nearest_places);
SQL_FUNCTION(abacus_sql_octree_locate_places);
SQL_FUNCTION(abacus_sql_octree_interpolate);
SQL_FUNCTION(abacus_sql_octree_interpolate_places);

/* Prepares for rows with boxes and attributes of leaves. */
static void
answers_begin(Answers *answers, Host *host, const abacus_facts *facts)
{
	answers->host = host;
	answers->facts = facts;
	answers_have_arrays(answers, facts->columns.attributes);
}

/* The columns of a leaf; valid for one row. */
static void
octant_of_row(const Answers *answers, const abacus_octant *octant, Datum *values)
{
	MemoryContext old = MemoryContextSwitchTo(answers->row);

	octant_columns(octant, answers->facts, values);
	MemoryContextSwitchTo(old);
}

/* ---- Neighbours ------------------------------------------------------------- */

/* Adds a neighbour; called by the core. */
static abacus_host_status
put_neighbour(void *context, int32_t axis, int32_t side, const abacus_octant *octant)
{
	Answers    *answers = context;
	Datum		values[2 + OCTANT_COLUMNS];
	bool		isnull[2 + OCTANT_COLUMNS] = {false};

	GUARD_BEGIN();
	values[0] = Int32GetDatum(axis + 1);
	values[1] = Int32GetDatum(side);
	octant_of_row(answers, octant, values + 2);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_octree_neighbours(octree regclass, code bigint)
 *     -> axis, side, code, level, lower, upper, attributes
 */
Datum
abacus_sql_octree_neighbours(PG_FUNCTION_ARGS)
{
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	CachedMesh *cached;

	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get_octree(PG_GETARG_OID(0));
	answers_begin(&answers, cached->host, &cached->header.facts);
	host_run(cached->host, abacus_octree_neighbours, cached->octree,
			 (uint64) PG_GETARG_INT64(1), put_neighbour, &answers);
	host_release(cached->host);
	PG_RETURN_NULL();
}

/* ---- Nearest leaves --------------------------------------------------------- */

/* Adds a leaf near one given place; called by the core. */
static abacus_host_status
put_near(void *context, int64_t place, uint64_t rank, const abacus_octant *octant, double distance)
{
	Answers    *answers = context;
	Datum		values[OCTANT_COLUMNS + 1];
	bool		isnull[OCTANT_COLUMNS + 1] = {false};

	GUARD_BEGIN();
	octant_of_row(answers, octant, values);
	values[OCTANT_COLUMNS] = Float8GetDatum(distance);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_octree_nearest(octree regclass, x float8, y float8[, z float8], k int)
 *     -> code, level, lower, upper, attributes, distance
 */
Datum
abacus_sql_octree_nearest(PG_FUNCTION_ARGS)
{
	int			given = PG_NARGS() - 2;
	uint64		k = place_count_argument(fcinfo, 1 + given, "leaves");
	double		place[ABACUS_MAX_DIMENSION];
	CachedMesh *cached;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get_octree(PG_GETARG_OID(0));
	place_require_z(given, &cached->header.facts.form);
	place_arguments_finite(fcinfo, given, &cached->header.facts.form, place);
	answers_begin(&answers, cached->host, &cached->header.facts);
	host_run(cached->host, abacus_octree_nearest, cached->octree, place, k, put_near, &answers);
	host_release(cached->host);
	PG_RETURN_NULL();
}

/* Columns of a leaf near one of many places */
enum
{
	RANKED_PLACE,
	RANKED_RANK,
	RANKED_CODE,
	RANKED_DISTANCE,
	RANKED_COLUMNS
};

/* Adds a leaf near one of many places; called by the core. */
static abacus_host_status
put_ranked(void *context, int64_t place, uint64_t rank, const abacus_octant *octant,
		   double distance)
{
	Answers    *answers = context;
	Datum		values[RANKED_COLUMNS];
	bool		isnull[RANKED_COLUMNS] = {false};

	values[RANKED_PLACE] = Int64GetDatum(place);
	values[RANKED_RANK] = Int64GetDatum((int64) rank);
	values[RANKED_CODE] = Int64GetDatum((int64) octant->code);
	values[RANKED_DISTANCE] = Float8GetDatum(distance);
	return answers_put(answers, values, isnull);
}

/* abacus_octree_nearest(octree regclass, query text, k int) -> id, rank, code, distance */
Datum
abacus_sql_octree_nearest_places(PG_FUNCTION_ARGS)
{
	uint64		k = place_count_argument(fcinfo, 2, "leaves");
	PlacesRead	read;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), ABACUS_OCTREE, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	answers_begin(&answers, read.host, read.names.facts);
	host_run(answers.host, abacus_octree_places_nearest, read.octants, k, put_ranked, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

/* ---- Leaves at many places --------------------------------------------------- */

/* Adds the leaf at a place; called by the core. */
static abacus_host_status
put_located(void *context, int64_t place, const abacus_octant *octant)
{
	Answers    *answers = context;
	Datum		values[1 + OCTANT_COLUMNS] = {0};
	bool		isnull[1 + OCTANT_COLUMNS];

	GUARD_BEGIN();
	memset(isnull, octant == NULL, sizeof(isnull));
	isnull[0] = false;
	values[0] = Int64GetDatum(place);
	if (octant != NULL)
		octant_of_row(answers, octant, values + 1);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_octree_locate(octree regclass, query text)
 *     -> id, code, level, lower, upper, attributes
 */
Datum
abacus_sql_octree_locate_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	places_read(&read, PG_GETARG_OID(0), ABACUS_OCTREE, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	answers_begin(&answers, read.host, read.names.facts);
	host_run(answers.host, abacus_octree_places_locate, read.octants, put_located, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

/* ---- Values between leaves ---------------------------------------------------- */

/*
 * abacus_octree_interpolate(octree regclass, x float8, y float8[, z float8], attribute text)
 *     -> float8
 */
Datum
abacus_sql_octree_interpolate(PG_FUNCTION_ARGS)
{
	int			given = PG_NARGS() - 2;
	double		place[ABACUS_MAX_DIMENSION];
	abacus_interpolation how;
	CachedMesh *cached;
	double		value;
	abacus_status status;

	if (interpolation_of_null(fcinfo, given))
		PG_RETURN_NULL();
	cached = mesh_cache_get_octree(PG_GETARG_OID(0));
	interpolation_attribute(fcinfo, 1 + given, abacus_names_of(&cached->header), &how);
	if (!place_arguments(fcinfo, given, &cached->header.facts.form, place))
		PG_RETURN_NULL();		/* outside every domain */
	status = host_run(cached->host, abacus_octree_interpolate, cached->octree, how.attribute,
					  how.attributes, place, &value);
	host_release(cached->host);
	if (status == ABACUS_END || isnan(value))
		PG_RETURN_NULL();
	PG_RETURN_FLOAT8(value);
}

/* abacus_octree_interpolate(octree regclass, query text, attributes text[]) -> id, values */
Datum
abacus_sql_octree_interpolate_places(PG_FUNCTION_ARGS)
{
	PlacesRead	read;
	abacus_interpolation how;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	if (interpolation_of_null(fcinfo, 1))
		PG_RETURN_NULL();
	places_open(&read, PG_GETARG_OID(0), ABACUS_OCTREE, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	interpolation_attributes(fcinfo, 2, read.names, &how);
	places_fetch(&read);
	answers.host = read.host;
	answers_have_arrays(&answers, how.attributes);
	host_run(answers.host, abacus_octree_places_interpolate, read.octants, how.attribute,
			 how.attributes, answers_put_values, &answers);
	places_done(&read);
	PG_RETURN_NULL();
}

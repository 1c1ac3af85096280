/*
 * fn_contours.c: abacus_contours, lines of equal value of an attribute, and the
 * bands between them.
 *
 * A line is complete only after all pages have been read, so the rows go into a tuplestore.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/memutils.h"

#include "abacus/area.h"
#include "abacus/contours.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/level_argument.h"
#include "pg/sql/arguments/missing.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/answers.h"
#include "pg/geos/clipped_rings.h"

SQL_FUNCTION(abacus_sql_contours);

/* Arguments */
enum
{
	ARGUMENT_MESH,
	ARGUMENT_INTERVAL,
	ARGUMENT_BASE,
	ARGUMENT_FIXED,
	ARGUMENT_POLYGONIZE,
	ARGUMENT_ATTRIBUTE,
	ARGUMENT_LOWER,
	ARGUMENT_UPPER,
	ARGUMENT_MAX_EDGE,
	ARGUMENT_WITHIN,
	ARGUMENT_MAX_ERROR
};

/* Columns */
enum
{
	CONTOUR_ID,
	CONTOUR_VALUE,
	CONTOUR_CLOSED,
	CONTOUR_PATH,
	CONTOUR_COLUMNS
};

/* An array with this many points is as large as a value may be. */
#define MOST_POINTS ((MaxAllocSize - ARR_OVERHEAD_NONULLS(1) - 1024) / (2 * sizeof(float8)))

/* Points as a float8[]; it may be large, so it is made in one piece. */
static ArrayType *
path_array(const double *path, size_t points)
{
	size_t		bytes = ARR_OVERHEAD_NONULLS(1) + points * 2 * sizeof(float8);
	ArrayType  *array;

	if (points > MOST_POINTS)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("a contour has %zu points, more than an array can hold", points),
				 errhint("Ask for the contours of one part of the mesh at a time, with lower and upper.")));
	array = palloc0(bytes);
	SET_VARSIZE(array, bytes);
	array->ndim = 1;
	array->elemtype = FLOAT8OID;
	ARR_DIMS(array)[0] = (int) (points * 2);
	ARR_LBOUND(array)[0] = 1;
	memcpy(ARR_DATA_PTR(array), path, points * 2 * sizeof(float8));
	return array;
}

/* Adds the row of a line or ring. */
static void
add_contour(const Answers *answers, int64 id, double value, bool closed, const double *path, size_t count)
{
	Datum		values[CONTOUR_COLUMNS];
	bool		isnull[CONTOUR_COLUMNS] = {false};

	values[CONTOUR_ID] = Int64GetDatum(id);
	values[CONTOUR_VALUE] = Float8GetDatum(value);
	values[CONTOUR_CLOSED] = BoolGetDatum(closed != 0);
	values[CONTOUR_PATH] = PointerGetDatum(path_array(path, count));
	tuplestore_putvalues(answers->set->setResult, answers->set->setDesc, values, isnull);
	pfree(DatumGetPointer(values[CONTOUR_PATH]));
}

/* Called by the core. */
static abacus_host_status
put_contour(void *context, int64_t id, double value, int32_t closed, const double *path, size_t count)
{
	Answers    *answers = context;

	GUARD_BEGIN();
	add_contour(answers, id, value, closed != 0, path, count);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/* ---- Bands in a polygon ------------------------------------------------------------------- */

/*
 * Bands of whole triangles are cut by the polygon, and by the window as another one: so their rings are
 * those of the mesh, which no rounding at a side can make invalid.
 */
typedef struct ClippedBands
{
	Answers    *answers;
	const char *polygon;
	const char *window;			/* NULL: there is none */
	RingSet		band,			/* that is read */
				clipped;
	int64		given,			/* its number */
				id;				/* of the last one with a part in the polygon */
	double		value;
} ClippedBands;

/* Adds the rows of the band that was read. */
static void
end_band(ClippedBands *bands)
{
	const double *path;

	clip_rings(&bands->band, bands->polygon, &bands->clipped);
	ring_set_clear(&bands->band);
	if (bands->window != NULL)
	{
		clip_rings(&bands->clipped, bands->window, &bands->band);
		ring_set_clear(&bands->clipped);
		ring_set_swap(&bands->clipped, &bands->band);
	}
	path = bands->clipped.places;
	if (bands->clipped.rings > 0)
		bands->id++;
	for (size_t i = 0; i < bands->clipped.rings; path += 2 * bands->clipped.sizes[i++])
		add_contour(bands->answers, bands->id, bands->value, true, path, bands->clipped.sizes[i]);
}

/* Called by the core. */
static abacus_host_status
put_ring(void *context, int64_t id, double value, int32_t closed, const double *path, size_t count)
{
	ClippedBands *bands = context;

	GUARD_BEGIN();
	if (id != bands->given)
		end_band(bands);
	bands->given = id;
	bands->value = value;
	memcpy(ring_set_add(&bands->band, count), path, count * 2 * sizeof(double));
	GUARD_END(bands->answers->host);
	return ABACUS_HOST_OK;
}

/* A window as a polygon. */
static char *
window_polygon(const abacus_window *window)
{
	const double *a = window->lower;
	const double *b = window->upper;

	return psprintf("POLYGON((%.17g %.17g,%.17g %.17g,%.17g %.17g,%.17g %.17g,%.17g %.17g))",
					a[0], a[1], b[0], a[1], b[0], b[1], a[0], b[1], a[0], a[1]);
}

/* Gives an extent the box in which the polygon and the window meet; false if they do not. */
static bool
narrow(abacus_extent *extent, const abacus_window *window)
{
	if (!abacus_area_box(extent->area, extent->lower, extent->upper))
		return false;
	for (int i = 0; i < 2 && window->kind != ABACUS_NO_WINDOW; i++)
	{
		extent->lower[i] = Max(extent->lower[i], window->lower[i]);
		extent->upper[i] = Min(extent->upper[i], window->upper[i]);
	}
	extent->has_box = 1;
	extent->area = NULL;
	return extent->lower[0] <= extent->upper[0] && extent->lower[1] <= extent->upper[1];
}

static void
put_bands_within(Reader *reader, const abacus_window *window, const abacus_contouring *how, const char *polygon,
				 Answers *answers)
{
	static const abacus_window none = {0};
	ClippedBands bands = {.answers = answers, .polygon = polygon};
	abacus_contouring whole = *how;

	if (!narrow(&whole.extent, window))
		return;
	if (window->kind != ABACUS_NO_WINDOW)
		bands.window = window_polygon(window);
	ring_set_begin(&bands.band);
	ring_set_begin(&bands.clipped);
	host_run(reader->host, abacus_contours, &reader->host->table, &reader->header.facts, &none, &whole,
			 setting_query_sort_bytes() + setting_cache_bytes(), put_ring, &bands);
	end_band(&bands);
	ring_set_end(&bands.band);
	ring_set_end(&bands.clipped);
}

static int
compare_doubles(const void *a, const void *b)
{
	double		x = *(const double *) a,
				y = *(const double *) b;

	return (x > y) - (x < y);
}

/* Levels in ascending order, each once. */
static void
fixed_levels(ArrayType *array, abacus_contouring *how)
{
	int			count;
	Datum	   *elements = shape_numbers(array, "fixed_levels", &count);
	double	   *levels = palloc((count + 1) * sizeof(double));
	size_t		kept = 0;

	for (int i = 0; i < count; i++)
	{
		levels[i] = DatumGetFloat8(elements[i]) + 0.0;
		if (!isfinite(levels[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("fixed_levels must be finite")));
	}
	qsort(levels, count, sizeof(double), compare_doubles);
	for (int i = 0; i < count; i++)
		if (kept == 0 || levels[i] != levels[kept - 1])
			levels[kept++] = levels[i];
	how->fixed = levels;
	how->fixed_count = kept;
}

/* The levels; NULL means the same as omitting an argument. */
static void
level_arguments(FunctionCallInfo fcinfo, abacus_contouring *how)
{
	how->interval = PG_ARGISNULL(ARGUMENT_INTERVAL) ? 100 : PG_GETARG_FLOAT8(ARGUMENT_INTERVAL);
	how->base = PG_ARGISNULL(ARGUMENT_BASE) ? 0 : PG_GETARG_FLOAT8(ARGUMENT_BASE);
	if (!PG_ARGISNULL(ARGUMENT_FIXED))
		fixed_levels(PG_GETARG_ARRAYTYPE_P(ARGUMENT_FIXED), how);
	if (!isfinite(how->interval) || how->interval <= 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("level_interval must be a finite number greater than 0"),
				 errhint("Give the difference between a level and the next one.")));
	if (!isfinite(how->base))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("level_base must be finite"),
				 errhint("Give one of the levels; the others are multiples of level_interval away "
						 "from it.")));
}

/*
 * abacus_contours(mesh regclass, level_interval float8, level_base float8, fixed_levels float8[],
 * polygonize bool, attribute text, lower float8[], upper float8[], max_edge float8,
 * within text, max_error float8)
 *     -> id, value, closed, path
 */
Datum
abacus_sql_contours(PG_FUNCTION_ARGS)
{
	static const LevelArguments level = {
		.mesh = ARGUMENT_MESH,.attribute = ARGUMENT_ATTRIBUTE,.within = ARGUMENT_WITHIN,.regions = -1,
		.step = -1,.max_error = ARGUMENT_MAX_ERROR,.pixel_error = -1
	};
	Oid			mesh;
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	abacus_contouring how = {0};
	abacus_window window = {0};
	Reader	   *reader;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(ARGUMENT_MESH))
		PG_RETURN_NULL();
	mesh = level_argument(fcinfo, &level);
	reader = reader_open(mesh, CurrentMemoryContext);
	header_require_dimension(&reader->header.facts.form, 2,
							 "Use abacus_isosurface for a mesh of dimension 3.");
	level_arguments(fcinfo, &how);
	how.bands = !PG_ARGISNULL(ARGUMENT_POLYGONIZE) && PG_GETARG_BOOL(ARGUMENT_POLYGONIZE);
	how.attribute = attribute_argument(fcinfo, ARGUMENT_ATTRIBUTE, abacus_names_of(&reader->header));
	extent_arguments(fcinfo, ARGUMENT_MAX_EDGE, ARGUMENT_WITHIN, mesh,
					 &reader->header, reader->host, &how.extent);
	window_arguments(fcinfo, ARGUMENT_LOWER, WINDOW_BOX, &reader->header.facts.form, &window);
	answers.host = reader->host;
	progress_begin(&reader->host->progress, mesh);
	if (how.bands != 0 && how.extent.area != NULL)
		put_bands_within(reader, &window, &how, text_to_cstring(PG_GETARG_TEXT_PP(ARGUMENT_WITHIN)), &answers);
	else
		host_run(reader->host, abacus_contours, &reader->host->table, &reader->header.facts, &window, &how,
				 setting_query_sort_bytes() + setting_cache_bytes(), put_contour, &answers);
	progress_end(&reader->host->progress);
	if (tuplestore_tuple_count(answers.set->setResult) == 0)
		notice_missing_values(reader, how.attribute);
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}

/*
 * bounds.c: the part of a mesh that a scan needs, once the values of its conditions are known.
 *
 * A point must meet all boxes, so it is in their intersection. A cell may meet two boxes in
 * different places. So only one condition is used to look for cells: one that the cell itself must
 * meet, rather than its bounding box, or else the smallest box.
 */
#include "postgres.h"

#include <float.h>
#include <math.h>

#include "catalog/pg_type.h"
#include "nodes/nodeFuncs.h"

#include "pg/fdw/conditions.h"
#include "pg/port/port.h"
#include "pg/postgis/geometry_box.h"
#include "pg/postgis/geometry_errors.h"

/* PostGIS computes distances with a relative error far below this. */
#define DISTANCE_ERROR 1e-9

/* The values of an attribute that the conditions allow. */
typedef struct Range
{
	int			number;
	double		least;
	double		greatest;
} Range;

/* The limits from the conditions so far. */
typedef struct Limits
{
	Bounds	   *bounds;
	Content		content;
	uint32		dimension;
	double		lower[ABACUS_MAX_DIMENSION];
	double		upper[ABACUS_MAX_DIMENSION];
	bool		has_box;
	ConditionKind kind;			/* of the condition that gave the box of cells */
	int32		srid;			/* of the column, or SRID_UNKNOWN */
	Range	   *ranges;			/* of each attribute in a comparison */
	int			range_count;
	int64		least_code;
	int64		greatest_code;
} Limits;

static void
limit(Limits *limits, double *least, double *greatest, ConditionKind kind, double value)
{
	if (isnan(value))			/* greater than all numbers */
	{
		if (kind != CONDITION_GREATEST)
			limits->bounds->nothing = true;
		return;
	}
	if (kind != CONDITION_GREATEST)
		*least = Max(*least, value);
	if (kind != CONDITION_LEAST)
		*greatest = Min(*greatest, value);
	if (!(*least <= *greatest))
		limits->bounds->nothing = true;
}

/* The range of an attribute. */
static Range *
range_of(Limits *limits, int number)
{
	Range	   *range = limits->ranges;

	while (range < limits->ranges + limits->range_count && range->number != number)
		range++;
	if (range == limits->ranges + limits->range_count)
	{
		*range = (Range) {number, -INFINITY, INFINITY};
		limits->range_count++;
	}
	return range;
}

/* A column is compared with a number. */
static void
limit_number(Limits *limits, const Condition *condition, double value)
{
	int			number = condition->column.number;

	if (condition->column.holds == HOLDS_ATTRIBUTE)
	{
		Range	   *range = range_of(limits, number);

		limit(limits, &range->least, &range->greatest, condition->kind, value);
	}
	else if (number < limits->dimension)
	{
		limit(limits, &limits->lower[number], &limits->upper[number], condition->kind, value);
		limits->has_box = true;
	}
}

/* A code is compared with an integer of any size. */
static void
limit_code(Limits *limits, const Condition *condition, Datum datum)
{
	Oid			type = exprType((Node *) condition->value);
	int64		value = type == INT2OID ? DatumGetInt16(datum)
		: type == INT4OID ? DatumGetInt32(datum) : DatumGetInt64(datum);

	if (condition->kind != CONDITION_GREATEST)
		limits->least_code = Max(limits->least_code, value);
	if (condition->kind != CONDITION_LEAST)
		limits->greatest_code = Min(limits->greatest_code, value);
	if (limits->least_code > limits->greatest_code)
		limits->bounds->nothing = true;
}

static double
size_of(const double *lower, const double *upper)
{
	return (upper[0] - lower[0]) * (upper[1] - lower[1]);
}

static void
limit_points(Limits *limits, const double *lower, const double *upper)
{
	limits->has_box = true;
	for (int k = 0; k < 2; k++)
	{
		limits->lower[k] = Max(limits->lower[k], lower[k]);
		limits->upper[k] = Min(limits->upper[k], upper[k]);
		if (!(limits->lower[k] <= limits->upper[k]))
			limits->bounds->nothing = true;
	}
}

static void
limit_cells(Limits *limits, ConditionKind kind, const double *lower, const double *upper)
{
	bool		is_first = !limits->has_box;
	bool		was_box = limits->kind == CONDITION_BOX;
	bool		is_box = kind == CONDITION_BOX;

	if (!is_first && (was_box == is_box
					  ? size_of(lower, upper) >= size_of(limits->lower, limits->upper) : is_box))
		return;
	limits->has_box = true;
	limits->kind = kind;
	for (int k = 0; k < 2; k++)
	{
		limits->lower[k] = lower[k];
		limits->upper[k] = upper[k];
	}
}

static double
single_beyond(double x, float direction)
{
	float		single = (float) x;

	if (isinf(single))
		single = copysignf(FLT_MAX, single);
	return Max(-DBL_MAX, Min(DBL_MAX, nextafterf(nextafterf(single, direction), direction)));
}

/*
 * Operators of PostGIS compare boxes after rounding both outward to single precision. This box is
 * widened so that it meets, as it is, every box that meets the rounded one.
 */
static void
round_outward(double *lower, double *upper)
{
	for (int k = 0; k < 2; k++)
	{
		lower[k] = single_beyond(lower[k], -INFINITY);
		upper[k] = single_beyond(upper[k], INFINITY);
	}
}

/*
 * The row's geometry must meet a geometry, itself or by its box, or come within a distance of it.
 */
static void
limit_geometry(Limits *limits, const Condition *condition, Datum geometry, double distance)
{
	const GeometryType *type = geometry_type(exprType((Node *) condition->value));
	double		lower[2];
	double		upper[2];
	int32		srid;
	GeometryBox place = geometry_box(type, geometry, lower, upper, &srid);

	/* PostGIS reports this for each row that it examines, but there may be none to examine */
	if (condition->kind != CONDITION_BOX && limits->srid != SRID_UNKNOWN && srid != limits->srid)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 srid == 0
				 ? errmsg("the geometry has no SRID, but the geometries of the foreign table have SRID %d",
						  limits->srid)
				 : errmsg("the geometry has SRID %d, but the geometries of the foreign table have SRID %d",
						  srid, limits->srid),
				 srid == 0
				 ? errhint("Give the geometry its SRID with ST_SetSRID(). If the SRID of the mesh has been changed, "
						   "publish the mesh again.")
				 : errhint("Transform the geometry with ST_Transform(). If the SRID of the mesh has been changed, "
						   "publish the mesh again.")));
	if (!(distance >= 0))		/* PostGIS reports what is wrong with it */
		return;
	switch (place)
	{
		case GEOMETRY_ANYWHERE:
			return;
		case GEOMETRY_NOWHERE:
			limits->bounds->nothing = true;
			return;
		case GEOMETRY_IN_BOX:
			break;
	}
	round_outward(lower, upper);
	for (int k = 0; k < 2 && condition->kind == CONDITION_NEAR; k++)
	{
		double		reach = distance +
			DISTANCE_ERROR * (fabs(distance) + fabs(lower[k]) + fabs(upper[k]));

		lower[k] = Max(-DBL_MAX, lower[k] - reach);
		upper[k] = Min(DBL_MAX, upper[k] + reach);
	}
	if (limits->content == CONTENT_POINTS)
		limit_points(limits, lower, upper);
	else
		limit_cells(limits, condition->kind, lower, upper);
}

static void
set_window(const Limits *limits, abacus_window *window)
{
	if (!limits->has_box)
		return;
	window->kind = limits->content == CONTENT_CELLS && limits->kind == CONDITION_BOX
		? ABACUS_BOUNDS_WINDOW : ABACUS_BOX_WINDOW;
	for (uint32 i = 0; i < limits->dimension; i++)
	{
		window->lower[i] = limits->lower[i];
		window->upper[i] = limits->upper[i];
	}
}

/* The range of one attribute: the first with two ends, or else the first with one. */
static void
set_range(const Limits *limits, Bounds *bounds)
{
	int			most = 0;

	for (const Range *range = limits->ranges; range < limits->ranges + limits->range_count; range++)
	{
		int			ends = !isinf(range->least) + !isinf(range->greatest);

		if (ends < most || ends == 0 ||
			(ends == most && range->number > (int) bounds->range.attribute))
			continue;
		most = ends;
		bounds->has_range = true;
		bounds->range.attribute = (uint32) range->number;
		bounds->range.least = range->least;
		bounds->range.greatest = range->greatest;
	}
}

/* A stretch of the curve, if it has both ends or there is no window. */
static void
set_codes(const Limits *limits, Bounds *bounds)
{
	bool		has_end = limits->greatest_code < PG_INT64_MAX;
	bool		has_begin = limits->least_code > 0;

	bounds->has_codes = !bounds->nothing && (has_begin || has_end) &&
		((has_begin && has_end) || !limits->has_box);
	bounds->least_code = (uint64) limits->least_code;
	bounds->greatest_code = (uint64) limits->greatest_code;
}

/*
 * The limits that the conditions set on a scan; conditions with unknown values are skipped. `srid`:
 * of the column with geometries; it is an error if a condition's geometry has another one.
 */
void
conditions_bounds(List *conditions, Content content, uint32 dimension, int32 srid,
				  ConditionValue value, void *context, Bounds *bounds)
{
	Limits		limits = {
		.bounds = bounds, .content = content, .dimension = dimension, .srid = srid
	};
	ListCell   *cell;

	MemSet(bounds, 0, sizeof(*bounds));
	for (int i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		limits.lower[i] = -DBL_MAX;
		limits.upper[i] = DBL_MAX;
	}
	limits.greatest_code = PG_INT64_MAX;
	limits.ranges = palloc(Max(1, list_length(conditions)) * sizeof(Range));
	foreach(cell, conditions)
	{
		Condition  *condition = lfirst(cell);
		Datum		datum;
		Datum		distance = Float8GetDatum(0);
		bool		isnull;
		bool		distance_isnull = false;

		if (!value(context, foreach_current_index(cell), false, &datum, &isnull) ||
			(condition->distance != NULL &&
			 !value(context, foreach_current_index(cell), true, &distance, &distance_isnull)))
			continue;
		if (isnull || distance_isnull)
			bounds->nothing = true; /* these are never true for NULL */
		else if (condition->column.holds == HOLDS_GEOMETRY)
			limit_geometry(&limits, condition, datum, DatumGetFloat8(distance));
		else if (condition->column.holds == HOLDS_CODE)
			limit_code(&limits, condition, datum);
		else
			limit_number(&limits, condition, DatumGetFloat8(datum));
	}
	set_window(&limits, &bounds->window);
	set_range(&limits, bounds);
	set_codes(&limits, bounds);
	pfree(limits.ranges);
}

/*
 * drawing.c: the common part of functions that draw: arguments, and the picture as a result.
 */
#include "postgres.h"

#include <math.h>

#include "utils/builtins.h"
#include "utils/memutils.h"

#include "pg/mesh/shape.h"
#include "pg/sql/arguments/word.h"
#include "pg/sql/draw/drawing.h"

#define MAX_PIXELS 16384

/* The pixels of a side; `otherwise` if not given. */
int32
drawing_pixels(FunctionCallInfo fcinfo, int argument, int32 otherwise, const char *name)
{
	int32		value;

	if (PG_ARGISNULL(argument))
		return otherwise;
	value = PG_GETARG_INT32(argument);
	if (value < 1 || value > MAX_PIXELS)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s must be between 1 and %d pixels, not %d", name, MAX_PIXELS, value)));
	return value;
}

/* A factor or length; 0 if not given. */
double
drawing_factor(FunctionCallInfo fcinfo, int argument, const char *name)
{
	double		value = PG_ARGISNULL(argument) ? 0 : PG_GETARG_FLOAT8(argument);

	if (!isfinite(value) || value < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s must be a finite number, at least 0", name)));
	return value;
}

/* Whether an argument that needs values is given; a notice if there are no values. */
bool
drawing_is_given(FunctionCallInfo fcinfo, int argument, const char *name,
				 const abacus_drawing *drawing)
{
	if (PG_ARGISNULL(argument))
		return false;
	if (drawing->attribute < 0)
		ereport(NOTICE, (errmsg("%s has no effect without an attribute", name)));
	return true;
}

/* The values at the ends of the colours, if given. */
void
drawing_range(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing)
{
	if (drawing_is_given(fcinfo, argument, "range", drawing))
		shape_range(PG_GETARG_ARRAYTYPE_P(argument), "range", drawing->range);
}

/* In the order of the core's numbers, which begin with 1 */
static const char *const ramps[] = {"terrain", "strata", "viridis", "magma", "cividis", "grey",
"diverging", NULL};

abacus_ramp
drawing_ramp_argument(FunctionCallInfo fcinfo, int argument)
{
	return ABACUS_RAMP_TERRAIN +
		word_argument(fcinfo, argument, ramps, "ramp",
					  "Use terrain, strata, viridis, magma, cividis, grey or diverging.");
}

void
drawing_ramp(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing)
{
	if (drawing_is_given(fcinfo, argument, "ramp", drawing))
		drawing->ramp = drawing_ramp_argument(fcinfo, argument);
}

/* The interval of contours; 0 if not given. */
double
drawing_interval(FunctionCallInfo fcinfo, int argument)
{
	double		interval;

	if (PG_ARGISNULL(argument))
		return 0;
	interval = PG_GETARG_FLOAT8(argument);
	if (!isfinite(interval) || interval <= 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("contours must be a finite number above 0"),
				 errhint("Give the difference in value from one line to the next.")));
	return interval;
}

void
drawing_contours(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing)
{
	if (drawing_is_given(fcinfo, argument, "contours", drawing))
		drawing->contour_interval = drawing_interval(fcinfo, argument);
}

/* Whether an argument is true. */
bool
drawing_flag(FunctionCallInfo fcinfo, int argument)
{
	return !PG_ARGISNULL(argument) && PG_GETARG_BOOL(argument);
}

/* Whether regions and fixed edges are drawn. */
void
drawing_overlay(FunctionCallInfo fcinfo, int regions, int lines, abacus_drawing *drawing)
{
	drawing->regions = drawing_flag(fcinfo, regions);
	drawing->lines = drawing_flag(fcinfo, lines);
}

/* Appends a part to a bytea, and frees it. */
static char *
append(Host *host, char *to, const abacus_picture *part)
{
	if (part->size > 0)			/* an empty vector tile has none */
	{
		memcpy(to, part->png, part->size);
		host->table.resize(host, part->png, 0);
	}
	return to + part->size;
}

/* Ends the reading; converts the picture, whose bytes are two parts, to a bytea. */
bytea *
drawing_finish_both(Host *host, const abacus_picture *first, const abacus_picture *second)
{
	size_t		size = first->size + second->size;
	bytea	   *result;

	if (size > MaxAllocSize - VARHDRSZ)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED), errmsg("picture is too large"),
				 errhint("Draw fewer pixels.")));
	result = palloc(VARHDRSZ + size);
	SET_VARSIZE(result, VARHDRSZ + size);
	(void) append(host, append(host, VARDATA(result), first), second);
	host_release(host);
	host_destroy(host);
	return result;
}

/* The same for one part. */
bytea *
drawing_finish(Host *host, const abacus_picture *picture)
{
	const abacus_picture none = {0};

	return drawing_finish_both(host, picture, &none);
}

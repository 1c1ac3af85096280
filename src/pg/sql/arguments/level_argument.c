/*
 * level_argument.c: the arguments max_error and pixel_error, which choose a level of a mesh.
 *
 * Without them the full mesh is read, whether it has levels or not.
 */
#include "postgres.h"

#include <math.h>

#include "utils/builtins.h"

#include "pg/geos/area_text.h"
#include "pg/levels/levels_table.h"
#include "pg/sql/arguments/level_argument.h"

static bool
is_given(FunctionCallInfo fcinfo, int argument)
{
	return argument >= 0 && !PG_ARGISNULL(argument);
}

/* Levels have no regions, so what asks for one needs the full mesh. */
static void
refuse_regions(FunctionCallInfo fcinfo, const LevelArguments *arguments)
{
	if (is_given(fcinfo, arguments->within) &&
		!area_text_is(text_to_cstring(PG_GETARG_TEXT_PP(arguments->within))))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("within must not be a region where an error is allowed"),
				 errdetail("Levels of a mesh have no regions."),
				 errhint("Give a polygon as WKT, or leave out max_error and pixel_error.")));
	if (is_given(fcinfo, arguments->regions) && PG_GETARG_BOOL(arguments->regions))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("regions cannot be drawn where an error is allowed"),
				 errdetail("Levels of a mesh have no regions."),
				 errhint("Leave out regions, or max_error and pixel_error.")));
}

/* The error of a level is that of an attribute, and says nothing of a solution. */
static void
refuse_step(FunctionCallInfo fcinfo, const LevelArguments *arguments)
{
	if (is_given(fcinfo, arguments->step))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("step cannot be read where an error is allowed"),
				 errdetail("The error of a level is that of an attribute, not of a step."),
				 errhint("Leave out step, or max_error and pixel_error.")));
}

static Oid
choose(FunctionCallInfo fcinfo, const LevelArguments *arguments, double max_error)
{
	char	   *attribute = is_given(fcinfo, arguments->attribute)
		? text_to_cstring(PG_GETARG_TEXT_PP(arguments->attribute)) : NULL;

	refuse_regions(fcinfo, arguments);
	refuse_step(fcinfo, arguments);
	return levels_choose(PG_GETARG_OID(arguments->mesh), max_error, attribute);
}

/* The mesh to read: the coarsest level whose error is at most max_error, if that is given. */
Oid
level_argument(FunctionCallInfo fcinfo, const LevelArguments *arguments)
{
	if (!is_given(fcinfo, arguments->max_error))
		return PG_GETARG_OID(arguments->mesh);
	return choose(fcinfo, arguments, PG_GETARG_FLOAT8(arguments->max_error));
}

/* The same for a tile, whose error may be given in pixels of this size on the ground. */
Oid
level_of_pixel(FunctionCallInfo fcinfo, const LevelArguments *arguments, double pixel)
{
	double		pixels;

	if (!is_given(fcinfo, arguments->pixel_error))
		return level_argument(fcinfo, arguments);
	pixels = PG_GETARG_FLOAT8(arguments->pixel_error);
	if (is_given(fcinfo, arguments->max_error))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("max_error and pixel_error exclude each other"),
				 errhint("Give max_error for the same error at all zooms, pixel_error for one that follows the zoom.")));
	if (isnan(pixels) || pixels < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("pixel_error must be a number, at least 0"),
				 errhint("Give the greatest error in pixels on the ground, for instance 1.")));
	return choose(fcinfo, arguments, pixels * pixel);
}

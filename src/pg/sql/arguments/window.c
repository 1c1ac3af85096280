/*
 * window.c: the part of a mesh that a call asks for: a box, which may be flat, or a ball; and which
 * simplices in it, by a label.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/mesh/header.h"
#include "pg/mesh/mesh_pages.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/units.h"
#include "pg/sql/arguments/window.h"

/* A closed box; the whole mesh if neither corner is given. */
static void
window_of_box(const abacus_form *form, ArrayType *lower, ArrayType *upper,
			  abacus_window *window)
{
	window->kind = ABACUS_NO_WINDOW;
	if (lower == NULL && upper == NULL)
		return;
	if (lower == NULL || upper == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("lower and upper must be given together"),
				 errhint("Leave both out for all of the %s.", type_name(form->type))));
	window->kind = ABACUS_BOX_WINDOW;
	shape_point(form, lower, "lower", window->lower);
	shape_point(form, upper, "upper", window->upper);
	for (uint32 i = 0; i < form->dimension; i++)
		if (!isfinite(window->lower[i]) || !isfinite(window->upper[i]) ||
			window->lower[i] > window->upper[i])
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("lower must not be greater than upper, and both must be finite, on axis %c",
							"xyz"[i]),
					 errhint("lower is the corner of the window with the least coordinates.")));
	units_tell_window(form, window->lower, window->upper);
}

/* A closed ball. */
static void
window_of_ball(const abacus_form *form, ArrayType *center, double radius,
			   abacus_window *window)
{
	double		lower[ABACUS_MAX_DIMENSION];
	double		upper[ABACUS_MAX_DIMENSION];

	window->kind = ABACUS_BALL_WINDOW;
	shape_point(form, center, "center", window->center);
	window->radius = radius;
	for (uint32 i = 0; i < form->dimension; i++)
		if (!isfinite(window->center[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("center must be finite on axis %c", "xyz"[i]),
					 errhint("Give finite coordinates.")));
	if (!isfinite(radius) || radius < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("radius must be a finite number, at least 0"),
				 errhint("A ball of radius 0 is the center alone.")));
	for (uint32 i = 0; i < form->dimension; i++)
	{
		lower[i] = window->center[i] - radius;
		upper[i] = window->center[i] + radius;
	}
	units_tell_window(form, lower, upper);
}

/*
 * A corner: an array, or an array written as a text. PostgreSQL takes a quoted argument for a text
 * if there is a form of the function with a text, so '{0,0}', '{9,9}' must be corners.
 */
static ArrayType *
corner(FunctionCallInfo fcinfo, int argument)
{
	char	   *given;
	Oid			input;
	Oid			parameter;

	if (PG_ARGISNULL(argument))
		return NULL;
	if (get_fn_expr_argtype(fcinfo->flinfo, argument) != TEXTOID)
		return PG_GETARG_ARRAYTYPE_P(argument);
	given = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	if (strchr("{[", given[strspn(given, " \t\n\r\f\v")]) == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TEXT_REPRESENTATION),
				 errmsg("upper must be an array, not \"%s\"", given),
				 errhint("If a radius is meant, name it, or leave the quotes out: radius => %s.", given)));
	getTypeInputInfo(FLOAT8ARRAYOID, &input, &parameter);
	return DatumGetArrayTypeP(OidInputFunctionCall(input, given, parameter, -1));
}

/* The window of a call: the first of two arguments. */
void
window_arguments(FunctionCallInfo fcinfo, int first, WindowForm kind,
				 const abacus_form *form, abacus_window *window)
{
	if (kind == WINDOW_BOX)
		window_of_box(form, corner(fcinfo, first), corner(fcinfo, first + 1), window);
	else if (PG_ARGISNULL(first) || PG_ARGISNULL(first + 1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("center and radius must not be NULL"),
				 errhint("Leave both out for all of the %s.", type_name(form->type))));
	else
		window_of_ball(form, PG_GETARG_ARRAYTYPE_P(first), PG_GETARG_FLOAT8(first + 1), window);
}

/*
 * The range of a label or an attribute: the first of two arguments is its name, `what` says which
 * it is. Without a range every value will do. False if no name is given.
 */
static bool
has_range(FunctionCallInfo fcinfo, int first, const char *what, const char *example,
		  abacus_range *range)
{
	double		ends[2] = {-INFINITY, INFINITY};

	if (PG_ARGISNULL(first))
	{
		if (!PG_ARGISNULL(first + 1))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("range needs %s, but none is given", what),
					 errhint("Name it, as in %s.", example)));
		return false;
	}
	if (!PG_ARGISNULL(first + 1))
		shape_pair(PG_GETARG_ARRAYTYPE_P(first + 1), "range", ends);
	if (!(ends[0] <= ends[1]))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("range must be two numbers, the first not greater than the second"),
				 errhint("Use -Infinity or Infinity for a range that is open at one end.")));
	range->least = ends[0];
	range->greatest = ends[1];
	return true;
}

/* The label that simplices must have, and its range; false if no label is required. */
bool
window_label(FunctionCallInfo fcinfo, int first, abacus_names names, abacus_range *range)
{
	if (!has_range(fcinfo, first, "a label", "label => 'material'", range))
		return false;
	range->attribute = (uint32) header_find_label(names,
												  text_to_cstring(PG_GETARG_TEXT_PP(first)));
	return true;
}

/* The attribute that vertices must have, and its range; false if no attribute is required. */
bool
window_attribute(FunctionCallInfo fcinfo, int first, abacus_names names,
				 abacus_range *range)
{
	if (!has_range(fcinfo, first, "an attribute", "attribute => 'height'", range))
		return false;
	range->attribute = attribute_argument(fcinfo, first, names);
	return true;
}

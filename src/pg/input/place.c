/*
 * place.c: a place given as x, y and, in space, z after the mesh, and k after them.
 */
#include "postgres.h"

#include <math.h>

#include "pg/base/type_name.h"
#include "pg/input/place.h"

/*
 * Reads the `given` coordinates after the first argument. False if one is infinite; NaN is an
 * error.
 */
bool
place_arguments(FunctionCallInfo fcinfo, int given, const abacus_form *form, double *point)
{
	uint32		dimension = form->dimension;
	bool		finite = true;

	if (given != (int) dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("z is %s, but the %s has dimension %u",
						dimension == 2 ? "given" : "missing", type_name(form->type), dimension),
				 dimension == 2
				 ? errhint("Leave z out, or make the %s with dimension => 3.", type_name(form->type))
				 : errhint("Give all three coordinates of the point.")));
	for (uint32 i = 0; i < dimension; i++)
	{
		point[i] = PG_GETARG_FLOAT8(1 + i);
		if (isnan(point[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("%c is not a number", "xyz"[i])));
		finite &= isfinite(point[i]) != 0;
	}
	return finite;
}

/* For functions where k follows: it may have been meant as a z that is missing. */
void
place_require_z(int given, const abacus_form *form)
{
	if (given < (int) form->dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("z is missing, but the %s has dimension %u", type_name(form->type),
						form->dimension),
				 errhint("Give z with a decimal point or as z => 1: a whole number after y is "
						 "taken as k.")));
}

/* The argument k of a function that returns the k nearest rows. */
uint64
place_count_argument(FunctionCallInfo fcinfo, int argument, const char *rows)
{
	int32		k = PG_GETARG_INT32(argument);

	if (k < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("k must be at least 1, not %d", k),
				 errhint("Set k to the number of %s to return.", rows)));
	return (uint64) k;
}

/* Reads coordinates, where an infinite one is also an error. */
void
place_arguments_finite(FunctionCallInfo fcinfo, int given, const abacus_form *form,
					   double *point)
{
	if (!place_arguments(fcinfo, given, form, point))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("a coordinate of the place is infinite"),
				 errhint("Give finite coordinates.")));
}

/*
 * line.c: places given as arrays, for functions that follow lines.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/array.h"

#include "pg/sql/arguments/line.h"

/* The elements of an argument, in an array of one dimension or more; all are finite. */
double *
line_places(FunctionCallInfo fcinfo, int argument, const char *what, size_t *count)
{
	ArrayType  *array = PG_GETARG_ARRAYTYPE_P(argument);
	Datum	   *elements;
	int			length;
	double	   *values;

	if (array_contains_nulls(array))
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s must be an array without NULLs", what)));
	deconstruct_array(array, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
					  &elements, NULL, &length);
	values = palloc(Max(length, 1) * sizeof(double));
	for (int i = 0; i < length; i++)
	{
		values[i] = DatumGetFloat8(elements[i]);
		if (!isfinite(values[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("%s must be finite, but its element %d is %s", what, i + 1,
							isnan(values[i]) ? "not a number" : "infinite"),
					 errhint("Give finite coordinates.")));
	}
	*count = (size_t) length;
	return values;
}

/* One place, or direction. */
void
line_place(FunctionCallInfo fcinfo, int argument, const char *what, uint32 dimension,
		   double *place)
{
	size_t		count;
	double	   *values = line_places(fcinfo, argument, what, &count);

	if (count != dimension)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s has %zu elements, but the mesh has dimension %u", what, count,
						dimension),
				 count == 3 ? errhint("To make one in space, use dimension => 3.") : 0));
	memcpy(place, values, dimension * sizeof(double));
}

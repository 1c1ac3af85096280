/*
 * float_array.c: figures of the core as float8[].
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/array.h"

#include "pg/base/float_array.h"
#include "pg/port/port.h"

/* Doubles as float8[] without NULLs: the array holds them exactly as they are here. */
static Datum
array_without_nulls(const double *values, int size, int dimensions, const int *counts)
{
	size_t		overhead = ARR_OVERHEAD_NONULLS(dimensions);
	ArrayType  *array = palloc0(overhead + size * sizeof(float8));

	SET_VARSIZE(array, overhead + size * sizeof(float8));
	array->ndim = dimensions;
	array->elemtype = FLOAT8OID;
	for (int i = 0; i < dimensions; i++)
	{
		ARR_DIMS(array)[i] = counts[i];
		ARR_LBOUND(array)[i] = 1;
	}
	memcpy(ARR_DATA_PTR(array), values, size * sizeof(float8));
	return PointerGetDatum(array);
}

/* Doubles as float8[]; the core's NaN is SQL's NULL. */
static Datum
float_array(const double *values, int dimensions, int *counts)
{
	int			size = dimensions == 1 ? counts[0] : counts[0] * counts[1];
	int			lower[2] = {1, 1};
	int			numbers = 0;
	Datum	   *elements;
	bool	   *isnull;
	Datum		array;

	if (size == 0)
		return PointerGetDatum(construct_empty_array(FLOAT8OID));
	while (numbers < size && !isnan(values[numbers]))
		numbers++;
	if (numbers == size)
		return array_without_nulls(values, size, dimensions, counts);
	elements = palloc(size * sizeof(Datum));
	isnull = palloc(size * sizeof(bool));
	for (int i = 0; i < size; i++)
	{
		elements[i] = Float8GetDatum(values[i]);
		isnull[i] = isnan(values[i]) != 0;
	}
	array = PointerGetDatum(construct_md_array(elements, isnull, dimensions, counts, lower,
											   FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
											   TYPALIGN_DOUBLE));
	pfree(elements);
	pfree(isnull);
	return array;
}

Datum
attribute_array(const double *attributes, int count)
{
	return float_array(attributes, 1, &count);
}

/* The same for rows that follow one another. */
Datum
float_matrix(const double *values, int rows, int columns)
{
	return float_array(values, 2, (int[]) {rows, columns});
}

/* The same, but NaN stays NaN: for readers of tables that cannot read NULL within an array. */
Datum
float_matrix_of_nan(const double *values, int rows, int columns)
{
	if (rows * columns == 0)
		return PointerGetDatum(construct_empty_array(FLOAT8OID));
	return array_without_nulls(values, rows * columns, 2, (int[]) {rows, columns});
}

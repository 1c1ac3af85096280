/*
 * result.c: the results of SQL functions: rows, and rows of figures.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "abacus/header.h"
#include "pg/port/port.h"
#include "pg/sql/result.h"

/* Row type of the function's result, blessed, in the current memory context. */
TupleDesc
result_row_type(FunctionCallInfo fcinfo)
{
	TupleDesc	row_type;

	if (get_call_result_type(fcinfo, NULL, &row_type) != TYPEFUNC_COMPOSITE)
		elog(ERROR, "function must return a row");
	return BlessTupleDesc(row_type);
}

/* Doubles as float8[], none of which is NULL: they lie in the array as they do here. */
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

/* The same of rows one after the other. */
Datum
float_matrix(const double *values, int rows, int columns)
{
	return float_array(values, 2, (int[]) {rows, columns});
}

void
put_figure(const Figures *figures, const char *name, double value, const char *description)
{
	Datum		values[3];
	bool		isnull[3] = {false};

	values[0] = CStringGetTextDatum(psprintf("%s%s", figures->prefix, name));
	values[1] = Float8GetDatum(value);
	values[2] = CStringGetTextDatum(description);
	tuplestore_putvalues(figures->set->setResult, figures->set->setDesc, values, isnull);
}

/* What one of PostgreSQL's functions says of the size of a relation. */
double
bytes_of(PGFunction size, Oid relid)
{
	return (double) DatumGetInt64(DirectFunctionCall1(size, ObjectIdGetDatum(relid)));
}

/*
 * changed_row.c: rows of simplices that a change has created or removed.
 */
#include "postgres.h"

#include "pg/sql/rows/changed_row.h"
#include "pg/sql/rows/result.h"

/* The values of a row; the corners are allocated. */
void
changed_columns(const abacus_simplex *simplex, uint32 dimension, bool created, Datum *values, bool *isnull)
{
	double		corners[(ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_DIMENSION];

	for (uint32 i = 0; i <= dimension; i++)
		memcpy(corners + i * dimension, simplex->corner[i], dimension * sizeof(double));
	values[CHANGED_CREATED] = BoolGetDatum(created);
	simplex_columns(simplex, dimension, values + CHANGED_SIMPLEX, isnull + CHANGED_SIMPLEX);
	values[CHANGED_CORNERS] = float_matrix(corners, (int) dimension + 1, (int) dimension);
}

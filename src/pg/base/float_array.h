/*
 * float_array.h: figures of the core as float8[].
 */
#ifndef ABACUS_FLOAT_ARRAY_H
#define ABACUS_FLOAT_ARRAY_H

extern Datum attribute_array(const double *attributes, int count);
extern Datum float_matrix(const double *values, int rows, int columns);
extern Datum float_matrix_of_nan(const double *values, int rows, int columns);

#endif

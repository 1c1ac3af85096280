/*
 * geometry_place.h: arguments of functions for PostGIS: places, and arrays of coordinates and values.
 */
#ifndef ABACUS_GEOMETRY_PLACE_H
#define ABACUS_GEOMETRY_PLACE_H

#include "utils/array.h"

#include "abacus/facts.h"
#include "pg/postgis/geometry_read.h"

extern const GeometryType *geometry_argument_type(FunctionCallInfo fcinfo, int argument);
extern void geometry_check_srid(const abacus_form *form, int32 srid);
extern bool geometry_place(FunctionCallInfo fcinfo, int argument, const char *what,
						   const abacus_form *form, double *place);
extern const double *geometry_numbers(ArrayType *array, int of, size_t *count);
extern bool geometry_corner_values(ArrayType *array, int attribute, double *values);

#endif

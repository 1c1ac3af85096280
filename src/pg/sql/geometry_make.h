/*
 * geometry_make.h: geometries of PostGIS as results.
 */
#ifndef ABACUS_GEOMETRY_MAKE_H
#define ABACUS_GEOMETRY_MAKE_H

#include "lib/stringinfo.h"

#include "pg/input/geometry.h"

extern void geometry_put_head(StringInfo bytes, const GeometryHead *head);
extern void geometry_put_count(StringInfo bytes, size_t count);
extern void geometry_put_numbers(StringInfo bytes, const double *numbers, size_t count);
extern Datum geometry_made(const GeometryType *type, StringInfo bytes);

#endif

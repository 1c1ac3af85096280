/*
 * geometry_write.h: makes geometries of PostGIS.
 */
#ifndef ABACUS_POSTGIS_GEOMETRY_WRITE_H
#define ABACUS_POSTGIS_GEOMETRY_WRITE_H

#include "lib/stringinfo.h"

#include "pg/postgis/catalogue.h"
#include "pg/postgis/ewkb.h"

extern void geometry_put_head(StringInfo bytes, const GeometryHead *head);
extern void geometry_put_count(StringInfo bytes, size_t count);
extern void geometry_put_numbers(StringInfo bytes, const double *numbers, size_t count);
extern void geometry_put_places(StringInfo bytes, const double *places, size_t count, int dimension,
								bool closes);
extern void geometry_put_triangle(StringInfo bytes, const GeometryHead *head, const double *corners);
extern void geometry_put_tetrahedron(StringInfo bytes, const double *corners, int32 srid);
extern Datum geometry_received(const GeometryType *type, StringInfo bytes, int32 modifier);
extern Datum geometry_made(const GeometryType *type, StringInfo bytes);

#endif

/*
 * geometry_place.h: geometries of PostGIS as arguments: places, paths, areas.
 */
#ifndef ABACUS_GEOMETRY_PLACE_H
#define ABACUS_GEOMETRY_PLACE_H

#include "abacus/header.h"
#include "pg/postgis/geometry_read.h"

extern const GeometryType *geometry_argument_type(FunctionCallInfo fcinfo, int argument);
extern void geometry_check_srid(const abacus_header *header, int32 srid);
extern bool geometry_place(FunctionCallInfo fcinfo, int argument, const char *what,
						   const abacus_header *header, double *place);

#endif

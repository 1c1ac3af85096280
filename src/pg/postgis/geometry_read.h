/*
 * geometry_read.h: reads geometries of PostGIS.
 */
#ifndef ABACUS_POSTGIS_GEOMETRY_READ_H
#define ABACUS_POSTGIS_GEOMETRY_READ_H

#include <math.h>

#include "pg/postgis/catalogue.h"
#include "pg/postgis/ewkb.h"

#define GEOMETRY_COORDINATES 4	/* x, y, z, m */

/* One point. */
typedef struct GeometryPoint
{
	int32		srid;			/* 0: none */
	bool		is_empty;
	bool		has_z;
	double		at[GEOMETRY_COORDINATES];
} GeometryPoint;

/* Bytes of a geometry, while they are read; begins with geometry_bytes(). */
typedef struct GeometryBytes
{
	const unsigned char *at;
	const unsigned char *end;
	bool		swaps;			/* its numbers have the other byte order */
} GeometryBytes;

/* Whether these are the coordinates of an empty point. */
static inline bool
geometry_is_nowhere(const double *at)
{
	return isnan(at[0]) && isnan(at[1]);
}

extern GeometryBytes geometry_bytes(const GeometryType *type, Datum geometry);
extern char *geometry_hex(const GeometryType *type, Datum geometry);
extern GeometryHead geometry_head(GeometryBytes *bytes);
extern uint32 geometry_count(GeometryBytes *bytes);
extern double geometry_number(GeometryBytes *bytes);
extern void geometry_coordinates(GeometryBytes *bytes, const GeometryHead *head, double *at);
extern void geometry_point(const GeometryType *type, Datum geometry, const char *what,
						   GeometryPoint *point);

#endif

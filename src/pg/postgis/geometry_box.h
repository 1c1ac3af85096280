/*
 * geometry_box.h: the extent of a geometry of PostGIS.
 */
#ifndef ABACUS_POSTGIS_GEOMETRY_BOX_H
#define ABACUS_POSTGIS_GEOMETRY_BOX_H

#include "pg/postgis/catalogue.h"

typedef enum GeometryBox
{
	GEOMETRY_ANYWHERE,			/* unknown: an arc, or a NaN */
	GEOMETRY_NOWHERE,			/* it is empty */
	GEOMETRY_IN_BOX
} GeometryBox;

extern GeometryBox geometry_box(const GeometryType *type, Datum geometry, double *lower,
								double *upper, int32 *srid);

#endif

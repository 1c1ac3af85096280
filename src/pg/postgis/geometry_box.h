/*
 * geometry_box.h: where a geometry of PostGIS is.
 */
#ifndef ABACUS_POSTGIS_GEOMETRY_BOX_H
#define ABACUS_POSTGIS_GEOMETRY_BOX_H

#include "pg/postgis/catalogue.h"

typedef enum GeometryBox
{
	GEOMETRY_ANYWHERE,			/* it is not known: an arc, or no number */
	GEOMETRY_NOWHERE,			/* it is empty */
	GEOMETRY_IN_BOX
} GeometryBox;

extern GeometryBox geometry_box(const GeometryType *type, Datum geometry, double *lower,
								double *upper, int32 *srid);

#endif

/*
 * geometry_column.h: values of a column of geometries.
 */
#ifndef ABACUS_GEOMETRY_COLUMN_H
#define ABACUS_GEOMETRY_COLUMN_H

#include "abacus/facts.h"
#include "pg/postgis/geometry_write.h"

/* How a column gets its values. */
typedef struct GeometryMaker
{
	GeometryType type;
	int32		modifier;		/* of the column's type */
	StringInfoData bytes;
} GeometryMaker;

extern GeometryMaker *geometry_maker(Oid type, int32 modifier);
extern Datum geometry_of_point(GeometryMaker *maker, const double *point, int dimension,
							   const double *z);
extern Datum geometry_of_cell(GeometryMaker *maker, double corners[][ABACUS_MAX_DIMENSION],
							  int dimension, const double *z);

#endif

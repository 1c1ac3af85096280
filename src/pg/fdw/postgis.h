/*
 * postgis.h: PostGIS as it is found in the catalogues, without its library.
 */
#ifndef ABACUS_POSTGIS_H
#define ABACUS_POSTGIS_H

#include "abacus/header.h"
#include "fmgr.h"
#include "lib/stringinfo.h"

/* How a geometry column gets its values. */
typedef struct GeometryMaker
{
	FmgrInfo	receive;
	Oid			io_parameter;
	int32		modifier;		/* of the column's type */
	StringInfoData bytes;
} GeometryMaker;

/* Where a geometry is. */
typedef enum GeometryBox
{
	GEOMETRY_ANYWHERE,			/* it is not known: an arc, or no number */
	GEOMETRY_NOWHERE,			/* it is empty */
	GEOMETRY_IN_BOX
} GeometryBox;

extern Oid	postgis_geometry(void);
extern const char *postgis_type_name(Oid *schema);
extern bool postgis_owns_function(Oid function);

extern GeometryMaker *geometry_maker(int32 modifier);
extern Datum geometry_of_point(GeometryMaker *maker, const double *point, int dimension,
							   const double *z);
extern Datum geometry_of_cell(GeometryMaker *maker, double corners[][ABACUS_MAX_DIMENSION],
							  int dimension, const double *z);
extern GeometryBox geometry_box(Datum geometry, double *lower, double *upper);
extern void geometry_box_outward(double *lower, double *upper);

#endif

/*
 * geometry_column.c: values of a column of geometries.
 *
 * The column's type modifier gives the SRID, which geometries get as they are received.
 */
#include "postgres.h"

#include "pg/fdw/geometry_column.h"

/* For a column of this type and modifier, in the current memory context. */
GeometryMaker *
geometry_maker(Oid type, int32 modifier)
{
	GeometryMaker *maker = palloc0(sizeof(GeometryMaker));

	geometry_open(&maker->type, type, CurrentMemoryContext);
	maker->modifier = modifier;
	initStringInfo(&maker->bytes);
	return maker;
}

/* POINT, or POINT Z; z may be NULL. */
Datum
geometry_of_point(GeometryMaker *maker, const double *point, int dimension, const double *z)
{
	GeometryHead head = {GEOMETRY_POINT, .has_z = dimension == 3 || z != NULL};

	resetStringInfo(&maker->bytes);
	geometry_put_head(&maker->bytes, &head);
	geometry_put_numbers(&maker->bytes, point, dimension);
	if (z != NULL && dimension == 2)
		geometry_put_numbers(&maker->bytes, z, 1);
	return geometry_received(&maker->type, &maker->bytes, maker->modifier);
}

/* A triangle: POLYGON, or POLYGON Z. A tetrahedron: POLYHEDRALSURFACE Z. z may be NULL. */
Datum
geometry_of_cell(GeometryMaker *maker, double corners[][ABACUS_MAX_DIMENSION], int dimension,
				 const double *z)
{
	GeometryHead head = {GEOMETRY_POLYGON, .has_z = z != NULL};
	double		ring[3 * 3];

	resetStringInfo(&maker->bytes);
	if (dimension == 3)
		geometry_put_tetrahedron(&maker->bytes, corners[0], 0);
	else
	{
		for (int i = 0; i < 3; i++)
		{
			double	   *place = ring + i * (2 + head.has_z);

			memcpy(place, corners[i], 2 * sizeof(double));
			if (z != NULL)
				place[2] = z[i];
		}
		geometry_put_triangle(&maker->bytes, &head, ring);
	}
	return geometry_received(&maker->type, &maker->bytes, maker->modifier);
}

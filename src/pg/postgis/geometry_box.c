/*
 * geometry_box.c: the box of a geometry in the plane.
 */
#include "postgres.h"

#include <float.h>

#include "miscadmin.h"

#include "pg/postgis/geometry_box.h"
#include "pg/postgis/geometry_read.h"

typedef struct Extent
{
	bool		is_known;
	double		lower[2];
	double		upper[2];
} Extent;

static void
add_places(Extent *extent, GeometryBytes *bytes, const GeometryHead *head, uint32 count)
{
	for (uint32 i = 0; i < count && extent->is_known; i++)
	{
		double		at[GEOMETRY_COORDINATES];

		geometry_coordinates(bytes, head, at);
		if (geometry_is_nowhere(at))
			continue;
		for (int k = 0; k < 2; k++)
		{
			if (isnan(at[k]))
				extent->is_known = false;
			extent->lower[k] = Min(extent->lower[k], at[k]);
			extent->upper[k] = Max(extent->upper[k], at[k]);
		}
	}
}

/* Reads a geometry with everything inside it; returns its SRID. */
static int32
add_geometry(Extent *extent, GeometryBytes *bytes)
{
	GeometryHead head = geometry_head(bytes);

	check_stack_depth();
	switch (head.kind)
	{
		case GEOMETRY_POINT:
			add_places(extent, bytes, &head, 1);
			break;
		case GEOMETRY_LINE:
			add_places(extent, bytes, &head, geometry_count(bytes));
			break;
		case GEOMETRY_POLYGON:
		case GEOMETRY_TRIANGLE:
			for (uint32 rings = geometry_count(bytes); rings > 0 && extent->is_known; rings--)
				add_places(extent, bytes, &head, geometry_count(bytes));
			break;
		case GEOMETRY_MULTIPOINT:
		case GEOMETRY_MULTILINE:
		case GEOMETRY_MULTIPOLYGON:
		case GEOMETRY_COLLECTION:
		case GEOMETRY_POLYHEDRAL:
		case GEOMETRY_TIN:
			for (uint32 parts = geometry_count(bytes); parts > 0 && extent->is_known; parts--)
				(void) add_geometry(extent, bytes);
			break;
		default:
			extent->is_known = false;	/* an arc leaves the box of its points */
	}
	return head.srid;
}

/* The box of a geometry in the plane, and its SRID. */
GeometryBox
geometry_box(const GeometryType *type, Datum geometry, double *lower, double *upper, int32 *srid)
{
	Extent		extent = {true, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
	GeometryBytes bytes = geometry_bytes(type, geometry);

	*srid = add_geometry(&extent, &bytes);
	if (!extent.is_known)
		return GEOMETRY_ANYWHERE;
	if (!(extent.lower[0] <= extent.upper[0]))
		return GEOMETRY_NOWHERE;
	for (int k = 0; k < 2; k++)
	{
		lower[k] = Max(extent.lower[k], -DBL_MAX);
		upper[k] = Min(extent.upper[k], DBL_MAX);
	}
	return GEOMETRY_IN_BOX;
}

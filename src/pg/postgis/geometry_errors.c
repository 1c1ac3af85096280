/*
 * geometry_errors.c: errors about geometries, with hints.
 */
#include "postgres.h"

#include "pg/postgis/ewkb.h"
#include "pg/postgis/geometry_errors.h"

/* The name of a kind in PostGIS. */
static const char *
kind_name(uint32 kind)
{
	static const char *const names[] = {
		"geometry", "Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon",
		"GeometryCollection", "CircularString", "CompoundCurve", "CurvePolygon", "MultiCurve",
		"MultiSurface", "Curve", "Surface", "PolyhedralSurface", "Tin", "Triangle"
	};

	return kind < lengthof(names) ? names[kind] : "geometry of another kind";
}

/* The geometry is of another kind; `what` names the geometry. */
void
geometry_refuse_kind(const char *what, uint32 kind, const char *wanted)
{
	bool		is_curved = kind >= GEOMETRY_CIRCULAR_LINE && kind <= GEOMETRY_SURFACE;
	bool		is_collection = kind >= GEOMETRY_MULTIPOINT && kind <= GEOMETRY_COLLECTION;

	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s is a %s, not %s", what, kind_name(kind), wanted),
			 is_curved ? errhint("Convert curves to straight lines with ST_CurveToLine.") :
			 is_collection ? errhint("Split the collection into its parts with ST_Dump.") : 0));
}

/* A coordinate is NaN or infinite. */
void
geometry_refuse_coordinate(const char *what)
{
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("a coordinate of %s is not finite", what)));
}

/* The geometry has another system; `wanted` is that of the whole, a mesh or an octree. */
void
geometry_refuse_srid(const char *what, int32 srid, int32 wanted, const char *whole)
{
	if (wanted == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has SRID %d, but the %s has none", what, srid, whole),
				 errhint("If the coordinates of the %s are in that system, say so with "
						 "abacus_set_srid(%s, %d).", whole, whole, srid)));
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 srid == 0 ? errmsg("%s has no SRID, but the %s has SRID %d", what, whole, wanted)
			 : errmsg("%s has SRID %d, but the %s has SRID %d", what, srid, whole, wanted),
			 srid == 0 ? errhint("If its coordinates are in that system, say so with "
								 "ST_SetSRID(geometry, %d).", wanted)
			 : errhint("Transform it with ST_Transform(geometry, %d).", wanted)));
}

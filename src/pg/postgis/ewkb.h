/*
 * ewkb.h: geometries as bytes.
 *
 * Values of PostGIS go through the type's own send and receive functions. Their bytes are EWKB, which
 * PostGIS documents, while what it stores is its own affair. A geometry is
 *
 *   byte order (0: big-endian, 1: little-endian), kind and flags, SRID if a flag says so, contents
 *
 * The contents of a point are its coordinates, those of a line their number and themselves, those of
 * a polygon the number of its rings and of each what a line has, and those of other kinds the number
 * of geometries and these, each with a head of its own. A triangle is written as a polygon. A point
 * whose coordinates are all NaN is empty.
 */
#ifndef ABACUS_POSTGIS_EWKB_H
#define ABACUS_POSTGIS_EWKB_H

/* Kinds of geometries, as OGC numbers them. */
enum
{
	GEOMETRY_POINT = 1,
	GEOMETRY_LINE,
	GEOMETRY_POLYGON,
	GEOMETRY_MULTIPOINT,
	GEOMETRY_MULTILINE,
	GEOMETRY_MULTIPOLYGON,
	GEOMETRY_COLLECTION,
	GEOMETRY_CIRCULAR_LINE,		/* the first of those with curves */
	GEOMETRY_SURFACE = 14,		/* the last */
	GEOMETRY_POLYHEDRAL,
	GEOMETRY_TIN,
	GEOMETRY_TRIANGLE
};

/* Flags beside the kind. */
#define EWKB_Z 0x80000000U
#define EWKB_M 0x40000000U
#define EWKB_SRID 0x20000000U
#define EWKB_FLAGS (EWKB_Z | EWKB_M | EWKB_SRID)

/* The byte order of this machine. */
#ifdef WORDS_BIGENDIAN
#define EWKB_ORDER 0
#else
#define EWKB_ORDER 1
#endif

/* What a geometry, or one inside another, begins with. */
typedef struct GeometryHead
{
	uint32		kind;
	int32		srid;			/* 0: none */
	bool		has_z;
	bool		has_m;
} GeometryHead;

#endif

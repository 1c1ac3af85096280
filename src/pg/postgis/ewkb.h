/*
 * ewkb.h: geometries as bytes.
 *
 * Values of PostGIS go through the type's own send and receive functions. Their bytes are EWKB,
 * which PostGIS documents, while its stored format is internal. A geometry is
 *
 *   byte order (0: big-endian, 1: little-endian), kind and flags, SRID if a flag says so, contents
 *
 * A point contains its coordinates. A line contains the number of its points and their coordinates,
 * and a polygon the number of its rings and each ring like a line. Other kinds contain the number
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
	GEOMETRY_CIRCULAR_LINE,		/* the first with curves */
	GEOMETRY_SURFACE = 14,		/* the last with curves */
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

/* The head of a geometry, or of one inside another. */
typedef struct GeometryHead
{
	uint32		kind;
	int32		srid;			/* 0: none */
	bool		has_z;
	bool		has_m;
} GeometryHead;

#endif

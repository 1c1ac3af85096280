/*
 * draw.h: pictures of a mesh or an octree.
 */
#ifndef ABACUS_ABACUS_DRAW_H
#define ABACUS_ABACUS_DRAW_H

#include "abacus/extent.h"
#include "abacus/facts.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Colours of values, from the least to the greatest. */
typedef enum abacus_ramp
{
	ABACUS_RAMP_USUAL = 0, /* terrain of a mesh of dimension 2, strata of a section */
	ABACUS_RAMP_TERRAIN,
	ABACUS_RAMP_STRATA,
	ABACUS_RAMP_VIRIDIS,
	ABACUS_RAMP_MAGMA,
	ABACUS_RAMP_CIVIDIS,
	ABACUS_RAMP_GREY,
	ABACUS_RAMP_DIVERGING
} abacus_ramp;

typedef struct abacus_drawing
{
	/* Window in mesh coordinates; empty (lower >= upper on an axis) = the whole mesh. In
	   dimension 3 a box: the picture shows the rectangle that just holds the part of the
	   plane within it. */
	double lower[ABACUS_MAX_DIMENSION], upper[ABACUS_MAX_DIMENSION];
	int32_t width, height;     /* pixels, 1 to 16384; height 0 = from the window's shape */
	int32_t attribute;         /* vertex attribute that gives colour and relief; -1 = none; for a
	                              mesh also a label of simplices, numbered behind the attributes */
	int32_t edges;             /* 1: draw the edges of the triangles, or of the section */
	double exaggeration;       /* values are multiplied by this for the hill shading; 0 = no shading */
	abacus_extent extent;      /* leave out simplices outside of it */
	double range[2];           /* values at the ends of the colours, also for values beyond;
	                              empty ([0] >= [1]) = the least and the greatest value seen */
	abacus_ramp ramp;
	double light[2];           /* where it is: degrees from north, clockwise; degrees above the
	                              horizon, over 0 to 90. 0 there: in the north-west, 45 degrees high */
	double contour_interval;   /* lines at its multiples, within the range; 0 = none */
	int32_t contour_labels;    /* 1: each fifth contour, counted from 0, is wider and has its value;
	                              of a mesh of dimension 2 only */
	size_t memory;             /* ... which takes so many bytes, spools beyond that, and memory for
	                              the longest contour */
	int32_t transparent;       /* 1: nothing is behind the mesh */
	const char *legend;        /* the colours and their values, with this above them, the unit of
	                              values or a title, in UTF-8; NULL = none */
	const char *scale_bar;     /* scale bar in this unit of coordinates, in UTF-8; NULL = none */
	int32_t is_geographic;     /* 1: coordinates are longitude and latitude in degrees, and the
	                              window is of Web Mercator, measured in degrees of longitude */
	int32_t regions;           /* 1: tint each region of a mesh in a colour of its own, with its border */
	int32_t lines;             /* 1: draw the fixed edges of a mesh */
	double density;            /* without an attribute: triangles per pixel shown as medium
	                              density; 0 = chosen to fit */
} abacus_drawing;

typedef struct abacus_picture
{
	unsigned char *png; /* from host->resize(), which also frees it */
	size_t size;        /* bytes */
	int32_t is_blank;   /* 1: nothing of the mesh is seen */
} abacus_picture;

/* Draws a mesh of dimension 2, or a quadtree without contours, as a PNG. */
ABACUS_API abacus_status abacus_draw(const abacus_host *host, const abacus_facts *facts,
									 const abacus_drawing *drawing, abacus_picture *picture,
									 abacus_error *error);

/*
 * A plane through a mesh of dimension 3. A picture of it has up upwards: z on planes
 * of 45 degrees or steeper, y on flatter ones, which are maps; x, or y where the plane
 * is perpendicular to x, grows to the right. So the sign of the normal does not matter.
 */
typedef struct abacus_section
{
	double through[3];   /* a point of the plane, finite */
	double normal[3];    /* finite, not zero, of any length */
	double exaggeration; /* lengths upwards are multiplied by this, finite, not 0; negative:
							the picture is upside down, for a z that is a depth */
} abacus_section;

/* Draws the section of a mesh of dimension 3, or of an octree, by a plane, as abacus_draw does. */
ABACUS_API abacus_status abacus_draw_section(const abacus_host *host, const abacus_facts *facts,
											 const abacus_section *section,
											 const abacus_drawing *drawing, abacus_picture *picture,
											 abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

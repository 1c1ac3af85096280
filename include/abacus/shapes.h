/*
 * shapes.h: the shape of the points of a mesh: Voronoi cells, the hull and closer outlines, the
 * spanning tree.
 */
#ifndef ABACUS_ABACUS_SHAPES_H
#define ABACUS_ABACUS_SHAPES_H

#include "abacus/extent.h"
#include "abacus/windows.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * The Voronoi cells of all vertices, or, with a box, the parts of all cells within it: including
 * cells of vertices outside it, so that they fill it. ABACUS_ERROR (state) if the mesh is not
 * Delaunay.
 */
typedef struct abacus_voronoi abacus_voronoi;
ABACUS_API abacus_status abacus_voronoi_open(const abacus_host *host, const abacus_facts *facts,
											 const abacus_window *window, size_t cache_bytes,
											 abacus_voronoi **voronoi, abacus_error *error);
typedef struct abacus_voronoi_cell
{
	int64_t vertex;
	int32_t bounded;    /* whether the whole cell, not its part, is bounded */
	double area;        /* infinite if unbounded; in space that of the surface */
	double volume;      /* in space */
	const double *ring; /* in the plane, `corners` points counterclockwise; valid until the next call */
	size_t corners;     /* 0 if there is no ring */
} abacus_voronoi_cell;
ABACUS_API abacus_status abacus_voronoi_next(abacus_voronoi *voronoi, abacus_voronoi_cell *cell,
											 abacus_error *error);
/*
 * The face between a cell and its neighbour's, or a side of the box: an edge in the plane, a
 * polygon in space.
 */
typedef struct abacus_voronoi_facet
{
	int64_t vertex;
	int64_t neighbour;
	int32_t has_neighbour; /* 0: a side of the box */
	int32_t bounded;
	double size;           /* a length or an area; infinite if unbounded */
	const double *ring;    /* `corners` points, valid until the next call */
	size_t corners;        /* 0 if unbounded */
} abacus_voronoi_facet;
/* The next facet of any cell: instead of abacus_voronoi_next(). */
ABACUS_API abacus_status abacus_voronoi_next_facet(abacus_voronoi *voronoi,
												   abacus_voronoi_facet *facet,
												   abacus_error *error);
ABACUS_API void abacus_voronoi_close(abacus_voronoi *voronoi);

/*
 * The part of a mesh that an outline goes around: all, which gives the hull, or some of its
 * simplices.
 */
typedef struct abacus_outline_kind
{
	abacus_extent extent; /* those in it */
	int32_t has_alpha;   /* 1: those whose circumradius has a square of at most `alpha` */
	double alpha;
	int32_t fills_holes; /* 1: without holes, in space cavities, and what lies in them */
} abacus_outline_kind;
/* A vertex of a ring, in the plane a polygon, in space a triangle. */
typedef struct abacus_outline_row
{
	uint64_t ring;     /* from 1 on */
	uint64_t position; /* from 1 on */
	int64_t vertex;
	double point[ABACUS_MAX_DIMENSION];
} abacus_outline_row;
/* Gets a vertex of a ring, valid during the call. May fail as a host function may. */
typedef abacus_host_status (*abacus_outline_report)(void *context, const abacus_outline_row *row);
/*
 * Reports the border of that part, ring by ring: counterclockwise, and clockwise around holes; in
 * space counterclockwise seen from outside. Rings come in the order of their least vertices, with
 * which they begin. Sorting takes `memory` bytes. ABACUS_ERROR (limit) if these have no room for
 * the parts, page by page, of possible cavities to be filled.
 */
ABACUS_API abacus_status abacus_outline(const abacus_host *host, const abacus_facts *facts,
										const abacus_outline_kind *kind, size_t memory,
										size_t cache_bytes, abacus_outline_report report,
										void *context, abacus_error *error);

/*
 * On which side of the line from a to b the point c lies in the plane, exactly: 1 left, -1 right, 0 on
 * it. Finite doubles.
 */
ABACUS_API abacus_status abacus_orientation(const double *a, const double *b, const double *c,
											int *side, abacus_error *error);

/* Gets an edge of a tree, valid during the call. May fail as a host function may. */
typedef abacus_host_status (*abacus_edge_report)(void *context, const abacus_edge *edge);
/*
 * Reports the edges of the minimum spanning tree of the mesh's vertices, the shortest first; in
 * meshes that are not Delaunay, the tree of their edges, piece by piece. Among edges of one length
 * those with the lesser ends are taken. Sorting, and data about vertices, take `memory` bytes.
 * ABACUS_ERROR (limit) if that is too little.
 */
ABACUS_API abacus_status abacus_spanning_tree(const abacus_host *host, const abacus_facts *facts,
											  size_t memory, size_t cache_bytes,
											  abacus_edge_report report, void *context,
											  abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

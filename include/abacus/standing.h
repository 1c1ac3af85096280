/*
 * standing.h: how a mesh is related to the Delaunay triangulation of its vertices, and what
 * follows.
 */
#ifndef ABACUS_ABACUS_STANDING_H
#define ABACUS_ABACUS_STANDING_H

#include "abacus/host_functions.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * How a mesh is related to the Delaunay triangulation of its vertices. Under the symbolic
 * perturbation there is only one triangulation, which the core makes, and only one that is
 * constrained by given lines. Any other mesh was loaded (abacus_load_open).
 */
typedef enum abacus_delaunay
{
	ABACUS_DELAUNAY = 0,    /* is that one, and can be changed */
	ABACUS_NOT_DELAUNAY,    /* a vertex lies inside the circumsphere of a simplex */
	ABACUS_WEAKLY_DELAUNAY, /* all circumspheres are empty, but cospherical vertices are
							   joined differently */
	ABACUS_NOT_CONVEX,      /* its boundary is not the convex hull of the vertices: there are
							   holes, notches or pieces */
	ABACUS_CONSTRAINED      /* has lines: is Delaunay but for their edges, which are fixed, and can
							   be changed (constrain.h) */
} abacus_delaunay;

/* Whether the core has made the mesh, rather than loaded it. */
static inline int
abacus_is_own(uint32_t standing)
{
	return standing == ABACUS_DELAUNAY || standing == ABACUS_CONSTRAINED;
}

/*
 * The same in words: a clause about the mesh, and a sentence that gives the reason. Not for
 * ABACUS_DELAUNAY.
 */
ABACUS_API const char *abacus_delaunay_clause(abacus_delaunay delaunay);
ABACUS_API const char *abacus_delaunay_reason(abacus_delaunay delaunay);

/* What follows: distinct properties, each tested where it matters. */

/* Points may be inserted and deleted. */
static inline int
abacus_is_editable(uint32_t standing)
{
	return abacus_is_own(standing);
}

/* Ghosts are linked across their ridges: one can walk around the boundary, and beside it. */
static inline int
abacus_links_ghosts(uint32_t standing)
{
	return abacus_is_own(standing);
}

/* Vertices are listed in staged pages, in the order of the curve: staged = inserted = vertices. */
static inline int
abacus_lists_vertices(uint32_t standing)
{
	return !abacus_is_own(standing);
}

/* The pages that meet a convex region are connected: a flood from one of them finds all. */
static inline int
abacus_floods_pages(uint32_t standing)
{
	return abacus_is_own(standing);
}

/* The boundary is the convex hull: walks arrive, and Euler's relation holds. */
static inline int
abacus_is_convex(uint32_t standing)
{
	return abacus_is_own(standing);
}

/*
 * Circumspheres are empty: nearest vertices are neighbours, and Voronoi cells, natural neighbours
 * and alpha shapes are defined.
 */
static inline int
abacus_is_delaunay(uint32_t standing)
{
	return standing == ABACUS_DELAUNAY;
}

#ifdef __cplusplus
}
#endif

#endif

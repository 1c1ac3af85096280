/*
 * constrain.h: fixed edges of a mesh of dimension 2, and the lines that they come from.
 *
 * A mesh with lines is the constrained Delaunay triangulation of its points and lines (Lee and Lin
 * 1986; Chew 1989): each segment of a line is an edge, or a chain of edges where vertices lie exactly
 * on it, and each edge that is not fixed so passes the in-circle test, under the symbolic
 * perturbation. So the mesh is a function of points and lines. The host keeps the lines; the mesh
 * has a mark for each fixed edge.
 */
#ifndef ABACUS_ABACUS_CONSTRAIN_H
#define ABACUS_ABACUS_CONSTRAIN_H

#include "abacus/build.h"
#include "abacus/locate.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Segments that are fixed or freed ------------------------------------------- */

typedef struct abacus_segments abacus_segments;

/* Opens a collection of segments, sorted within `memory` bytes and beyond it in spools. */
ABACUS_API abacus_status abacus_segments_open(const abacus_host *host, const abacus_facts *facts,
											  size_t memory, abacus_segments **segments,
											  abacus_error *error);

/* A segment of a line. */
typedef struct abacus_segment
{
	double ends[2][2]; /* the places of both */
	int32_t is_soft;   /* 1 if the line is soft, 0 if it is hard */
} abacus_segment;

/* Adds `count` segments. One that is added several times is hard if it is so once. */
ABACUS_API abacus_status abacus_segments_add(abacus_segments *segments,
											 const abacus_segment *added, size_t count,
											 abacus_error *error);
/* Gives the spools back: the last call before it is closed, unless something has failed. */
ABACUS_API abacus_status abacus_segments_end(abacus_segments *segments, abacus_error *error);
ABACUS_API void abacus_segments_close(abacus_segments *segments);

/* ---- Lines, as the host keeps them ------------------------------------------------ */

/* A segment of a line that ends at a certain place. */
typedef struct abacus_segment_end
{
	int64_t line;
	double other[2]; /* the place of its other end */
	int32_t is_soft;
} abacus_segment_end;

/*
 * Finds the segments that end at a place: all of all lines, two for each position of a line but its
 * first and last, which have one. The array belongs to the host, until the next call.
 */
typedef abacus_host_status (*abacus_segments_at)(void *context, const double place[2],
												 const abacus_segment_end **ends, size_t *count);

/*
 * The lines of the mesh. To be called before any change of a mesh with lines that frees segments or
 * deletes points.
 */
ABACUS_API abacus_status abacus_build_lines(abacus_build *build, abacus_segments_at at,
											void *context, abacus_error *error);

/* ---- Changes ------------------------------------------------------------------------ */

/*
 * fix: makes each segment an edge of the mesh, or a chain of edges, that is fixed. Its ends must be
 * vertices: ABACUS_ERROR (argument) if one is not. An edge is soft if all its segments are.
 * ABACUS_ERROR (crossing) if a segment crosses another one, or a fixed edge, elsewhere than in a
 * vertex. The mesh must have simplices; points that wait are inserted before.
 */
ABACUS_API abacus_status abacus_build_fix(abacus_build *build, abacus_segments *segments,
										  abacus_header *header, abacus_error *error);
/*
 * unfix: frees the edges of each segment, but for those that are on a segment of a line that the
 * host still has, which get its kind; so their lines must be gone there. ABACUS_END, and *fault says
 * which, if a region ends at an edge that would be free: then the change must be given up.
 */
struct abacus_region_fault; /* regions.h */
ABACUS_API abacus_status abacus_build_unfix(abacus_build *build, abacus_segments *segments,
											abacus_header *header,
											struct abacus_region_fault *fault,
											abacus_error *error);
/*
 * restore: flips edges that fail the in-circle test under the symbolic perturbation, and those beside
 * them, until only fixed edges fail it. `edges` are those that may fail; if the mesh lacks one, it is
 * ignored. Both ends must be vertices.
 */
ABACUS_API abacus_status abacus_build_restore(abacus_build *build, abacus_segments *edges,
											  abacus_header *header, abacus_error *error);

/*
 * vertex_at: whether the mesh as it is being changed has a vertex at a place; ABACUS_END if not. If
 * `record` is not NULL it gets id, coordinates and attributes, a word each, which must not be apart;
 * without it, the only call that may follow a failure: that of fix, because of a crossing.
 */
ABACUS_API abacus_status abacus_build_vertex_at(abacus_build *build, const double place[2],
												uint64_t *record, abacus_error *error);

/* ---- Reading --------------------------------------------------------------------------- */

typedef enum abacus_edge_kind
{
	ABACUS_FREE_EDGE,
	ABACUS_SOFT_EDGE, /* all lines over it are soft */
	ABACUS_HARD_EDGE
} abacus_edge_kind;

/* Gets an edge on a segment: ids and places of its ends, in the direction of the segment. */
typedef abacus_host_status (*abacus_along_report)(void *context, const int64_t ids[2],
												 const double ends[2][2], abacus_edge_kind kind);
/*
 * Reports the edges of the mesh that make up the segment from a to b, in their order; *is_whole is 0
 * if the mesh lacks one, where the report ends.
 */
ABACUS_API abacus_status abacus_edges_along(abacus_mesh *mesh, const double a[2],
											const double b[2], abacus_along_report report,
											void *context, int *is_whole, abacus_error *error);

/*
 * Goes on from the vertex at a place, straight away from a place behind it, along a fixed edge: its
 * other end becomes *next. ABACUS_END if no such edge is there.
 */
ABACUS_API abacus_status abacus_fixed_straight_on(abacus_mesh *mesh, const double behind[2],
												  const double at[2], double next[2],
												  abacus_error *error);

/* Whether p lies exactly on the ray from a place through another one: ABACUS_OK, or ABACUS_END. */
ABACUS_API abacus_status abacus_is_on_ray(const double from[2], const double through[2],
										  const double p[2], abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

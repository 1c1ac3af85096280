/*
 * windows.h: what meets a window: simplices with the values at their corners, vertices, edges.
 */
#ifndef ABACUS_ABACUS_WINDOWS_H
#define ABACUS_ABACUS_WINDOWS_H

#include "abacus/extent.h"
#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum abacus_window_kind
{
	ABACUS_NO_WINDOW = 0,    /* all of the mesh */
	ABACUS_BOX_WINDOW,       /* from lower to upper */
	ABACUS_BALL_WINDOW,      /* all places at most `radius` from center */
	ABACUS_BOUNDS_WINDOW     /* simplices whose bounding boxes meet the box from lower to upper */
} abacus_window_kind;

/* A closed part of the plane or of space; all numbers are finite. */
typedef struct abacus_window
{
	abacus_window_kind kind;
	double lower[ABACUS_MAX_DIMENSION];
	double upper[ABACUS_MAX_DIMENSION];
	double center[ABACUS_MAX_DIMENSION];
	double radius;
} abacus_window;

/* A range of values of an attribute, or of a label; ends may be infinite. */
typedef struct abacus_range
{
	uint32_t attribute; /* its number, or that of the label */
	double least;
	double greatest;
} abacus_range;

/*
 * The simplices that meet a window, exactly, in the order in which their pages are found; without a
 * window all simplices in key order. Simplices outside of the extent are left
 * out; and those whose label is outside the range, unless that is NULL: the heads of
 * pages of labels show which pages to skip.
 */
typedef struct abacus_cells abacus_cells;
ABACUS_API abacus_status abacus_cells_open(const abacus_host *host, const abacus_facts *facts,
										   const abacus_window *window,
										   const abacus_extent *extent,
										   const abacus_range *label, abacus_cells **cells,
										   abacus_error *error);
/* The simplices with codes from `least` to `greatest`, page by page in key order. */
ABACUS_API abacus_status abacus_cells_open_stretch(const abacus_host *host,
												   const abacus_facts *facts, uint64_t least,
												   uint64_t greatest, abacus_cells **cells,
												   abacus_error *error);
/*
 * `values` gets the attributes of the corners, corner by corner: for each corner all attributes of
 * the mesh. It may be NULL.
 */
ABACUS_API abacus_status abacus_cells_next(abacus_cells *cells, abacus_simplex *simplex,
										   double *values, abacus_error *error);
/*
 * The labels of a simplex, as many as the header names: of one that abacus_cells_next() has
 * returned. Valid until the next call.
 */
ABACUS_API abacus_status abacus_cells_labels(abacus_cells *cells, const abacus_simplex *simplex,
											 const double **labels, abacus_error *error);
/* How many pages have been read. */
ABACUS_API uint64_t abacus_cells_pages(const abacus_cells *cells);
ABACUS_API void abacus_cells_close(abacus_cells *cells);

/*
 * The vertices in a window, or the edges that meet one, each once: points equal to a vertex, and
 * points that wait, are not included. Edges longer than the extent's
 * max_edge are left out, and those without a triangle in its region.
 */
typedef struct abacus_faces abacus_faces;
ABACUS_API abacus_status abacus_faces_open(const abacus_host *host, const abacus_facts *facts,
										   const abacus_window *window, int edges,
										   const abacus_extent *extent,
										   size_t cache_bytes, abacus_faces **faces,
										   abacus_error *error);
/*
 * The vertices of the window with an attribute within a range. The heads of their columns show
 * which pages have no such value, and these are skipped.
 */
ABACUS_API abacus_status abacus_faces_open_range(const abacus_host *host,
												 const abacus_facts *facts,
												 const abacus_window *window,
												 const abacus_range *range, size_t cache_bytes,
												 abacus_faces **faces, abacus_error *error);
ABACUS_API abacus_status abacus_faces_next_vertex(abacus_faces *faces, abacus_vertex *vertex,
												  abacus_error *error);
typedef struct abacus_edge
{
	int64_t id[2]; /* the lesser one first */
	double length;
} abacus_edge;
/* `ends` gets the coordinates of both ends, in the order of their ids; it may be NULL. */
ABACUS_API abacus_status abacus_faces_next_edge(abacus_faces *faces, abacus_edge *edge,
												double *ends, abacus_error *error);
/* Whether the edge returned last is fixed; in space none is. */
ABACUS_API int abacus_faces_is_fixed(const abacus_faces *faces);
ABACUS_API uint64_t abacus_faces_pages(const abacus_faces *faces);
ABACUS_API void abacus_faces_close(abacus_faces *faces);

#ifdef __cplusplus
}
#endif

#endif

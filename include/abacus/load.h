/*
 * load.h: turns a triangulation made elsewhere into a mesh.
 */
#ifndef ABACUS_ABACUS_LOAD_H
#define ABACUS_ABACUS_LOAD_H

#include "abacus/constrain.h"
#include "abacus/mesh_header.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abacus_load abacus_load;

/*
 * Opens the loading of a triangulation made elsewhere into a mesh without points.
 * `memory` bounds the memory used, in bytes (maintenance_work_mem); beyond it everything goes to
 * spools. With `reorient` simplices of negative orientation are turned; without it they are
 * refused. With `split_nodes` vertices at one place are distinguished by their ids, and no
 * attributes are apart; without it such vertices are refused.
 */
ABACUS_API abacus_status abacus_load_open(const abacus_host *host, const abacus_facts *facts,
										  size_t memory, int reorient, int split_nodes,
										  abacus_load **load, abacus_error *error);
/* Adds vertices, as abacus_stage_add adds points; each id once. */
ABACUS_API abacus_status abacus_load_vertices(abacus_load *load, const uint64_t *points,
											  size_t count, abacus_error *error);
/*
 * After all vertices: adds simplices. Each is dimension + 1 ids of vertices, followed by its labels,
 * which are doubles: as many as the header names, NaN where there is none.
 */
ABACUS_API abacus_status abacus_load_simplices(abacus_load *load, const uint64_t *simplices,
											   size_t count, abacus_error *error);
/*
 * After all simplices, if at all: adds markers of facets. Each is `dimension` ids of vertices, and a
 * double that is a 32-bit integer; NaN is none.
 */
ABACUS_API abacus_status abacus_load_facets(abacus_load *load, const uint64_t *facets, size_t count,
											abacus_error *error);
/*
 * After all that, if at all: adds edges of a mesh in the plane that lines fix. Each is the line and two
 * ids of vertices. Once this is called, also for no edges, a mesh whose other edges pass the in-circle
 * test without the symbolic perturbation (ABACUS_WEAKLY_DELAUNAY) is written like one of
 * ABACUS_DELAUNAY: fix the edges and restore the ties (constrain.h) before anything else.
 */
ABACUS_API abacus_status abacus_load_lines(abacus_load *load, const uint64_t *edges, size_t count,
										   abacus_error *error);
/*
 * No more simplices come. Checks exactly that they form a complex, and how it is related to the
 * Delaunay triangulation of its vertices. ABACUS_ERROR (argument) names the fault: an unknown or
 * repeated vertex, a flat simplex, a facet used too often, an overlap.
 */
ABACUS_API abacus_status abacus_load_check(abacus_load *load, abacus_delaunay *outcome,
										   abacus_error *error);
/* The error's detail in full: it lists up to a hundred faults. Valid as long as the load. */
ABACUS_API const char *abacus_load_detail(const abacus_load *load);
/* An edge of a line. */
typedef struct abacus_loaded_edge
{
	int64_t line;
	int64_t row;           /* counts the edges that were added, from 1 */
	int64_t ids[2];        /* as they were given */
	double ends[2][2];
} abacus_loaded_edge;

/* After the check: the next edges of lines, in any order; *count is 0 after the last. */
ABACUS_API abacus_status abacus_load_edges(abacus_load *load, abacus_loaded_edge *edges,
										   size_t room, size_t *count, abacus_error *error);
/*
 * After the check: adds the edges that fail the in-circle test because of the symbolic perturbation
 * alone, and lie on no line, to segments; *count is how many they are.
 */
ABACUS_API abacus_status abacus_load_ties(abacus_load *load, abacus_segments *segments,
										  uint64_t *count, abacus_error *error);
/*
 * After the check: writes the pages and brings the header up to date. The vertices can be staged after
 * that with `keeps_vertices`.
 */
ABACUS_API abacus_status abacus_load_write(abacus_load *load, int keeps_vertices,
										   abacus_header *header, abacus_error *error);
/* After that, or instead: adds the vertices of the simplices to a stage, to be triangulated again. */
ABACUS_API abacus_status abacus_load_stage(abacus_load *load, abacus_stage *stage,
										   abacus_error *error);
ABACUS_API void abacus_load_close(abacus_load *load);

#ifdef __cplusplus
}
#endif

#endif

/*
 * octree.h: quadtrees and octrees, which are made, changed and read like meshes.
 *
 * Their header has the type ABACUS_OCTREE. An octant is identified by its Morton code, the place of
 * its least cell on a grid of the finest level (31 levels in the plane, 21 in space), and its
 * level: 0 is the whole domain.
 */
#ifndef ABACUS_ABACUS_OCTREE_H
#define ABACUS_ABACUS_OCTREE_H

#include "abacus/mesh_header.h"
#include "abacus/windows.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The finest level that an octree of a dimension can have. */
ABACUS_API uint32_t abacus_octree_levels(uint32_t dimension);

typedef struct abacus_octant
{
	uint64_t code;
	int32_t level;
	double lower[ABACUS_MAX_DIMENSION];
	double upper[ABACUS_MAX_DIMENSION];
	const double *values; /* attributes; NaN = NULL. Valid until the next call */
} abacus_octant;

/* ---- Changes ------------------------------------------------------------- */

/*
 * All of these write the pages and bring the header up to date. Those that sort take at most
 * `memory` bytes, beyond that spools.
 */

/* Writes the single leaf of a new octree, and sets the header's fields about leaves. */
ABACUS_API abacus_status abacus_octree_root(const abacus_host *host, abacus_header *header,
											abacus_error *error);

/*
 * Growth: splits leaves until the octree is the smallest one that meets the requirements given.
 * Each growth ends with one of the functions that take the header.
 */
typedef struct abacus_octree_growth abacus_octree_growth;
ABACUS_API abacus_status abacus_octree_growth_open(const abacus_host *host,
												   const abacus_facts *facts, size_t memory,
												   abacus_octree_growth **growth,
												   abacus_error *error);
/*
 * Adds `count` places: each 1 + dimension words: with `levels` a level (int64_t), otherwise a word
 * that is not read; then coordinates (double, finite).
 */
ABACUS_API abacus_status abacus_octree_growth_add(abacus_octree_growth *growth,
												  const uint64_t *places, size_t count, int levels,
												  abacus_error *error);
/* The leaf that contains a place has the place's level or is finer. */
ABACUS_API abacus_status abacus_octree_growth_levels(abacus_octree_growth *growth,
													 abacus_header *header,
													 abacus_error *error);
/* At most `most` of the places lie in a leaf, unless it has the finest level. */
ABACUS_API abacus_status abacus_octree_growth_points(abacus_octree_growth *growth, uint64_t most,
													 abacus_header *header,
													 abacus_error *error);
/*
 * Says how large octants may be: gets `count` places, coordinate by coordinate, and the longest edge
 * of the octant around each, and sets the size allowed there. A size that is NaN splits nothing. May
 * fail as a host function may.
 */
typedef abacus_host_status (*abacus_octree_sizes)(void *context, size_t count,
												  const double *const *places,
												  const double *edges, double *sizes);
/* The most places along an axis of an octant. */
#define ABACUS_MAX_SAMPLES 16
/*
 * Leaves are no larger than the least size given for the centers of the `samples` equal parts along
 * each axis, unless they have the finest level. *longer becomes the number of leaves that are
 * larger than a size that was given for a place in them.
 */
ABACUS_API abacus_status abacus_octree_growth_sizes(abacus_octree_growth *growth,
													abacus_octree_sizes sizes, void *context,
													uint32_t samples, abacus_header *header,
													uint64_t *longer, abacus_error *error);
/* Leaves that touch across a face (1), an edge (2) or a corner (3) differ by at most one level. */
ABACUS_API abacus_status abacus_octree_growth_balance(abacus_octree_growth *growth, int32_t across,
													  abacus_header *header,
													  abacus_error *error);
ABACUS_API void abacus_octree_growth_close(abacus_octree_growth *growth);

/* Edits of single leaves, in place: each edit is of one kind. */
typedef struct abacus_octree_edit abacus_octree_edit;
ABACUS_API abacus_status abacus_octree_edit_open(const abacus_host *host,
												 const abacus_facts *facts, size_t memory,
												 size_t cache_bytes, abacus_octree_edit **edit,
												 abacus_error *error);
/* Adds `count` leaves to be: each 1 + dimension words: a level (int64_t), coordinates of a place. */
ABACUS_API abacus_status abacus_octree_edit_add_merges(abacus_octree_edit *edit,
													   const uint64_t *places, size_t count,
													   abacus_error *error);
/* Octants of these levels at these places become leaves. */
ABACUS_API abacus_status abacus_octree_edit_merge(abacus_octree_edit *edit, abacus_header *header,
												  abacus_error *error);
/* Adds `count` rows: each 1 + attributes words: a code, attributes (double; NaN = NULL). */
ABACUS_API abacus_status abacus_octree_edit_add_values(abacus_octree_edit *edit,
													   const uint64_t *rows, size_t count,
													   abacus_error *error);
/* The leaves with these codes get the attributes. *set: how many leaves. */
ABACUS_API abacus_status abacus_octree_edit_set(abacus_octree_edit *edit, abacus_header *header,
												uint64_t *set, abacus_error *error);
ABACUS_API void abacus_octree_edit_close(abacus_octree_edit *edit);

/*
 * A linear octree made elsewhere, into a new octree. ABACUS_ERROR (argument) names the row that
 * overlaps another or leaves a gap.
 */
typedef struct abacus_octree_load abacus_octree_load;
ABACUS_API abacus_status abacus_octree_load_open(const abacus_host *host,
												 const abacus_facts *facts, size_t memory,
												 abacus_octree_load **load, abacus_error *error);
/* Adds `count` leaves: each 2 + attributes words: a code, a level (double), attributes. */
ABACUS_API abacus_status abacus_octree_load_add(abacus_octree_load *load, const uint64_t *rows,
												size_t count, abacus_error *error);
ABACUS_API abacus_status abacus_octree_load_write(abacus_octree_load *load, abacus_header *header,
												  abacus_error *error);
ABACUS_API void abacus_octree_load_close(abacus_octree_load *load);

/* ---- Reading ------------------------------------------------------------- */

typedef struct abacus_octree abacus_octree;
ABACUS_API abacus_status abacus_octree_open(const abacus_host *host, const abacus_facts *facts,
											size_t cache_bytes, abacus_octree **octree,
											abacus_error *error);
/* The leaf that contains a place (`dimension` finite doubles); ABACUS_END outside the domain. */
ABACUS_API abacus_status abacus_octree_locate(abacus_octree *octree, const double *place,
											  abacus_octant *octant, abacus_error *error);
/* Gets a neighbour across the face below (side -1) or above (1) on an axis, valid during the call. */
typedef abacus_host_status (*abacus_octant_report)(void *context, int32_t axis, int32_t side,
												   const abacus_octant *octant);
/* Reports the leaves that share a piece of a face with the leaf with this code. */
ABACUS_API abacus_status abacus_octree_neighbours(abacus_octree *octree, uint64_t code,
												  abacus_octant_report report, void *context,
												  abacus_error *error);
ABACUS_API void abacus_octree_counters(const abacus_octree *octree, abacus_counters *counters);
ABACUS_API void abacus_octree_close(abacus_octree *octree);

/* The leaves that meet a window (all, a box, or a ball), along the curve. */
typedef struct abacus_octree_scan abacus_octree_scan;
ABACUS_API abacus_status abacus_octree_scan_open(const abacus_host *host,
												 const abacus_facts *facts,
												 const abacus_window *window, size_t cache_bytes,
												 abacus_octree_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_octree_scan_next(abacus_octree_scan *scan, abacus_octant *octant,
												 abacus_error *error);
ABACUS_API void abacus_octree_scan_close(abacus_octree_scan *scan);

/*
 * Extraction: corners of leaves are nodes, numbered from 0 along the curve. ABACUS_ERROR (state)
 * where a node hangs that is not the middle of an edge or a face: balance the octree first.
 */
typedef struct abacus_octree_node
{
	uint64_t number;
	double point[ABACUS_MAX_DIMENSION];
	int32_t anchors;   /* 0, or 2 or 4 for a hanging node */
	uint64_t anchor[4];
} abacus_octree_node;
typedef struct abacus_octree_nodes abacus_octree_nodes;
ABACUS_API abacus_status abacus_octree_nodes_open(const abacus_host *host,
												  const abacus_facts *facts, size_t memory,
												  abacus_octree_nodes **nodes,
												  abacus_error *error);
ABACUS_API abacus_status abacus_octree_nodes_next(abacus_octree_nodes *nodes,
												  abacus_octree_node *node, abacus_error *error);
ABACUS_API void abacus_octree_nodes_close(abacus_octree_nodes *nodes);

/* Leaves along the curve, by the numbers of their 2^dimension corners; axis 0 varies fastest. */
typedef struct abacus_octree_elements abacus_octree_elements;
ABACUS_API abacus_status abacus_octree_elements_open(const abacus_host *host,
													 const abacus_facts *facts, size_t memory,
													 abacus_octree_elements **elements,
													 abacus_error *error);
ABACUS_API abacus_status abacus_octree_elements_next(abacus_octree_elements *elements,
													 abacus_octant *octant, uint64_t *corners,
													 abacus_error *error);
ABACUS_API void abacus_octree_elements_close(abacus_octree_elements *elements);

/*
 * A balanced octree as a conforming mesh of triangles or tetrahedra with nodes as corners, leaf by
 * leaf along the curve. ABACUS_ERROR (state) as for nodes.
 */
typedef struct abacus_octree_simplices abacus_octree_simplices;
ABACUS_API abacus_status abacus_octree_simplices_open(const abacus_host *host,
													  const abacus_facts *facts, size_t memory,
													  abacus_octree_simplices **simplices,
													  abacus_error *error);
/* The leaf that it is part of, and its dimension + 1 nodes, in positive orientation. */
ABACUS_API abacus_status abacus_octree_simplices_next(abacus_octree_simplices *simplices,
													  uint64_t *element, uint64_t *nodes,
													  abacus_error *error);
ABACUS_API void abacus_octree_simplices_close(abacus_octree_simplices *simplices);

#ifdef __cplusplus
}
#endif

#endif

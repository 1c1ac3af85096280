/*
 * read.h: a mesh read: its simplices one by one, many places at once,
 * everything in order, the check.
 */
#ifndef ABACUS_ABACUS_READ_H
#define ABACUS_ABACUS_READ_H

#include "abacus/header.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * A simplex with its corners a, b, c(, d) in positive orientation (§4.3.1):
 * det(b - a, c - a) > 0, counterclockwise; det(b - a, c - a, d - a) > 0, the
 * right hand around the first three with its thumb to the fourth (Figure 4.4).
 * dimension + 1 of them are set.
 */
typedef struct abacus_simplex
{
	uint64_t code;   /* locational code of the simplex's key */
	int32_t ghost;   /* 1: hull facet; the last corner is the point at infinity and not set */
	int64_t id[ABACUS_MAX_DIMENSION + 1];
	double corner[ABACUS_MAX_DIMENSION + 1][ABACUS_MAX_DIMENSION];
} abacus_simplex;

/* A point of a mesh, or one that waits to be. */
typedef struct abacus_vertex
{
	int64_t id;
	double point[ABACUS_MAX_DIMENSION];
	const double *attributes; /* valid until the next call */
	int32_t waits;           /* 1: it is not inserted yet */
	uint64_t sequence;       /* of a point that waits: its place in the insertion order */
	int64_t vertex;          /* of one that does not: id of the vertex that stands for it,
								its own unless an equal point came before it */
} abacus_vertex;

typedef struct abacus_mesh abacus_mesh;

ABACUS_API abacus_status abacus_mesh_open(const abacus_host *host, const abacus_header *header,
										  size_t cache_bytes, abacus_mesh **mesh,
										  abacus_error *error);
ABACUS_API void abacus_mesh_close(abacus_mesh *mesh);
/*
 * The simplex that contains the point (`dimension` finite doubles); of several
 * (the point lies on a facet) the one with the least code, then least ids, so
 * that the answer depends on the mesh alone. ABACUS_END outside the hull.
 */
ABACUS_API abacus_status abacus_mesh_locate(abacus_mesh *mesh, const double *point,
											abacus_simplex *simplex, abacus_error *error);
/*
 * The neighbour of the simplex with this code and these corner ids across its
 * facet `facet` (the one opposite corner `facet`, 0 to dimension). ABACUS_END at
 * the hull; ABACUS_ERROR (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_mesh_walk(abacus_mesh *mesh, uint64_t code, const int64_t *ids,
										  int facet, abacus_simplex *simplex, abacus_error *error);
/*
 * The labels of the simplex with this code and these corner ids, as many as the header names; valid
 * until the next call. ABACUS_ERROR (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_mesh_labels(abacus_mesh *mesh, uint64_t code, const int64_t *ids,
											const double **labels, abacus_error *error);
/*
 * Gets one of the vertices nearest to a place, valid during the call, and its distance: rank 1 is
 * the nearest. May fail as a host function may. `place` is the id of one of many places.
 */
typedef abacus_host_status (*abacus_nearest_report)(void *context, int64_t place, uint64_t rank,
													const abacus_vertex *vertex, double distance);
/*
 * Reports the k vertices nearest to the point (`dimension` finite doubles), nearest first; fewer if
 * the mesh has fewer. Distances are compared exactly; of vertices equally far the one with the
 * lexicographically least coordinates comes first.
 */
ABACUS_API abacus_status abacus_mesh_nearest(abacus_mesh *mesh, const double *point, uint64_t k,
											 abacus_nearest_report report, void *context,
											 abacus_error *error);
ABACUS_API void abacus_mesh_counters(const abacus_mesh *mesh, abacus_counters *counters);

/*
 * Many places at once: sorted along the curve within `memory` bytes, beyond it in
 * spools, then located page by page.
 */
typedef struct abacus_places abacus_places;
ABACUS_API abacus_status abacus_places_open(const abacus_host *host, const abacus_header *header,
											size_t memory, size_t cache_bytes,
											abacus_places **places, abacus_error *error);
/* Adds `count` places: each 1 + dimension words of 8 bytes, as in abacus_stage_add. */
ABACUS_API abacus_status abacus_places_add(abacus_places *places, const uint64_t *records,
										   size_t count, abacus_error *error);
/*
 * Gets the id of a place, and the simplex that contains it as abacus_mesh_locate finds it, with its
 * labels, as many as the header names; NULL outside the hull. Valid during the call. May fail as a
 * host function may.
 */
typedef abacus_host_status (*abacus_place_report)(void *context, int64_t id,
												  const abacus_simplex *simplex,
												  const double *labels);
/* No more places come: reports each of them, in the order of the curve. Once. */
ABACUS_API abacus_status abacus_places_locate(abacus_places *places, abacus_place_report report,
											  void *context, abacus_error *error);
/* The same of their nearest vertices: instead of abacus_places_locate(), which finds simplices. */
ABACUS_API abacus_status abacus_places_nearest(abacus_places *places, uint64_t k,
											   abacus_nearest_report report, void *context,
											   abacus_error *error);
ABACUS_API void abacus_places_close(abacus_places *places);

/* All simplices, page by page in key order; with `ghosts` the hull facets too. */
typedef struct abacus_scan abacus_scan;
ABACUS_API abacus_status abacus_scan_open(const abacus_host *host, const abacus_header *header,
										  int ghosts, abacus_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_scan_next(abacus_scan *scan, abacus_simplex *simplex,
										  abacus_error *error);
ABACUS_API void abacus_scan_close(abacus_scan *scan);

/*
 * All points: the vertices, page by page along the curve; the points equal to a
 * vertex; those that wait, in insertion order.
 */
typedef struct abacus_vertex_scan abacus_vertex_scan;
ABACUS_API abacus_status abacus_vertex_scan_open(const abacus_host *host,
												 const abacus_header *header, size_t cache_bytes,
												 abacus_vertex_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_vertex_scan_next(abacus_vertex_scan *scan, abacus_vertex *vertex,
												 abacus_error *error);
ABACUS_API void abacus_vertex_scan_close(abacus_vertex_scan *scan);

/*
 * Whether the mesh's domain fits its points, by what the header counts and a look into a few pages;
 * if not, abacus_build_rekey() helps.
 */
ABACUS_API abacus_status abacus_domain_fits(const abacus_host *host, const abacus_header *header,
											int *fits, abacus_error *error);

/* ---- Checking -------------------------------------------------------------------- */

typedef struct abacus_fault
{
	abacus_key key;       /* page where the fault was seen; vertex page: code = first sequence number */
	const char *kind;     /* a short fixed word, e.g. "orientation" */
	char message[256];
} abacus_fault;

/*
 * Verifies the mesh exactly, once, when opened; then hands out the faults (at most `limit`). The
 * header is one that abacus_header_decode() has read: faults that it refuses are not checked again.
 */
typedef struct abacus_check abacus_check;
ABACUS_API abacus_status abacus_check_open(const abacus_host *host, const abacus_header *header,
										   size_t cache_bytes, size_t limit, abacus_check **check,
										   abacus_error *error);
ABACUS_API abacus_status abacus_check_next(abacus_check *check, abacus_fault *fault);
/* Simplices whose volume, computed in doubles, is lost in rounding; that is not a fault. */
ABACUS_API uint64_t abacus_check_flat(const abacus_check *check);
ABACUS_API void abacus_check_close(abacus_check *check);

#ifdef __cplusplus
}
#endif

#endif

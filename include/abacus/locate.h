/*
 * locate.h: finds simplices and vertices: at a place, nearest to it, across a facet, around; for
 * one place, or for many in one call.
 */
#ifndef ABACUS_ABACUS_LOCATE_H
#define ABACUS_ABACUS_LOCATE_H

#include "abacus/mesh_counters.h"
#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abacus_mesh abacus_mesh;

ABACUS_API abacus_status abacus_mesh_open(const abacus_host *host, const abacus_facts *facts,
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
 * the mesh has fewer. Distances are compared exactly; of vertices equally far away the one with the
 * lexicographically least coordinates comes first.
 */
ABACUS_API abacus_status abacus_mesh_nearest(abacus_mesh *mesh, const double *point, uint64_t k,
											 abacus_nearest_report report, void *context,
											 abacus_error *error);
ABACUS_API void abacus_mesh_counters(const abacus_mesh *mesh, abacus_counters *counters);

/* The id of the vertex at a place; of one of them, if several share it. ABACUS_END if there is none. */
ABACUS_API abacus_status abacus_mesh_vertex_at(abacus_mesh *mesh, const double *point, int64_t *id,
											   abacus_error *error);

/* Gets one of several simplices, valid during the call. May fail as a host function may. */
typedef abacus_host_status (*abacus_simplex_report)(void *context, const abacus_simplex *simplex);
/*
 * Reports all simplices that contain the point (`dimension` finite doubles): at a vertex its star,
 * on an edge or a facet those that meet there, otherwise one or none.
 */
ABACUS_API abacus_status abacus_mesh_star(abacus_mesh *mesh, const double *point,
										  abacus_simplex_report report, void *context,
										  abacus_error *error);
/*
 * Reports the simplex with this code and these corner ids, and all that can be reached from it
 * across at most `steps` facets, the nearest first. ABACUS_ERROR (argument) if the mesh has no such
 * simplex.
 */
ABACUS_API abacus_status abacus_mesh_neighbours(abacus_mesh *mesh, uint64_t code,
												const int64_t *ids, uint32_t steps,
												abacus_simplex_report report, void *context,
												abacus_error *error);

/*
 * Many places at once: sorted along the curve within `memory` bytes, beyond it in
 * spools, then located page by page.
 */
typedef struct abacus_places abacus_places;
ABACUS_API abacus_status abacus_places_open(const abacus_host *host, const abacus_facts *facts,
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
/* The same for their nearest vertices: instead of abacus_places_locate(), which finds simplices. */
ABACUS_API abacus_status abacus_places_nearest(abacus_places *places, uint64_t k,
											   abacus_nearest_report report, void *context,
											   abacus_error *error);
ABACUS_API void abacus_places_close(abacus_places *places);

#ifdef __cplusplus
}
#endif

#endif

/*
 * octree_ask.h: queries of an octree by place: leaves near a place, values between leaves, both
 * also for many places at once.
 */
#ifndef ABACUS_ABACUS_OCTREE_ASK_H
#define ABACUS_ABACUS_OCTREE_ASK_H

#include "abacus/octree.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Gets one of the leaves nearest to a place, valid during the call, and its distance: rank 1 is the
 * nearest. May fail as a host function may. `place` is the id of one of many places.
 */
typedef abacus_host_status (*abacus_octant_near)(void *context, int64_t place, uint64_t rank,
												 const abacus_octant *octant, double distance);
/*
 * Reports the k leaves nearest to a place (`dimension` finite doubles), nearest first; fewer if
 * there are fewer. The distances to their closed boxes are compared exactly; of leaves equally far
 * away the one with the least code comes first.
 */
ABACUS_API abacus_status abacus_octree_nearest(abacus_octree *octree, const double *place,
											   uint64_t k, abacus_octant_near report,
											   void *context, abacus_error *error);
/*
 * Values of `count` attributes, by their numbers, at a place (`dimension` finite doubles), linear
 * along each axis between the corners of the leaf. NaN where a leaf that counts has none. ABACUS_END
 * outside the domain.
 */
ABACUS_API abacus_status abacus_octree_interpolate(abacus_octree *octree,
												   const uint32_t *attributes, uint32_t count,
												   const double *place, double *values,
												   abacus_error *error);

/*
 * Many places at once: sorted along the curve within `memory` bytes, beyond it in
 * spools, then looked up page by page.
 */
typedef struct abacus_octree_places abacus_octree_places;
ABACUS_API abacus_status abacus_octree_places_open(const abacus_host *host,
												   const abacus_facts *facts, size_t memory,
												   size_t cache_bytes,
												   abacus_octree_places **places,
												   abacus_error *error);
/* Adds `count` places: each 1 + dimension words: an id (int64_t), coordinates (double, finite). */
ABACUS_API abacus_status abacus_octree_places_add(abacus_octree_places *places,
												  const uint64_t *records, size_t count,
												  abacus_error *error);
/*
 * Gets the id of a place and the leaf that contains it, NULL outside the domain; valid during the
 * call.
 */
typedef abacus_host_status (*abacus_octant_at)(void *context, int64_t place,
											   const abacus_octant *octant);
/* No more places come: reports each of them, in the order of the curve. One of these three, once. */
ABACUS_API abacus_status abacus_octree_places_locate(abacus_octree_places *places,
													 abacus_octant_at report, void *context,
													 abacus_error *error);
ABACUS_API abacus_status abacus_octree_places_nearest(abacus_octree_places *places, uint64_t k,
													  abacus_octant_near report, void *context,
													  abacus_error *error);
/* Gets the id of a place and its values, NULL outside the domain. */
typedef abacus_host_status (*abacus_octree_values)(void *context, int64_t place,
												   const double *values);
ABACUS_API abacus_status abacus_octree_places_interpolate(abacus_octree_places *places,
														  const uint32_t *attributes,
														  uint32_t count,
														  abacus_octree_values report,
														  void *context, abacus_error *error);
ABACUS_API void abacus_octree_places_close(abacus_octree_places *places);

#ifdef __cplusplus
}
#endif

#endif

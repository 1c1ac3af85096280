/*
 * area.h: polygons in the plane, of which questions ask.
 */
#ifndef ABACUS_ABACUS_AREA_H
#define ABACUS_ABACUS_AREA_H

#include "abacus/extent.h"
#include "abacus/host_functions.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Prepares a polygon. `points` has x and y of all rings, one after the other; ring i has sizes[i]
 * points, and the last may repeat the first. Inside is what an odd number of rings goes around.
 * Rings may touch in points, but must not cross or run along one another. ABACUS_ERROR (argument)
 * for a number that is not finite.
 */
ABACUS_API abacus_status abacus_area_open(const abacus_host *host, const double *points,
										  const size_t *sizes, size_t rings,
										  abacus_area **polygon, abacus_error *error);
ABACUS_API void abacus_area_close(abacus_area *polygon);

/* The least box around it, lower[2] and upper[2]; 0 if it is empty, and then there is none. */
ABACUS_API int32_t abacus_area_box(const abacus_area *polygon, double *lower, double *upper);

#ifdef __cplusplus
}
#endif

#endif

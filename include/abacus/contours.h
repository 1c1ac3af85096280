/*
 * contours.h: lines of equal value of an attribute in a mesh of the plane, and
 * the bands between them.
 */
#ifndef ABACUS_ABACUS_CONTOURS_H
#define ABACUS_ABACUS_CONTOURS_H

#include "abacus/extent.h"
#include "abacus/windows.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abacus_contouring
{
	uint32_t attribute;  /* its number */
	int32_t bands;       /* 1: rings around the bands between levels, not lines */
	double interval;     /* levels are base + n * interval, ... */
	double base;
	const double *fixed; /* ... or these, in ascending order, all different and finite, ... */
	size_t fixed_count;  /* ... unless this is 0 */
	abacus_extent extent; /* triangles outside of it are left out */
} abacus_contouring;

/*
 * Gets a line or ring, `count` points of two coordinates each; if it is closed, the last point is
 * the first. `value` is the level; for a band the lower one, -infinity below all levels. `id`
 * counts lines, or bands, from 1 on. May fail as a host function may.
 */
typedef abacus_host_status (*abacus_contour_report)(void *context, int64_t id, double value,
													int32_t closed, const double *path,
													size_t count);
/*
 * Reports all of them within a window, which must not be a ball, in ascending order of `value`,
 * then in an order that depends on the mesh alone. Takes `memory` bytes, spools beyond that, and
 * memory for the longest line. ABACUS_ERROR (argument) if there are too many levels to be
 * distinguished.
 */
ABACUS_API abacus_status abacus_contours(const abacus_host *host, const abacus_facts *facts,
										 const abacus_window *window,
										 const abacus_contouring *contouring, size_t memory,
										 abacus_contour_report report, void *context,
										 abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

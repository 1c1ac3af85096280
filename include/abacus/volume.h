/*
 * volume.h: areas and volumes of a mesh with an attribute, over a base or
 * another mesh.
 */
#ifndef ABACUS_ABACUS_VOLUME_H
#define ABACUS_ABACUS_VOLUME_H

#include "abacus/extent.h"
#include "abacus/windows.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The part of a mesh that counts. */
typedef struct abacus_surface
{
	abacus_window window; /* none or a box: simplices are cut at its border */
	abacus_extent extent; /* leave out simplices outside of it */
	uint32_t attribute;   /* the heights; simplices that lack one are left out */
} abacus_surface;

/*
 * In dimension 2: the area below the surface, the area of the surface, the volumes above the base
 * and below it. In dimension 3: the volume, the area of the surface on which the attribute equals
 * the base, the volumes of the parts where it is at least that, and less. Infinite, or NaN, where
 * the range of doubles is too small.
 */
typedef struct abacus_volume
{
	double area, surface, cut, fill;
} abacus_volume;

ABACUS_API abacus_status abacus_volume_above(const abacus_host *host, const abacus_facts *facts,
											 const abacus_surface *surface, double base,
											 abacus_volume *volume, abacus_error *error);
/*
 * Between two meshes of dimension 2, where both have heights: cut is where the first is higher. The
 * other mesh may have its own host; longest edge and window are those of the first.
 */
ABACUS_API abacus_status abacus_volume_between(const abacus_host *host,
											   const abacus_facts *facts,
											   const abacus_surface *surface,
											   const abacus_host *other_host,
											   const abacus_facts *other,
											   uint32_t other_attribute, size_t cache_bytes,
											   abacus_volume *volume, abacus_error *error);

/*
 * How two meshes differ where both have values, those of the first less those of the other: the
 * greatest difference by its absolute value, and where; the mean, the mean of the absolute value, and
 * the root of the mean square, weighted by area or volume. Infinite, or NaN, where the range of doubles
 * is too small.
 */
typedef struct abacus_comparison
{
	int is_any;            /* 0: they have no part in common, and all else is 0 */
	double greatest, place[ABACUS_MAX_DIMENSION];
	double mean, mean_absolute, rms;
} abacus_comparison;

/* Of two meshes of the same dimension, as abacus_volume_between(). */
ABACUS_API abacus_status abacus_compare(const abacus_host *host, const abacus_facts *facts,
										const abacus_surface *surface,
										const abacus_host *other_host, const abacus_facts *other,
										uint32_t other_attribute, size_t cache_bytes,
										abacus_comparison *comparison, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

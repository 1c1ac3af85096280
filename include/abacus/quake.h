/*
 * quake.h: earthquake data sets (dissertation §5.1.2).
 */
#ifndef ABACUS_ABACUS_QUAKE_H
#define ABACUS_ABACUS_QUAKE_H

#include "abacus/host_functions.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A corner of the octree (dissertation §5.1.2), and the ground there. */
typedef struct abacus_quake_point
{
	int64_t id;          /* 1, 2, ... */
	double point[3];     /* metres; z is height, 0 at the surface */
	double vs, vp;       /* velocity of shear and of pressure waves, metres a second */
	double density;      /* kilograms a cubic metre */
} abacus_quake_point;

/*
 * Points for waves of `frequency` Hz, resolved by `points_per_wavelength`, one
 * at a time in Z-order. ABACUS_ERROR (argument) if they are not positive and
 * finite, or too high for the depth of the octree. `host` gives memory, half a
 * megabyte, and interrupts only.
 */
typedef struct abacus_quake abacus_quake;
ABACUS_API abacus_status abacus_quake_open(const abacus_host *host, double frequency,
										   double points_per_wavelength, abacus_quake **quake,
										   abacus_error *error);
ABACUS_API abacus_status abacus_quake_next(abacus_quake *quake, abacus_quake_point *point,
										   abacus_error *error);
ABACUS_API void abacus_quake_close(abacus_quake *quake);

#ifdef __cplusplus
}
#endif

#endif

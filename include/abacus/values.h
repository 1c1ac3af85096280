/*
 * values.h: a mesh with attributes as a function of place: values, the
 * weights of vertices that they are made of, gradients.
 */
#ifndef ABACUS_ABACUS_VALUES_H
#define ABACUS_ABACUS_VALUES_H

#include "abacus/extent.h"
#include "abacus/locate.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum abacus_method
{
	ABACUS_LINEAR = 0, /* in the simplex that abacus_mesh_locate finds */
	ABACUS_NATURAL,    /* Sibson's; in a Delaunay mesh only */
	ABACUS_NEAREST     /* of the nearest vertex */
} abacus_method;

typedef enum abacus_outside
{
	ABACUS_OUTSIDE_NOTHING = 0,
	ABACUS_OUTSIDE_NEAREST /* as by ABACUS_NEAREST */
} abacus_outside;

typedef struct abacus_interpolation
{
	abacus_method method;
	abacus_outside outside;
	abacus_extent extent; /* simplices outside of it count as outside of the mesh */
	uint32_t attributes; /* how many are requested */
	uint32_t attribute[ABACUS_MAX_ATTRIBUTES]; /* their numbers */
} abacus_interpolation;

/* The share of the value at a vertex in the value at a place. */
typedef struct abacus_weight
{
	int64_t vertex; /* its id */
	double weight;  /* not 0; all weights of a place sum to 1 up to rounding */
} abacus_weight;

/*
 * Values of the attributes at a point (`dimension` finite doubles). NaN where a vertex with a
 * weight has none. ABACUS_END outside.
 */
ABACUS_API abacus_status abacus_mesh_interpolate(abacus_mesh *mesh,
												 const abacus_interpolation *interpolation,
												 const double *point, double *values,
												 abacus_error *error);
/* The weights of a point, valid until the next call. ABACUS_END outside. */
ABACUS_API abacus_status abacus_mesh_weigh(abacus_mesh *mesh,
										   const abacus_interpolation *interpolation,
										   const double *point, const abacus_weight **weights,
										   size_t *count, abacus_error *error);
/*
 * The value that vertices with these weights and values give, as by abacus_mesh_interpolate(). NaN where one
 * has none.
 */
ABACUS_API double abacus_weighted_mean(const abacus_weight *weights, const double *values, size_t count);
/*
 * The gradient of the first attribute in the simplex that abacus_mesh_locate finds, `dimension`
 * doubles; NaN where a corner has no finite value. ABACUS_END outside. If `exponent` is not null, the
 * gradient is to be multiplied by 2^exponent, so that its direction is right where it overflows or underflows.
 */
ABACUS_API abacus_status abacus_mesh_gradient(abacus_mesh *mesh,
											  const abacus_interpolation *interpolation,
											  const double *point, double *gradient, int *exponent,
											  abacus_error *error);

/* Gets the id of a place and its values, NULL outside; as abacus_place_report. */
typedef abacus_host_status (*abacus_values_report)(void *context, int64_t id,
												   const double *values);
ABACUS_API abacus_status abacus_places_interpolate(abacus_places *places,
												   const abacus_interpolation *interpolation,
												   abacus_values_report report, void *context,
												   abacus_error *error);
/* Gets the id of a place and its weights, none outside. */
typedef abacus_host_status (*abacus_weights_report)(void *context, int64_t id,
													const abacus_weight *weights, size_t count);
ABACUS_API abacus_status abacus_places_weigh(abacus_places *places,
											 const abacus_interpolation *interpolation,
											 abacus_weights_report report, void *context,
											 abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

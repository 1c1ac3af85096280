/*
 * lines.h: a mesh along straight lines: the simplices on a ray, the profile of an attribute over a
 * path, whether one place is visible from another.
 */
#ifndef ABACUS_ABACUS_LINES_H
#define ABACUS_ABACUS_LINES_H

#include "abacus/extent.h"
#include "abacus/locate.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Gets a simplex that a ray meets, its labels (as many as the header names, NaN where it has none),
 * and the parameters between which the ray meets it; valid during the call. May fail as a host
 * function may.
 */
typedef abacus_host_status (*abacus_ray_report)(void *context, double enters, double leaves,
												const abacus_simplex *simplex,
												const double *labels);
/*
 * Reports, in order, the simplices that have more than a point in common with a ray. If several
 * have the same piece of it, around an edge or on both sides of a facet, only the one that
 * abacus_mesh_locate finds there. The parameter is in multiples of the direction, which must not be
 * 0.
 */
ABACUS_API abacus_status abacus_mesh_ray(abacus_mesh *mesh, const double *origin,
										 const double *direction, abacus_ray_report report,
										 void *context, abacus_error *error);

/* Gets a place of a profile; the value is NaN outside the mesh and where it is missing. */
typedef abacus_host_status (*abacus_profile_report)(void *context, double distance,
													const double *place, double value);
/*
 * Reports the places where a path of straight lines crosses the facets of simplices, and its own
 * corners, in order. Where it leaves or enters the mesh a place is reported twice, once of these as
 * outside. `corners` places of `dimension` finite doubles each. Simplices outside of the
 * extent count as outside.
 */
ABACUS_API abacus_status abacus_mesh_profile(abacus_mesh *mesh, uint32_t attribute,
											 const abacus_extent *extent, const double *path, size_t corners,
											 abacus_profile_report report, void *context,
											 abacus_error *error);

/* One end of a line of sight. */
typedef struct abacus_sight_end
{
	double place[2];
	int32_t stands; /* 1: `height` is above the ground at the place; 0: it is z */
	double height;
} abacus_sight_end;

typedef enum abacus_sight_kind
{
	ABACUS_SIGHT_UNKNOWN = 0, /* an end stands where there is no ground */
	ABACUS_SIGHT_FREE,
	ABACUS_SIGHT_BLOCKED
} abacus_sight_kind;

typedef struct abacus_sight
{
	abacus_sight_kind kind;
	double place[3]; /* where it is first blocked */
} abacus_sight;

/*
 * Whether the target is seen from the observer over a mesh in the plane whose heights are an
 * attribute. A line of sight that touches the ground is free; where there is no ground nothing
 * blocks it. Decided exactly. Triangles outside of the extent count as outside.
 */
ABACUS_API abacus_status abacus_mesh_look(abacus_mesh *mesh, uint32_t attribute,
										  const abacus_extent *extent,
										  const abacus_sight_end *observer,
										  const abacus_sight_end *target, abacus_sight *sight,
										  abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

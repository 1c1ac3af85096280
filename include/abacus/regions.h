/*
 * regions.h: regions of a mesh of dimension 2, which end at fixed edges.
 *
 * A region is a set of triangles. Outlines make one by parity: a place is inside if a ray from it
 * crosses an odd number of the edges on the region's outlines. A seed makes one by flooding: it fills
 * all triangles that can be reached from it without crossing a fixed edge. Regions do not overlap.
 * Each triangle has the number of its region, and passes it on to those that replace it, since no
 * change reaches across a fixed edge. The host keeps names, outlines and seeds.
 */
#ifndef ABACUS_ABACUS_REGIONS_H
#define ABACUS_ABACUS_REGIONS_H

#include "abacus/constrain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The greatest number of a region; the least is 1. */
#define ABACUS_MAX_REGIONS 16777214

/* ---- Outlines and seeds ------------------------------------------------------------ */

typedef struct abacus_region_parts abacus_region_parts;

/* Opens a collection of outlines and seeds, sorted within `memory` bytes and beyond it in spools. */
ABACUS_API abacus_status abacus_region_parts_open(const abacus_host *host,
												  const abacus_facts *facts, size_t memory,
												  abacus_region_parts **parts,
												  abacus_error *error);
/* A segment of an outline, which is one of a line of the mesh. */
ABACUS_API abacus_status abacus_region_parts_outline(abacus_region_parts *parts, uint32_t region,
													 const double ends[2][2], abacus_error *error);
/* ABACUS_ERROR (argument) unless the place is finite. */
ABACUS_API abacus_status abacus_region_parts_seed(abacus_region_parts *parts, uint32_t region,
												  const double place[2], abacus_error *error);
ABACUS_API void abacus_region_parts_close(abacus_region_parts *parts);

/* ---- Changes ------------------------------------------------------------------------- */

typedef enum abacus_region_fault_kind
{
	ABACUS_REGION_OPEN,         /* an outline is not closed: it has an end at the place */
	ABACUS_REGION_EMPTY,        /* no place is inside the outlines */
	ABACUS_REGION_SEED_OUTSIDE, /* the seed is outside the hull */
	ABACUS_REGION_SEED_FIXED,   /* the seed is on a fixed edge */
	ABACUS_REGION_LEAK,         /* the flood reaches the hull at the place */
	ABACUS_REGION_TWICE,        /* a triangle, with a corner at the place, is in another one as well */
	ABACUS_REGION_BORDER        /* the region ends at a segment that is to go */
} abacus_region_fault_kind;

typedef struct abacus_region_fault
{
	abacus_region_fault_kind kind;
	uint32_t region;
	uint32_t other;  /* the region that has the triangle, or 0 */
	double place[2];
	double edge[2][2]; /* both ends of a fixed edge there, or of the segment that is to go */
	int64_t line;      /* that has the edge, if it is known */
	int32_t has_line;
} abacus_region_fault;

/* Gets a box around triangles of a region; several may come of one, which lies in all of them together. */
typedef abacus_host_status (*abacus_region_box_report)(void *context, uint32_t region,
													   const double *lower, const double *upper);
/*
 * Puts the triangles of the regions into them, and reports boxes around them. The mesh must have simplices, and the outlines must be
 * fixed edges of it. ABACUS_END, and *fault says why, if that is impossible: then the change must be
 * given up. No more parts can be added.
 */
ABACUS_API abacus_status abacus_build_fill_regions(abacus_build *build, abacus_region_parts *parts,
												   abacus_header *header,
												   abacus_region_box_report report, void *context,
												   abacus_region_fault *fault,
												   abacus_error *error);
/* Takes all triangles out of the regions that have these parts. */
ABACUS_API abacus_status abacus_build_clear_regions(abacus_build *build,
													abacus_region_parts *parts,
													abacus_header *header, abacus_error *error);

/*
 * Segments have been fixed: makes the regions with these parts, all of which have seeds, what they are
 * with them. ABACUS_END as abacus_build_fill_regions(). No more parts can be added.
 */
ABACUS_API abacus_status abacus_build_cut_regions(abacus_build *build, abacus_segments *segments,
												  abacus_region_parts *parts, abacus_header *header,
												  abacus_region_fault *fault, abacus_error *error);

/* Gets the number of a region that lies beside segments; regions may come repeatedly. */
typedef abacus_host_status (*abacus_region_report)(void *context, uint32_t region);
/* Reports the regions on either side of fixed segments, which the mesh must have. */
ABACUS_API abacus_status abacus_build_regions_along(abacus_build *build,
													abacus_segments *segments,
													abacus_region_report report, void *context,
													abacus_error *error);

/* ---- Reading ---------------------------------------------------------------------------- */

typedef struct abacus_region_size
{
	uint32_t region;
	uint64_t triangles;
	uint64_t edges; /* on its border, which are fixed */
	double area;    /* the exact sum, rounded once; in square units of the coordinates */
	double lower[2]; /* of the box of its border */
	double upper[2];
} abacus_region_size;

typedef abacus_host_status (*abacus_region_size_report)(void *context,
														const abacus_region_size *size);
/* Reports all regions of the mesh that have triangles, by their numbers; sorts in `memory` bytes. */
ABACUS_API abacus_status abacus_region_sizes(abacus_mesh *mesh, size_t memory,
											 abacus_region_size_report report, void *context,
											 abacus_error *error);

/*
 * Compares the triangles of all regions of a sound mesh with what their parts give them, within `memory`
 * bytes: *region gets the number of one whose triangles are others, or 0. No more parts can be added.
 */
ABACUS_API abacus_status abacus_region_check(abacus_mesh *mesh, abacus_region_parts *parts,
											 size_t memory, uint32_t *region, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

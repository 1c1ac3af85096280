/*
 * extent.h: which part of a mesh counts in a question.
 */
#ifndef ABACUS_ABACUS_EXTENT_H
#define ABACUS_ABACUS_EXTENT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A polygon in the plane, prepared for questions: area.h. */
typedef struct abacus_area abacus_area;

/* All else is as if it were outside of the mesh. All zero: all counts. */
typedef struct abacus_extent
{
	double max_edge;   /* simplices without a longer edge; 0 or infinity: any */
	uint32_t region;   /* those in the region with this number; 0: any */
	int32_t has_box;   /* 1: what counts lies in the box from `lower` to `upper`; pages beyond it
						  need not be read */
	double lower[2];
	double upper[2];
	const abacus_area *area; /* those that have a part in it; lines, areas and values end at its
							  * border; null: any. It must live as long. */
} abacus_extent;

#ifdef __cplusplus
}
#endif

#endif

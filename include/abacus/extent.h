/*
 * extent.h: which simplices of a mesh count in a question.
 */
#ifndef ABACUS_ABACUS_EXTENT_H
#define ABACUS_ABACUS_EXTENT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The others are as if they were outside of the mesh. All zero: all count. */
typedef struct abacus_extent
{
	double max_edge;   /* those without a longer edge; 0 or infinity: any */
	uint32_t region;   /* those in the region with this number; 0: any */
} abacus_extent;

#ifdef __cplusplus
}
#endif

#endif

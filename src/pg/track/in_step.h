/*
 * in_step.h: checks whether a mesh is what its triggers expect.
 */
#ifndef ABACUS_IN_STEP_H
#define ABACUS_IN_STEP_H

#include "pg/mesh/change.h"

/* The shape of a mesh that its triggers expect. */
typedef struct ExpectedShape
{
	int			dimension;
	int			columns;		/* of a point: id, coordinates, attributes */
	uint32		dropped;		/* attributes of the mesh that were dropped */
} ExpectedShape;

extern void in_step_check_shape(const Change *change, ExpectedShape expected, const char *trigger);
extern void in_step_check_srid(Change *change, int32 srid);
extern void in_step_check_found(const Change *change, const char *table, const char *what,
								uint64 wanted, uint64 found);

#endif

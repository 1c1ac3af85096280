/*
 * nearest.h: the points of a mesh, the nearest to a place first.
 */
#ifndef ABACUS_NEAREST_H
#define ABACUS_NEAREST_H

#include "utils/rel.h"

#include "abacus/simplex.h"

/* Makes the row of a vertex. */
typedef void (*NearestRow) (void *context, const abacus_vertex *vertex, Datum *values,
							bool *isnull);

typedef struct Nearest Nearest;

extern Nearest *nearest_begin(Relation table, Oid mesh, Oid user, const double *place,
							  uint64 first, NearestRow row, void *context, MemoryContext parent);
extern bool nearest_next(Nearest *nearest, Datum *values, bool *isnull);
extern void nearest_end(Nearest *nearest);

#endif

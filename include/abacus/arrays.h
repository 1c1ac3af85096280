/*
 * arrays.h: a mesh as two arrays: vertices, and simplices by the numbers of
 * their corners, as scipy.spatial.Delaunay has `points` and `simplices`.
 */
#ifndef ABACUS_ABACUS_ARRAYS_H
#define ABACUS_ABACUS_ARRAYS_H

#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Vertices are numbered from 0 along the curve, so the numbers depend on the points alone. All
 * pages are read once for the vertices, twice for the simplices; sorting takes at most `memory`
 * bytes, beyond that spools.
 */
typedef struct abacus_numbered abacus_numbered;
ABACUS_API abacus_status abacus_numbered_open(const abacus_host *host, const abacus_facts *facts,
											  int simplices, size_t memory,
											  abacus_numbered **numbered, abacus_error *error);
/* The next vertex, in the order of the numbers: the first has number 0. Not for simplices. */
ABACUS_API abacus_status abacus_numbered_next_vertex(abacus_numbered *numbered,
													 abacus_vertex *vertex, abacus_error *error);
/* The next simplex in key order, and the numbers of its dimension + 1 corners. Not for vertices. */
ABACUS_API abacus_status abacus_numbered_next_simplex(abacus_numbered *numbered,
													  abacus_simplex *simplex, uint64_t *numbers,
													  abacus_error *error);
/* The labels of the simplex that came last, as many as the header names; valid until the next call. */
ABACUS_API abacus_status abacus_numbered_labels(abacus_numbered *numbered,
												const abacus_simplex *simplex,
												const double **labels, abacus_error *error);
ABACUS_API void abacus_numbered_close(abacus_numbered *numbered);

#ifdef __cplusplus
}
#endif

#endif

/*
 * simplex.h: a simplex and a vertex as readers return them.
 */
#ifndef ABACUS_ABACUS_SIMPLEX_H
#define ABACUS_ABACUS_SIMPLEX_H

#include "abacus/facts.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * A simplex with its corners a, b, c(, d) in positive orientation (§4.3.1):
 * det(b - a, c - a) > 0, counterclockwise; det(b - a, c - a, d - a) > 0, the
 * right hand around the first three with its thumb to the fourth (Figure 4.4).
 * dimension + 1 of them are set.
 */
typedef struct abacus_simplex
{
	uint64_t code;   /* locational code of the simplex's key */
	uint32_t region; /* number of its region; 0: none */
	int32_t ghost;   /* 1: hull facet; the last corner is the point at infinity and not set */
	int64_t id[ABACUS_MAX_DIMENSION + 1];
	double corner[ABACUS_MAX_DIMENSION + 1][ABACUS_MAX_DIMENSION];
} abacus_simplex;

/* A point of a mesh, or one that waits to be. */
typedef struct abacus_vertex
{
	int64_t id;
	double point[ABACUS_MAX_DIMENSION];
	const double *attributes; /* valid until the next call */
	int32_t waits;           /* 1: not yet inserted */
	uint64_t sequence;       /* for a point that waits: its place in the insertion order */
	int64_t vertex;          /* for one that does not: id of the vertex that stands for it,
								its own unless an equal point came before it */
} abacus_vertex;

#ifdef __cplusplus
}
#endif

#endif

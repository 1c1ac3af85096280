/*
 * shares.h: a mesh cut into parts along the curve, for the ranks of a parallel program, and what
 * one of them needs: its part, with layers of simplices around it.
 */
#ifndef ABACUS_ABACUS_SHARES_H
#define ABACUS_ABACUS_SHARES_H

#include "abacus/locate.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the parts have equal sums of. */
typedef enum abacus_weight_kind
{
	ABACUS_WEIGHT_ONE = 0,     /* simplices, each of which counts 1 */
	ABACUS_WEIGHT_ATTRIBUTE,   /* the mean of an attribute at the corners */
	ABACUS_WEIGHT_LABEL
} abacus_weight_kind;

typedef struct abacus_cut
{
	uint32_t parts;            /* at least 1 */
	uint32_t weight;           /* an abacus_weight_kind */
	uint32_t column;           /* the number of the attribute or label */
} abacus_cut;

/* One part, and what it has in common with others. */
typedef struct abacus_part
{
	uint32_t part;             /* from 0 on */
	uint64_t vertices;         /* of those that belong to it: it is the least part at them */
	uint64_t simplices;
	uint64_t cut_facets;       /* between its simplices and others' */
	uint64_t halo;             /* others' simplices that share a vertex with its own */
} abacus_part;

/* A share: a part, and so many layers of simplices around it. */
typedef struct abacus_share
{
	abacus_cut cut;
	uint32_t part;             /* less than cut.parts */
	uint32_t halo;             /* layers; each has all simplices that share a vertex with what is there */
} abacus_share;

typedef struct abacus_share_vertex
{
	uint64_t local;            /* from 0 on: the part's own first, then by owner, along the curve */
	uint32_t owner;            /* the least part that has a simplex at it */
	int64_t id;
	double point[ABACUS_MAX_DIMENSION];
	const double *attributes;  /* as many as the header names */
} abacus_share_vertex;

typedef struct abacus_share_simplex
{
	abacus_simplex simplex;
	uint64_t local[ABACUS_MAX_DIMENSION + 1]; /* numbers of the corners */
	uint32_t owner;
	const double *labels;      /* as many as the header names; valid during the call */
	double markers[ABACUS_MAX_DIMENSION + 1]; /* of the facet opposite each corner; NaN: none */
} abacus_share_simplex;

/* Each gets one, valid during the call. May fail as a host function may. */
typedef abacus_host_status (*abacus_part_report)(void *context, const abacus_part *part);
typedef abacus_host_status (*abacus_share_vertex_report)(void *context,
														 const abacus_share_vertex *vertex);
typedef abacus_host_status (*abacus_share_simplex_report)(void *context,
														  const abacus_share_simplex *simplex);

/*
 * A handle keeps the last cut, which takes one pass over the pages, and at most `memory` bytes for the parts: an error
 * (limit) if there are too many. Sorting takes at most as many, beyond that spools. Parts are the same whatever the pages: simplices are in the order of
 * their keys, then of their corners, and one belongs to the part in which its middle lies.
 */
ABACUS_API abacus_status abacus_mesh_parts(abacus_mesh *mesh, const abacus_cut *cut, size_t memory,
										   abacus_part_report report, void *context,
										   abacus_error *error);
/* In the order of their numbers. */
ABACUS_API abacus_status abacus_mesh_share_vertices(abacus_mesh *mesh, const abacus_share *share,
													size_t memory,
													abacus_share_vertex_report report,
													void *context, abacus_error *error);
/* Page by page along the curve. */
ABACUS_API abacus_status abacus_mesh_share_simplices(abacus_mesh *mesh, const abacus_share *share,
													 size_t memory,
													 abacus_share_simplex_report report,
													 void *context, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

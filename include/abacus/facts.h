/*
 * facts.h: what is known of a mesh or an octree as a whole, but for its names: what it is, what its
 * columns are, what it has, and how it stands. Small, so it may be copied.
 */
#ifndef ABACUS_ABACUS_FACTS_H
#define ABACUS_ABACUS_FACTS_H

#include "abacus/host_functions.h"
#include "abacus/page_kinds.h"
#include "abacus/standing.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The greatest number of a spatial reference system, as in PostGIS. */
#define ABACUS_MAX_SRID 999999

/* So many labels simplices may have. */
#define ABACUS_MAX_LABELS 115
#define ABACUS_MAX_NAMES (ABACUS_MAX_ATTRIBUTES + ABACUS_MAX_LABELS)

/* What the pages are of. */
typedef enum abacus_type
{
	ABACUS_MESH = 0,
	ABACUS_OCTREE              /* or a quadtree */
} abacus_type;

/* What a mesh is, or an octree: changes of points leave it as it is, but for the domain. */
typedef struct abacus_form
{
	uint32_t type;         /* an abacus_type */
	uint32_t dimension;    /* 2 or 3 */
	uint32_t has_domain;   /* 0 until given or taken from the first points */
	double lower[ABACUS_MAX_DIMENSION]; /* domain; used for clustering only */
	double upper[ABACUS_MAX_DIMENSION];
	uint32_t srid;         /* spatial reference system, to ABACUS_MAX_SRID; 0: unknown */
	uint32_t levels;       /* of an octree: the finest that a leaf may have */
} abacus_form;

/* What the values of a column are. */
typedef enum abacus_column_type
{
	ABACUS_FLOAT8 = 0          /* doubles; NaN is no value */
} abacus_column_type;

/* Which columns vertices (or leaves) and simplices have; their names and types are in the header. */
typedef struct abacus_columns
{
	uint32_t attributes;   /* number of attributes, 0 to ABACUS_MAX_ATTRIBUTES */
	uint32_t apart;        /* whether vertices have them in pages of their own */
	uint32_t labels;       /* number of labels, which a simplex may have, to ABACUS_MAX_LABELS */
	uint32_t inherits;     /* 1: a new simplex gets the labels of the one that its centroid lay in */
	/*
	 * Never stored. 1: the values of a step are read in place of the attributes, by the ids of the
	 * vertices (ABACUS_STEP_PAGES); the simplex pages have so many others.
	 */
	uint32_t by_id;
	uint32_t in_pages;
} abacus_columns;

/* What a mesh has; an octree has leaves alone. */
typedef struct abacus_census
{
	uint64_t staged;       /* sequence number of the next staged point */
	uint64_t inserted;     /* ... of the first that waits; those before it are in the mesh */
	uint64_t vertices;     /* of the mesh; 0 while the points span no simplex: then all wait */
	uint64_t duplicates;   /* further points of the mesh, each equal to a vertex */
	uint64_t serials;      /* serial number of the next such point */
	uint64_t simplices;
	uint64_t ghosts;       /* facets of the boundary, which is the convex hull of a Delaunay mesh */
	uint64_t leaves;       /* of an octree */
	uint64_t labelled;     /* simplices that have labels */
	uint64_t marked;       /* simplices beside a facet with a marker */
	uint64_t split;        /* vertices that share their place with another one, told apart by id;
							  unless 0 the mesh was loaded and is not Delaunay, and no attribute is
							  apart */
	uint64_t lines;        /* that the host keeps; unless 0 the mesh is constrained */
	uint64_t soft_lines;   /* of them, the soft ones */
	uint64_t lines_wait;   /* 1: their edges are not fixed yet, as the points span no simplex */
	uint64_t regions;      /* of a constrained mesh, that the host keeps */
	uint64_t seeded;       /* of them, those that have seeds */
	uint64_t knows_ids;    /* 1: of a constrained mesh, no point has a greater id than ... */
	int64_t greatest_id;   /* ... this one */
	uint64_t outside;      /* points that came where the domain does not fit them, outside it or to
							  a code that fills pages, since it was last chosen */
} abacus_census;

/* All of that: what reading takes. */
typedef struct abacus_facts
{
	abacus_form form;
	abacus_columns columns;
	abacus_census census;
	uint32_t standing;     /* an abacus_delaunay; what follows from it is in standing.h */
} abacus_facts;

/*
 * Whether a new mesh should have so many attributes apart: a few take less room in the simplex
 * pages, in each that names their vertex.
 */
ABACUS_API uint32_t abacus_are_apart(uint32_t dimension, uint32_t attributes);

#ifdef __cplusplus
}
#endif

#endif

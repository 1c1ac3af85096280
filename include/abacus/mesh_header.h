/*
 * mesh_header.h: what is known about a mesh as a whole, and the counters of all its builds. It is a
 * separate row among the pages.
 */
#ifndef ABACUS_ABACUS_MESH_HEADER_H
#define ABACUS_ABACUS_MESH_HEADER_H

#include <string.h>

#include "abacus/host_functions.h"
#include "abacus/standing.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Pages of a mesh ------------------------------------------------------ */

enum
{
	/* Simplices: the interval of their keys from the page's key to that of the next. */
	ABACUS_SIMPLEX_PAGES = 0,
	/* Points that wait to be inserted, in insertion order: {sequence number of the first, 0}. */
	ABACUS_STAGED_PAGES,
	/* Points equal to a vertex: {code, serial number}, an interval as for simplices. */
	ABACUS_REPEATED_PAGES,
	/*
	 * Attributes of vertices, if they are apart, labels of simplices, markers of facets: separate
	 * intervals of keys, group by group.
	 */
	ABACUS_ATTRIBUTE_PAGES
};

/* Leaves of an octree: in the same place as the simplices of a mesh, which has none. */
#define ABACUS_OCTANT_PAGES ABACUS_SIMPLEX_PAGES

/* ---- Counters (chapter 5 of the dissertation) --------------------------- */

typedef struct abacus_counters
{
	uint64_t insertions;       /* vertices added */
	uint64_t removals;         /* vertices removed */
	uint64_t steps;            /* links followed: walk, cavity, rim */
	uint64_t misses;           /* links that led out of the cache (§4.10) */
	uint64_t link_probes;      /* page look-ups by a stored neighbour key */
	uint64_t quick_probes;     /* §4.10.1 */
	uint64_t ray_probes;       /* §4.10.2 */
	uint64_t concentric_probes;/* §4.10.3 */
	uint64_t incircle_tests;   /* insertions that consulted the application cache (§4.12.4) */
	uint64_t incircle_hits;    /* ... and found a simplex there */
	uint64_t walks;            /* point locations by walking */
	uint64_t created;          /* simplices created */
	uint64_t deleted;          /* simplices deleted */
	uint64_t loads;            /* pages read into the cache */
	uint64_t stores;           /* pages written from the cache */
	uint64_t rewrites;         /* ... of them in place of an older version */
	uint64_t splits;           /* blocks split */
	uint64_t merges;           /* blocks dissolved into their neighbours on the curve */
	uint64_t evictions;        /* blocks dropped from the cache */
	uint64_t eviction_batches;
	uint64_t bytes_read;
	uint64_t bytes_written;
	uint64_t translation_ns;   /* time between the two representations, host calls included */
	uint64_t total_ns;         /* time in the core, host calls included */
	uint64_t peak_bytes;       /* largest amount of memory the cache held */
	uint64_t passes;           /* of several threads over points */
	uint64_t put_off;          /* points that a pass left to the next one */
	uint64_t waited_ns;        /* total time that threads waited for the session's */
} abacus_counters;

/* ---- Header of a mesh ----------------------------------------------------- */

/* The greatest number of a spatial reference system, as in PostGIS. */
#define ABACUS_MAX_SRID 999999

/* Most labels that simplices may have. */
#define ABACUS_MAX_LABELS 115
#define ABACUS_MAX_NAMES (ABACUS_MAX_ATTRIBUTES + ABACUS_MAX_LABELS)
/*
 * Most names of attributes and labels in the header row; if there are more, all are in rows of
 * names.
 */
#define ABACUS_HEADER_NAMES 115

/* The type of data in the pages. */
typedef enum abacus_type
{
	ABACUS_MESH = 0,
	ABACUS_OCTREE              /* or a quadtree */
} abacus_type;

/* Copied by abacus_header_copy(): its room for names is much larger than most headers need. */
typedef struct abacus_header
{
	uint32_t type;         /* an abacus_type */
	uint32_t dimension;    /* 2 or 3 */
	uint32_t attributes;   /* number of attributes, 0 to ABACUS_MAX_ATTRIBUTES */
	uint32_t apart;        /* whether vertices have them in pages of their own */
	uint32_t has_domain;   /* 0 until given or taken from the first points */
	double lower[ABACUS_MAX_DIMENSION]; /* domain; used for clustering only */
	double upper[ABACUS_MAX_DIMENSION];
	uint64_t outside;      /* points that the domain did not fit since it was last chosen: outside
							  it, or at a code that fills pages */
	uint64_t stamp;        /* never repeats; set by the host at each change */
	uint64_t staged;       /* sequence number of the next staged point */
	uint64_t inserted;     /* ... of the first that waits; those before it are in the mesh */
	uint64_t vertices;     /* of the mesh; 0 while the points span no simplex: then all wait */
	uint64_t duplicates;   /* further points of the mesh, each equal to a vertex */
	uint64_t serials;      /* serial number of the next such point */
	uint64_t simplices;
	uint64_t ghosts;       /* facets of the boundary, which is the convex hull of a Delaunay mesh */
	uint32_t standing;     /* an abacus_delaunay; what follows from it is in standing.h */
	uint32_t srid;         /* spatial reference system of the coordinates, to ABACUS_MAX_SRID; 0: unknown */
	uint32_t levels;       /* of an octree: the finest that a leaf may have; */
	uint64_t leaves;       /* ... of the above it has a domain, attributes, a stamp and an SRID */
	abacus_counters counters; /* summed over all builds; peak_bytes: the largest */
	uint32_t labels;       /* number of labels, which a simplex may have, to ABACUS_MAX_LABELS */
	uint64_t labelled;     /* simplices that have some */
	uint64_t marked;       /* simplices beside a facet with a marker */
	uint32_t inherits;     /* 1: a new simplex gets the labels of the one that its centroid lay in */
	uint64_t split;        /* vertices that share their place with another one, separated by id;
							  unless 0 the mesh was loaded and is not Delaunay, and no attribute is
							  apart */
	char names[ABACUS_MAX_NAMES][ABACUS_NAME_BYTES]; /* of attributes, then of labels */
#ifdef __cplusplus
	abacus_header() = default;
	abacus_header(const abacus_header &other) { copy(other); }
	abacus_header &operator=(const abacus_header &other) { return copy(other); }

  private:
	abacus_header &copy(const abacus_header &other);
#endif
} abacus_header;

/* Copies all that matters; names beyond those in use stay as they are. */
static inline void
abacus_header_copy(abacus_header *to, const abacus_header *from)
{
	if (to != from)
		memcpy((void *) to, from,
			   offsetof(abacus_header, names) +
				   (size_t) (from->attributes + from->labels) * ABACUS_NAME_BYTES);
}

#ifdef __cplusplus
inline abacus_header &
abacus_header::copy(const abacus_header &other)
{
	abacus_header_copy(this, &other);
	return *this;
}
#endif

/*
 * Whether a new mesh should have this many attributes apart: a few take less room in the simplex
 * pages, even though each page with their vertex has them.
 */
ABACUS_API uint32_t abacus_are_apart(uint32_t dimension, uint32_t attributes);

/* Bytes of the header row; `bytes` has room for ABACUS_PAGE_BYTES. Returns the size. */
ABACUS_API size_t abacus_header_encode(const abacus_header *header, unsigned char *bytes);
/*
 * Checks and reads a header row; ABACUS_ERROR (corrupted) if it is not a header, (state) if it has
 * another format. If it has rows of names beside it, its names are empty until these are read.
 */
ABACUS_API abacus_status abacus_header_decode(const unsigned char *bytes, size_t size,
											  abacus_header *header, abacus_error *error);

/* Rows of names beside the header row; 0 if this has room for all names. */
ABACUS_API uint32_t abacus_header_name_rows(const abacus_header *header);
/* The same for such a row, from 0. */
ABACUS_API size_t abacus_header_encode_names(const abacus_header *header, uint32_t row,
											 unsigned char *bytes);
ABACUS_API abacus_status abacus_header_decode_names(const unsigned char *bytes, size_t size,
													uint32_t row, abacus_header *header,
													abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

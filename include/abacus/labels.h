/*
 * labels.h: gives labels to simplices and markers to facets, and reads facets by their markers.
 */
#ifndef ABACUS_ABACUS_LABELS_H
#define ABACUS_ABACUS_LABELS_H

#include "abacus/mesh_header.h"
#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Labels ------------------------------------------------------------------ */

typedef struct abacus_labelling abacus_labelling;

/*
 * Opens the labelling of simplices of a mesh, Delaunay or not. `facts` counts all labels; the first
 * `known` of them are not new. Each row has values of `count` labels, whose numbers are `labels`.
 * `memory` bounds the memory for sorting, in bytes.
 */
ABACUS_API abacus_status abacus_labelling_open(const abacus_host *host,
											   const abacus_facts *facts, uint32_t known,
											   const uint32_t *labels, size_t count, size_t memory,
											   size_t cache_bytes, abacus_labelling **labelling,
											   abacus_error *error);
/*
 * Adds rows of 8-byte words: code and dimension + 1 ids of a simplex, then the values, NaN where
 * there is none. If there are several rows for a simplex, the last one counts.
 */
ABACUS_API abacus_status abacus_labelling_add(abacus_labelling *labelling, const uint64_t *rows,
											  size_t count, abacus_error *error);
/*
 * No more rows come: gives the simplices their labels and brings the header up to date. ABACUS_ERROR
 * (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_labelling_end(abacus_labelling *labelling, abacus_header *header,
											  abacus_error *error);
ABACUS_API void abacus_labelling_close(abacus_labelling *labelling);

/* ---- Markers of facets ----------------------------------------------------------- */

typedef struct abacus_marking abacus_marking;

/* Opens the marking of facets of a mesh, Delaunay or not; `memory` as for labels. */
ABACUS_API abacus_status abacus_marking_open(const abacus_host *host, const abacus_facts *facts,
											 size_t memory, size_t cache_bytes,
											 abacus_marking **marking, abacus_error *error);
/*
 * Adds rows of 8-byte words: code and dimension + 1 ids of a simplex, the number of the corner
 * opposite the facet, and the marker, a double that is a 32-bit integer; NaN removes it.
 */
ABACUS_API abacus_status abacus_marking_add(abacus_marking *marking, const uint64_t *rows,
											size_t count, abacus_error *error);
/*
 * No more rows come: marks the facets, on both of their sides, and brings the header up to date.
 * ABACUS_ERROR (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_marking_end(abacus_marking *marking, abacus_header *header,
											abacus_error *error);
ABACUS_API void abacus_marking_close(abacus_marking *marking);

/* A facet with a marker: the ids and places of its `dimension` corners. */
typedef struct abacus_facet
{
	double marker; /* an integer */
	int64_t id[ABACUS_MAX_DIMENSION];
	double corner[ABACUS_MAX_DIMENSION][ABACUS_MAX_DIMENSION];
} abacus_facet;
/*
 * The facets with a marker, each once, by marker and then along the curve; NaN: those with any
 * marker. Sorts within `memory` bytes.
 */
typedef struct abacus_facets abacus_facets;
ABACUS_API abacus_status abacus_facets_open(const abacus_host *host, const abacus_facts *facts,
											double marker, size_t memory, size_t cache_bytes,
											abacus_facets **facets, abacus_error *error);
ABACUS_API abacus_status abacus_facets_next(abacus_facets *facets, abacus_facet *facet,
											abacus_error *error);
ABACUS_API void abacus_facets_close(abacus_facets *facets);

#ifdef __cplusplus
}
#endif

#endif

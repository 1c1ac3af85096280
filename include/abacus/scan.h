/*
 * scan.h: all simplices or all points of a mesh, in order.
 */
#ifndef ABACUS_ABACUS_SCAN_H
#define ABACUS_ABACUS_SCAN_H

#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All simplices, page by page in key order; with `ghosts` the hull facets too. */
typedef struct abacus_scan abacus_scan;
ABACUS_API abacus_status abacus_scan_open(const abacus_host *host, const abacus_facts *facts,
										  int ghosts, abacus_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_scan_next(abacus_scan *scan, abacus_simplex *simplex,
										  abacus_error *error);
ABACUS_API void abacus_scan_close(abacus_scan *scan);

/*
 * All points: the vertices, page by page along the curve; the points equal to a
 * vertex; those that wait, in insertion order.
 */
typedef struct abacus_vertex_scan abacus_vertex_scan;
ABACUS_API abacus_status abacus_vertex_scan_open(const abacus_host *host,
												 const abacus_facts *facts, size_t cache_bytes,
												 abacus_vertex_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_vertex_scan_next(abacus_vertex_scan *scan, abacus_vertex *vertex,
												 abacus_error *error);
ABACUS_API void abacus_vertex_scan_close(abacus_vertex_scan *scan);

#ifdef __cplusplus
}
#endif

#endif

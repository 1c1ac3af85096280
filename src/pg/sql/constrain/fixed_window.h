/*
 * fixed_window.h: the fixed edges of a window, and the lines over them.
 */
#ifndef ABACUS_FIXED_WINDOW_H
#define ABACUS_FIXED_WINDOW_H

#include "abacus/windows.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/reader.h"

/* Gets an edge and a line over it: ids and places of its ends, in the order of the places. */
typedef void (*FixedEdgeReport) (void *context, const int64 ids[2], const double ends[4], int64 line, bool is_hard);

extern bool fixed_window_read(Reader *reader, CachedMesh *cached, const abacus_window *window,
							  const abacus_extent *extent, Oid table, FixedEdgeReport report, void *context);

#endif

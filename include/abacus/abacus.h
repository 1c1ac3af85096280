/*
 * abacus.h: the bridge between PostgreSQL (C) and the Abacus core (C++), all of its headers.
 *
 * The core knows nothing of PostgreSQL. An abacus_host (host_functions.h) gives it what it needs
 * from a database: memory, pages found and stored by key, spool files, and news of interrupts. The
 * core offers a handful of plain handles:
 *
 *   build.h      points in (abacus_stage) and simplex pages out (abacus_build)  (dissertation §4.12)
 *   load.h       vertices and simplices made elsewhere in, simplex pages out
 *   labels.h     labels of simplices, markers of facets
 *   locate.h     places, neighbours, nearest vertices, for one place or many (§4.11.3)
 *   values.h     values at places: interpolation, weights, gradients; raster.h: many in rows
 *   lines.h      rays, profiles, lines of sight
 *   windows.h    simplices, vertices and edges of a window; scan.h: all, in order
 *   contours.h, surface.h, shapes.h, volume.h   lines, surfaces, outlines, volumes
 *   crossings.h                                 where segments of lines cross
 *   constrain.h, regions.h, extent.h, area.h    fixed edges, regions between them, questions within
 *   draw.h, raycast.h, tile.h                   pictures
 *   octree.h, octree_ask.h                      octrees
 *   shards.h                                    one mesh over several servers
 *   check.h                                     verification
 *   facts.h, standing.h                         what is known of a mesh, but for its names
 *   mesh_header.h, mesh_counters.h              all that is known of it; what has been done with it
 *   page_kinds.h, simplex.h                     kinds of pages, and what readers return
 *
 * Errors travel by return value only. A host function that fails returns
 * ABACUS_HOST_FAILED and keeps its own error; the core unwinds and returns
 * ABACUS_HOST_ERROR, and the caller re-raises what the host kept. The core's own errors
 * are returned as ABACUS_ERROR with an abacus_error filled in. No exception and no
 * longjmp ever crosses this header. After any failure a handle may only be closed;
 * closing calls nothing of the host but resize().
 *
 * Every handle is bound to one thread and to the host it was opened with,
 * which must stay at its address until the handle is closed.
 */
#ifndef ABACUS_ABACUS_H
#define ABACUS_ABACUS_H

#include "abacus/area.h"
#include "abacus/arrays.h"
#include "abacus/build.h"
#include "abacus/check.h"
#include "abacus/constrain.h"
#include "abacus/contours.h"
#include "abacus/crossings.h"
#include "abacus/draw.h"
#include "abacus/extent.h"
#include "abacus/facts.h"
#include "abacus/goose.h"
#include "abacus/host_functions.h"
#include "abacus/labels.h"
#include "abacus/lines.h"
#include "abacus/load.h"
#include "abacus/locate.h"
#include "abacus/mesh_counters.h"
#include "abacus/mesh_header.h"
#include "abacus/octree.h"
#include "abacus/octree_ask.h"
#include "abacus/page_kinds.h"
#include "abacus/populate.h"
#include "abacus/quake.h"
#include "abacus/raster.h"
#include "abacus/raycast.h"
#include "abacus/regions.h"
#include "abacus/scan.h"
#include "abacus/shapes.h"
#include "abacus/shards.h"
#include "abacus/shares.h"
#include "abacus/simplex.h"
#include "abacus/standing.h"
#include "abacus/surface.h"
#include "abacus/thin.h"
#include "abacus/tile.h"
#include "abacus/values.h"
#include "abacus/volume.h"
#include "abacus/windows.h"

#endif

/*
 * abacus.h: the one bridge between PostgreSQL (C) and the Abacus core (C++).
 *
 * The core knows nothing of PostgreSQL. An abacus_host (host.h) gives it what it needs
 * from a database: memory, pages found and stored by key, spool files, and a word about
 * interrupts. The core offers a handful of plain handles:
 *
 *   abacus_stage   points in, vertex pages in insertion order out   (dissertation §4.12.2)
 *   abacus_build   staged points in, simplex pages out              (§4.12.3-5)
 *   abacus_load    vertices and simplices made elsewhere in, simplex pages out
 *   abacus_mesh    locate and walk over stored pages                (§4.11.3)
 *                  also rays, profiles, lines of sight (lines.h)
 *   abacus_places  locate many places at once; both also interpolate (interpolate.h)
 *   abacus_isosurface, abacus_sections   surfaces through a mesh
 *   abacus_scan, abacus_vertex_scan, abacus_check, abacus_draw      whole-mesh readers
 *   abacus_raster_scan  an attribute as a raster (raster.h)
 *   abacus_contours  lines of equal value and the bands between them, in one call
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

#include "abacus/arrays.h"
#include "abacus/ask.h"
#include "abacus/change.h"
#include "abacus/contours.h"
#include "abacus/draw.h"
#include "abacus/goose.h"
#include "abacus/header.h"
#include "abacus/host.h"
#include "abacus/interpolate.h"
#include "abacus/lines.h"
#include "abacus/octree.h"
#include "abacus/quake.h"
#include "abacus/raycast.h"
#include "abacus/raster.h"
#include "abacus/read.h"
#include "abacus/surface.h"
#include "abacus/volume.h"

#endif

/*
 * fixed_edges.h: the edges on the lines of a mesh.
 */
#ifndef ABACUS_FIXED_EDGES_H
#define ABACUS_FIXED_EDGES_H

#include "abacus/windows.h"
#include "nodes/execnodes.h"
#include "pg/mesh/reader.h"

extern void fixed_edges_put(Reader *reader, const abacus_window *window, const abacus_extent *extent, bool with_ends,
							ReturnSetInfo *set);
extern char *fixed_edges_fault(Oid mesh, uint64 fixed, uint64 soft);

#endif

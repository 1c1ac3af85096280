/*
 * mesh_lines.h: the lines of a mesh that is being changed, for the core.
 */
#ifndef ABACUS_MESH_LINES_H
#define ABACUS_MESH_LINES_H

#include "abacus/constrain.h"
#include "pg/mesh/writer.h"

extern void mesh_lines_attach(Host *host, abacus_build *build);
extern void mesh_lines_add(Host *host, abacus_segments *segments, const char *query);
extern void mesh_lines_open(Writer *writer, abacus_segments **segments);
extern void mesh_lines_close(Host *host, abacus_segments **segments);
extern void mesh_lines_fix(Writer *writer, abacus_build *build, abacus_segments *segments);
extern void mesh_lines_fix_waiting(Writer *writer, abacus_build *build, abacus_segments **segments);
extern void mesh_lines_fix_left(Writer *writer, abacus_build *build, abacus_segments **segments);
extern void mesh_lines_notice_waiting(const Writer *writer);
extern void mesh_lines_refuse_waiting(const Writer *writer);
extern void mesh_lines_refuse_clearing(const Writer *writer);

#endif

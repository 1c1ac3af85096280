/*
 * lines_table.h: the table of a mesh's lines, found or made.
 */
#ifndef ABACUS_LINES_TABLE_H
#define ABACUS_LINES_TABLE_H

#include "pg/mesh/mesh.h"

extern Oid	lines_table_make(Relation mesh, bool *is_new);
extern void lines_table_index(Relation mesh);
extern void lines_table_index_made(Relation mesh);
extern Oid	lines_table_require(Relation mesh, MeshAccess access);
extern Oid	lines_table_of(Relation mesh, uint64 lines);
extern char *lines_table_name(Oid table);
extern char *lines_table_segments_at(Oid table);

#endif

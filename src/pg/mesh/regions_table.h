/*
 * regions_table.h: the table of a mesh's regions, found or made.
 */
#ifndef ABACUS_REGIONS_TABLE_H
#define ABACUS_REGIONS_TABLE_H

#include "pg/mesh/mesh.h"

extern Oid	regions_table_make(Relation mesh);
extern char *regions_table_require(Relation mesh, MeshAccess access);
extern char *regions_table_region(Relation mesh, MeshAccess access, uint32 number);
extern uint32 regions_table_number(Relation mesh, MeshAccess access, const char *region);
extern void regions_table_refuse_lines(Relation mesh, const char *ids);

#endif

/*
 * regions_table.h: the table of a mesh's regions, found, made and read.
 */
#ifndef ABACUS_REGIONS_TABLE_H
#define ABACUS_REGIONS_TABLE_H

#include "abacus/extent.h"
#include "abacus/facts.h"
#include "pg/mesh/mesh.h"

/* The names of all regions, by their numbers. */
typedef struct RegionNames RegionNames;

extern Oid	regions_table_make(Relation mesh);
extern char *regions_table_require(Relation mesh, MeshAccess access);
extern char *regions_table_region(Relation mesh, MeshAccess access, uint32 number);
extern char *regions_table_name(Relation mesh, MeshAccess access, uint32 number);
extern void regions_table_find(Relation mesh, MeshAccess access, const char *region, abacus_extent *extent);
extern void regions_table_refuse_lines(Relation mesh, const char *ids);
extern bool region_names_may_read(Oid mesh, Oid user);
extern RegionNames *region_names_read(Oid mesh, const abacus_facts *facts);
extern const char *region_names_find(const RegionNames *names, uint32 number);

#endif

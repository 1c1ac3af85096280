/*
 * mesh_regions.h: the regions of a mesh that is being changed, for the core.
 */
#ifndef ABACUS_MESH_REGIONS_H
#define ABACUS_MESH_REGIONS_H

#include "abacus/regions.h"
#include "pg/mesh/writer.h"

extern abacus_region_parts *mesh_regions_read(Host *host, const abacus_facts *facts, Relation mesh,
											  MeshAccess access, const char *filter);
extern void mesh_regions_fill(Writer *writer, abacus_build *build, abacus_region_parts *parts);
extern void mesh_regions_clear(Writer *writer, abacus_build *build, abacus_region_parts *parts);
extern void mesh_regions_renew(Writer *writer, abacus_build *build);
extern void mesh_regions_refuse(Writer *writer, const abacus_region_fault *fault);
extern void mesh_regions_follow(Writer *writer, abacus_build *build, abacus_segments *segments);

#endif

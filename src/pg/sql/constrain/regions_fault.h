/*
 * regions_fault.h: whether the regions of a mesh are those of its table.
 */
#ifndef ABACUS_REGIONS_FAULT_H
#define ABACUS_REGIONS_FAULT_H

#include "pg/lines/named_rows.h"
#include "pg/mesh/mesh_cache.h"

#define REGION_SIZES "abacus_region_sizes"

extern NamedRows *region_sizes_read(CachedMesh *cached);
extern char *regions_fault(Oid mesh);

#endif

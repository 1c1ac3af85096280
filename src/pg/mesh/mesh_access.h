/*
 * mesh_access.h: who may use a table of a mesh, and whether it can be used.
 */
#ifndef ABACUS_MESH_ACCESS_H
#define ABACUS_MESH_ACCESS_H

#include "pg/mesh/mesh.h"

extern void mesh_check_access(Relation rel, MeshAccess access, Relation mesh);
extern void mesh_check_rows_access(Relation rel, MeshAccess access, Relation mesh,
								   const char *side);

#endif

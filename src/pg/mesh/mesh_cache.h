/*
 * mesh_cache.h: what a session keeps of the meshes it reads.
 */
#ifndef ABACUS_MESH_CACHE_H
#define ABACUS_MESH_CACHE_H

#include "abacus/locate.h"
#include "abacus/octree.h"
#include "pg/mesh/header.h"

typedef struct CachedMesh
{
	Host	   *host;
	abacus_mesh *mesh;			/* NULL while being opened, and for an octree */
	abacus_octree *octree;		/* NULL while being opened, and for a mesh */
	uint32		dimension;
	abacus_header header;		/* as the mesh was when it was opened */
} CachedMesh;

extern CachedMesh *mesh_cache_get(Oid relid);
extern CachedMesh *mesh_cache_get_octree(Oid relid);
extern CachedMesh *mesh_cache_get_any(Oid relid);
extern const CachedMesh *mesh_cache_peek(Oid relid);
extern void mesh_cache_init(void);

#endif

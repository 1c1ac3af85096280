/*
 * mesh_pages.h: the two tables of a mesh as the core's page operations.
 */
#ifndef ABACUS_PAGE_STORE_H
#define ABACUS_PAGE_STORE_H

#include "abacus/mesh_header.h"

#include "pg/base/type_name.h"
#include "pg/host/host.h"
#include "pg/mesh/mesh.h"
#include "pg/store/page_table.h"

/* For pages of any type, when they are moved or inspected. */
#define ANY_TYPE UINT32_MAX

struct MeshPages;

/* How pages are read that lie on other servers: a room above knows. */
typedef struct RemoteMeshes
{
	/* Registers the functions for the pages of a mesh with its host; returns what these need. */
	struct RemotePages *(*open) (Host *host, struct MeshPages *pages);
	/* The header, under the active snapshot. */
	void		(*read_header) (struct RemotePages *remote, abacus_header *header);
} RemoteMeshes;

typedef struct MeshPages
{
	Oid			mesh;
	uint32		type;			/* the abacus_type that the header must have, or ANY_TYPE */
	MeshAccess	access;
	uint32		name_rows;		/* rows of names beside the header: header.c */
	PageTable	simplices;
	PageTable	vertices;		/* its OID is looked up when first needed */
	struct RemotePages *remote;	/* of a mesh over several servers, which has no tables; otherwise NULL */
} MeshPages;

extern Host *mesh_host_create(MemoryContext parent, Oid mesh, MeshAccess access);
extern void mesh_pages_set_remote(const RemoteMeshes *functions);
extern void mesh_pages_read_remote_header(MeshPages *pages, abacus_header *header);
extern Oid	mesh_pages_vertex_table(MeshPages *pages);

extern bool mesh_pages_any(MeshPages *pages, abacus_page_kind kind);
extern void mesh_pages_expect_moves(MeshPages *pages);

/* The pages of a host from mesh_host_create(). */
static inline MeshPages *
mesh_pages(const Host *host)
{
	return host->pages[ABACUS_SIMPLEX_PAGES].owner;
}

#endif

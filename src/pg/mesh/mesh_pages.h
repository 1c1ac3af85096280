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

typedef struct MeshPages
{
	Oid			mesh;
	uint32		type;			/* the abacus_type that the header must have, or ANY_TYPE */
	MeshAccess	access;
	uint32		name_rows;		/* rows of names beside the header: header.c */
	PageTable	simplices;
	PageTable	vertices;		/* its OID is looked up when first needed */
} MeshPages;

extern Host *mesh_host_create(MemoryContext parent, Oid mesh, MeshAccess access);
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

/*
 * page_store.h: the two tables of a mesh as the core's page operations.
 */
#ifndef ABACUS_PAGE_STORE_H
#define ABACUS_PAGE_STORE_H

#include "abacus/host.h"

#include "pg/mesh/mesh.h"
#include "pg/store/page_table.h"

typedef struct PageStore
{
	Oid			mesh;
	MeshAccess	access;
	PageTable	simplices;
	PageTable	vertices;		/* its OID is looked up when first needed */
} PageStore;

extern void page_store_init(PageStore *store, Oid mesh, MeshAccess access, MemoryContext memory);
extern void page_store_close(PageStore *store);
extern void page_store_refuse_newer_index(PageStore *store);
extern Oid	page_store_vertex_table(PageStore *store);

extern bool page_store_find(PageStore *store, abacus_page_kind kind, abacus_key key,
							abacus_page *page);
extern void page_store_expect_moves(PageStore *store);
extern bool page_store_fetch(PageStore *store, abacus_page_kind kind, abacus_page *page);
extern bool page_store_next(PageStore *store, abacus_page_kind kind, const abacus_key *key,
							abacus_page *page);
extern void page_store_put(PageStore *store, abacus_page_kind kind, abacus_page *page);
extern void page_store_erase(PageStore *store, abacus_page_kind kind, const abacus_page *page);

#endif

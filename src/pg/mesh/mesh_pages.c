/*
 * mesh_pages.c: the two tables of a mesh as the core's page operations.
 *
 * Codes, parts and sequence numbers are unsigned numbers below 2^63 in the core and bigint in the
 * tables. Each table holds two kinds of pages, and one of them has its codes shifted to the
 * negative numbers. In the vertex table these are repeated points, below all sequence numbers of
 * staged points. In the simplex table they are attributes that are apart, below the header and all
 * simplices. A page's location is its TID: block * 2^16 + offset, never 0, since offsets start at
 * 1.
 */
#include "postgres.h"

#include "access/table.h"

#include "pg/base/location.h"
#include "pg/mesh/header.h"
#include "pg/mesh/mesh_pages.h"
#include "pg/store/page_fetch.h"
#include "pg/store/page_search.h"
#include "pg/store/page_write.h"

#define KEY_LIMIT UINT64CONST(0x7FFFFFFFFFFFFFFF)

/* OID of the vertex table, with lock and privileges. */
Oid
mesh_pages_vertex_table(MeshPages *pages)
{
	if (!OidIsValid(pages->vertices.relid))
	{
		page_table_open(&pages->simplices);
		pages->vertices.relid = mesh_vertex_table(pages->simplices.heap, pages->access);
	}
	return pages->vertices.relid;
}

/* The table of a kind of pages. */
static PageTable *
table_of(MeshPages *pages, abacus_page_kind kind)
{
	if (kind == ABACUS_SIMPLEX_PAGES || kind == ABACUS_ATTRIBUTE_PAGES)
		return &pages->simplices;
	mesh_pages_vertex_table(pages);
	return &pages->vertices;
}

/* The first column of the least key of a kind. */
static int64
least_column(abacus_page_kind kind)
{
	return kind == ABACUS_REPEATED_PAGES || kind == ABACUS_ATTRIBUTE_PAGES ? PG_INT64_MIN : 0;
}

/* Whether a row of its table is a page of a kind. */
static bool
is_of_kind(abacus_page_kind kind, const StoredPage *stored)
{
	int64		column = stored->key[0];

	switch (kind)
	{
		case ABACUS_ATTRIBUTE_PAGES:
			return column < header_key[0];
		case ABACUS_REPEATED_PAGES:
			return column < 0;
		default:
			return column >= 0;
	}
}

static void
hand_out(const StoredPage *stored, abacus_page_kind kind, abacus_page *page)
{
	page->key.code = (uint64) stored->key[0] - (uint64) least_column(kind);
	page->key.part = (uint64) stored->key[1];
	page->bytes = stored->bytes;
	page->size = stored->size;
	page->location = pack_location(&stored->tid);
}

static void
to_columns(abacus_page_kind kind, abacus_key key, int64 *columns)
{
	columns[0] = (int64) (Min(key.code, KEY_LIMIT) + (uint64) least_column(kind));
	columns[1] = (int64) Min(key.part, KEY_LIMIT);
}

static bool
mesh_pages_find(void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	MeshPages  *pages = owner;
	int64		columns[PAGE_TABLE_KEYS];
	StoredPage	stored;

	to_columns(kind, key, columns);
	if (!page_table_floor(table_of(pages, kind), columns, &stored) ||
		!is_of_kind(kind, &stored))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

/* Tells both tables that others may have moved pages. */
void
mesh_pages_expect_moves(MeshPages *pages)
{
	page_table_expect_moves(&pages->simplices);
	page_table_expect_moves(&pages->vertices);
}

static bool
mesh_pages_fetch(void *owner, abacus_page_kind kind, abacus_page *page)
{
	MeshPages  *pages = owner;
	ItemPointerData tid;
	StoredPage	stored;

	unpack_location(page->location, &tid);
	if (!page_table_fetch(table_of(pages, kind), &tid, page->bytes, page->size, &stored) ||
		!is_of_kind(kind, &stored))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

static bool
mesh_pages_next(void *owner, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	MeshPages  *pages = owner;
	int64		columns[PAGE_TABLE_KEYS] = {-1, PG_INT64_MAX};	/* after the negative codes */
	bool		first = key == NULL && least_column(kind) < 0;
	StoredPage	stored;

	if (key != NULL)
		to_columns(kind, *key, columns);
	if (!page_table_next(table_of(pages, kind), first ? NULL : columns, &stored) ||
		!is_of_kind(kind, &stored))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

static void
mesh_pages_put(void *owner, abacus_page_kind kind, abacus_page *page)
{
	MeshPages  *pages = owner;
	PageTable  *table = table_of(pages, kind);
	int64		columns[PAGE_TABLE_KEYS];
	ItemPointerData tid;

	to_columns(kind, page->key, columns);
	if (page->location != 0)
	{
		unpack_location(page->location, &tid);
		page_table_update(table, columns, page->bytes, page->size, &tid);
	}
	else
		page_table_insert(table, columns, page->bytes, page->size, &tid);
	page->location = pack_location(&tid);
}

static void
mesh_pages_erase(void *owner, abacus_page_kind kind, const abacus_page *page)
{
	MeshPages  *pages = owner;
	ItemPointerData tid;

	unpack_location(page->location, &tid);
	page_table_delete(table_of(pages, kind), &tid);
}

/* Called when pages do not fit together: an error if the cause is that our snapshot is too old. */
static void
mesh_pages_doubt(void *owner)
{
	MeshPages  *pages = owner;

	page_table_refuse_newer_index(&pages->simplices);
	if (OidIsValid(pages->vertices.relid))
		page_table_refuse_newer_index(&pages->vertices);
}

static void
mesh_pages_release(void *owner)
{
	MeshPages  *pages = owner;

	page_table_close(&pages->simplices);
	page_table_close(&pages->vertices);
}

/* Whether the snapshot sees a page of this kind. */
bool
mesh_pages_any(MeshPages *pages, abacus_page_kind kind)
{
	abacus_key	last = {UINT64_MAX, UINT64_MAX};
	abacus_page page;

	return mesh_pages_find(pages, kind, last, &page);
}

static const RemoteMeshes *remote_meshes = NULL;

/* Says how meshes are read whose pages lie on other servers. */
void
mesh_pages_set_remote(const RemoteMeshes *functions)
{
	remote_meshes = functions;
}

void
mesh_pages_read_remote_header(MeshPages *pages, abacus_header *header)
{
	remote_meshes->read_header(pages->remote, header);
}

/* A host for the pages of a mesh, in a memory context under `parent`. */
Host *
mesh_host_create(MemoryContext parent, Oid mesh, MeshAccess access)
{
	static const HostPageFunctions functions = {
		mesh_pages_find, mesh_pages_fetch, mesh_pages_next, mesh_pages_put, mesh_pages_erase,
		mesh_pages_doubt, mesh_pages_release
	};
	Host	   *host = host_create(parent);
	MeshPages  *pages = MemoryContextAllocZero(host->home, sizeof(MeshPages));

	pages->mesh = mesh;
	pages->type = ABACUS_MESH;	/* unless the caller chooses another type */
	pages->access = access;
	page_table_init(&pages->simplices, mesh, access != MESH_READ, host->home);
	page_table_init(&pages->vertices, InvalidOid, access != MESH_READ, host->home);
	if (access == MESH_READ && mesh_is_sharded(mesh))
	{
		pages->remote = remote_meshes->open(host, pages);
		return host;
	}
	host_register_pages(host, ABACUS_SIMPLEX_PAGES, &functions, pages);
	host_register_pages(host, ABACUS_STAGED_PAGES, &functions, pages);
	host_register_pages(host, ABACUS_REPEATED_PAGES, &functions, pages);
	host_register_pages(host, ABACUS_ATTRIBUTE_PAGES, &functions, pages);
	return host;
}

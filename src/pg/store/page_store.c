/*
 * page_store.c: the two tables of a mesh as the core's page operations.
 *
 * Codes, parts and sequence numbers are unsigned below 2^63 in the core and
 * bigint in the tables. The vertex table holds two kinds of pages: repeated
 * points have their codes shifted to the negative numbers, below all sequence
 * numbers of staged points. A page's location is its TID: block * 2^16 +
 * offset, never 0, for offsets start at 1.
 */
#include "postgres.h"

#include "access/table.h"

#include "pg/store/location.h"
#include "pg/store/page_store.h"

#define KEY_LIMIT UINT64CONST(0x7FFFFFFFFFFFFFFF)

void
page_store_init(PageStore *store, Oid mesh, MeshAccess access, MemoryContext memory)
{
	store->mesh = mesh;
	store->access = access;
	page_table_init(&store->simplices, mesh, access != MESH_READ, memory);
	page_table_init(&store->vertices, InvalidOid, access != MESH_READ, memory);
}

void
page_store_close(PageStore *store)
{
	page_table_close(&store->simplices);
	page_table_close(&store->vertices);
}

/* Called when pages do not fit together: an error if that is since our snapshot is too old. */
void
page_store_refuse_newer_index(PageStore *store)
{
	page_table_refuse_newer_index(&store->simplices);
	if (OidIsValid(store->vertices.relid))
		page_table_refuse_newer_index(&store->vertices);
}

/* OID of the vertex table, with lock and privileges. */
Oid
page_store_vertex_table(PageStore *store)
{
	if (!OidIsValid(store->vertices.relid))
	{
		page_table_open(&store->simplices);
		store->vertices.relid = mesh_vertex_table(store->simplices.heap, store->access);
	}
	return store->vertices.relid;
}

/* The table of a kind of pages. */
static PageTable *
table_of(PageStore *store, abacus_page_kind kind)
{
	if (kind == ABACUS_SIMPLEX_PAGES)
		return &store->simplices;
	page_store_vertex_table(store);
	return &store->vertices;
}

/* The first column of the least key of a kind. */
static int64
least_column(abacus_page_kind kind)
{
	return kind == ABACUS_REPEATED_PAGES ? PG_INT64_MIN : 0;
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

bool
page_store_find(PageStore *store, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	int64		columns[PAGE_TABLE_KEYS];
	StoredPage	stored;

	to_columns(kind, key, columns);
	if (!page_table_floor(table_of(store, kind), columns, &stored) ||
		stored.key[0] < least_column(kind))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

/* Others may have moved pages since. */
void
page_store_expect_moves(PageStore *store)
{
	page_table_expect_moves(&store->simplices);
	page_table_expect_moves(&store->vertices);
}

bool
page_store_fetch(PageStore *store, abacus_page_kind kind, abacus_page *page)
{
	ItemPointerData tid;
	StoredPage	stored;

	unpack_location(page->location, &tid);
	if (!page_table_fetch(table_of(store, kind), &tid, page->bytes, page->size, &stored) ||
		stored.key[0] < least_column(kind))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

bool
page_store_next(PageStore *store, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	int64		columns[PAGE_TABLE_KEYS] = {-1, PG_INT64_MAX};	/* before all but repeated pages */
	bool		first = key == NULL && kind == ABACUS_REPEATED_PAGES;
	StoredPage	stored;

	if (key != NULL)
		to_columns(kind, *key, columns);
	if (!page_table_next(table_of(store, kind), first ? NULL : columns, &stored) ||
		(kind == ABACUS_REPEATED_PAGES && stored.key[0] >= 0))
		return false;
	hand_out(&stored, kind, page);
	return true;
}

void
page_store_put(PageStore *store, abacus_page_kind kind, abacus_page *page)
{
	PageTable  *table = table_of(store, kind);
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

void
page_store_erase(PageStore *store, abacus_page_kind kind, const abacus_page *page)
{
	ItemPointerData tid;

	unpack_location(page->location, &tid);
	page_table_delete(table_of(store, kind), &tid);
}

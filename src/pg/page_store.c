/*
 * page_store.c: the two tables of a mesh as the core's page operations.
 *
 * Codes, parts and sequence numbers are unsigned below 2^63 in the core and
 * bigint in the tables. A page's location is its TID: block * 2^16 + offset,
 * never 0, for offsets start at 1.
 */
#include "postgres.h"

#include "access/table.h"

#include "pg/page_store.h"

#define KEY_LIMIT UINT64CONST(0x7FFFFFFFFFFFFFFF)

void
page_store_init(PageStore *store, Oid mesh, MeshAccess access, MemoryContext memory)
{
	store->mesh = mesh;
	store->access = access;
	page_table_init(&store->simplices, mesh, 2, access == MESH_WRITE, memory);
	page_table_init(&store->vertices, InvalidOid, 1, access == MESH_WRITE, memory);
}

void
page_store_close(PageStore *store)
{
	page_table_close(&store->simplices);
	page_table_close(&store->vertices);
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

static uint64
pack_location(const ItemPointerData *tid)
{
	return ((uint64) ItemPointerGetBlockNumber(tid) << 16) | ItemPointerGetOffsetNumber(tid);
}

static void
unpack_location(uint64 location, ItemPointer tid)
{
	ItemPointerSet(tid, (BlockNumber) (location >> 16), (OffsetNumber) (location & 0xFFFF));
}

static void
hand_out(const StoredPage *stored, abacus_page *page)
{
	page->key.code = (uint64) stored->key[0];
	page->key.part = (uint64) stored->key[1];
	page->bytes = stored->bytes;
	page->size = stored->size;
	page->location = pack_location(&stored->tid);
}

static void
to_bigints(abacus_key key, int64 *columns)
{
	columns[0] = (int64) Min(key.code, KEY_LIMIT);
	columns[1] = (int64) Min(key.part, KEY_LIMIT);
}

bool
page_store_find(PageStore *store, abacus_key key, abacus_page *page)
{
	int64		columns[PAGE_TABLE_MAX_KEYS];
	StoredPage	stored;

	to_bigints(key, columns);
	if (!page_table_floor(&store->simplices, columns, &stored))
		return false;
	hand_out(&stored, page);
	return true;
}

bool
page_store_next(PageStore *store, const abacus_key *key, abacus_page *page)
{
	int64		columns[PAGE_TABLE_MAX_KEYS];
	StoredPage	stored;

	if (key != NULL)
		to_bigints(*key, columns);
	if (!page_table_next(&store->simplices, key != NULL ? columns : NULL, &stored))
		return false;
	hand_out(&stored, page);
	return true;
}

void
page_store_put(PageStore *store, abacus_page *page)
{
	int64		columns[PAGE_TABLE_MAX_KEYS];
	ItemPointerData tid;

	to_bigints(page->key, columns);
	if (page->location != 0)
	{
		unpack_location(page->location, &tid);
		page_table_update(&store->simplices, columns, page->bytes, page->size, &tid);
	}
	else
		page_table_insert(&store->simplices, columns, page->bytes, page->size, &tid);
	page->location = pack_location(&tid);
}

void
page_store_append_vertices(PageStore *store, uint64 first, const unsigned char *bytes, size_t size)
{
	int64		column = (int64) first;
	ItemPointerData tid;

	page_store_vertex_table(store);
	page_table_insert(&store->vertices, &column, bytes, size, &tid);
}

bool
page_store_read_vertices(PageStore *store, uint64 sequence, uint64 *first,
						 const unsigned char **bytes, size_t *size)
{
	int64		column = (int64) Min(sequence, KEY_LIMIT);
	StoredPage	stored;

	page_store_vertex_table(store);
	if (!page_table_floor(&store->vertices, &column, &stored))
		return false;
	*first = (uint64) stored.key[0];
	*bytes = stored.bytes;
	*size = stored.size;
	return true;
}

/*
 * page_write.c: rows of a table of pages are added, replaced, removed and moved.
 *
 * By heap_insert and index_insert, as the executor does it. No
 * BulkInsertState (its ring would evict the pages that are about to be read
 * again) and no SKIP_FSM (freed pages must be found; those that this session
 * has freed are taken from the beginning of the table on).
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/xact.h"

#include "pg/buffer_map.h"
#include "pg/page_table.h"
#include "pg/page_type.h"

/* Rows from which on a writer is one of very many. */
#define MANY_ROWS 16

/* Forms the tuple of a row in the current memory context. */
static HeapTuple
form_row(PageTable *table, const int64 *key, const unsigned char *bytes, size_t size,
		 Datum *values, bool *isnull)
{
	page_type_fill(table->datum, bytes, size);
	for (int i = 0; i < PAGE_TABLE_KEYS; i++)
	{
		values[i] = Int64GetDatum(key[i]);
		isnull[i] = false;
	}
	values[PAGE_TABLE_KEYS] = PointerGetDatum(table->datum);
	isnull[PAGE_TABLE_KEYS] = false;
	return heap_form_tuple(RelationGetDescr(table->heap), values, isnull);
}

/*
 * Has the next row go to a heap page that has become empty, the first one in the
 * table, if there is one that we know of, and returns it; else the heap looks
 * for a page by itself, and InvalidBlockNumber is returned.
 */
static BlockNumber
choose_heap_page(PageTable *table, HeapTuple tuple)
{
	Size		size = MAXALIGN(tuple->t_len);
	BlockNumber block;

	if (table->superseded == NULL)
		return InvalidBlockNumber;
	if (table->room < size)
	{
		block = superseded_take_empty(table->superseded, table->heap, size, &table->room);
		if (block == InvalidBlockNumber)
			return block;
		RelationSetTargetBlock(table->heap, block);
	}
	table->room -= Min(size + sizeof(ItemIdData), table->room);
	return RelationGetTargetBlock(table->heap);
}

/* After a row has been stored. */
static void
note_stored(PageTable *table, const ItemPointerData *tid)
{
	table->wrote = true;
	if (++table->stored > MANY_ROWS)
		buffer_map_around(table->heap, ItemPointerGetBlockNumber(tid));
}

/* Adds a row; *tid becomes its place. */
void
page_table_insert(PageTable *table, const int64 *key, const unsigned char *bytes, size_t size,
				  ItemPointer tid)
{
	Datum		values[PAGE_TABLE_KEYS + 1];
	bool		isnull[PAGE_TABLE_KEYS + 1];
	HeapTuple	tuple;

	page_table_open(table);
	tuple = form_row(table, key, bytes, size, values, isnull);
	choose_heap_page(table, tuple);
	heap_insert(table->heap, tuple, GetCurrentCommandId(true), 0, NULL);
	page_index_insert(table->indexes, table->heap, values, isnull, &tuple->t_self, false);
	*tid = tuple->t_self;
	heap_freetuple(tuple);
	note_stored(table, tid);
}

/* Replaces the row at *tid, which must have this key; *tid becomes its new place. */
void
page_table_update(PageTable *table, const int64 *key, const unsigned char *bytes, size_t size,
				  ItemPointer tid)
{
	Datum		values[PAGE_TABLE_KEYS + 1];
	bool		isnull[PAGE_TABLE_KEYS + 1];
	HeapTuple	tuple;

	page_table_open(table);
	/* an update would leave a small row where it lies */
	if (table->superseded != NULL &&
		superseded_is_far(table->superseded, ItemPointerGetBlockNumber(tid)))
	{
		page_table_delete(table, tid);
		page_table_insert(table, key, bytes, size, tid);
		return;
	}
	page_table_see_own_changes(table);
	tuple = form_row(table, key, bytes, size, values, isnull);
	choose_heap_page(table, tuple);
	simple_heap_update(table->heap, tid, tuple);
	if (table->superseded != NULL)
		superseded_add(table->superseded, ItemPointerGetBlockNumber(tid));
	if (!HeapTupleIsHeapOnly(tuple))
		page_index_insert(table->indexes, table->heap, values, isnull, &tuple->t_self, true);
	*tid = tuple->t_self;
	heap_freetuple(tuple);
	note_stored(table, tid);
}

/* Removes the row at *tid. */
void
page_table_delete(PageTable *table, ItemPointer tid)
{
	page_table_open(table);
	page_table_see_own_changes(table);
	simple_heap_delete(table->heap, tid);
	if (table->superseded != NULL)
		superseded_add(table->superseded, ItemPointerGetBlockNumber(tid));
	table->wrote = true;
}

/*
 * Moves the row in the slot, as it is, to the first heap page that has become
 * empty; returns false if that is none before the one on which it lies.
 */
bool
page_table_move(PageTable *table, TupleTableSlot *slot)
{
	HeapTuple	tuple = ExecCopySlotHeapTuple(slot);
	bool		moves = choose_heap_page(table, tuple) < ItemPointerGetBlockNumber(&slot->tts_tid);

	if (moves)
	{
		slot_getallattrs(slot);
		page_table_delete(table, &slot->tts_tid);
		heap_insert(table->heap, tuple, GetCurrentCommandId(true), 0, NULL);
		page_index_insert(table->indexes, table->heap, slot->tts_values, slot->tts_isnull,
						  &tuple->t_self, true);
		table->wrote = true;
	}
	heap_freetuple(tuple);
	return moves;
}

/*
 * page_write.c: adds, replaces, removes and moves rows of a table of pages.
 *
 * It calls heap_insert and index_insert, as the executor does. It uses no BulkInsertState, whose
 * ring would evict pages that are about to be read again. It uses no SKIP_FSM, since freed pages
 * must be found; those that this session has freed are used from the beginning of the table on. If
 * none is free, the table grows by many heap pages at a time.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/xact.h"
#include "storage/bufmgr.h"
#include "storage/freespace.h"

#include "pg/port/port.h"
#include "pg/port/shortcuts.h"
#include "pg/store/buffer_map.h"
#include "pg/store/heap_room.h"
#include "pg/store/own_versions.h"
#include "pg/store/page_type.h"
#include "pg/store/page_write.h"

/* From this number of rows on, a writer counts as one of very many. */
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
 * Chooses the heap page of the next row: the one being filled; or the first one in the table that
 * has become empty; or one of many new ones, if the table may grow. Returns it, or
 * InvalidBlockNumber: then the heap looks for a page by itself.
 */
static BlockNumber
choose_heap_page(PageTable *table, HeapTuple tuple, bool may_grow)
{
	Size		size = MAXALIGN(tuple->t_len);

	if (table->target == InvalidBlockNumber || table->room < size)
	{
		page_table_leave_target(table);
		if (table->superseded != NULL)
			table->target = superseded_take_empty(table->superseded, table->heap, size, &table->room);
		if (table->target == InvalidBlockNumber && may_grow)
		{
			table->target = heap_growth_take(&table->growth, table->heap, size, table->stored);
			table->room = NEW_HEAP_PAGE_ROOM;
		}
	}
	if (table->target != InvalidBlockNumber)
		RelationSetTargetBlock(table->heap, table->target);
	return table->target;
}

/* Called before the row at *tid is replaced or removed. */
static void
note_superseded(PageTable *table, ItemPointer tid)
{
	BlockNumber block = ItemPointerGetBlockNumber(tid);

	if (table->superseded == NULL)
		return;
	if (ABACUS_SHORTCUTS && own_versions_has(table->heap, tid))
		superseded_add_own(table->superseded, block);
	superseded_add(table->superseded, block);
}

/* Called after a row was written; before, it was on the heap page `from`, or did not exist. */
static void
note_written(PageTable *table, HeapTuple tuple, BlockNumber from)
{
	BlockNumber block = ItemPointerGetBlockNumber(&tuple->t_self);

	table->wrote = true;
	if (block == table->target)
		table->room -= Min(MAXALIGN(tuple->t_len) + sizeof(ItemIdData), table->room);
	else if (block != from)
		table->target = InvalidBlockNumber; /* the heap found no room there and updated the map */
}

/* Called after a row was stored. */
static void
note_stored(PageTable *table, HeapTuple tuple, BlockNumber from, ItemPointer tid)
{
	note_written(table, tuple, from);
	*tid = tuple->t_self;
	if (++table->stored > MANY_ROWS)
		buffer_map_around(PrefetchBuffer(table->heap, MAIN_FORKNUM,
										 ItemPointerGetBlockNumber(tid)).recent_buffer);
	heap_freetuple(tuple);
}

/* Adds a row; *tid gets its location. */
void
page_table_insert(PageTable *table, const int64 *key, const unsigned char *bytes, size_t size,
				  ItemPointer tid)
{
	Datum		values[PAGE_TABLE_KEYS + 1];
	bool		isnull[PAGE_TABLE_KEYS + 1];
	HeapTuple	tuple;

	page_table_open(table);
	tuple = form_row(table, key, bytes, size, values, isnull);
	choose_heap_page(table, tuple, true);
	heap_insert(table->heap, tuple, GetCurrentCommandId(true), 0, NULL);
	page_index_insert(table->indexes, table->heap, values, isnull, &tuple->t_self, false);
	note_stored(table, tuple, InvalidBlockNumber, tid);
}

/* Replaces the row at *tid, which must have this key; *tid gets its new location. */
void
page_table_update(PageTable *table, const int64 *key, const unsigned char *bytes, size_t size,
				  ItemPointer tid)
{
	Datum		values[PAGE_TABLE_KEYS + 1];
	bool		isnull[PAGE_TABLE_KEYS + 1];
	HeapTuple	tuple;

	page_table_open(table);
	/* an update would leave a small row in its place */
	if (table->superseded != NULL &&
		superseded_is_far(table->superseded, ItemPointerGetBlockNumber(tid)))
	{
		page_table_delete(table, tid);
		page_table_insert(table, key, bytes, size, tid);
		return;
	}
	page_table_see_own_changes(table);
	tuple = form_row(table, key, bytes, size, values, isnull);
	choose_heap_page(table, tuple, true);
	note_superseded(table, tid);
	port_heap_update(table->heap, tid, tuple);
	if (!HeapTupleIsHeapOnly(tuple))
		page_index_insert(table->indexes, table->heap, values, isnull, &tuple->t_self, true);
	note_stored(table, tuple, ItemPointerGetBlockNumber(tid), tid);
}

/* Removes the row at *tid. */
void
page_table_delete(PageTable *table, ItemPointer tid)
{
	page_table_open(table);
	page_table_see_own_changes(table);
	note_superseded(table, tid);
	simple_heap_delete(table->heap, tid);
	table->wrote = true;
}

/*
 * Moves the row in the slot, unchanged, to the first heap page that has become empty; false if
 * there is none before the page where it lies.
 */
bool
page_table_move(PageTable *table, TupleTableSlot *slot)
{
	HeapTuple	tuple = ExecCopySlotHeapTuple(slot);
	bool		moves = choose_heap_page(table, tuple, false) < ItemPointerGetBlockNumber(&slot->tts_tid);

	if (moves)
	{
		slot_getallattrs(slot);
		page_table_delete(table, &slot->tts_tid);
		heap_insert(table->heap, tuple, GetCurrentCommandId(true), 0, NULL);
		page_index_insert(table->indexes, table->heap, slot->tts_values, slot->tts_isnull,
						  &tuple->t_self, true);
		note_written(table, tuple, InvalidBlockNumber);
	}
	heap_freetuple(tuple);
	return moves;
}

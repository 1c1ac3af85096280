/*
 * page_fetch.c: reads a row of a table of pages at a location that an earlier search returned.
 *
 * The index is not used. Rows may have moved, and VACUUM may have cut the file. For that it needs a
 * lock, which ours excludes, so the length of the file is read only once after each call of
 * page_table_expect_moves().
 *
 * The heap page is mostly still in the same buffer. Then the shared table of buffers, which is
 * usually in cold memory, is not needed either. But such an access does not count as a use of the
 * buffer. So it is done only with buffers that have a usage count to spare; otherwise the pages
 * needed most would be replaced first. The bytes to be read are prefetched before it is known
 * whether they are still there.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "pgstat.h"
#include "storage/bufmgr.h"
#include "utils/snapmgr.h"

#include "pg/port/port.h"
#include "pg/port/shortcuts.h"
#include "pg/store/page_fetch.h"

/* Others may have moved rows. */
void
page_table_expect_moves(PageTable *table)
{
	table->blocks = 0;
}

/*
 * Loads whose values are not needed: a processor may drop prefetch instructions to cold memory.
 */
static void
ask_for(const unsigned char *bytes, size_t size)
{
	for (size_t at = 0; at < size; at += 64)	/* a line of the processor's cache */
		(void) ((const volatile unsigned char *) bytes)[at];
}

/* Reads the row at *tid, if its heap page is still in the buffer that held its bytes. */
static bool
fetch_where_it_was(PageTable *table, ItemPointer tid, const unsigned char *bytes, size_t size)
{
	BufferHeapTupleTableSlot *slot = (BufferHeapTupleTableSlot *) table->fetched;
	HeapTuple	row = &slot->base.tupdata;
	Size		place = (Size) ((const char *) bytes - BufferBlocks) / BLCKSZ;
	Buffer		buffer = (Buffer) place + 1;
	bool		found;

	if (place >= (Size) NBuffers)
		return false;			/* of a temporary table */
	ask_for(bytes, Min(size, BLCKSZ - ((const char *) bytes - BufferBlocks) % BLCKSZ));
	if (port_buffer_usage(buffer) < 2 ||
		!ReadRecentBuffer(table->heap->rd_locator, MAIN_FORKNUM, ItemPointerGetBlockNumber(tid),
						  buffer))
		return false;
	pgstat_count_buffer_read(table->heap);
	pgstat_count_buffer_hit(table->heap);
	ExecClearTuple(table->fetched);
	row->t_self = *tid;
	LockBuffer(buffer, BUFFER_LOCK_SHARE);
	port_refuse_old_snapshot(GetActiveSnapshot(), table->heap, BufferGetPage(buffer));
	found = heap_hot_search_buffer(&row->t_self, table->heap, buffer, GetActiveSnapshot(), row,
								   NULL, true);
	LockBuffer(buffer, BUFFER_LOCK_UNLOCK);
	if (found)
		ExecStorePinnedBufferHeapTuple(row, table->fetched, buffer);
	else
		ReleaseBuffer(buffer);
	return found;
}

/*
 * Reads the row at *tid, whatever it is; false if our snapshot sees none. `bytes` is where its page
 * was; `size` of them will be read.
 */
bool
page_table_fetch(PageTable *table, ItemPointer tid, const unsigned char *bytes, size_t size,
				 StoredPage *page)
{
	page_table_open(table);
	page_table_see_own_changes(table);
	if (ItemPointerGetBlockNumber(tid) >= table->blocks)
		table->blocks = RelationGetNumberOfBlocks(table->heap);
	if (ItemPointerGetBlockNumber(tid) >= table->blocks)
		return false;
	if (table->fetched == NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(table->memory);

		table->fetched = MakeSingleTupleTableSlot(RelationGetDescr(table->heap),
												  &TTSOpsBufferHeapTuple);
		MemoryContextSwitchTo(old);
	}
	if (!(ABACUS_SHORTCUTS && fetch_where_it_was(table, tid, bytes, size)) &&
		!table_tuple_fetch_row_version(table->heap, tid, GetActiveSnapshot(), table->fetched))
		return false;
	stored_page_read(table->fetched, page);
	return true;
}

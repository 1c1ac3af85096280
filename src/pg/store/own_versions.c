/*
 * own_versions.c: prunes rows that a transaction has both made and replaced, before it ends.
 *
 * PostgreSQL prunes what is dead to everyone, but nothing of a transaction in progress. But a row
 * that nothing can see any more (own_sight.c) is as dead now as it will be after the commit or the
 * rollback. A transaction that changes a mesh point by point leaves thousands of them.
 *
 * This does to a heap page what PostgreSQL's pruning does, with the same function and the same
 * record of the write-ahead log (pruning.c), under the same lock: no one else has the page pinned.
 * Line pointers stay, as dead ones, until VACUUM has removed their index entries. A chain of
 * versions on one page (HOT) keeps its first line pointer, which leads to the first remaining
 * version. A standby replays it like any pruning. No snapshot there can be in its way, since none
 * ever saw the rows.
 *
 * The version before, from another transaction, points to one that is gone. Only a row lock that a
 * user takes on a mesh's table follows that pointer. It finds what it would find after a DELETE.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/htup_details.h"
#include "access/xact.h"
#include "storage/bufmgr.h"

#include "pg/port/pruning.h"
#include "pg/store/heap_room.h"
#include "pg/store/own_versions.h"

/* Whether our own transaction has made the row at *tid. */
bool
own_versions_has(Relation heap, ItemPointer tid)
{
	Buffer		buffer = ReadBuffer(heap, ItemPointerGetBlockNumber(tid));
	Page		page = BufferGetPage(buffer);
	bool		has = false;

	LockBuffer(buffer, BUFFER_LOCK_SHARE);
	if (ItemPointerGetOffsetNumber(tid) <= PageGetMaxOffsetNumber(page))
	{
		ItemId		item = PageGetItemId(page, ItemPointerGetOffsetNumber(tid));

		has = ItemIdIsNormal(item) &&
			TransactionIdIsCurrentTransactionId(HeapTupleHeaderGetXmin((HeapTupleHeader) PageGetItem(page, item)));
	}
	UnlockReleaseBuffer(buffer);
	return has;
}

/* The row at a line pointer, or NULL. */
static HeapTupleHeader
row_at(Page page, OffsetNumber offset)
{
	ItemId		item;

	if (offset < FirstOffsetNumber || offset > PageGetMaxOffsetNumber(page))
		return NULL;
	item = PageGetItemId(page, offset);
	return ItemIdIsNormal(item) ? (HeapTupleHeader) PageGetItem(page, item) : NULL;
}

/*
 * Follows the chain of versions that begins at a line pointer, as long as they are past. All but
 * the first lose their line pointers; an index points to the first.
 */
static void
judge_chain(Page page, OffsetNumber first, const OwnSight *sight, Pruning *pruning)
{
	ItemId		item = PageGetItemId(page, first);
	OffsetNumber at = ItemIdIsRedirected(item) ? ItemIdGetRedirect(item) : first;
	int			unused_before = pruning->unused_count;
	int			past = 0;
	bool		has_more = true;
	TransactionId replaced_by = InvalidTransactionId;

	while (has_more)
	{
		HeapTupleHeader row = row_at(page, at);

		if (row == NULL || (past > 0 && HeapTupleHeaderGetRawXmin(row) != replaced_by))
		{
			pruning->unused_count = unused_before;	/* an unexpected state */
			return;
		}
		if (!own_sight_is_past(sight, row))
			break;
		past++;
		if (at != first)
			pruning->unused[pruning->unused_count++] = at;
		replaced_by = HeapTupleHeaderGetRawXmax(row);
		has_more = HeapTupleHeaderIsHotUpdated(row);
		if (has_more)
			at = ItemPointerGetOffsetNumber(&row->t_ctid);
	}
	if (past == 0)
		return;
	if (!has_more)
		pruning->dead[pruning->dead_count++] = first;
	else
	{
		pruning->redirected[pruning->redirected_count * 2] = first;
		pruning->redirected[pruning->redirected_count * 2 + 1] = at;
		pruning->redirected_count++;
	}
}

static void
judge_page(Page page, const OwnSight *sight, Pruning *pruning)
{
	pruning->redirected_count = pruning->dead_count = pruning->unused_count = 0;
	for (OffsetNumber offset = FirstOffsetNumber; offset <= PageGetMaxOffsetNumber(page); offset++)
	{
		HeapTupleHeader row = row_at(page, offset);

		if (ItemIdIsRedirected(PageGetItemId(page, offset)) || (row != NULL && !HeapTupleHeaderIsHeapOnly(row)))
			judge_chain(page, offset, sight, pruning);
	}
}

/*
 * Prunes past versions on a heap page; false if there are none, or the page is in use. *room gets
 * its room.
 */
bool
own_versions_prune(Relation heap, BlockNumber block, const OwnSight *sight, Size *room)
{
	Buffer		buffer = ReadBuffer(heap, block);
	Pruning		pruning;
	bool		any = false;

	if (!ConditionalLockBufferForCleanup(buffer))
	{
		ReleaseBuffer(buffer);
		return false;
	}
	judge_page(BufferGetPage(buffer), sight, &pruning);
	any = pruning.dead_count + pruning.redirected_count > 0;
	if (any)
	{
		port_prune(heap, buffer, &pruning);
		*room = heap_room_on(buffer);
	}
	UnlockReleaseBuffer(buffer);
	return any;
}

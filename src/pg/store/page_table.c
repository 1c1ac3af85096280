/*
 * page_table.c: a heap table of pages: opening, closing, and the heap page being filled.
 *
 * A writer sees its own changes because its active snapshot is a private copy whose
 * command id follows each change. There is one CommandCounterIncrement between a change
 * and the next search or update.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "storage/freespace.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/port/port.h"
#include "pg/store/page_table.h"
#include "pg/store/page_type.h"

/* Prepares a table for use; nothing is opened yet. */
void
page_table_init(PageTable *table, Oid relid, bool writable, MemoryContext memory)
{
	MemSet(table, 0, sizeof(*table));
	table->relid = relid;
	table->writable = writable;
	table->memory = memory;
}

/* The lock for the table and its indexes. */
LOCKMODE
page_table_lock_mode(const PageTable *table)
{
	return table->writable ? RowExclusiveLock : AccessShareLock;
}

/*
 * Others cannot rewrite a table that we have locked, but our own transaction can,
 * between two rows of a cursor. Readers hold places of the old file in memory, and
 * their snapshot need not see the new one. Where relations stay open between two rows,
 * PostgreSQL itself refuses the rewriting.
 */
static void
check_node(PageTable *table)
{
	if (!OidIsValid(table->node.relNumber))
		table->node = table->heap->rd_locator;
	else if (!table->writable && !RelFileLocatorEquals(table->node, table->heap->rd_locator))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_IN_USE),
				 errmsg("table \"%s\" was rewritten while this query was reading it",
						RelationGetRelationName(table->heap)),
				 errhint("End queries and loops over a mesh before you CLUSTER, TRUNCATE or alter it.")));
}

/* Opens the table, which our own transaction may have dropped between two rows of a cursor. */
static Relation
open_heap(PageTable *table)
{
	Relation	heap = try_table_open(table->relid, page_table_lock_mode(table));

	if (heap == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_IN_USE),
				 errmsg("table of a mesh was dropped while this query was reading it"),
				 errhint("End queries and loops over a mesh before you drop it.")));
	return heap;
}

void
page_table_open(PageTable *table)
{
	MemoryContext old;

	if (table->heap != NULL)
		return;
	old = MemoryContextSwitchTo(table->memory);
	table->heap = open_heap(table);
	check_node(table);
	MemSet(&table->growth, 0, sizeof(table->growth));
	table->target = InvalidBlockNumber;
	if (table->writable)
	{
		table->indexes = page_index_open_all(table->heap);
		if (table->datum == NULL)
			table->datum = palloc0(PAGE_TYPE_OVERHEAD + ABACUS_MAX_PAGE_BYTES);
	}
	MemoryContextSwitchTo(old);
}

void
page_scan_close(PageScan *scan)
{
	if (scan->scan != NULL)
	{
		index_endscan(scan->scan);
		ExecDropSingleTupleTableSlot(scan->slot);
	}
	scan->scan = NULL;
	scan->slot = NULL;
}

/* Leaves the heap page being filled, if there is one; others may use its rest. */
void
page_table_leave_target(PageTable *table)
{
	if (table->target == InvalidBlockNumber)
		return;
	RecordPageWithFreeSpace(table->heap, table->target, table->room);
	if (table->superseded != NULL)
		superseded_give_back(table->superseded, table->target, table->room);
	table->target = InvalidBlockNumber;
}

/* Closes the table and its indexes; locks stay until the end of the transaction, as usual. */
void
page_table_close(PageTable *table)
{
	if (table->heap == NULL)
		return;
	page_scan_close(&table->floor);
	page_scan_close(&table->forward);
	if (table->fetched != NULL)
		ExecDropSingleTupleTableSlot(table->fetched);
	table->fetched = NULL;
	table->at_key = false;
	page_index_close_all(table->indexes);
	table->indexes = NIL;
	page_table_leave_target(table);
	heap_growth_end(&table->growth, table->heap);
	if (table->index != NULL)
		index_close(table->index, NoLock);
	table_close(table->heap, NoLock);
	table->heap = NULL;
	table->index = NULL;
}

/* Makes our own changes visible to the searches that follow. */
void
page_table_see_own_changes(PageTable *table)
{
	if (table->wrote)
	{
		CommandCounterIncrement();
		UpdateActiveSnapshotCommandId();
		table->wrote = false;
		table->at_key = false;
	}
}

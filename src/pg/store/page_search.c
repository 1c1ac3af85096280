/*
 * page_search.c: rows of a table of pages found by key.
 *
 * "Greatest key <= K" is a backward scan of the primary key's
 * B-tree that takes its first row. The scan is kept open and only rescanned;
 * the bound is one comparison of rows, so equal codes with many parts still
 * cost one descent. (A second bound some way below K, to keep
 * nbtree from copying all matches of a leaf page, gained nothing when
 * measured.)
 */
#include "postgres.h"

#include "access/nbtree.h"
#include "access/relscan.h"
#include "access/stratnum.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/port/port.h"
#include "pg/store/page_search.h"
#include "pg/store/page_type.h"

/*
 * Starts a search with these scan keys; opens the scan when first used. What the scan allocates, now
 * or later (nbtree notes rows that are dead), lasts as long as the scan, not as the caller's memory.
 */
static void
search(PageTable *table, PageScan *scan, ScanKey keys, int count)
{
	MemoryContext old = MemoryContextSwitchTo(table->memory);

	if (scan->scan == NULL)
	{
		if (table->index == NULL)
			table->index = page_index_open_primary(table->heap, page_table_lock_mode(table));
		scan->slot = MakeSingleTupleTableSlot(RelationGetDescr(table->heap), &TTSOpsBufferHeapTuple);
		scan->scan = port_index_beginscan(table->heap, table->index, GetActiveSnapshot(), count);
	}
	index_rescan(scan->scan, keys, count, NULL, 0);
	MemoryContextSwitchTo(old);
}

/* Goes on to the next row; false after the last. */
static bool
advance(PageTable *table, PageScan *scan, ScanDirection direction)
{
	MemoryContext old = MemoryContextSwitchTo(table->memory);
	bool		found = index_getnext_slot(scan->scan, direction, scan->slot);

	MemoryContextSwitchTo(old);
	return found;
}

/* "key <strategy> given" over all key columns, as one scan key. */
static void
bound_key(PageTable *table, PageScan *scan, ScanKey bound, StrategyNumber strategy,
		  const int64 *key)
{
	for (int i = 0; i < PAGE_TABLE_KEYS; i++)
	{
		ScanKeyInit(&scan->members[i], i + 1, strategy, F_BTINT8CMP, Int64GetDatum(key[i]));
		scan->members[i].sk_flags = SK_ROW_MEMBER | (i == PAGE_TABLE_KEYS - 1 ? SK_ROW_END : 0);
	}
	MemSet(bound, 0, sizeof(*bound));
	bound->sk_flags = SK_ROW_HEADER;
	bound->sk_attno = 1;
	bound->sk_strategy = strategy;
	bound->sk_argument = PointerGetDatum(scan->members);
}

/*
 * The row with exactly this key. The search goes backwards: a transaction may have left very many
 * versions with this key, and the last ones come first.
 */
bool
page_table_get(PageTable *table, const int64 *key, StoredPage *page)
{
	ScanKeyData keys[PAGE_TABLE_KEYS];

	page_table_open(table);
	page_table_see_own_changes(table);
	/* used for the rows of the header only: a scan of its own is not worth keeping */
	page_scan_close(&table->forward);
	table->at_key = false;
	for (int i = 0; i < PAGE_TABLE_KEYS; i++)
		ScanKeyInit(&keys[i], i + 1, BTEqualStrategyNumber, F_INT8EQ, Int64GetDatum(key[i]));
	search(table, &table->forward, keys, PAGE_TABLE_KEYS);
	if (!advance(table, &table->forward, BackwardScanDirection))
	{
		page_scan_close(&table->forward);
		return false;
	}
	stored_page_read(table->forward.slot, page);
	return true;
}

/* The row with the greatest key <= `key`. */
bool
page_table_floor(PageTable *table, const int64 *key, StoredPage *page)
{
	ScanKeyData bound;

	page_table_open(table);
	page_table_see_own_changes(table);
	bound_key(table, &table->floor, &bound, BTLessEqualStrategyNumber, key);
	search(table, &table->floor, &bound, 1);
	if (!advance(table, &table->floor, BackwardScanDirection))
		return false;
	stored_page_read(table->floor.slot, page);
	return true;
}

/* The row with the least key > `key`; NULL: with the least of all. */
bool
page_table_next(PageTable *table, const int64 *key, StoredPage *page)
{
	static const int64 least[PAGE_TABLE_KEYS] = {PG_INT64_MIN, PG_INT64_MIN};

	page_table_open(table);
	page_table_see_own_changes(table);
	/* reading on in order, the scan already stands there */
	if (key == NULL || !table->at_key ||
		memcmp(key, table->forward_key, PAGE_TABLE_KEYS * sizeof(int64)) != 0)
	{
		ScanKeyData bound;

		if (table->forward.scan != NULL && table->forward.scan->numberOfKeys != 1)
			page_scan_close(&table->forward);
		if (key == NULL)
			bound_key(table, &table->forward, &bound, BTGreaterEqualStrategyNumber, least);
		else
			bound_key(table, &table->forward, &bound, BTGreaterStrategyNumber, key);
		search(table, &table->forward, &bound, 1);
	}
	if (!advance(table, &table->forward, ForwardScanDirection))
	{
		table->at_key = false;
		return false;
	}
	stored_page_read(table->forward.slot, page);
	memcpy(table->forward_key, page->key, sizeof(table->forward_key));
	table->at_key = true;
	return true;
}

/*
 * Called when something does not fit together: an error if our snapshot is older than
 * the index by which we search. An index that REINDEX CONCURRENTLY has built lacks the
 * versions that were dead by then. On the primary it waits for all transactions that
 * might need them. On a standby nothing waits, and PostgreSQL itself would answer
 * without these rows. The index is as young as the last change of its row in pg_index,
 * which made it valid. Not for our own changes: they wait for nobody.
 */
void
page_table_refuse_newer_index(PageTable *table)
{
	TransactionId changed;

	page_table_open(table);
	if (table->index == NULL)
		table->index = page_index_open_primary(table->heap, page_table_lock_mode(table));
	changed = HeapTupleHeaderGetXmin(table->index->rd_indextuple->t_data);
	if (!TransactionIdIsNormal(changed) || TransactionIdIsCurrentTransactionId(changed) ||
		!XidInMVCCSnapshot(changed, GetActiveSnapshot()))
		return;
	ereport(ERROR,
			(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
			 errmsg("index \"%s\" of a mesh was built after this snapshot was taken",
					RelationGetRelationName(table->index)),
			 errdetail("It lacks pages that the snapshot would have to see."),
			 errhint("The transaction might succeed if retried.")));
}

/*
 * Called when rows are missed: an error if our snapshot sees none and newer ones would.
 * Then the table has been made since, or an ALTER TABLE has rewritten all of its rows,
 * which disregards older snapshots. An error also if the snapshot is older than the
 * index.
 */
void
page_table_refuse_newer(PageTable *table)
{
	StoredPage	page;
	TupleTableSlot *slot;
	TableScanDesc scan;
	bool		is_newer;

	if (page_table_next(table, NULL, &page))
	{
		page_table_refuse_newer_index(table);
		return;
	}
	slot = table_slot_create(table->heap, NULL);
	scan = port_table_beginscan(table->heap, SnapshotSelf);
	is_newer = table_scan_getnextslot(scan, ForwardScanDirection, slot);
	table_endscan(scan);
	ExecDropSingleTupleTableSlot(slot);
	if (is_newer)
		ereport(ERROR,
				(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
				 errmsg("table \"%s\" was made or rewritten after this snapshot was taken",
						RelationGetRelationName(table->heap)),
				 errhint("The transaction might succeed if retried.")));
}

/* Starts a scan of the rows on one heap page, as they are after our changes. */
TableScanDesc
page_table_scan_heap_page(PageTable *table, BlockNumber block)
{
	ItemPointerData first;
	ItemPointerData last;

	page_table_open(table);
	page_table_see_own_changes(table);
	ItemPointerSet(&first, block, FirstOffsetNumber);
	ItemPointerSet(&last, block, MaxOffsetNumber);
	return port_table_beginscan_tidrange(table->heap, GetActiveSnapshot(), &first, &last);
}

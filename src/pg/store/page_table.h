/*
 * page_table.h: pages of bytes in one heap table, under its primary key's B-tree.
 *
 * Both tables of a mesh have this shape: two bigint key columns, then the
 * page. Direct heap and nbtree calls; no SPI, no executor. A table is
 * opened when first needed and closed before the SQL call returns. Its rows are found
 * by key (page_search.h), fetched by place (page_fetch.h), and written (page_write.h).
 */
#ifndef ABACUS_PAGE_TABLE_H
#define ABACUS_PAGE_TABLE_H

#include "access/genam.h"
#include "access/skey.h"
#include "access/tableam.h"
#include "executor/tuptable.h"
#include "utils/rel.h"

#include "pg/port/port.h"
#include "pg/store/heap_growth.h"
#include "pg/store/page_index.h"
#include "pg/store/stored_page.h"
#include "pg/store/superseded.h"

/* A kept-open index scan in one direction. */
typedef struct PageScan
{
	IndexScanDesc scan;			/* NULL while not open */
	TupleTableSlot *slot;
	/* columns of the row comparison; the scan points here as long as it runs */
	ScanKeyData members[PAGE_TABLE_KEYS];
} PageScan;

typedef struct PageTable
{
	Oid			relid;
	bool		writable;

	Relation	heap;			/* NULL while closed */
	RelFileLocator node;			/* of the heap when it was opened first */
	Relation	index;			/* NULL until searched */
	List	   *indexes;		/* writers: all that they keep */

	PageScan	floor;			/* backward: greatest key <= given */
	PageScan	forward;		/* least key > given, and onward */
	bool		at_key;			/* forward stands at forward_key */
	int64		forward_key[PAGE_TABLE_KEYS];
	TupleTableSlot *fetched;	/* NULL while none is */
	BlockNumber blocks;			/* of the heap, at least; 0: not known */

	bool		wrote;			/* changes that our snapshot does not yet see */
	uint64		stored;			/* rows so far */
	MemoryContext memory;		/* of what is open */
	struct varlena *datum;		/* writers: room for one page */
	Superseded *superseded;		/* where replaced rows lie; NULL if nobody asks */
	HeapGrowth	growth;			/* new heap pages, not written yet */
	BlockNumber target;			/* heap page that is being filled, or InvalidBlockNumber */
	Size		room;			/* on it */
} PageTable;

extern void page_table_init(PageTable *table, Oid relid, bool writable, MemoryContext memory);
extern void page_table_open(PageTable *table);
extern void page_table_close(PageTable *table);
extern void page_table_see_own_changes(PageTable *table);
extern void page_table_leave_target(PageTable *table);
extern void page_scan_close(PageScan *scan);
extern LOCKMODE page_table_lock_mode(const PageTable *table);

#endif

/*
 * goose_table.h: a table with one row for each simplex and a GiST index of boxes, as the core's
 * R-tree.
 */
#ifndef ABACUS_GOOSE_TABLE_H
#define ABACUS_GOOSE_TABLE_H

#include "access/genam.h"
#include "access/skey.h"
#include "executor/tuptable.h"
#include "nodes/execnodes.h"
#include "utils/rel.h"

#include "abacus/goose.h"
#include "pg/host/host.h"

typedef struct GooseTable
{
	Oid			relid;
	int			dimension;
	Relation	heap;
	Relation	index;
	IndexInfo  *index_info;
	IndexScanDesc scan;
	TupleTableSlot *slot;
	ScanKeyData overlaps;		/* box && given */
	ScanKeyData equals;			/* box ~= given, or = */
	bool		has_leaves;		/* the index has more than one page */
	CommandId	inserting;		/* under which rows are inserted: see goose_table.c */
	abacus_boxed_simplex *found;
	size_t		room;			/* of `found` */
	MemoryContext memory;
	MemoryContext scratch;		/* of one insertion */
	Host	   *host;			/* keeps the errors */
	abacus_rtree rtree;			/* what the core gets; its context is this table */
} GooseTable;

extern GooseTable *goose_table_create(text *name, int dimension);
extern void goose_table_own(GooseTable *table, Host *host);
extern void goose_table_remove_ghosts(GooseTable *table);
extern void goose_table_close(GooseTable *table);

#endif

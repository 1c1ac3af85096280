/*
 * truncate.c: the file of a table whose rows are all dead.
 *
 * A build in batches takes its points from vertex pages and erases them, each
 * batch in a transaction of its own. At the end the vertex table holds nothing
 * but dead rows, and its file is as large as ever, until VACUUM comes and cuts
 * it. That can be done here and now if nobody is in the way: no transaction
 * that may still see a row, nobody who has the table open.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/table.h"
#include "access/tableam.h"
#include "catalog/heap.h"
#include "storage/bufmgr.h"
#include "storage/lmgr.h"
#include "storage/procarray.h"
#include "utils/snapmgr.h"

#include "pg/truncate.h"

/* Whether a row is there that VACUUM would not remove. */
static bool
has_rows(Relation rel)
{
	SnapshotData snapshot;
	TableScanDesc scan;
	TupleTableSlot *slot = table_slot_create(rel, NULL);
	bool		found;

	InitNonVacuumableSnapshot(snapshot, GlobalVisTestFor(rel));
	scan = table_beginscan_strat(rel, &snapshot, 0, NULL, true, false);
	found = table_scan_getnextslot(scan, ForwardScanDirection, slot);
	table_endscan(scan);
	ExecDropSingleTupleTableSlot(slot);
	return found;
}

/* Cuts the file of a table to nothing, if it has only dead rows and nobody uses it. */
void
truncate_if_empty(Oid relid)
{
	Relation	rel;

	if (!ConditionalLockRelationOid(relid, AccessExclusiveLock))
		return;
	rel = try_relation_open(relid, NoLock);
	if (rel == NULL)
		return;
	if (RelationGetNumberOfBlocks(rel) > 0 && !has_rows(rel))
		heap_truncate_one_rel(rel);
	relation_close(rel, NoLock);
}

/*
 * truncate.c: the file of a table whose rows are all dead.
 *
 * A build in batches takes its points from vertex pages and erases them, each
 * batch in a transaction of its own. At the end the vertex table holds nothing
 * but dead rows, and its file is as large as ever, until VACUUM comes and cuts
 * it. That can be done here and now if nobody is in the way: no transaction
 * that may still see a row, nobody who has the table open.
 *
 * As TRUNCATE does it, table and index get new files, and the old ones go at
 * commit. Cutting the files where they are is not for tables that must survive
 * a crash: between the cut of the table and the new index there are moments
 * when one does not fit the other.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/table.h"
#include "access/tableam.h"
#include "catalog/index.h"
#include "pgstat.h"
#include "storage/bufmgr.h"
#include "storage/lmgr.h"
#include "storage/predicate.h"
#include "storage/procarray.h"
#include "utils/rel.h"
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

/* New, empty files for a table and its indexes, under the lock of the caller. */
static void
truncate_table(Relation rel)
{
	ReindexParams params = {0};

	CheckTableForSerializableConflictIn(rel);
	RelationSetNewRelfilenode(rel, rel->rd_rel->relpersistence);
	reindex_relation(RelationGetRelid(rel), REINDEX_REL_PROCESS_TOAST, &params);
	pgstat_count_truncate(rel);
}

/*
 * Truncates a table if it has only dead rows and nobody uses it; nobody can then until the
 * transaction ends. Returns whether.
 */
bool
truncate_if_empty(Oid relid)
{
	Relation	rel;
	bool		empty;

	if (!ConditionalLockRelationOid(relid, AccessExclusiveLock))
		return false;
	rel = try_relation_open(relid, NoLock);
	if (rel == NULL)
		return false;
	empty = RelationGetNumberOfBlocks(rel) > 0 && !has_rows(rel);
	if (empty)
		truncate_table(rel);
	relation_close(rel, NoLock);
	return empty;
}

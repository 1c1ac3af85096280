/*
 * truncate.c: cuts the file of a table whose rows are all dead.
 *
 * A build in batches takes its points from vertex pages and erases them, each batch in a
 * transaction of its own. At the end the vertex table holds only dead rows, and its file keeps its
 * size until VACUUM cuts it. The file can be cut at once if no transaction may still see a row and
 * no one has the table open. A session on a standby may have it open. It is cancelled when the
 * truncation arrives there, as after VACUUM's; the table's setting vacuum_truncate forbids both.
 *
 * As with TRUNCATE, table and index get new files, and the old ones go at commit.
 * Cutting the files in place would not survive a crash: for a moment the cut table and
 * its index do not fit each other.
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

#include "pg/port/port.h"
#include "pg/space/truncate.h"

/* Whether there is a row that VACUUM would not remove. */
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

/* Makes new, empty files for a table and its indexes, under the caller's lock. */
static void
truncate_table(Relation rel)
{
	ReindexParams params = {0};

	CheckTableForSerializableConflictIn(rel);
	RelationSetNewRelfilenumber(rel, rel->rd_rel->relpersistence);
	port_reindex_relation(RelationGetRelid(rel), REINDEX_REL_PROCESS_TOAST, &params);
	pgstat_count_truncate(rel);
}

/* Whether there is something to cut, and the table's settings let lazy VACUUM cut it. */
static bool
is_empty(Relation rel)
{
	return port_vacuum_truncates(rel) && RelationGetNumberOfBlocks(rel) > 0 && !has_rows(rel);
}

/*
 * Truncates a table if it has only dead rows and no one uses it; no one can then until the
 * transaction ends. Returns whether it did. It takes the lock only when it will use it, since
 * standbys replay the lock.
 */
bool
truncate_if_empty(Oid relid)
{
	Relation	rel = try_relation_open(relid, AccessShareLock);
	bool		empty;

	if (rel == NULL)
		return false;
	empty = is_empty(rel) && ConditionalLockRelation(rel, AccessExclusiveLock) && is_empty(rel);
	if (empty)
		truncate_table(rel);
	relation_close(rel, NoLock);
	return empty;
}

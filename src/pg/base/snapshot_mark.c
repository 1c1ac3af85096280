/*
 * snapshot_mark.c: which snapshot something was found valid under.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/base/snapshot_mark.h"

/* Takes this snapshot's mark; its lists live in `memory`. */
void
mark_snapshot(SnapshotMark *mark, const SnapshotData *snapshot, MemoryContext memory)
{
	uint32		needed = snapshot->xcnt + snapshot->subxcnt;

	mark->set = false;
	if (needed > mark->room || mark->xids == NULL)
	{
		if (mark->xids != NULL)
			pfree(mark->xids);
		mark->xids = NULL;
		mark->room = 0;
		mark->xids = MemoryContextAlloc(memory, (needed + 16) * sizeof(TransactionId));
		mark->room = needed + 16;
	}
	mark->xmin = snapshot->xmin;
	mark->xmax = snapshot->xmax;
	mark->curcid = snapshot->curcid;
	mark->suboverflowed = snapshot->suboverflowed;
	mark->taken_during_recovery = snapshot->takenDuringRecovery;
	mark->xcnt = snapshot->xcnt;
	mark->subxcnt = snapshot->subxcnt;
	if (snapshot->xcnt > 0)
		memcpy(mark->xids, snapshot->xip, snapshot->xcnt * sizeof(TransactionId));
	if (snapshot->subxcnt > 0)
		memcpy(mark->xids + snapshot->xcnt, snapshot->subxip,
			   snapshot->subxcnt * sizeof(TransactionId));
	mark->set = true;
}

/*
 * snapshot_mark.h: which snapshot something was found valid under, to see whether the present one is
 * equal.
 */
#ifndef ABACUS_SNAPSHOT_MARK_H
#define ABACUS_SNAPSHOT_MARK_H

#include "utils/snapshot.h"

/* Decides which changes of others, and of our own commands, a snapshot sees. */
typedef struct SnapshotMark
{
	bool		set;
	TransactionId xmin;
	TransactionId xmax;
	CommandId	curcid;
	bool		suboverflowed;
	bool		taken_during_recovery;
	uint32		xcnt;
	int32		subxcnt;
	uint32		room;			/* of xids, which holds xip and then subxip */
	TransactionId *xids;
} SnapshotMark;

/*
 * memcmp() of no bytes is not free: a snapshot without transactions has no array, and
 * vector instructions at NULL that read nothing take as long as some hundred others.
 */
static inline bool
same_xids(const TransactionId *a, const TransactionId *b, uint32 count)
{
	return count == 0 || memcmp(a, b, count * sizeof(TransactionId)) == 0;
}

/* Inline, since it is called for every row. */
static inline bool
same_snapshot(const SnapshotMark *mark, const SnapshotData *snapshot)
{
	return mark->set && mark->curcid == snapshot->curcid && mark->xmin == snapshot->xmin &&
		mark->xmax == snapshot->xmax && mark->xcnt == snapshot->xcnt &&
		mark->subxcnt == snapshot->subxcnt && mark->suboverflowed == snapshot->suboverflowed &&
		mark->taken_during_recovery == snapshot->takenDuringRecovery &&
		same_xids(mark->xids, snapshot->xip, mark->xcnt) &&
		same_xids(mark->xids + mark->xcnt, snapshot->subxip, mark->subxcnt);
}

extern void mark_snapshot(SnapshotMark *mark, const SnapshotData *snapshot, MemoryContext memory);

#endif

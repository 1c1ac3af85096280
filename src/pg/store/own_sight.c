/*
 * own_sight.c: what a session's snapshots see of the changes of its own transaction.
 *
 * A row that a transaction has made and replaced again is seen by no other session, ever. In
 * its own it is seen by a snapshot that was taken between the two commands: that of a
 * cursor, of a loop over a query, of the statement from which this one is called. And it
 * comes back with a rollback to a savepoint between the two. Otherwise nobody can see it any more.
 *
 * PostgreSQL does not tell which snapshots there are. Registered ones lie in one heap of pairs,
 * whose nodes are part of the snapshots and lead from one to all others. Active ones are a stack:
 * each can be had when those above are taken off, and these are put back. With each goes the
 * nested transaction that has put it there, which is not to be seen, but outside of all nested ones
 * there is no doubt. In a nested transaction the first and the last can be had, and, in a
 * trigger, the last but one. So all are known there if there are no more than that: in
 * statements that a client sends, and in those of a DO block, of a procedure, or of a function that such
 * a statement calls. Where they are not known, nothing is past.
 */
#include "postgres.h"

#include "access/transam.h"
#include "access/xact.h"
#include "lib/pairingheap.h"
#include "utils/snapmgr.h"

#include "pg/store/own_sight.h"

static void
add_snapshot(OwnSight *sight, Snapshot snapshot)
{
	if (sight->count == SIGHT_MOST_SNAPSHOTS)
		sight->known = false;
	else
		sight->from[sight->count++] = snapshot->curcid;
}

/* Adds those at this node of the heap, and below and behind it. */
static void
add_registered(OwnSight *sight, pairingheap_node *node)
{
	for (; node != NULL && sight->known; node = node->next_sibling)
	{
		add_snapshot(sight, pairingheap_container(SnapshotData, ph_node, node));
		add_registered(sight, node->first_child);
	}
}

static void
add_all_registered(OwnSight *sight)
{
	Snapshot	mine;
	pairingheap_node *root;

	InvalidateCatalogSnapshot();	/* taken anew when needed */
	/* sees all that was done before, so it is in nobody's way; in the heap it leads to the others */
	mine = RegisterSnapshot(GetTransactionSnapshot());
	for (root = &mine->ph_node; root->prev_or_parent != NULL;)
		root = root->prev_or_parent;
	add_registered(sight, root);
	UnregisterSnapshot(mine);
}

/* Adds all active snapshots, where none was put there by a nested transaction. */
static void
add_all_active(OwnSight *sight)
{
	Snapshot	taken[SIGHT_MOST_SNAPSHOTS];
	int			count = 0;

	while (ActiveSnapshotSet() && sight->known)
	{
		add_snapshot(sight, GetActiveSnapshot());
		if (!sight->known)
			break;
		taken[count++] = RegisterSnapshot(GetActiveSnapshot());
		PopActiveSnapshot();
	}
	while (count-- > 0)
	{
		PushActiveSnapshot(taken[count]);
		UnregisterSnapshot(taken[count]);
	}
}

/*
 * The last but one active snapshot. The last must have been put there in the innermost
 * transaction, for there it is put again.
 */
static Snapshot
last_but_one(void)
{
	Snapshot	last = RegisterSnapshot(GetActiveSnapshot());
	Snapshot	before;

	PopActiveSnapshot();
	before = GetActiveSnapshot();
	PushActiveSnapshot(last);
	UnregisterSnapshot(last);
	return before;
}

/*
 * Looks at what snapshots there are. `in_trigger`: we are called as a trigger; then the
 * active snapshot is that of the statement, put there in the innermost transaction.
 */
void
own_sight_take(OwnSight *sight, bool in_trigger)
{
	MemSet(sight, 0, sizeof(*sight));
	/* with a threshold the oldest snapshot need not be the first active one */
	sight->known = old_snapshot_threshold < 0;
	sight->level = GetCurrentTransactionNestLevel();
	sight->innermost = GetCurrentTransactionIdIfAny();
	if (!sight->known)
		return;
	if (sight->level == 1)
		add_all_active(sight);
	else if (ActiveSnapshotSet())
	{
		Snapshot	first = GetOldestSnapshot();

		add_snapshot(sight, first);
		add_snapshot(sight, GetActiveSnapshot());
		if (GetActiveSnapshot() != first)
			sight->known = in_trigger && last_but_one() == first;
	}
	if (sight->known)
		add_all_registered(sight);
}

/*
 * Whether two of our transactions, which have not been rolled back, will stay or be rolled back
 * together. A nested one that has ended belongs to the one that encloses it. Numbers grow: what is not
 * less than that of the innermost open one belongs to it. Of those between it and the outermost we do not know.
 */
static bool
share_fate(const OwnSight *sight, TransactionId one, TransactionId other)
{
	bool		is_inner = TransactionIdIsValid(sight->innermost);
	bool		one_is = is_inner && !TransactionIdPrecedes(one, sight->innermost);
	bool		other_is = is_inner && !TransactionIdPrecedes(other, sight->innermost);

	switch (sight->level)
	{
		case 1:
			return true;
		case 2:
			return one_is == other_is;
		default:
			return one_is && other_is;
	}
}

/* Whether our transaction has made this row and replaced it, and nobody can see it any more. */
bool
own_sight_is_past(const OwnSight *sight, HeapTupleHeader row)
{
	TransactionId made = HeapTupleHeaderGetRawXmin(row);
	TransactionId gone = HeapTupleHeaderGetRawXmax(row);
	CommandId	from;
	CommandId	to;

	if (!sight->known || (row->t_infomask & (HEAP_XMAX_INVALID | HEAP_XMAX_IS_MULTI | HEAP_MOVED)) != 0 ||
		HEAP_XMAX_IS_LOCKED_ONLY(row->t_infomask) || HeapTupleHeaderXminFrozen(row) ||
		!TransactionIdIsCurrentTransactionId(made) || !TransactionIdIsCurrentTransactionId(gone) ||
		!share_fate(sight, made, gone))
		return false;
	from = HeapTupleHeaderGetCmin(row);
	to = HeapTupleHeaderGetCmax(row);
	for (int i = 0; i < sight->count; i++)
		if (from < sight->from[i] && sight->from[i] <= to)
			return false;
	return true;
}

/*
 * own_sight.c: which changes of its own transaction a session's snapshots see.
 *
 * No other session ever sees a row that a transaction has made and replaced again. In its own
 * session a snapshot that was taken between the two commands sees it: that of a cursor, of a loop
 * over a query, or of the statement from which this one is called. And a rollback to a savepoint
 * between the two brings the row back. Otherwise nothing can see it.
 *
 * PostgreSQL does not show which snapshots there are. The registered ones lie in a pairing heap,
 * whose nodes are part of the snapshots and lead from one to all others. The active ones are a
 * stack: to reach one, those above it are popped and pushed again. Each belongs to the nested
 * transaction that has pushed it, which cannot be seen. Outside all nested transactions there is no
 * doubt. In a nested transaction the first and the last can be reached, and, in a trigger, the last
 * but one. So there all snapshots are known if there are no more than these: in statements that a
 * client sends, and in those of a DO block, of a procedure, or of a function that such a statement
 * calls. If they are not known, no row counts as past.
 */
#include "postgres.h"

#include "access/transam.h"
#include "access/xact.h"
#include "lib/pairingheap.h"
#include "utils/snapmgr.h"

#include "pg/port/port.h"
#include "pg/port/shortcuts.h"
#include "pg/store/own_sight.h"

static void
add_snapshot(OwnSight *sight, Snapshot snapshot)
{
	if (sight->count == SIGHT_MOST_SNAPSHOTS)
		sight->known = false;
	else
		sight->from[sight->count++] = snapshot->curcid;
}

/* Adds the snapshots at this node of the heap, below it and behind it. */
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

	InvalidateCatalogSnapshot();	/* taken again when needed */
	/* sees everything done before, so it does no harm; its node leads to the others in the heap */
	mine = RegisterSnapshot(GetTransactionSnapshot());
	for (root = &mine->ph_node; root->prev_or_parent != NULL;)
		root = root->prev_or_parent;
	add_registered(sight, root);
	UnregisterSnapshot(mine);
}

/* Adds all active snapshots; no nested transaction has pushed one. */
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
 * The last but one active snapshot, or NULL. The last must have been pushed in the innermost
 * transaction, since it is pushed there again.
 */
static Snapshot
last_but_one(void)
{
	Snapshot	last = RegisterSnapshot(GetActiveSnapshot());
	Snapshot	before;

	PopActiveSnapshot();
	before = ActiveSnapshotSet() ? GetActiveSnapshot() : NULL;
	PushActiveSnapshot(last);
	UnregisterSnapshot(last);
	return before;
}

/*
 * Finds the existing snapshots. `in_trigger`: this is called as a trigger. Then the active snapshot
 * is that of the statement, pushed in the innermost transaction.
 */
void
own_sight_take(OwnSight *sight, bool in_trigger)
{
	MemSet(sight, 0, sizeof(*sight));
	/* with a threshold the oldest snapshot need not be the first active one */
	sight->known = ABACUS_SHORTCUTS && !port_snapshots_may_be_too_old();
	sight->level = GetCurrentTransactionNestLevel();
	sight->innermost = GetCurrentTransactionIdIfAny();
	if (!sight->known)
		return;
	if (sight->level == 1)
		add_all_active(sight);
	else if (ActiveSnapshotSet())
	{
		Snapshot	first = port_first_active_snapshot();

		if (first != NULL)
			add_snapshot(sight, first);
		add_snapshot(sight, GetActiveSnapshot());
		if (GetActiveSnapshot() != first)
			sight->known = in_trigger && last_but_one() == first;
	}
	if (sight->known)
		add_all_registered(sight);
}

/*
 * Whether two of our transactions that have not been rolled back will share their fate. A nested
 * one that has ended belongs to the one around it. Numbers grow: a transaction whose number is not
 * less than that of the innermost open one belongs to it. Nothing is known about transactions
 * between that one and the outermost.
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

/* Whether our transaction has made and replaced this row, and nothing can see it any more. */
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

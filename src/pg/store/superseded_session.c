/*
 * superseded_session.c: the replaced rows that a session has left in the meshes that it changed
 * lately.
 *
 * The source query for one mesh may change any number of other meshes. So an entry that the current
 * transaction has requested may be in use, and does not make way for another mesh. If there are too
 * many meshes, the last ones get no entry.
 */
#include "postgres.h"

#include "storage/proc.h"
#include "utils/memutils.h"

#include "pg/port/port.h"
#include "pg/store/superseded.h"

#define MESHES_KEPT 4

static struct
{
	RelFileLocator node;
	Superseded *superseded;		/* NULL while the entry is free */
	LocalTransactionId used;	/* the last transaction that requested it */
}			kept[MESHES_KEPT];
static int	next_kept = 0;

/* The entry of this table, or one for it; MESHES_KEPT if there is none. */
static int
place_for(Relation heap)
{
	int			i = 0;

	while (i < MESHES_KEPT &&
		   !(kept[i].superseded != NULL && RelFileLocatorEquals(kept[i].node, heap->rd_locator)))
		i++;
	for (int tried = 0; i == MESHES_KEPT && tried < MESHES_KEPT; tried++)
	{
		if (kept[next_kept].superseded == NULL || kept[next_kept].used != port_local_transaction())
			i = next_kept;
		next_kept = (next_kept + 1) % MESHES_KEPT;
	}
	return i;
}

/* The session's entry for a table; it lives at least as long as the transaction. */
Superseded *
superseded_of_session(Relation heap)
{
	int			i = place_for(heap);

	if (i == MESHES_KEPT)
		return superseded_create(CurTransactionContext);
	if (kept[i].superseded != NULL && !RelFileLocatorEquals(kept[i].node, heap->rd_locator))
	{
		superseded_forget(kept[i].superseded);
		kept[i].superseded = NULL;
	}
	if (kept[i].superseded == NULL)
		kept[i].superseded = superseded_create(TopMemoryContext);
	kept[i].node = heap->rd_locator;
	kept[i].used = port_local_transaction();
	return kept[i].superseded;
}

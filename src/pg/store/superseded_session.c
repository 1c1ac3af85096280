/*
 * superseded_session.c: what a session has left behind in the meshes that it changed
 * lately.
 *
 * The query that gives points to one mesh may change any number of other meshes. So an
 * entry that the current transaction has asked for may be in use, and does not make way
 * for another mesh. When there are too many meshes, the last ones get no entry.
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
	Superseded *superseded;		/* NULL while nothing is kept here */
	LocalTransactionId used;	/* the last that asked for it */
}			kept[MESHES_KEPT];
static int	next_kept = 0;

/* Where what is left in this table is kept, or may be; MESHES_KEPT if nowhere. */
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

/* What this session has left in a table; lives as long as the transaction, or longer. */
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

/*
 * buffer_map.c: shared buffers come into this process's address space many at a time.
 *
 * All processes share the buffers, but each has to be shown them by the kernel,
 * which takes it two page faults for each buffer that it writes to. Who stores
 * pages by the thousand takes buffers as the server hands them out, and that
 * is nearly in a row. So around each one that has got a new page a stretch of
 * them is asked for at once (populate.h), and each stretch once.
 */
#include "postgres.h"

#include "storage/bufmgr.h"
#include "utils/memutils.h"

#include <abacus/populate.h>

#include "pg/store/buffer_map.h"

#define STRETCH 32				/* buffers */

/* By stretches of this process: whether they were asked for. */
static bool *mapped = NULL;

/* Asks for the buffers around this one, unless it is InvalidBuffer or a temporary table's. */
void
buffer_map_around(Buffer buffer)
{
	int			first;

	if (buffer <= 0)
		return;
	if (mapped == NULL)
		mapped = MemoryContextAllocZero(TopMemoryContext, NBuffers / STRETCH + 1);
	first = (buffer - 1) / STRETCH * STRETCH;
	if (mapped[first / STRETCH])
		return;
	mapped[first / STRETCH] = true;
	abacus_populate(BufferBlocks + (Size) first * BLCKSZ,
					(Size) Min(STRETCH, NBuffers - first) * BLCKSZ);
}

/*
 * buffer_map.c: maps shared buffers into this process's address space, many at a time.
 *
 * All processes share the buffers, but the kernel has to map each one into each process: two page
 * faults for each buffer that the process writes to. A writer of thousands of pages gets buffers
 * from the server nearly in sequence. So around each buffer with a new page, a stretch of them is
 * mapped at once (populate.h), and each stretch only once.
 */
#include "postgres.h"

#include "storage/bufmgr.h"
#include "utils/memutils.h"

#include <abacus/populate.h>

#include "pg/port/shortcuts.h"
#include "pg/store/buffer_map.h"

#define STRETCH 32				/* buffers */

/* For each stretch, whether this process has mapped it. */
static bool *mapped = NULL;

/* Maps the buffers around this one, unless it is InvalidBuffer or a temporary table's. */
void
buffer_map_around(Buffer buffer)
{
	int			first;

	if (!ABACUS_SHORTCUTS || buffer <= 0)
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

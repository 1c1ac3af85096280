/*
 * host_memory.c: memory for the core, in a context of its own.
 *
 * The context's reset callback closes the core handle first (host.c). So a handle always ends with
 * the context that it belongs to, and pg_backend_memory_contexts shows its size.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/host/guard.h"
#include "pg/host/host_parts.h"

static void *
host_resize(void *context, void *block, size_t size)
{
	Host	   *host = context;
	MemoryContext guard_context = CurrentMemoryContext;
	void	   *volatile moved = NULL;

	if (size == 0)
	{
		if (block != NULL)
			pfree(block);
		return NULL;
	}
	if (size > MaxAllocHugeSize || unlikely(guard_failure_is_due()))
		return NULL;
	if (block == NULL)
		return MemoryContextAllocExtended(host->core, size,
										  MCXT_ALLOC_HUGE | MCXT_ALLOC_NO_OOM);
	/* large blocks grow by realloc(), which moves page tables instead of bytes */
	PG_TRY();
	{
		moved = repalloc_huge(block, size);
	}
	PG_CATCH();
	{
		FlushErrorState();
		MemoryContextSwitchTo(guard_context);
	}
	PG_END_TRY();
	return moved;
}

void
host_memory_init(Host *host)
{
	host->table.resize = host_resize;
}

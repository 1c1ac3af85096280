/*
 * host.c: the abacus_host table, and the hand-over of errors.
 *
 * PostgreSQL reports errors with longjmp, C++ with exceptions; neither may
 * cross the other's frames. So every host function runs its PostgreSQL calls
 * under PG_TRY, keeps a copy of the error and returns ABACUS_HOST_FAILED. The
 * core unwinds its own frames, its outermost function returns
 * ABACUS_HOST_ERROR, and host_leave() re-throws the kept error with SQLSTATE,
 * detail and hint as they were. Between the catch and the re-throw nothing of
 * PostgreSQL is called except to free memory: locks and pins may still be
 * held until the transaction has aborted.
 *
 * Memory: the core allocates through resize(), in a context of its own whose
 * reset callback closes the core handle first. So a handle goes away with the
 * context it belongs to, on every way out, and pg_backend_memory_contexts
 * shows what it takes.
 *
 * A guard costs about 5 ns; the core calls the host on a miss, never on a hit.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "utils/memutils.h"

#include "pg/guard.h"
#include "pg/store/spool.h"

/* ---- Memory ------------------------------------------------------------- */

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
	/* large blocks grow by realloc(), which moves page tables and not bytes */
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

/* ---- Interrupts and progress -------------------------------------------- */

static abacus_host_status
host_poll(void *context)
{
	Host	   *host = context;

	GUARD_BEGIN();
	CHECK_FOR_INTERRUPTS();
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_progress(void *context, const abacus_progress *progress)
{
	Host	   *host = context;

	GUARD_BEGIN();
	progress_report(&host->progress, progress);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

/* ---- Pages -------------------------------------------------------------- */

static abacus_host_status
host_find(void *context, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	Host	   *host = context;
	volatile bool found = false;

	GUARD_BEGIN();
	found = page_store_find(&host->store, kind, key, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_fetch(void *context, abacus_page_kind kind, abacus_page *page)
{
	Host	   *host = context;
	volatile bool found = false;

	GUARD_BEGIN();
	found = page_store_fetch(&host->store, kind, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_next(void *context, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	Host	   *host = context;
	volatile bool found = false;

	GUARD_BEGIN();
	found = page_store_next(&host->store, kind, key, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_put(void *context, abacus_page_kind kind, abacus_page *page)
{
	Host	   *host = context;

	GUARD_BEGIN();
	page_store_put(&host->store, kind, page);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_erase(void *context, abacus_page_kind kind, const abacus_page *page)
{
	Host	   *host = context;

	GUARD_BEGIN();
	page_store_erase(&host->store, kind, page);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

/* ---- Spools ------------------------------------------------------------- */

static abacus_host_status
host_spool_create(void *context, void **spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	*spool = spool_create(host->home);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_write(void *context, void *spool, const void *bytes, size_t size)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_write(spool, bytes, size);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_rewind(void *context, void *spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_rewind(spool);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_read(void *context, void *spool, void *bytes, size_t size)
{
	Host	   *host = context;
	volatile bool more = false;

	GUARD_BEGIN();
	more = spool_read(spool, bytes, size);
	GUARD_END(host);
	return more ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_spool_close(void *context, void *spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_close(spool);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

/* ---- Life of a host ------------------------------------------------------ */

/* Reset callback of the core's memory: the handle goes before its memory does. */
static void
close_handle(void *arg)
{
	Host	   *host = arg;

	if (host->handle != NULL)
		host->close(host->handle);
	host->handle = NULL;
}

/* Makes a host for one mesh, in a memory context under `parent`. */
Host *
host_create(MemoryContext parent, Oid mesh, MeshAccess access)
{
	MemoryContext home = AllocSetContextCreate(parent, "Abacus host", ALLOCSET_SMALL_SIZES);
	Host	   *host = MemoryContextAllocZero(home, sizeof(Host));
	MemoryContextCallback *callback = MemoryContextAllocZero(home, sizeof(MemoryContextCallback));

	host->home = home;
	host->core = AllocSetContextCreate(home, "Abacus core", ALLOCSET_DEFAULT_SIZES);
	/* with room for an error in its first block, so that keeping one needs no malloc() */
	host->errors = AllocSetContextCreate(home, "Abacus error", 8 * 1024, 8 * 1024, 8 * 1024);
	callback->func = close_handle;
	callback->arg = host;
	MemoryContextRegisterResetCallback(host->core, callback);
	page_store_init(&host->store, mesh, access, home);

	host->table.context = host;
	host->table.resize = host_resize;
	StaticAssertStmt(sizeof(InterruptPending) == sizeof(int), "the core reads the flag as an int");
	host->table.interrupted = (const volatile int *) &InterruptPending;
	host->table.poll = host_poll;
	host->table.progress = host_progress;
	host->table.find = host_find;
	host->table.fetch = host_fetch;
	host->table.next = host_next;
	host->table.put = host_put;
	host->table.erase = host_erase;
	host->table.spool_create = host_spool_create;
	host->table.spool_write = host_spool_write;
	host->table.spool_rewind = host_spool_rewind;
	host->table.spool_read = host_spool_read;
	host->table.spool_close = host_spool_close;
	return host;
}

/* The host closes the handle when it goes, or before the next one is owned. */
void
host_own(Host *host, void *handle, void (*close) (void *handle))
{
	close_handle(host);
	host->handle = handle;
	host->close = close;
}

/* Gives up relations, scans and pins: nothing of them outlives an SQL call. */
void
host_release(Host *host)
{
	page_store_close(&host->store);
}

void
host_destroy(Host *host)
{
	MemoryContextDelete(host->home);
}

/* ---- Around a call of the core ------------------------------------------- */

void
host_enter(Host *host)
{
	host->busy = true;
}

static int
sqlstate_of(abacus_error_kind kind)
{
	switch (kind)
	{
		case ABACUS_ERROR_CORRUPTED:
			return ERRCODE_DATA_CORRUPTED;
		case ABACUS_ERROR_MEMORY:
			return ERRCODE_OUT_OF_MEMORY;
		case ABACUS_ERROR_ARGUMENT:
			return ERRCODE_INVALID_PARAMETER_VALUE;
		case ABACUS_ERROR_STATE:
			return ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE;
		case ABACUS_ERROR_LIMIT:
			return ERRCODE_PROGRAM_LIMIT_EXCEEDED;
		case ABACUS_ERROR_DUPLICATE:
			return ERRCODE_UNIQUE_VIOLATION;
		case ABACUS_ERROR_INTERNAL:
			break;
	}
	return ERRCODE_INTERNAL_ERROR;
}

/* Returns ABACUS_OK or ABACUS_END; raises everything else. */
abacus_status
host_leave(Host *host, abacus_status status)
{
	if (likely(status == ABACUS_OK || status == ABACUS_END))
	{
		host->busy = false;
		return status;
	}
	if (status == ABACUS_HOST_ERROR)
	{
		if (host->error == NULL)
			ereport(ERROR, (errcode(ERRCODE_OUT_OF_MEMORY), errmsg("out of memory")));
		ReThrowError(host->error);
	}
	ereport(ERROR,
			(errcode(sqlstate_of(host->failure.kind)),
			 errmsg_internal("%s", host->failure.message),
			 host->failure.detail[0] != '\0' ? errdetail_internal("%s", host->failure.detail) : 0,
			 host->failure.hint[0] != '\0' ? errhint("%s", host->failure.hint) : 0));
	return status;				/* not reached */
}

/*
 * host.c: the life of a host, and the hand-over of errors.
 *
 * PostgreSQL reports errors with longjmp, C++ with exceptions; neither may cross the
 * other's frames. So every host function runs its PostgreSQL calls under PG_TRY, keeps
 * a copy of the error and returns ABACUS_HOST_FAILED. The core unwinds its own frames,
 * and its outermost function returns ABACUS_HOST_ERROR. Then host_leave() re-throws the
 * kept error with its SQLSTATE, detail and hint. Between the catch and the re-throw
 * nothing of PostgreSQL is called except to free memory: locks and pins may still be
 * held until the transaction has aborted.
 *
 * A guard costs about 5 ns; the core calls the host on a miss, never on a hit.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/host/host_parts.h"

/* ---- Life of a host ------------------------------------------------------ */

/* Reset callback of the core's memory: the handle is closed before its memory is freed. */
static void
close_handle(void *arg)
{
	Host	   *host = arg;

	if (host->handle != NULL)
		host->close(host->handle);
	host->handle = NULL;
}

/* Makes a host in a memory context under `parent`. */
Host *
host_create(MemoryContext parent)
{
	MemoryContext home = AllocSetContextCreate(parent, "Abacus host", ALLOCSET_SMALL_SIZES);
	Host	   *host = MemoryContextAllocZero(home, sizeof(Host));
	MemoryContextCallback *callback = MemoryContextAllocZero(home, sizeof(MemoryContextCallback));

	host->home = home;
	host->core = AllocSetContextCreate(home, "Abacus core", ALLOCSET_DEFAULT_SIZES);
	/* room for an error in its first block, so that keeping one needs no malloc() */
	host->errors = AllocSetContextCreate(home, "Abacus error", 8 * 1024, 8 * 1024, 8 * 1024);
	callback->func = close_handle;
	callback->arg = host;
	MemoryContextRegisterResetCallback(host->core, callback);

	host->table.context = host;
	host_memory_init(host);
	host_control_init(host);
	host_pages_init(host);
	host_spools_init(host);
	return host;
}

/* The host closes the handle when it ends, or before it owns another one. */
void
host_own(Host *host, void *handle, void (*close) (void *handle))
{
	close_handle(host);
	host->handle = handle;
	host->close = close;
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
		case ABACUS_ERROR_CROSSING:
			return ERRCODE_INVALID_PARAMETER_VALUE;
		case ABACUS_ERROR_STATE:
			return ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE;
		case ABACUS_ERROR_LIMIT:
			return ERRCODE_PROGRAM_LIMIT_EXCEEDED;
		case ABACUS_ERROR_DUPLICATE:
			return ERRCODE_UNIQUE_VIOLATION;
		case ABACUS_ERROR_UNSUPPORTED:
			return ERRCODE_FEATURE_NOT_SUPPORTED;
		case ABACUS_ERROR_RANGE:
			return ERRCODE_NUMERIC_VALUE_OUT_OF_RANGE;
		case ABACUS_ERROR_INTERNAL:
			break;
	}
	return ERRCODE_INTERNAL_ERROR;
}

/* Returns ABACUS_OK or ABACUS_END; raises everything else as an error. */
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
	if (host->failure.kind == ABACUS_ERROR_CORRUPTED)
		host_doubt_pages(host);
	ereport(ERROR,
			(errcode(sqlstate_of(host->failure.kind)),
			 errmsg_internal("%s", host->failure.message),
			 host->failure.detail[0] != '\0' ? errdetail_internal("%s", host->failure.detail) : 0,
			 host->failure.hint[0] != '\0' ? errhint("%s", host->failure.hint) : 0));
	return status;				/* not reached */
}

/* The same after a call that has used two hosts: either of them may have failed. */
abacus_status
host_leave_both(Host *host, Host *other, abacus_status status)
{
	if (status == ABACUS_HOST_ERROR && host->error == NULL)
		host_leave(other, status);
	if (status == ABACUS_ERROR && host->failure.kind == ABACUS_ERROR_CORRUPTED)
		host_doubt_pages(other);
	host_leave(host, status);
	return host_leave(other, status);
}

/*
 * point_log.c: points in the order in which they came; it can be cut off at any place.
 *
 * A few statements' points are kept in memory; beyond that, all go to a temporary file. The file
 * belongs to the whole transaction, not to the nested one that happens to create it. The caller
 * knows where the log ends and writes there, over the part that a rollback to a savepoint has cut
 * off.
 */
#include "postgres.h"

#include "storage/buffile.h"
#include "utils/memutils.h"
#include "utils/resowner.h"

#include "pg/track/point_log.h"

#define BYTES_IN_MEMORY (64 * 1024)

struct PointLog
{
	MemoryContext memory;
	char	   *bytes;			/* until there is a file */
	BufFile    *file;
	uint64		place;			/* in the file */
};

/* Lives in `memory`, which must not outlive the transaction. */
PointLog *
point_log_create(MemoryContext memory)
{
	PointLog   *log = MemoryContextAllocZero(memory, sizeof(PointLog));

	log->memory = memory;
	log->bytes = MemoryContextAlloc(memory, BYTES_IN_MEMORY);
	return log;
}

void
point_log_close(PointLog *log)
{
	if (log->file != NULL)
		BufFileClose(log->file);
	if (log->bytes != NULL)
		pfree(log->bytes);
	pfree(log);
}

/* Makes the file, with the first `size` bytes. */
static void
move_to_file(PointLog *log, size_t size)
{
	MemoryContext old = MemoryContextSwitchTo(log->memory);
	ResourceOwner owner = CurrentResourceOwner;

	CurrentResourceOwner = TopTransactionResourceOwner;
	log->file = BufFileCreateTemp(false);
	CurrentResourceOwner = owner;
	MemoryContextSwitchTo(old);
	BufFileWrite(log->file, log->bytes, size);
	log->place = size;
	pfree(log->bytes);
	log->bytes = NULL;
}

static void
go_to(PointLog *log, uint64 at)
{
	/* positions count from the first segment of the file, which is allowed */
	if (log->place != at && BufFileSeek(log->file, 0, (off_t) at, SEEK_SET) != 0)
		ereport(ERROR,
				(errcode_for_file_access(), errmsg("could not seek in temporary file: %m")));
	log->place = at;
}

/* Writes at a place; the bytes before it must exist. */
void
point_log_write(PointLog *log, uint64 at, const void *bytes, size_t size)
{
	if (log->file == NULL && at + size <= BYTES_IN_MEMORY)
	{
		memcpy(log->bytes + at, bytes, size);
		return;
	}
	if (log->file == NULL)
		move_to_file(log, at);
	go_to(log, at);
	BufFileWrite(log->file, unconstify(void *, bytes), size);
	log->place += size;
}

void
point_log_read(PointLog *log, uint64 at, void *bytes, size_t size)
{
	size_t		got;

	if (log->file == NULL)
	{
		memcpy(bytes, log->bytes + at, size);
		return;
	}
	go_to(log, at);
	got = BufFileRead(log->file, bytes, size);
	if (got != size)
		ereport(ERROR,
				(errcode_for_file_access(),
				 errmsg("could not read temporary file: read only %zu of %zu bytes", got, size)));
	log->place += size;
}

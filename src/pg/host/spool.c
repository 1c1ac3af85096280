/*
 * spool.c: temporary files, written and then read from start to end.
 *
 * BufFile brings temp_tablespaces, temp_file_limit, the figures in
 * pg_stat_database and removal at the end of the transaction.
 */
#include "postgres.h"

#include "storage/buffile.h"
#include "utils/memutils.h"

#include "pg/host/spool.h"

void *
spool_create(MemoryContext memory)
{
	MemoryContext old = MemoryContextSwitchTo(memory);
	BufFile    *file = BufFileCreateTemp(false);

	MemoryContextSwitchTo(old);
	return file;
}

void
spool_write(void *spool, const void *bytes, size_t size)
{
	BufFileWrite(spool, unconstify(void *, bytes), size);
}

void
spool_rewind(void *spool)
{
	if (BufFileSeek(spool, 0, 0, SEEK_SET) != 0)
		ereport(ERROR,
				(errcode_for_file_access(), errmsg("could not rewind temporary file: %m")));
}

/* Reads `size` bytes; false at the end of the file. */
bool
spool_read(void *spool, void *bytes, size_t size)
{
	size_t		got = BufFileRead(spool, bytes, size);

	if (got == size)
		return true;
	if (got != 0)
		ereport(ERROR,
				(errcode_for_file_access(),
				 errmsg("could not read temporary file: read only %zu of %zu bytes", got, size)));
	return false;
}

void
spool_close(void *spool)
{
	BufFileClose(spool);
}

/*
 * heap_growth.c: a table of pages grows by many heap pages at a time.
 *
 * PostgreSQL 15 adds a heap page by writing zeros to the end of the file, which takes 15
 * microseconds, and writes the page itself later. A writer of more than a few rows lets the file
 * system reserve room for many pages at once, as PostgreSQL does from 16 on
 * (docs/design/postgresql.md). A full disk is noticed at once and not when buffers are written,
 * and nothing is written twice. Where a file system cannot do that, pages are added one by one.
 *
 * Buffers get the pages, as zeros, before the file has them. So nothing has to be read.
 * Nobody can ask for a page beyond the end of the file, so nobody can have written
 * them. Once the file has grown, they are pages as a crash may also leave them: scans
 * skip them, an insertion initializes them, and VACUUM enters them into the free space
 * map. Pages that stay unused are entered there at once.
 */
#include "postgres.h"

#include <fcntl.h>

#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/fd.h"
#include "storage/freespace.h"
#include "storage/lmgr.h"
#include "storage/smgr.h"

#include "pg/port/port.h"
#include "pg/store/buffer_map.h"
#include "pg/store/heap_growth.h"

/* A table grows by a page for so many rows that have been stored, */
#define ROWS_A_PAGE 16
/* ... and by no more than these, */
#define MOST_PAGES 32
/* ... nor by more than this share of the shared buffers, which would evict some of them again. */
#define BUFFERS_A_PAGE 8

/*
 * Room in the file for pages from `first` on, all of one segment; false if there is none.
 * posix_fallocate() will not do: where the file system lacks the call, it makes two small
 * writes a page, which takes longer than PostgreSQL does.
 */
static bool
reserve(Relation heap, BlockNumber first, int pages)
{
#ifdef __linux__
	char	   *name = port_relation_path(heap);
	BlockNumber segment = first / RELSEG_SIZE;
	char	   *path = segment == 0 ? pstrdup(name) : psprintf("%s.%u", name, segment);
	int			file = OpenTransientFile(path, O_RDWR | PG_BINARY);
	int			failed = -1;

	if (file >= 0)
	{
		do
			failed = fallocate(file, 0, (off_t) (first % RELSEG_SIZE) * BLCKSZ, (off_t) pages * BLCKSZ);
		while (failed != 0 && errno == EINTR);
		CloseTransientFile(file);
	}
	pfree(path);
	pfree(name);
	return failed == 0;
#else
	return false;
#endif
}

/*
 * Buffers of zeros for pages that the file does not have. They may exist, if somebody
 * failed to add them before. False if one is not zeros, which the next session that adds
 * it will report.
 */
static bool
take_buffers(Relation heap, BlockNumber first, int pages)
{
	for (int i = 0; i < pages; i++)
	{
		Buffer		buffer = ReadBufferExtended(heap, MAIN_FORKNUM, first + i, RBM_ZERO_AND_LOCK, NULL);
		bool		is_new = PageIsNew(BufferGetPage(buffer));

		UnlockReleaseBuffer(buffer);
		if (!is_new)
			return false;
		buffer_map_around(buffer);
	}
	return true;
}

/*
 * Adds so many pages, or as many as the segment of the file has room for; none to an empty
 * one, whose first page makes the file.
 */
static void
grow(HeapGrowth *growth, Relation heap, int pages)
{
	BlockNumber first;

	LockRelationForExtension(heap, ExclusiveLock);
	first = RelationGetNumberOfBlocks(heap);
	pages = Min(pages, (RELSEG_SIZE - first % RELSEG_SIZE) % RELSEG_SIZE);
	pages = Min(pages, MaxBlockNumber - first);
	growth->is_refused = pages > 0 && !(take_buffers(heap, first, pages) && reserve(heap, first, pages));
	if (!growth->is_refused)
	{
		growth->next = first;
		growth->end = first + pages;
		if (growth->first == 0)
			growth->first = first;
	}
	UnlockRelationForExtension(heap, ExclusiveLock);
}

/*
 * A new heap page for a row of `size` bytes, if so many rows have been stored that the
 * table had better grow by several, and the free space map knows of none that has room. Else
 * InvalidBlockNumber: then the heap finds one by itself.
 */
BlockNumber
heap_growth_take(HeapGrowth *growth, Relation heap, Size size, uint64 stored)
{
	if (growth->next == growth->end)
	{
		int			pages = (int) Min(stored / ROWS_A_PAGE, Min(MOST_PAGES, NBuffers / BUFFERS_A_PAGE));

		if (pages < 2 || growth->is_refused || RelationUsesLocalBuffers(heap) ||
			GetPageWithFreeSpace(heap, size) != InvalidBlockNumber)
			return InvalidBlockNumber;
		grow(growth, heap, pages);
		if (growth->next == growth->end)
			return InvalidBlockNumber;
	}
	return growth->next++;
}

/* No more rows follow: others may have the pages that are left. */
void
heap_growth_end(HeapGrowth *growth, Relation heap)
{
	for (; growth->next < growth->end; growth->next++)
		RecordPageWithFreeSpace(heap, growth->next, BLCKSZ - SizeOfPageHeaderData);
	if (growth->first < growth->end)
		FreeSpaceMapVacuumRange(heap, growth->first, growth->end);
	MemSet(growth, 0, sizeof(*growth));
}

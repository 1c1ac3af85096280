/*
 * heap_growth.c: a table of pages grows by many heap pages at a time.
 *
 * PostgreSQL 15 adds a heap page by writing zeros to the end of the file, which takes
 * 15 microseconds (docs/design/postgresql.md), and writes the page itself later. Who stores more
 * than a few rows has the file system give room to many at once instead, much as
 * PostgreSQL does from 16 on: a full disk is noticed now and not when buffers are
 * written, and nothing is written twice. Where a file system cannot, pages are
 * added one by one as ever.
 *
 * Buffers get the pages, as zeros, before the file has them: nothing has to be
 * read then, and as nobody can ask for a page beyond the end of the file, nobody
 * can have written them yet. From the moment when the file has grown they are what
 * a crash may leave too: pages that scans skip, that whoever inserts a row
 * initializes, and that VACUUM enters into the free space map. What is not
 * used in the end is entered at once.
 */
#include "postgres.h"

#include <fcntl.h>

#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/fd.h"
#include "storage/freespace.h"
#include "storage/lmgr.h"
#include "storage/smgr.h"

#include "pg/store/buffer_map.h"
#include "pg/store/heap_growth.h"

/* A table grows by a page for so many rows that have been stored, */
#define ROWS_A_PAGE 16
/* ... and by no more than these, */
#define MOST_PAGES 32
/* ... nor by more than this share of the shared buffers, from which some would be driven out again. */
#define BUFFERS_A_PAGE 8

/*
 * Room in the file for pages from `first` on, all of one segment; false if that cannot be had.
 * Not posix_fallocate(): where the file system has no such thing, that takes longer than
 * PostgreSQL, by two small writes a page.
 */
static bool
reserve(Relation heap, BlockNumber first, int pages)
{
#ifdef __linux__
	char	   *name = relpath(RelationGetSmgr(heap)->smgr_rnode, MAIN_FORKNUM);
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
 * Buffers of zeros for pages that the file does not have. They may be there, if somebody
 * failed to add them before; false if one is not zeros, which whoever adds it will report.
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

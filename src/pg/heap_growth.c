/*
 * heap_growth.c: a table of pages grows by many heap pages at a time.
 *
 * PostgreSQL 15 adds a heap page by writing zeros to the end of the file, 15
 * microseconds before the page itself is written (docs/design.md). Who stores
 * rows by the hundred has the file system give room to many at once instead, as
 * PostgreSQL does from 16 on: a full disk is noticed now and not when buffers are
 * written, and nothing is written twice. Where a file system cannot, pages are
 * added one by one as ever.
 *
 * Buffers get the pages, as zeros, before the file has them: nothing has to be
 * read then, and as nobody can ask for a page behind the end of the file, nobody
 * can have written them yet. From the moment when the file has grown they are what
 * a crash may leave too: pages that scans skip, that whoever inserts a row
 * initializes, and that VACUUM enters into the free space map. What is not
 * used in the end is entered at once.
 */
#include "postgres.h"

#include <fcntl.h>

#include "storage/bufmgr.h"
#include "storage/fd.h"
#include "storage/freespace.h"
#include "storage/lmgr.h"
#include "storage/smgr.h"

#include "pg/buffer_map.h"
#include "pg/heap_growth.h"

/* Rows after which a table may grow by more than a page: by a sixteenth of them. */
#define ROWS_A_PAGE 16
#define MOST_PAGES 32

/*
 * Room in the file for pages from `first` on, all of one segment; false if that cannot be had.
 * Not posix_fallocate(): where the file system has no such thing, that writes zeros,
 * perhaps over what others have written in the meantime.
 */
static bool
reserve(Relation heap, BlockNumber first, int pages)
{
#ifdef __linux__
	char	   *name = relpath(RelationGetSmgr(heap)->smgr_rnode, MAIN_FORKNUM);
	BlockNumber segment = first / RELSEG_SIZE;
	char	   *path = segment == 0 ? pstrdup(name) : psprintf("%s.%u", name, segment);
	int			file = OpenTransientFile(path, O_RDWR | PG_BINARY);
	bool		done = file >= 0 &&
		fallocate(file, 0, (off_t) (first % RELSEG_SIZE) * BLCKSZ, (off_t) pages * BLCKSZ) == 0;

	if (file >= 0)
		CloseTransientFile(file);
	pfree(path);
	pfree(name);
	return done;
#else
	return false;
#endif
}

/* Adds so many pages; none if that cannot be done, and whoever adds a single one will tell why. */
static void
grow(HeapGrowth *growth, Relation heap, int pages)
{
	BlockNumber first;

	LockRelationForExtension(heap, ExclusiveLock);
	first = RelationGetNumberOfBlocks(heap);
	/* a segment's first page makes its file */
	if (first > 0 && first % RELSEG_SIZE == 0)
		pages = 0;
	pages = Min(pages, RELSEG_SIZE - first % RELSEG_SIZE);
	for (int i = 0; i < pages; i++)
	{
		Buffer		buffer = ReadBufferExtended(heap, MAIN_FORKNUM, first + i, RBM_ZERO_AND_LOCK, NULL);

		/* somebody failed to add this page before: then it is zeros still */
		if (!PageIsNew(BufferGetPage(buffer)))
			pages = 0;
		UnlockReleaseBuffer(buffer);
		buffer_map_around(buffer);
	}
	growth->is_refused = pages > 0 && !reserve(heap, first, pages);
	if (pages > 0 && !growth->is_refused)
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
 * table had better grow by several, and no page in use has room. Else
 * InvalidBlockNumber: then the heap finds one by itself.
 */
BlockNumber
heap_growth_take(HeapGrowth *growth, Relation heap, Size size, uint64 stored)
{
	if (growth->next == growth->end)
	{
		int			pages = (int) Min(stored / ROWS_A_PAGE, MOST_PAGES);

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

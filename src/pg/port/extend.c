/*
 * extend.c: many heap pages added to a table at once.
 *
 * Since version 16 PostgreSQL offers that. It reserves room in the file and returns buffers of
 * zeros.
 *
 * PostgreSQL 15 adds a heap page by writing zeros to the end of the file, which takes 15
 * microseconds, and writes the page itself later. So the same is done here: the file system
 * reserves room for many pages. A full disk is noticed at once and not when buffers are written,
 * and nothing is written twice. If a file system cannot do that, no pages are added.
 *
 * Buffers get the pages, as zeros, before the file has them. So nothing has to be read. No one can
 * ask for a page beyond the end of the file, so no one can have written them. Once the file has
 * grown, the new pages are like those that a crash may leave: scans skip them, an insertion
 * initializes them, and VACUUM enters them into the free space map.
 */
#include "postgres.h"

#include <fcntl.h>

#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/fd.h"
#include "storage/lmgr.h"
#include "storage/smgr.h"

#include "pg/port/extend.h"
#include "pg/port/port.h"
#include "pg/port/shortcuts.h"

#if PG_VERSION_NUM >= 160000

/*
 * Adds this many pages, or fewer if few buffers are free. Returns how many; *first gets the number
 * of the first. Calls taken() with the buffer of each.
 */
int
port_extend(Relation heap, int pages, void (*taken) (Buffer buffer), BlockNumber *first)
{
	Buffer		buffers[EXTEND_MOST_PAGES];
	uint32		added = 0;

	*first = ExtendBufferedRelBy(BMR_REL(heap), MAIN_FORKNUM, NULL, 0,
								 Min(pages, EXTEND_MOST_PAGES), buffers, &added);
	for (uint32 i = 0; i < added; i++)
	{
		taken(buffers[i]);
		ReleaseBuffer(buffers[i]);
	}
	return (int) added;
}

#else

/*
 * Reserves room in the file for pages from `first` on, all of one segment; false if it fails.
 * posix_fallocate() is no alternative: if the file system lacks the call, it makes two small writes
 * for each page, which takes longer than PostgreSQL does.
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
 * Takes buffers of zeros for pages that the file does not have. They may exist if an earlier
 * attempt to add them failed. False if a buffer is not zero; the next session that adds the page
 * will report it.
 */
static bool
take_buffers(Relation heap, BlockNumber first, int pages, void (*taken) (Buffer buffer))
{
	for (int i = 0; i < pages; i++)
	{
		Buffer		buffer = ReadBufferExtended(heap, MAIN_FORKNUM, first + i, RBM_ZERO_AND_LOCK, NULL);
		bool		is_new = PageIsNew(BufferGetPage(buffer));

		UnlockReleaseBuffer(buffer);
		if (!is_new)
			return false;
		taken(buffer);
	}
	return true;
}

/*
 * Adds this many pages, or as many as the segment of the file has room for. Returns how many;
 * *first gets the number of the first. Calls taken() with the buffer of each. 0: the next page
 * begins a segment, so it must be added alone. Negative: no pages can be added in this way.
 */
int
port_extend(Relation heap, int pages, void (*taken) (Buffer buffer), BlockNumber *first)
{
	if (!ABACUS_SHORTCUTS)
		return -1;
	LockRelationForExtension(heap, ExclusiveLock);
	*first = RelationGetNumberOfBlocks(heap);
	pages = Min(pages, EXTEND_MOST_PAGES);
	pages = Min(pages, (RELSEG_SIZE - *first % RELSEG_SIZE) % RELSEG_SIZE);
	pages = Min(pages, MaxBlockNumber - *first);
	if (pages > 0 && !(take_buffers(heap, *first, pages, taken) && reserve(heap, *first, pages)))
		pages = -1;
	UnlockRelationForExtension(heap, ExclusiveLock);
	return pages;
}

#endif

/*
 * heap_growth.c: lets a table of pages grow by many heap pages at a time.
 *
 * A heap adds its pages one by one, each by a write of zeros. A writer of more than a few rows asks
 * for many at once (extend.c), which the file system reserves without writing. If that is
 * impossible, pages come one by one. The new pages are empty: scans skip them, and an insertion
 * initializes them. Unused ones are entered into the free space map.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/freespace.h"

#include "pg/port/extend.h"
#include "pg/store/buffer_map.h"
#include "pg/store/heap_growth.h"

/* A table grows by one page for this many stored rows, */
#define ROWS_A_PAGE 16
/*
 * ... but at most by this share of the shared buffers, since more would evict some of them again.
 */
#define BUFFERS_A_PAGE 8

/* Adds this many pages, or fewer. */
static void
grow(HeapGrowth *growth, Relation heap, int pages)
{
	BlockNumber first;
	int			added = port_extend(heap, pages, buffer_map_around, &first);

	growth->is_refused = added < 0;
	if (added > 0)
	{
		growth->next = first;
		growth->end = first + added;
		if (growth->first == 0)
			growth->first = first;
	}
}

/*
 * A new heap page for a row of `size` bytes, if enough rows have been stored that the table should
 * grow by several, and the free space map knows of no page with room. Otherwise InvalidBlockNumber:
 * then the heap finds a page by itself.
 */
BlockNumber
heap_growth_take(HeapGrowth *growth, Relation heap, Size size, uint64 stored)
{
	if (growth->next == growth->end)
	{
		int			pages = (int) Min(stored / ROWS_A_PAGE, Min(EXTEND_MOST_PAGES, NBuffers / BUFFERS_A_PAGE));

		if (pages < 2 || growth->is_refused || RelationUsesLocalBuffers(heap) ||
			GetPageWithFreeSpace(heap, size) != InvalidBlockNumber)
			return InvalidBlockNumber;
		grow(growth, heap, pages);
		if (growth->next == growth->end)
			return InvalidBlockNumber;
	}
	return growth->next++;
}

/* No more rows follow: others may use the remaining pages. */
void
heap_growth_end(HeapGrowth *growth, Relation heap)
{
	for (; growth->next < growth->end; growth->next++)
		RecordPageWithFreeSpace(heap, growth->next, BLCKSZ - SizeOfPageHeaderData);
	if (growth->first < growth->end)
		FreeSpaceMapVacuumRange(heap, growth->first, growth->end);
	MemSet(growth, 0, sizeof(*growth));
}

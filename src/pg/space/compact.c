/*
 * compact.c: moves the rows of a mesh to the beginning of their tables.
 *
 * A page of a mesh fills a heap page. A statement that changes pages all over the mesh writes new
 * versions of all of them, and the old ones are free only after its commit. So the table doubles in
 * size. From then on one half of it is empty, each time the other half, and some rows always lie
 * near its end, which VACUUM could otherwise cut off. Nothing inside one transaction helps. But
 * abacus_build and VACUUM (vacuum.c) may commit in between. So they move the rows at the end to the
 * empty heap pages at the beginning, until the two meet. As a rule each row moves once. Other
 * writers are kept away meanwhile. The vertex table has such an empty beginning where staged points
 * were, and the pages of repeated points lie behind it.
 *
 * A move is a deletion and an insertion of the same row: an update would leave a small row on its
 * heap page. Readers see the one or the other, by their snapshots. The data that sessions hold of
 * the mesh in memory stay valid, since the stamp of the header stays. But each batch of moves
 * writes the header, as every change does. A writer with an older snapshot would look for pages in
 * their old places; the new header tells it that it must not.
 *
 * Rows that some snapshot still sees keep their heap pages. The others are moved, and a later call
 * continues.
 *
 * The file keeps its length. Index entries still point to the old places of the moved
 * rows. Only VACUUM removes these entries, and then it cuts the file by itself.
 */
#include "postgres.h"

#include "access/tableam.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "utils/memutils.h"

#include "pg/space/compact.h"
#include "pg/store/page_search.h"
#include "pg/store/page_write.h"

/* Number of heap pages in the sample of a larger table. */
#define SAMPLE 1024
/* Rows moved in one transaction, which a cancel or a crash undoes. */
#define ROWS_AT_ONCE 1024
/* This many empty heap pages, besides an eighth of the table, are not worth moving rows. */
#define FEW_PAGES 8

/* Whether much of a table is empty, judged by a sample of its heap pages. */
static bool
is_worthwhile(Superseded *superseded, Relation heap)
{
	uint64		blocks = RelationGetNumberOfBlocks(heap);
	uint64		one_of = blocks / SAMPLE + 1;
	uint64		block = 0;
	uint64		empty = superseded_survey(superseded, heap, &block, blocks, one_of, blocks);

	return empty * one_of > blocks / 8 + FEW_PAGES;
}

/*
 * Whether compact() would do something, judged by the table alone. The caller has some lock on it,
 * and a snapshot must be active.
 */
bool
compact_is_worthwhile(Relation heap)
{
	MemoryContext memory = AllocSetContextCreate(CurrentMemoryContext, "Abacus sample",
												 ALLOCSET_SMALL_SIZES);
	bool		is = is_worthwhile(superseded_create(memory), heap);

	MemoryContextDelete(memory);
	return is;
}

/* Whether a row lies behind an empty heap page; if so, *end is set behind the last such row. */
static bool
find_last_row(PageTable *table, BlockNumber *end)
{
	TupleTableSlot *slot = table_slot_create(table->heap, NULL);
	bool		found = false;

	while (!found && *end > 0 && superseded_has_empty_before(table->superseded, *end - 1))
	{
		TableScanDesc scan = page_table_scan_heap_page(table, *end - 1);

		CHECK_FOR_INTERRUPTS();
		found = table_scan_getnextslot_tidrange(scan, ForwardScanDirection, slot);
		table_endscan(scan);
		if (!found)
			(*end)--;
	}
	ExecDropSingleTupleTableSlot(slot);
	return found;
}

/* Moves rows, from the last one before *end backwards. Returns how many. */
static int
move_rows(PageTable *table, BlockNumber *end)
{
	TupleTableSlot *slot = table_slot_create(table->heap, NULL);
	bool		room = true;	/* whether an empty heap page is left before the row */
	int			moved = 0;

	while (room && moved < ROWS_AT_ONCE && *end > 0)
	{
		TableScanDesc scan = page_table_scan_heap_page(table, *end - 1);

		CHECK_FOR_INTERRUPTS();
		while (room && table_scan_getnextslot_tidrange(scan, ForwardScanDirection, slot))
		{
			room = page_table_move(table, slot);
			if (room)
				moved++;
		}
		table_endscan(scan);
		if (room)
			(*end)--;
	}
	ExecDropSingleTupleTableSlot(slot);
	return moved;
}

/* Moves the rows of a table to its beginning, if that is worth it. Returns how many. */
static uint64
compact_table(Writer *writer, PageTable *table)
{
	uint64		looked = 0;		/* number of heap pages surveyed */
	uint64		moved = 0;
	BlockNumber end;
	int			rows = -1;

	page_table_open(table);
	table->superseded = superseded_create(writer->host->home);
	if (!is_worthwhile(table->superseded, table->heap))
		return 0;
	end = RelationGetNumberOfBlocks(table->heap);
	while (rows != 0)
	{
		superseded_survey(table->superseded, table->heap, &looked, end, 1, ROWS_AT_ONCE);
		if (!find_last_row(table, &end))
			break;
		/* the header first, as long as there is room for it at the beginning */
		header_rewrite(writer->host, writer->header, &writer->header_tid);
		rows = move_rows(table, &end);
		moved += rows;
		writer_release(writer);
		SPI_commit();
		writer_continue(writer);
		page_table_open(table);
		/* others may have cut the file of the vertex table, or made another one */
		end = Min(end, RelationGetNumberOfBlocks(table->heap));
	}
	return moved;
}

/*
 * Moves the rows of a mesh to the beginning of the one table, the other or both, and commits after
 * each batch. The caller has kept others from changing the mesh by a lock of the session (mesh.h),
 * and no core handle has it open. Returns how many rows were moved.
 */
uint64
compact(Writer *writer, bool simplices, bool vertices)
{
	MeshPages  *pages = mesh_pages(writer->host);
	const abacus_facts *facts = &writer->header->facts;
	uint64		moved = 0;

	if (simplices)
		moved += compact_table(writer, &pages->simplices);
	/* without such points all rows of the vertex table are dead, and it is truncated */
	if (vertices && (facts->census.duplicates > 0 || facts->census.inserted < facts->census.staged))
	{
		mesh_pages_vertex_table(pages);
		moved += compact_table(writer, &pages->vertices);
	}
	return moved;
}

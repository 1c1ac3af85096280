/*
 * compact.c: the rows of a mesh moved to the beginning of their tables.
 *
 * A page of a mesh fills a heap page. A statement that changes pages all over
 * the mesh writes all of them anew, and the old versions are free only when it
 * has committed: so the table becomes twice as large. From then on half of it
 * is empty, each time another half, and there are always rows near its end,
 * where VACUUM could cut it. Nothing that happens inside one transaction helps.
 * abacus_build commits as it likes, and keeps other writers away meanwhile: so
 * it is there that the rows at the end are moved to the empty heap pages at the
 * beginning, until these meet; each once, as a rule. In the vertex table
 * the points that were staged leave such a beginning, and the pages of repeated
 * points lie behind it.
 *
 * A move is a deletion and an insertion of the same row: an update would leave
 * a small row on its heap page. Readers see the one or the other, by their
 * snapshots, and what sessions have of the mesh in memory stays good, for the
 * stamp of the header does. But each batch of moves writes the header, as
 * every change does: a writer whose snapshot is older would look for pages
 * where they were, and is told so by the header.
 *
 * Rows that somebody's snapshot still sees keep their heap pages; the rest is
 * done, and another call goes on.
 *
 * The file is left as long as it is. Index entries point to what the moved rows
 * have left, and only VACUUM removes these; then it cuts the file by itself.
 */
#include "postgres.h"

#include "access/tableam.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "storage/bufmgr.h"

#include "pg/compact.h"

/* Heap pages by which a larger table is judged. */
#define SAMPLE 1024
/* Rows moved in one transaction, which a cancel or a crash undoes. */
#define ROWS_AT_ONCE 1024

/* Whether much of the table is empty, judged by some of its heap pages. */
static bool
is_worthwhile(PageTable *table)
{
	uint64		blocks = RelationGetNumberOfBlocks(table->heap);
	uint64		one_of = blocks / SAMPLE + 1;
	uint64		block = 0;
	uint64		empty = superseded_survey(table->superseded, table->heap, &block, blocks, one_of,
										  blocks);

	return empty * one_of > blocks / 8 + SUPERSEDED_FAR_PAGES;
}

/* Whether a row lies behind an empty heap page; if so, *end is behind the last one. */
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
	bool		room = true;	/* on an empty heap page before the row */
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

/* Moves the rows of a table to its beginning, if that is worth it. */
static void
compact_table(Writer *writer, PageTable *table)
{
	uint64		looked = 0;		/* at the heap pages before this one */
	BlockNumber end;
	bool		moves = true;

	page_table_open(table);
	if (!is_worthwhile(table))
		return;
	end = RelationGetNumberOfBlocks(table->heap);
	while (moves)
	{
		superseded_survey(table->superseded, table->heap, &looked, end, 1, ROWS_AT_ONCE);
		if (!find_last_row(table, &end))
			break;
		/* the header first, as long as there is room for it at the beginning */
		header_rewrite(writer->host, writer->header, &writer->header_tid);
		moves = move_rows(table, &end) > 0;
		writer_release(writer);
		SPI_commit();
		writer_continue(writer);
		page_table_open(table);
	}
}

/*
 * Moves the rows of a mesh to the beginning of their tables, and commits after
 * each batch. The caller has kept others from changing the mesh by
 * mesh_lock_for_session(), and no core handle has it open.
 */
void
compact(Writer *writer)
{
	PageStore  *store = &writer->host->store;

	compact_table(writer, &store->simplices);
	/* without such points all rows of the vertex table are dead, and it is truncated */
	if (writer->header->duplicates > 0 || writer->header->inserted < writer->header->staged)
	{
		page_store_vertex_table(store);
		store->vertices.superseded = superseded_create(writer->host->home);
		compact_table(writer, &store->vertices);
	}
}

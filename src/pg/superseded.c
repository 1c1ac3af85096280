/*
 * superseded.c: the space of rows that were replaced.
 *
 * A page of a mesh fills a heap page, so the new version of a row goes
 * elsewhere and the old one keeps its heap page. PostgreSQL would prune that
 * when somebody comes by, but nobody does: no search leads to a dead row, and
 * an insertion goes where the free space map sends it, which pruning does not
 * tell. So a writer remembers the heap pages that it left, has them pruned
 * when the commit has made the old versions dead, and enters their space into
 * the map: abacus_build after each batch, every other change at the session's
 * next change of the mesh. Else each single point would leave pages behind.
 *
 * Old versions that some transaction still sees stay, and are tried again the
 * next time. What remains in any case, until VACUUM, are a line pointer of
 * four bytes and the index entry.
 *
 * The heap pages are remembered in a bitmap: 1 MB for 64 GB of table.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/freespace.h"
#include "storage/proc.h"
#include "utils/memutils.h"
#include "utils/rel.h"

#include "pg/superseded.h"

#define FIRST_BYTES 1024
/* Meshes of which a session remembers what it left. */
#define MESHES_KEPT 4
/* Heap pages that one page of the free space map is about, and fewer. */
#define MAP_STRIDE 4000

struct Superseded
{
	Size		bytes;
	uint8	   *bits;			/* of each heap page */
	uint64		count;			/* of bits set */
	uint64		worth_trying;	/* with that many again */
	LocalTransactionId last;	/* that added one */
};

/* What this session has left in the meshes that it changed lately. */
static struct
{
	RelFileNode node;
	Superseded *superseded;
}			kept[MESHES_KEPT];
static int	next_kept = 0;

/* Lives in `memory`. */
Superseded *
superseded_create(MemoryContext memory)
{
	Superseded *superseded = MemoryContextAllocZero(memory, sizeof(Superseded));

	superseded->bytes = FIRST_BYTES;
	superseded->bits = MemoryContextAllocZero(memory, FIRST_BYTES);
	return superseded;
}

/* Remembers that a row on this heap page has been replaced. */
void
superseded_add(Superseded *superseded, BlockNumber block)
{
	Size		byte = block / BITS_PER_BYTE;

	if (byte >= superseded->bytes)
	{
		Size		more = Max(byte + 1, superseded->bytes * 2);

		superseded->bits = repalloc_huge(superseded->bits, more);
		MemSet(superseded->bits + superseded->bytes, 0, more - superseded->bytes);
		superseded->bytes = more;
	}
	if ((superseded->bits[byte] & (1 << (block % BITS_PER_BYTE))) == 0)
		superseded->count++;
	superseded->bits[byte] |= 1 << (block % BITS_PER_BYTE);
	superseded->last = MyProc->lxid;
}

/* What this session has left in a table; lives as long as the session, or is forgotten. */
Superseded *
superseded_of_session(Relation heap)
{
	int			i;

	for (i = 0; i < MESHES_KEPT; i++)
		if (kept[i].superseded != NULL && RelFileNodeEquals(kept[i].node, heap->rd_node))
			return kept[i].superseded;
	i = next_kept;
	if (kept[i].superseded != NULL)
	{
		Superseded *old = kept[i].superseded;

		kept[i].superseded = NULL;
		pfree(old->bits);
		pfree(old);
	}
	kept[i].node = heap->rd_node;
	kept[i].superseded = superseded_create(TopMemoryContext);
	next_kept = (i + 1) % MESHES_KEPT;
	return kept[i].superseded;
}

/*
 * Prunes a heap page and tells the free space map what room it has. Returns
 * false if there is more to prune, but not now: a row is seen by somebody
 * still, or the page is being read.
 */
static bool
reclaim(Relation heap, BlockNumber block)
{
	Buffer		buffer = ReadBuffer(heap, block);
	Page		page = BufferGetPage(buffer);
	Size		room;
	bool		done;

	/* a page that a row was deleted from, and that has room, would not be pruned for long */
	LockBuffer(buffer, BUFFER_LOCK_EXCLUSIVE);
	PageSetFull(page);
	LockBuffer(buffer, BUFFER_LOCK_UNLOCK);
	heap_page_prune_opt(heap, buffer);
	LockBuffer(buffer, BUFFER_LOCK_SHARE);
	room = PageGetHeapFreeSpace(page);
	done = !TransactionIdIsValid(((PageHeader) page)->pd_prune_xid);
	UnlockReleaseBuffer(buffer);
	RecordPageWithFreeSpace(heap, block, room);
	return done;
}

/*
 * Gives the space back. The replacing transactions must have committed, and
 * a snapshot taken since be active: it is what tells this backend that nobody
 * else needs the old versions.
 */
void
superseded_reclaim(Superseded *superseded, Relation heap)
{
	BlockNumber first = InvalidBlockNumber;
	BlockNumber last = InvalidBlockNumber;
	BlockNumber blocks = RelationGetNumberOfBlocks(heap);	/* VACUUM may have cut it */

	for (Size byte = 0; byte < superseded->bytes; byte++)
	{
		for (int bit = 0; superseded->bits[byte] >> bit != 0; bit++)
		{
			BlockNumber block = (BlockNumber) (byte * BITS_PER_BYTE + bit);

			if ((superseded->bits[byte] & (1 << bit)) == 0)
				continue;
			CHECK_FOR_INTERRUPTS();
			if (block >= blocks || reclaim(heap, block))
			{
				superseded->bits[byte] &= ~(1 << bit);
				superseded->count--;
			}
			if (block >= blocks)
				continue;
			if (first != InvalidBlockNumber && block - last > MAP_STRIDE)
			{
				FreeSpaceMapVacuumRange(heap, first, last + 1);
				first = InvalidBlockNumber;
			}
			if (first == InvalidBlockNumber)
				first = block;
			last = block;
		}
	}
	if (first != InvalidBlockNumber)
		FreeSpaceMapVacuumRange(heap, first, last + 1);
}

/*
 * The same for what earlier transactions of the session have left. What cannot
 * be reclaimed yet is tried again only when it has doubled.
 */
void
superseded_reclaim_earlier(Superseded *superseded, Relation heap)
{
	if (superseded->count == 0 || superseded->count < superseded->worth_trying ||
		superseded->last == MyProc->lxid)
		return;
	superseded_reclaim(superseded, heap);
	superseded->worth_trying = 2 * superseded->count;
}

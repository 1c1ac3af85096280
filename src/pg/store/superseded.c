/*
 * superseded.c: reclaims the space of rows that were replaced.
 *
 * A page of a mesh fills a heap page, so the new version of a row goes elsewhere and the old one
 * keeps its heap page. PostgreSQL would prune that page when someone visits it, but no one does. No
 * search leads to a dead row, and an insertion goes where the free space map sends it, which
 * pruning does not update. So a writer remembers the heap pages that it left. When the commit has
 * made the old versions dead, it prunes these pages and enters their space into the map.
 * abacus_build does so after each batch, every other change at the session's next change of the
 * mesh. Otherwise each single point would leave pages behind.
 *
 * Versions that the current transaction has made itself need no commit: those that nothing can see
 * any more are removed at the transaction's next change (own_versions.c). Their heap pages are
 * remembered separately, each for one try, so that a change costs no more than the one before it. A
 * few that are still seen, as by a statement that makes several changes, are tried again.
 *
 * Old versions that some transaction still sees stay, and are tried again the next time. In any
 * case a line pointer of four bytes and the index entry remain until VACUUM.
 *
 * Free heap pages are used from the beginning of the table on. The free space map goes round and
 * round. A table that once grew, because someone saw the old versions for a while, would then
 * always have pages in use up to its end, and VACUUM could not cut it.
 *
 * Versions left by other sessions, or rolled back, are looked for only when rows are moved anyway
 * (compact.c), since that means reading every heap page.
 *
 * The heap pages are remembered in bitmaps: 2 MB for 64 GB of table.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "miscadmin.h"
#include "port/pg_bitutils.h"
#include "storage/bufmgr.h"
#include "storage/freespace.h"
#include "storage/proc.h"
#include "storage/procarray.h"
#include "utils/memutils.h"
#include "utils/rel.h"

#include "pg/port/port.h"
#include "pg/store/heap_room.h"
#include "pg/store/own_versions.h"
#include "pg/store/superseded.h"

#define FIRST_BYTES 1024
/* Heap pages that one page of the free space map covers, rounded down. */
#define MAP_STRIDE 4000
/*
 * The least room of a heap page without rows. Until VACUUM each row that it had takes a
 * line pointer. Full pages of a mesh still fit for long, since most leave some room.
 */
#define EMPTY_BYTES (BLCKSZ - BLCKSZ / 8)
/* Heap pages; a row nearer than this to the beginning keeps its place. */
#define NEAR_PAGES 4
/* The most heap pages with versions of our own that are tried again. */
#define OWN_TRIED_AGAIN 16

struct Superseded
{
	Size		bytes;
	uint8	   *bits;			/* for each heap page: a row on it has been replaced */
	uint64		count;			/* of bits set */
	uint8	   *free;			/* for each heap page: it has become empty */
	Size		first_free;		/* all bytes before are zero */
	LocalTransactionId last;	/* transaction that added a page last */
	TransactionId horizon;		/* the horizon when not everything could be pruned */
	BlockNumber *own;			/* heap pages where the current transaction has replaced its own rows */
	uint32		own_count;
	uint32		own_room;
	LocalTransactionId own_of;	/* that transaction */
};

/* Lives in `memory`. */
Superseded *
superseded_create(MemoryContext memory)
{
	Superseded *superseded = MemoryContextAllocZero(memory, sizeof(Superseded));

	superseded->bytes = FIRST_BYTES;
	superseded->bits = MemoryContextAllocZero(memory, FIRST_BYTES);
	superseded->free = MemoryContextAllocZero(memory, FIRST_BYTES);
	superseded->own_room = FIRST_BYTES / sizeof(BlockNumber);
	superseded->own = MemoryContextAlloc(memory, FIRST_BYTES);
	return superseded;
}

void
superseded_forget(Superseded *superseded)
{
	pfree(superseded->bits);
	pfree(superseded->free);
	pfree(superseded->own);
	pfree(superseded);
}

/* Makes room in the bitmaps for this heap page. */
static void
cover(Superseded *superseded, BlockNumber block)
{
	Size		more;

	if (block / BITS_PER_BYTE < superseded->bytes)
		return;
	more = Max(block / BITS_PER_BYTE + 1, superseded->bytes * 2);
	superseded->bits = repalloc_huge(superseded->bits, more);
	superseded->free = repalloc_huge(superseded->free, more);
	MemSet(superseded->bits + superseded->bytes, 0, more - superseded->bytes);
	MemSet(superseded->free + superseded->bytes, 0, more - superseded->bytes);
	superseded->bytes = more;
}

/* Remembers that a row on this heap page has been replaced. */
void
superseded_add(Superseded *superseded, BlockNumber block)
{
	Size		byte = block / BITS_PER_BYTE;

	cover(superseded, block);
	if ((superseded->bits[byte] & (1 << (block % BITS_PER_BYTE))) == 0)
		superseded->count++;
	superseded->bits[byte] |= 1 << (block % BITS_PER_BYTE);
	superseded->last = port_local_transaction();
}

/* Remembers that the current transaction has replaced a row of its own on this heap page. */
void
superseded_add_own(Superseded *superseded, BlockNumber block)
{
	if (superseded->own_of != port_local_transaction())
	{
		superseded->own_of = port_local_transaction();
		superseded->own_count = 0;
	}
	if (superseded->own_count > 0 && superseded->own[superseded->own_count - 1] == block)
		return;
	if (superseded->own_count == superseded->own_room)
	{
		superseded->own_room *= 2;
		superseded->own = repalloc_huge(superseded->own, superseded->own_room * sizeof(BlockNumber));
	}
	superseded->own[superseded->own_count++] = block;
}

/* An empty heap page is the next to be written, unless there is one before it. */
static void
hand_out(Superseded *superseded, BlockNumber block)
{
	Size		byte = block / BITS_PER_BYTE;

	cover(superseded, block);
	superseded->free[byte] |= 1 << (block % BITS_PER_BYTE);
	superseded->first_free = Min(superseded->first_free, byte);
}

/* The first heap page that has become empty, or InvalidBlockNumber. */
static BlockNumber
first_empty(Superseded *superseded)
{
	for (; superseded->first_free < superseded->bytes; superseded->first_free++)
	{
		uint8		free = superseded->free[superseded->first_free];

		if (free != 0)
			return (BlockNumber) (superseded->first_free * BITS_PER_BYTE + pg_rightmost_one_pos32(free));
	}
	return InvalidBlockNumber;
}

/*
 * Takes the first heap page that has become empty and still has room for `size` bytes; another
 * session may have written it meanwhile. *room gets its room. If there is none, returns
 * InvalidBlockNumber, and *room is unchanged.
 */
BlockNumber
superseded_take_empty(Superseded *superseded, Relation heap, Size size, Size *room)
{
	BlockNumber block;

	while ((block = first_empty(superseded)) != InvalidBlockNumber)
	{
		Size		here = 0;

		superseded->free[block / BITS_PER_BYTE] &= ~(1 << (block % BITS_PER_BYTE));
		/* VACUUM may have cut the table, but not while we hold a lock on it */
		if (block < RelationGetNumberOfBlocks(heap))
			here = heap_room_at(heap, block);
		if (here >= size)
		{
			*room = here;
			return block;
		}
	}
	return InvalidBlockNumber;
}

/* Takes back a heap page with this much room left, if it is still almost empty. */
void
superseded_give_back(Superseded *superseded, BlockNumber block, Size room)
{
	if (room >= EMPTY_BYTES)
		hand_out(superseded, block);
}

/*
 * Whether a row lies far behind the first empty heap page. An update keeps a row of less than half
 * a heap page, such as the header, in its place, and then the table could not be cut before it.
 */
bool
superseded_is_far(Superseded *superseded, BlockNumber block)
{
	BlockNumber empty = first_empty(superseded);

	return empty != InvalidBlockNumber && block > NEAR_PAGES && (block - NEAR_PAGES) / 2 > empty;
}

/* Whether there is an empty heap page before this one. */
bool
superseded_has_empty_before(Superseded *superseded, BlockNumber block)
{
	return first_empty(superseded) < block; /* so InvalidBlockNumber is not before any */
}

/* Whether there is a row whose insertion was rolled back; the page's header does not show that. */
static bool
has_rolled_back(Relation heap, Buffer buffer)
{
	Page		page = BufferGetPage(buffer);

	for (OffsetNumber offset = FirstOffsetNumber; offset <= PageGetMaxOffsetNumber(page); offset++)
	{
		ItemId		item = PageGetItemId(page, offset);
		HeapTupleData tuple;
		TransactionId dead_after;

		if (!ItemIdIsNormal(item))
			continue;
		tuple.t_data = (HeapTupleHeader) PageGetItem(page, item);
		tuple.t_len = ItemIdGetLength(item);
		tuple.t_tableOid = RelationGetRelid(heap);
		ItemPointerSet(&tuple.t_self, BufferGetBlockNumber(buffer), offset);
		if (HeapTupleSatisfiesVacuumHorizon(&tuple, buffer, &dead_after) == HEAPTUPLE_DEAD)
			return true;
	}
	return false;
}

/*
 * Prunes a heap page and enters its room into the free space map; *is_empty says whether it has
 * become empty. Returns false if more is left to prune, but not now, since someone still sees a row
 * or is reading the page.
 */
static bool
reclaim(Superseded *superseded, Relation heap, BlockNumber block, bool *is_empty)
{
	Buffer		buffer = ReadBuffer(heap, block);
	Page		page = BufferGetPage(buffer);
	Size		room;
	bool		done;

	LockBuffer(buffer, BUFFER_LOCK_EXCLUSIVE);
	/* a transaction that ended long ago: rolled-back rows are dead to everyone */
	if (!TransactionIdIsValid(((PageHeader) page)->pd_prune_xid) && has_rolled_back(heap, buffer))
		PageSetPrunable(page, heap->rd_rel->relfrozenxid);
	/* otherwise a page with a deleted row would not be pruned as long as it has room */
	if (TransactionIdIsValid(((PageHeader) page)->pd_prune_xid))
		PageSetFull(page);
	LockBuffer(buffer, BUFFER_LOCK_UNLOCK);
	port_prune_heap_page(heap, buffer);
	LockBuffer(buffer, BUFFER_LOCK_SHARE);
	room = heap_room_on(buffer);
	done = !TransactionIdIsValid(((PageHeader) page)->pd_prune_xid);
	UnlockReleaseBuffer(buffer);
	RecordPageWithFreeSpace(heap, block, room);
	*is_empty = room >= EMPTY_BYTES;
	if (*is_empty)
		hand_out(superseded, block);
	return done;
}

/*
 * Gives the space back. The replacing transactions must have committed, and a snapshot taken since
 * then must be active: it shows this backend that no one else needs the old versions.
 */
void
superseded_reclaim(Superseded *superseded, Relation heap)
{
	BlockNumber first = InvalidBlockNumber;
	BlockNumber last = InvalidBlockNumber;
	BlockNumber blocks = RelationGetNumberOfBlocks(heap);	/* VACUUM may have cut it */
	bool		is_empty;

	for (Size byte = 0; byte < superseded->bytes; byte++)
	{
		for (int bit = 0; superseded->bits[byte] >> bit != 0; bit++)
		{
			BlockNumber block = (BlockNumber) (byte * BITS_PER_BYTE + bit);

			if ((superseded->bits[byte] & (1 << bit)) == 0)
				continue;
			CHECK_FOR_INTERRUPTS();
			if (block >= blocks || reclaim(superseded, heap, block, &is_empty))
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

/* The same for versions that the current transaction has made and replaced. */
static void
reclaim_own(Superseded *superseded, Relation heap, const OwnSight *sight)
{
	uint32		again = 0;

	for (uint32 i = 0; i < superseded->own_count; i++)
	{
		BlockNumber block = superseded->own[i];
		Size		room;

		CHECK_FOR_INTERRUPTS();
		if (own_versions_prune(heap, block, sight, &room))
		{
			RecordPageWithFreeSpace(heap, block, room);
			superseded_give_back(superseded, block, room);
		}
		else if (again < OWN_TRIED_AGAIN)
			superseded->own[again++] = block;
	}
	superseded->own_count = again;
}

/*
 * The same for versions from earlier transactions of the session, or from earlier changes in this
 * transaction. What cannot be reclaimed yet is tried again when no transaction sees it.
 */
void
superseded_reclaim_earlier(Superseded *superseded, Relation heap, const OwnSight *sight)
{
	TransactionId horizon;

	/* a user's own triggers on the table may have pending events that need the rows */
	if (superseded->own_of == port_local_transaction() && superseded->own_count > 0 &&
		heap->trigdesc == NULL)
		reclaim_own(superseded, heap, sight);
	if (superseded->count == 0 || superseded->last == port_local_transaction())
		return;
	horizon = GetOldestNonRemovableTransactionId(heap);
	if (horizon == superseded->horizon)
		return;
	superseded_reclaim(superseded, heap);
	superseded->horizon = superseded->count > 0 ? horizon : InvalidTransactionId;
}

/*
 * Surveys every n-th heap page, from *block to before `end`, until enough are found to be empty;
 * these will be used from now on. The space of dead rows there is reclaimed, whichever session left
 * them. Returns how many are empty.
 */
uint64
superseded_survey(Superseded *superseded, Relation heap, uint64 *block, uint64 end,
				  uint64 one_of, uint64 enough)
{
	uint64		empty = 0;

	for (; *block < end && empty < enough; *block += one_of)
	{
		bool		is_empty;

		CHECK_FOR_INTERRUPTS();
		reclaim(superseded, heap, (BlockNumber) *block, &is_empty);
		if (is_empty)
			empty++;
	}
	return empty;
}

/*
 * heap_room.c: how large a row a heap page has room for.
 */
#include "postgres.h"

#include "storage/bufmgr.h"

#include "pg/store/heap_room.h"

/* On a locked page; also on one of zeros, which nobody has initialized yet. */
Size
heap_room_on(Buffer buffer)
{
	Page		page = BufferGetPage(buffer);

	return PageIsNew(page) ? NEW_HEAP_PAGE_ROOM : PageGetHeapFreeSpace(page);
}

/* On a page that is not locked: as it was a moment ago. */
Size
heap_room_at(Relation heap, BlockNumber block)
{
	Buffer		buffer = ReadBuffer(heap, block);
	Size		room;

	LockBuffer(buffer, BUFFER_LOCK_SHARE);
	room = heap_room_on(buffer);
	UnlockReleaseBuffer(buffer);
	return room;
}

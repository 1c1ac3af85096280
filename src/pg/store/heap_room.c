/*
 * heap_room.c: the room for a row on a heap page.
 */
#include "postgres.h"

#include "storage/bufmgr.h"

#include "pg/store/heap_room.h"

/* On a locked page, even one of zeros that is not initialized yet. */
Size
heap_room_on(Buffer buffer)
{
	Page		page = BufferGetPage(buffer);

	return PageIsNew(page) ? NEW_HEAP_PAGE_ROOM : PageGetHeapFreeSpace(page);
}

/* On a page that is not locked: the room it had a moment ago. */
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

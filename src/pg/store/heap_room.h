/*
 * heap_room.h: the room for a row on a heap page.
 */
#ifndef ABACUS_HEAP_ROOM_H
#define ABACUS_HEAP_ROOM_H

#include "storage/buf.h"
#include "storage/bufpage.h"
#include "utils/rel.h"

/* The room on a heap page without rows. */
#define NEW_HEAP_PAGE_ROOM (BLCKSZ - SizeOfPageHeaderData - sizeof(ItemIdData))

extern Size heap_room_on(Buffer buffer);
extern Size heap_room_at(Relation heap, BlockNumber block);

#endif

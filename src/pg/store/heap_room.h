/*
 * heap_room.h: how large a row a heap page has room for.
 */
#ifndef ABACUS_HEAP_ROOM_H
#define ABACUS_HEAP_ROOM_H

#include "storage/buf.h"
#include "storage/bufpage.h"
#include "utils/rel.h"

/* On a heap page without any row. */
#define NEW_HEAP_PAGE_ROOM (BLCKSZ - SizeOfPageHeaderData - sizeof(ItemIdData))

extern Size heap_room_on(Buffer buffer);
extern Size heap_room_at(Relation heap, BlockNumber block);

#endif

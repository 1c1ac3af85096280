/*
 * location.h: the place of a row as one word, in the form that the core keeps.
 */
#ifndef ABACUS_LOCATION_H
#define ABACUS_LOCATION_H

#include "storage/itemptr.h"

static inline uint64
pack_location(const ItemPointerData *tid)
{
	return ((uint64) ItemPointerGetBlockNumber(tid) << 16) | ItemPointerGetOffsetNumber(tid);
}

static inline void
unpack_location(uint64 location, ItemPointer tid)
{
	ItemPointerSet(tid, (BlockNumber) (location >> 16), (OffsetNumber) (location & 0xFFFF));
}

#endif

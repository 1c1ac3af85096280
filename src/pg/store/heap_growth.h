/*
 * heap_growth.h: lets a table of pages grow by many heap pages at a time.
 */
#ifndef ABACUS_HEAP_GROWTH_H
#define ABACUS_HEAP_GROWTH_H

#include "storage/block.h"
#include "utils/rel.h"

/* All zero while the table has not grown. */
typedef struct HeapGrowth
{
	BlockNumber first;			/* first heap page added in this way */
	BlockNumber next;			/* added but not used yet: [next, end) */
	BlockNumber end;
	bool		is_refused;		/* by the file system: not tried again */
} HeapGrowth;

extern BlockNumber heap_growth_take(HeapGrowth *growth, Relation heap, Size size, uint64 stored);
extern void heap_growth_end(HeapGrowth *growth, Relation heap);

#endif

/*
 * pruning.h: pruning of a heap page by an extension.
 */
#ifndef ABACUS_PRUNING_H
#define ABACUS_PRUNING_H

#include "access/htup_details.h"
#include "storage/buf.h"
#include "utils/rel.h"

/* The changes to the line pointers of a heap page. */
typedef struct Pruning
{
	int			redirected_count;
	int			dead_count;
	int			unused_count;
	OffsetNumber redirected[MaxHeapTuplesPerPage * 2];	/* from, to */
	OffsetNumber dead[MaxHeapTuplesPerPage];
	OffsetNumber unused[MaxHeapTuplesPerPage];
} Pruning;

extern void port_prune(Relation heap, Buffer buffer, Pruning *pruning);

#endif

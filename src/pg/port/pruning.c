/*
 * pruning.c: prunes a heap page and writes the log record, as heap_page_prune() does.
 *
 * From 17 on PostgreSQL has one record for all changes of line pointers, and a function that writes
 * it. For older versions the record is formed here. Only their own transaction ever saw these rows,
 * so no snapshot of a standby can be in the way, and the record names no transaction.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/heapam_xlog.h"
#include "access/xloginsert.h"
#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "utils/rel.h"

#include "pg/port/port.h"
#include "pg/port/pruning.h"

#if PG_VERSION_NUM < 170000
static void
write_record(Relation heap, Buffer buffer, Pruning *pruning)
{
	xl_heap_prune record;
	XLogRecPtr	end;

#if PG_VERSION_NUM >= 160000
	record.snapshotConflictHorizon = InvalidTransactionId;
	record.isCatalogRel = RelationIsAccessibleInLogicalDecoding(heap);
#else
	record.latestRemovedXid = InvalidTransactionId;
#endif
	record.nredirected = pruning->redirected_count;
	record.ndead = pruning->dead_count;
	XLogBeginInsert();
	XLogRegisterData((char *) &record, SizeOfHeapPrune);
	XLogRegisterBuffer(0, buffer, REGBUF_STANDARD);
	if (pruning->redirected_count > 0)
		XLogRegisterBufData(0, (char *) pruning->redirected,
							pruning->redirected_count * sizeof(OffsetNumber) * 2);
	if (pruning->dead_count > 0)
		XLogRegisterBufData(0, (char *) pruning->dead, pruning->dead_count * sizeof(OffsetNumber));
	if (pruning->unused_count > 0)
		XLogRegisterBufData(0, (char *) pruning->unused,
							pruning->unused_count * sizeof(OffsetNumber));
	end = XLogInsert(RM_HEAP2_ID, XLOG_HEAP2_PRUNE);
	PageSetLSN(BufferGetPage(buffer), end);
}
#endif

/* The caller has the buffer locked for cleanup. */
void
port_prune(Relation heap, Buffer buffer, Pruning *pruning)
{
	START_CRIT_SECTION();
#if PG_VERSION_NUM >= 170000
	heap_page_prune_execute(buffer, false, pruning->redirected, pruning->redirected_count,
							pruning->dead, pruning->dead_count, pruning->unused,
							pruning->unused_count);
#else
	heap_page_prune_execute(buffer, pruning->redirected, pruning->redirected_count, pruning->dead,
							pruning->dead_count, pruning->unused, pruning->unused_count);
#endif
	PageClearFull(BufferGetPage(buffer));
	MarkBufferDirty(buffer);
	if (RelationNeedsWAL(heap))
	{
#if PG_VERSION_NUM >= 190000
		log_heap_prune_and_freeze(heap, buffer, InvalidBuffer, 0, InvalidTransactionId, true,
								  PRUNE_ON_ACCESS, NULL, 0, pruning->redirected,
								  pruning->redirected_count, pruning->dead, pruning->dead_count,
								  pruning->unused, pruning->unused_count);
#elif PG_VERSION_NUM >= 170000
		log_heap_prune_and_freeze(heap, buffer, InvalidTransactionId, true, PRUNE_ON_ACCESS, NULL, 0,
								  pruning->redirected, pruning->redirected_count, pruning->dead,
								  pruning->dead_count, pruning->unused, pruning->unused_count);
#else
		write_record(heap, buffer, pruning);
#endif
	}
	END_CRIT_SECTION();
}

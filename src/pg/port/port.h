/*
 * port.h: what differs between major versions of PostgreSQL, and the only file that asks for the version.
 *
 * All other files use the names and signatures of the newest version; here they are mapped to
 * those of older ones. Where a name would say too little, it begins with port_. A version that is
 * not known does not compile: a wrong guess would damage data.
 */
#ifndef ABACUS_PORT_H
#define ABACUS_PORT_H

#include "access/genam.h"
#include "access/heapam.h"
#include "access/tableam.h"
#include "catalog/index.h"
#include "catalog/pg_class.h"
#include "catalog/pg_database.h"
#include "catalog/pg_namespace.h"
#include "commands/tablecmds.h"
#include "commands/trigger.h"
#include "common/relpath.h"
#include "miscadmin.h"
#include "storage/bufmgr.h"
#include "storage/proc.h"
#include "storage/smgr.h"
#include "utils/acl.h"
#include "utils/rel.h"
#include "utils/relcache.h"
#include "utils/snapmgr.h"

#if PG_VERSION_NUM < 150000 || PG_VERSION_NUM >= 160000
#error "Abacus is made for PostgreSQL 15"
#endif

/* ---- Files of a relation (names of 16) ------------------------------------ */

typedef RelFileNode RelFileLocator;

#define RelFileLocatorEquals(a, b) RelFileNodeEquals(a, b)
#define rd_locator rd_node
#define relNumber relNode
#define smgr_rlocator smgr_rnode
#define RelationSetNewRelfilenumber(relation, persistence) \
	RelationSetNewRelfilenode(relation, persistence)

/* The path of a relation's main fork, in memory of the caller's (18: relpath() gives a struct). */
static inline char *
port_relation_path(Relation rel)
{
	return relpath(RelationGetSmgr(rel)->smgr_rlocator, MAIN_FORKNUM);
}

/* As by REINDEX TABLE, without a statement (17 takes it). */
static inline bool
port_reindex_relation(Oid relid, int flags, const ReindexParams *params)
{
	ReindexParams copy = *params;

	return reindex_relation(relid, flags, &copy);
}

/* ---- Privileges (names of 16) ----------------------------------------------- */

static inline bool
object_ownercheck(Oid class, Oid object, Oid role)
{
	Assert(class == RelationRelationId || class == DatabaseRelationId);
	return class == RelationRelationId ? pg_class_ownercheck(object, role)
		: pg_database_ownercheck(object, role);
}

static inline AclResult
object_aclcheck(Oid class, Oid object, Oid role, AclMode mode)
{
	Assert(class == NamespaceRelationId);
	return pg_namespace_aclcheck(object, role, mode);
}

/* ---- Scans, rows and triggers ------------------------------------------------ */

/* 18 counts searches, 19 takes flags. */
static inline IndexScanDesc
port_index_beginscan(Relation heap, Relation index, Snapshot snapshot, int keys)
{
	return index_beginscan(heap, index, snapshot, keys, 0);
}

/* 16 tells which indexes are to be updated: ours are, by ourselves. */
static inline void
port_heap_update(Relation heap, ItemPointer tid, HeapTuple tuple)
{
	simple_heap_update(heap, tid, tuple);
}

/* 16 asks whether clones of the trigger shall be changed, too. */
static inline void
port_set_trigger_firing(Relation rel, const char *name, char fires, LOCKMODE lock)
{
	EnableDisableTrigger(rel, name, fires, false, lock);
}

/* 19 hands a pin of the visibility map's page, which is to be released. */
static inline void
port_prune_heap_page(Relation heap, Buffer buffer)
{
	heap_page_prune_opt(heap, buffer);
}

/* ---- Transactions and snapshots ------------------------------------------------ */

/* The number of the transaction in this backend (17: MyProc->vxid.lxid). */
static inline LocalTransactionId
port_local_transaction(void)
{
	return MyProc->lxid;
}

/* Whether rows that a snapshot sees may go for the age of the snapshot (until 16). */
static inline bool
port_snapshots_may_be_too_old(void)
{
	return old_snapshot_threshold >= 0;
}

/* An error if that has happened to what the snapshot would see on the page. */
static inline void
port_refuse_old_snapshot(Snapshot snapshot, Relation rel, Page page)
{
	TestForOldSnapshot(snapshot, rel, page);
}

#endif

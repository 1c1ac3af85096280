/*
 * port.h: the differences between major versions of PostgreSQL. Only this folder checks the
 * version.
 *
 * All other files use the names and signatures of the newest version; here they are mapped to those
 * of older ones. If a name would say too little, it begins with port_. An unknown version does not
 * compile: a wrong guess would damage data.
 */
#ifndef ABACUS_PORT_H
#define ABACUS_PORT_H

#if PG_VERSION_NUM < 150000 || PG_VERSION_NUM >= 200000
#error "Abacus is made for PostgreSQL 15 to 19: this version is not known"
#endif

#include "access/genam.h"
#include "access/heapam.h"
#include "access/stratnum.h"
#include "access/tableam.h"
#include "catalog/index.h"
#include "catalog/pg_class.h"
#include "catalog/pg_database.h"
#include "catalog/pg_foreign_server.h"
#include "catalog/pg_namespace.h"
#include "commands/explain.h"
#include "commands/tablecmds.h"
#include "commands/trigger.h"
#include "commands/vacuum.h"
#include "executor/executor.h"
#include "miscadmin.h"
#include "optimizer/pathnode.h"
#include "storage/buf_internals.h"
#include "storage/bufmgr.h"
#include "storage/proc.h"
#include "tcop/pquery.h"
#include "utils/acl.h"
#include "utils/rel.h"
#include "utils/relcache.h"
#include "utils/snapmgr.h"
#if PG_VERSION_NUM >= 160000
#include "varatt.h"
#endif
#if PG_VERSION_NUM >= 180000
#include "commands/explain_format.h"
#include "commands/explain_state.h"
#endif

#if PG_VERSION_NUM < 180000
#define pg_noreturn pg_attribute_noreturn()
#endif

/* The module's name and version, which pg_get_loaded_modules() shows (from 18 on). */
#if PG_VERSION_NUM < 180000
#define PG_MODULE_MAGIC_EXT(...) PG_MODULE_MAGIC
#endif

/* ---- Columns that are computed when they are read (name of 18) ------------ */

#if PG_VERSION_NUM < 180000
#define ATTRIBUTE_GENERATED_VIRTUAL 'v'
#endif

/* ---- Files of a relation (names of 16) ------------------------------------ */

#if PG_VERSION_NUM < 160000
typedef RelFileNode RelFileLocator;

#define RelFileLocatorEquals(a, b) RelFileNodeEquals(a, b)
#define rd_locator rd_node
#define relNumber relNode
#define RelationSetNewRelfilenumber(relation, persistence) \
	RelationSetNewRelfilenode(relation, persistence)
#endif

/* As REINDEX TABLE does, without a statement (17 takes it). */
static inline bool
port_reindex_relation(Oid relid, int flags, const ReindexParams *params)
{
#if PG_VERSION_NUM >= 170000
	return reindex_relation(NULL, relid, flags, params);
#else
	ReindexParams copy = *params;

	return reindex_relation(relid, flags, &copy);
#endif
}

/* ---- Privileges (names of 16) ----------------------------------------------- */

#if PG_VERSION_NUM < 160000
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
	Assert(class == NamespaceRelationId || class == ForeignServerRelationId);
	return class == NamespaceRelationId ? pg_namespace_aclcheck(object, role, mode)
		: pg_foreign_server_aclcheck(object, role, mode);
}
#endif

/* Whether a role may vacuum a table: as its owner, or with the privilege MAINTAIN (from 17 on). */
static inline bool
port_may_maintain(Oid table, Oid role)
{
#if PG_VERSION_NUM >= 170000
	return pg_class_aclcheck(table, role, ACL_MAINTAIN) == ACLCHECK_OK;
#else
	return object_ownercheck(RelationRelationId, table, role);
#endif
}

/* ---- Scans, rows and triggers ------------------------------------------------ */

/* The last step of making a row description: without it 19 does not know where its columns are. */
#if PG_VERSION_NUM < 190000
#define TupleDescFinalize(desc) ((void) (desc))
#endif

/* 18 counts searches, 19 takes flags. */
static inline IndexScanDesc
port_index_beginscan(Relation heap, Relation index, Snapshot snapshot, int keys)
{
#if PG_VERSION_NUM >= 190000
	return index_beginscan(heap, index, snapshot, NULL, keys, 0, SO_NONE);
#elif PG_VERSION_NUM >= 180000
	return index_beginscan(heap, index, snapshot, NULL, keys, 0);
#else
	return index_beginscan(heap, index, snapshot, keys, 0);
#endif
}

/* After the last insertion: a BRIN index keeps pages pinned until then (from 17 on). */
static inline void
port_index_insert_cleanup(Relation index, IndexInfo *info)
{
#if PG_VERSION_NUM >= 170000
	index_insert_cleanup(index, info);
#endif
}

/* A scan of all rows (19 takes flags). */
static inline TableScanDesc
port_table_beginscan(Relation rel, Snapshot snapshot)
{
#if PG_VERSION_NUM >= 190000
	return table_beginscan(rel, snapshot, 0, NULL, SO_NONE);
#else
	return table_beginscan(rel, snapshot, 0, NULL);
#endif
}

/* A scan of the rows with locations from `first` to `last`. */
static inline TableScanDesc
port_table_beginscan_tidrange(Relation rel, Snapshot snapshot, ItemPointer first, ItemPointer last)
{
#if PG_VERSION_NUM >= 190000
	return table_beginscan_tidrange(rel, snapshot, first, last, SO_NONE);
#else
	return table_beginscan_tidrange(rel, snapshot, first, last);
#endif
}

/* The primary key's index, if it is checked immediately (18 also returns a deferrable one). */
static inline Oid
port_primary_key_index(Relation heap)
{
#if PG_VERSION_NUM >= 180000
	return RelationGetPrimaryKeyIndex(heap, false);
#else
	return RelationGetPrimaryKeyIndex(heap);
#endif
}

/* 16 reports which indexes need updates: we update ours ourselves. */
static inline void
port_heap_update(Relation heap, ItemPointer tid, HeapTuple tuple)
{
#if PG_VERSION_NUM >= 160000
	TU_UpdateIndexes ignored;

	simple_heap_update(heap, tid, tuple, &ignored);
#else
	simple_heap_update(heap, tid, tuple);
#endif
}

/* Changes the trigger's clones at partitions, too (16 asks). */
static inline void
port_set_trigger_firing(Relation rel, const char *name, char fires, LOCKMODE lock)
{
#if PG_VERSION_NUM >= 160000
	EnableDisableTrigger(rel, name, InvalidOid, fires, false, true, lock);
#else
	EnableDisableTrigger(rel, name, fires, false, lock);
#endif
}

/* 19 returns a pin of the visibility map's page, which must be released. */
static inline void
port_prune_heap_page(Relation heap, Buffer buffer)
{
#if PG_VERSION_NUM >= 190000
	Buffer		map = InvalidBuffer;

	heap_page_prune_opt(heap, buffer, &map, false);
	if (BufferIsValid(map))
		ReleaseBuffer(map);
#else
	heap_page_prune_opt(heap, buffer);
#endif
}

/* ---- VACUUM and buffers -------------------------------------------------------- */

/* Whether VACUUM cuts the table's file (18: a server setting, unless the table has its own). */
static inline bool
port_vacuum_truncates(Relation rel)
{
	const StdRdOptions *options = (const StdRdOptions *) rel->rd_options;

#if PG_VERSION_NUM >= 190000
	return options == NULL || options->vacuum_truncate == PG_TERNARY_UNSET ? vacuum_truncate
		: options->vacuum_truncate == PG_TERNARY_TRUE;
#elif PG_VERSION_NUM >= 180000
	return options == NULL || !options->vacuum_truncate_set ? vacuum_truncate
		: options->vacuum_truncate;
#else
	return options == NULL || options->vacuum_truncate;
#endif
}

/* How often a shared buffer has been used lately, read without a lock (19: a state of 64 bits). */
static inline uint32
port_buffer_usage(Buffer buffer)
{
	BufferDesc *descriptor = GetBufferDescriptor(buffer - 1);

#if PG_VERSION_NUM >= 190000
	return BUF_STATE_GET_USAGECOUNT(pg_atomic_read_u64(&descriptor->state));
#else
	return BUF_STATE_GET_USAGECOUNT(pg_atomic_read_u32(&descriptor->state));
#endif
}

/* ---- Transactions and snapshots ------------------------------------------------ */

/* The number of the transaction in this backend (17: MyProc->vxid.lxid). */
static inline LocalTransactionId
port_local_transaction(void)
{
#if PG_VERSION_NUM >= 170000
	return MyProc->vxid.lxid;
#else
	return MyProc->lxid;
#endif
}

/*
 * The first active snapshot, or NULL if it is unknown. From 18 on it is known only while the portal
 * without a name runs. That is a client's statement, which has none below it; portals of cursors
 * and of functions have names.
 */
static inline Snapshot
port_first_active_snapshot(void)
{
#if PG_VERSION_NUM >= 180000
	if (ActivePortal == NULL || ActivePortal->name[0] != '\0')
		return NULL;
	if (ActivePortal->portalSnapshot != NULL)
		return ActivePortal->portalSnapshot;
	return ActivePortal->queryDesc != NULL ? ActivePortal->queryDesc->snapshot : NULL;
#else
	return GetOldestSnapshot();
#endif
}

/* Whether rows that a snapshot sees may be removed because the snapshot is old (until 16). */
static inline bool
port_snapshots_may_be_too_old(void)
{
#if PG_VERSION_NUM >= 170000
	return false;
#else
	return old_snapshot_threshold >= 0;
#endif
}

/* An error if that has happened to rows on the page that the snapshot should see. */
static inline void
port_refuse_old_snapshot(Snapshot snapshot, Relation rel, Page page)
{
#if PG_VERSION_NUM < 170000
	TestForOldSnapshot(snapshot, rel, page);
#endif
}

/* ---- Foreign scans ------------------------------------------------------------- */

/* Whether the least keys come first in this order (18 compares, other versions have strategies). */
static inline bool
port_pathkey_ascends(const PathKey *key)
{
#if PG_VERSION_NUM >= 180000
	return key->pk_cmptype == COMPARE_LT;
#else
	return key->pk_strategy == BTLessStrategyNumber;
#endif
}

/* A path that scans a foreign table (17 takes clauses, 18 disabled nodes). */
static inline ForeignPath *
port_create_foreignscan_path(PlannerInfo *root, RelOptInfo *rel, double rows, Cost startup,
							 Cost total, List *order, Relids outer, List *more)
{
#if PG_VERSION_NUM >= 180000
	return create_foreignscan_path(root, rel, NULL, rows, 0, startup, total, order, outer, NULL,
								   NIL, more);
#elif PG_VERSION_NUM >= 170000
	return create_foreignscan_path(root, rel, NULL, rows, startup, total, order, outer, NULL, NIL,
								   more);
#else
	return create_foreignscan_path(root, rel, NULL, rows, startup, total, order, outer, NULL, more);
#endif
}

/* The user with whose rights a foreign scan reads (16 keeps it in the plan). */
static inline Oid
port_foreign_scan_user(ForeignScanState *state)
{
#if PG_VERSION_NUM >= 160000
	Oid			user = ((ForeignScan *) state->ss.ps.plan)->checkAsUser;
#else
	const Scan *scan = (Scan *) state->ss.ps.plan;
	Oid			user = exec_rt_fetch(scan->scanrelid, state->ss.ps.state)->checkAsUser;
#endif

	return OidIsValid(user) ? user : GetUserId();
}

#endif

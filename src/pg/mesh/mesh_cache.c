/*
 * mesh_cache.c: what a session keeps of the meshes that it reads.
 *
 * A core handle for locating and walking holds simplices in memory, so it is worth
 * keeping between calls and between statements. It is valid for one (relfilenode,
 * stamp); the header row that the active snapshot sees tells which.
 *
 * Reading that row for every call would cost more than locating the point. So an entry
 * remembers the snapshot under which it was found valid. It also remembers that the
 * lock is held and, within a statement, that the privileges were checked. In one
 * transaction an equal snapshot sees the same header. A subtransaction that aborts is
 * the exception: it takes changes and locks back without any trace in the snapshot. So
 * aborts and ends of transactions make entries forget. The callbacks touch memory only.
 *
 * An entry is busy while the core runs on it. If an abort or the next call finds it busy, an error
 * has interrupted it. Then it is dropped: a failed handle may only be closed.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "miscadmin.h"
#include "utils/inval.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/base/settings.h"
#include "pg/base/snapshot_mark.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/port/port.h"

#define MESHES_KEPT 4

typedef struct Entry
{
	CachedMesh	cached;			/* host NULL: the entry is free */
	Oid			relid;
	RelFileLocator node;
	uint64		stamp;
	size_t		bytes;			/* cache size when it was opened */
	uint64		last_use;
	Oid			user;			/* whose privileges were checked under `valid` */
	TimestampTz statement;		/* its start: they may be revoked between two */
	SnapshotMark valid;
} Entry;

static Entry entries[MESHES_KEPT];
static uint64 uses = 0;

static void
drop(Entry *entry)
{
	Host	   *host = entry->cached.host;

	entry->cached.host = NULL;
	entry->cached.mesh = NULL;
	entry->cached.octree = NULL;
	entry->valid.set = false;
	if (host != NULL)
		host_destroy(host);
}

static Entry *
find(Oid relid)
{
	for (int i = 0; i < MESHES_KEPT; i++)
		if (entries[i].relid == relid && entries[i].cached.host != NULL)
			return &entries[i];
	return NULL;
}

/* A free entry; if there is none, the one used longest ago is dropped. */
static Entry *
take_entry(Oid relid)
{
	Entry	   *oldest = &entries[0];

	for (int i = 0; i < MESHES_KEPT; i++)
	{
		if (entries[i].cached.host == NULL)
		{
			oldest = &entries[i];
			break;
		}
		if (entries[i].last_use < oldest->last_use)
			oldest = &entries[i];
	}
	drop(oldest);
	oldest->relid = relid;
	return oldest;
}

static void
open_mesh(Entry *entry, const abacus_facts *facts)
{
	Host	   *host = entry->cached.host;
	abacus_mesh *mesh = NULL;

	host_run(host, abacus_mesh_open, &host->table, facts, entry->bytes, &mesh);
	host_own(host, mesh, (void (*) (void *)) abacus_mesh_close);
	entry->cached.mesh = mesh;
}

static void
open_octree(Entry *entry, const abacus_facts *facts)
{
	Host	   *host = entry->cached.host;
	abacus_octree *octree = NULL;

	host_run(host, abacus_octree_open, &host->table, facts, entry->bytes, &octree);
	host_own(host, octree, (void (*) (void *)) abacus_octree_close);
	entry->cached.octree = octree;
}

/* Opens the handle in a free or outdated entry. */
static void
open_handle(Entry *entry, const abacus_header *header)
{
	entry->bytes = setting_cache_bytes();
	if (header->facts.form.type == ABACUS_OCTREE)
		open_octree(entry, &header->facts);
	else
		open_mesh(entry, &header->facts);
	entry->cached.dimension = header->facts.form.dimension;
	abacus_header_copy(&entry->cached.header, header);
}

/* Makes the entry for `relid` valid under the active snapshot. */
static Entry *
validate(Oid relid, Entry *entry, uint32 type)
{
	Relation	rel;
	abacus_header header;
	Host	   *host;

	/* taking a lock that the transaction already holds does not process changes of privileges */
	AcceptInvalidationMessages();
	rel = mesh_table_open_to_read(relid);
	/* the data of a mesh lies in one file; TRUNCATE and rewrites give it another */
	if (entry != NULL &&
		(entry->cached.host->busy || !RelFileLocatorEquals(entry->node, rel->rd_locator) ||
		 entry->bytes != setting_cache_bytes()))
	{
		drop(entry);
		entry = NULL;
	}
	if (entry == NULL)
	{
		entry = take_entry(relid);
		entry->node = rel->rd_locator;
		entry->cached.host = mesh_host_create(TopMemoryContext, relid, MESH_READ);
	}
	host = entry->cached.host;
	host->busy = true;			/* until everything has succeeded */
	mesh_pages(host)->type = ANY_TYPE;
	header_read(host, &header, NULL);
	mesh_pages_expect_moves(mesh_pages(host));
	host->busy = true;
	mesh_pages(host)->type = type;
	header_require_type(host, &header.facts.form);
	if (host->handle == NULL || entry->stamp != header.stamp)
	{
		/* whatever happens, the old handle must not be found under the new stamp */
		host_own(host, NULL, NULL);
		entry->cached.mesh = NULL;
		entry->cached.octree = NULL;
		open_handle(entry, &header);
		entry->stamp = header.stamp;
	}
	entry->user = GetUserId();
	entry->statement = GetCurrentStatementStartTimestamp();
	host_release(host);
	host->busy = false;
	table_close(rel, NoLock);
	/* there may be no memory for it: last, when nothing is open any more */
	mark_snapshot(&entry->valid, GetActiveSnapshot(), TopMemoryContext);
	return entry;
}

/* The session's entry for reading a mesh or an octree as the active snapshot sees it. */
static inline CachedMesh *
get(Oid relid, uint32 type)
{
	Entry	   *entry = find(relid);

	if (unlikely(entry == NULL || entry->cached.host->busy || entry->user != GetUserId() ||
				 entry->statement != GetCurrentStatementStartTimestamp() ||
				 entry->bytes != setting_cache_bytes() ||
				 (entry->cached.header.facts.form.type != type && type != ANY_TYPE) ||
				 !same_snapshot(&entry->valid, GetActiveSnapshot())))
		entry = validate(relid, entry, type);
	entry->last_use = ++uses;
	return &entry->cached;
}

CachedMesh *
mesh_cache_get(Oid relid)
{
	return get(relid, ABACUS_MESH);
}

CachedMesh *
mesh_cache_get_octree(Oid relid)
{
	return get(relid, ABACUS_OCTREE);
}

/* The same for a mesh or an octree. */
CachedMesh *
mesh_cache_get_any(Oid relid)
{
	return get(relid, ANY_TYPE);
}

/* The session's present entry for a mesh, or NULL. */
const CachedMesh *
mesh_cache_peek(Oid relid)
{
	Entry	   *entry = find(relid);

	return entry != NULL && !entry->cached.host->busy ? &entry->cached : NULL;
}

static void
forget_validity(bool aborted)
{
	for (int i = 0; i < MESHES_KEPT; i++)
	{
		entries[i].valid.set = false;
		if (aborted && entries[i].cached.host != NULL && entries[i].cached.host->busy)
			drop(&entries[i]);
	}
}

static void
at_transaction_event(XactEvent event, void *arg)
{
	if (event == XACT_EVENT_ABORT || event == XACT_EVENT_PARALLEL_ABORT)
		forget_validity(true);
	else if (event == XACT_EVENT_COMMIT || event == XACT_EVENT_PARALLEL_COMMIT ||
			 event == XACT_EVENT_PREPARE)
		forget_validity(false);
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	if (event == SUBXACT_EVENT_ABORT_SUB)
		forget_validity(true);
}

void
mesh_cache_init(void)
{
	RegisterXactCallback(at_transaction_event, NULL);
	RegisterSubXactCallback(at_subtransaction_event, NULL);
}

/*
 * remote_pages.c: the pages of a mesh over several servers as the core's page operations.
 *
 * The servers show what they own of the mesh of all shards as pages that partition the curve (src/shards), and
 * with them the coordinator has one mesh as any other. All functions of the core that read work on it. The
 * owner of a key has its page: it is asked for some pages from there on, more of them if they are read in
 * order. They are kept as long as there is room, as bytes: the core checks them as it checks those of tables.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "access/xact.h"
#include "catalog/pg_type.h"
#include "common/hashfn.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/mesh/mesh_pages.h"
#include "pg/remote/page_shelf.h"
#include "pg/remote/remote_pages.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_transaction.h"

#define CODE_LIMIT UINT64CONST(0x7FFFFFFFFFFFFFFF)
#define KINDS 2
/* Bytes of pages to ask for: at random places, and at most, as a share of what is kept. */
#define FEW_BYTES (ABACUS_PAGE_BYTES / 2)	/* mostly one page */
#define MOST_SHARE 8
#define LEAST_KEPT (4 * MOST_SHARE * ABACUS_PAGE_BYTES)

/* Columns of what servers return */
enum
{
	PAGE_CODE,
	PAGE_PART,
	PAGE_BYTES,
	PAGE_COLUMNS
};

/* The pages of a kind. */
typedef struct RemoteKind
{
	PageShelf	shelf;
	abacus_key	expected;		/* where the last ones ended */
	size_t		ahead;			/* bytes to ask for if reading goes on there */
} RemoteKind;

typedef struct RemotePages
{
	Oid			mesh;
	MemoryContext memory;
	MemoryContext state;		/* of what follows; NULL: the header has not been read */
	Generation	generation;
	ShardLinks	links;
	TupleDesc	columns;
	abacus_header *header;
	RemoteKind	kinds[KINDS];
} RemotePages;

/* ---- Pages from a server -------------------------------------------------------------------- */

/* Pages that arrive. One can be kept when it is known where the next one begins. */
typedef struct Arrival
{
	RemotePages *remote;
	PageShelf  *shelf;
	int			shard;
	bool		has_page;
	bool		has_ended;
	abacus_key	key;			/* of the page */
	size_t		size;
	unsigned char bytes[ABACUS_MAX_PAGE_BYTES];
} Arrival;

static void
refuse_pages(const Arrival *arrival)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATA_CORRUPTED),
			 errmsg("server \"%s\" returned pages that do not follow one another",
					arrival->remote->generation.servers[arrival->shard]),
			 errhint("Let coordinator and servers have the same version of abacus, and call abacus_check() for the mesh.")));
}

static void
take_page(void *context, HeapTuple row, TupleDesc desc)
{
	Arrival    *arrival = context;
	Datum		values[PAGE_COLUMNS];
	bool		isnull[PAGE_COLUMNS];
	abacus_key	key;

	heap_deform_tuple(row, desc, values, isnull);
	if (isnull[PAGE_CODE] || isnull[PAGE_PART] || arrival->has_ended)
		refuse_pages(arrival);
	key.code = (uint64) DatumGetInt64(values[PAGE_CODE]);
	key.part = (uint64) DatumGetInt64(values[PAGE_PART]);
	if (arrival->has_page)
	{
		if (key_compare(&arrival->key, &key) >= 0)
			refuse_pages(arrival);
		shelf_put(arrival->shelf, &arrival->key, &key, arrival->bytes, arrival->size);
	}
	arrival->key = key;
	arrival->has_page = !isnull[PAGE_BYTES];
	arrival->has_ended = isnull[PAGE_BYTES];
	if (arrival->has_page)
	{
		bytea	   *bytes = DatumGetByteaPP(values[PAGE_BYTES]);

		arrival->size = VARSIZE_ANY_EXHDR(bytes);
		if (arrival->size > sizeof(arrival->bytes))
			refuse_pages(arrival);
		memcpy(arrival->bytes, VARDATA_ANY(bytes), arrival->size);
	}
}

static RemoteKind *
kind_of(RemotePages *remote, abacus_page_kind kind)
{
	return &remote->kinds[kind == ABACUS_ATTRIBUTE_PAGES ? 1 : 0];
}

/* Gets the page that owns the key, and some that follow. */
static void
ask_for_pages(RemotePages *remote, abacus_page_kind kind, const abacus_key *key)
{
	RemoteKind *pages = kind_of(remote, kind);
	int			shard = (int) generation_owner(&remote->generation, abacus_key_code(kind, key));
	MemoryContext scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus arrival", ALLOCSET_DEFAULT_SIZES);
	MemoryContext old = MemoryContextSwitchTo(scratch);
	Arrival    *arrival = palloc(sizeof(Arrival));

	pages->ahead = key_compare(key, &pages->expected) == 0
		? Max(FEW_BYTES, Min(2 * pages->ahead, pages->shelf.most / MOST_SHARE)) : FEW_BYTES;
	*arrival = (Arrival) {
		.remote = remote,.shelf = &pages->shelf,.shard = shard
	};
	generation_require_seen(&remote->generation, &remote->links, shard);
	link_send(&remote->links, shard,
			  psprintf("SELECT code, part, page FROM abacus_shard_pages('%s', %u, %s, " INT64_FORMAT ", " INT64_FORMAT ", %zu)",
					   generation_mesh(&remote->generation, shard), kind, shard_sql_stretch(&remote->generation, shard),
					   (int64) key->code, (int64) key->part, pages->ahead));
	(void) link_each_row(&remote->links, shard, remote->columns, take_page, arrival);
	if (!arrival->has_ended)
		refuse_pages(arrival);
	pages->expected = arrival->key;
	MemoryContextSwitchTo(old);
	MemoryContextDelete(scratch);
}

/* ---- The core's operations ------------------------------------------------------------------ */

/* The page that owns the key; NULL if there is none. */
static const ShelfPage *
take(RemotePages *remote, abacus_page_kind kind, const abacus_key *key)
{
	const ShelfPage *page;

	if (remote->header->facts.census.simplices == 0 || key->code > CODE_LIMIT)
		return NULL;
	page = shelf_find(&kind_of(remote, kind)->shelf, key);
	if (page != NULL)
		return page;
	ask_for_pages(remote, kind, key);
	return shelf_find(&kind_of(remote, kind)->shelf, key);
}

static bool
remote_find(void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	RemotePages *remote = ((MeshPages *) owner)->remote;
	abacus_key	wanted = {Min(key.code, CODE_LIMIT), Min(key.part, CODE_LIMIT)};
	const ShelfPage *found = take(remote, kind, &wanted);

	if (found != NULL)
		*page = found->page;
	return found != NULL;
}

/* Its place is no short cut: the core looks for the page by its key. */
static bool
remote_fetch(void *owner, abacus_page_kind kind, abacus_page *page)
{
	return false;
}

static bool
remote_next(void *owner, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	RemotePages *remote = ((MeshPages *) owner)->remote;
	abacus_key	wanted = {0, 0};
	const ShelfPage *found;

	if (key != NULL)
	{
		found = take(remote, kind, key);
		if (found == NULL)
			return false;
		wanted = found->upper;
	}
	found = take(remote, kind, &wanted);
	if (found != NULL)
		*page = found->page;
	return found != NULL;
}

static void
remote_put(void *owner, abacus_page_kind kind, abacus_page *page)
{
	elog(ERROR, "pages of a mesh over several servers are not written");
}

static void
remote_erase(void *owner, abacus_page_kind kind, const abacus_page *page)
{
	elog(ERROR, "pages of a mesh over several servers are not written");
}

/* Points that are in no simplex are not shown as pages. */
static bool
find_none(void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	return false;
}

static bool
next_none(void *owner, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	return false;
}

static void
nothing(void *owner)
{
}

static const HostPageFunctions remote_functions = {
	remote_find, remote_fetch, remote_next, remote_put, remote_erase, nothing, nothing
};
static const HostPageFunctions no_points = {
	find_none, remote_fetch, next_none, remote_put, remote_erase, nothing, nothing
};

/* ---- The header ----------------------------------------------------------------------------- */

/* (Sub)transactions of the session that have ended, but for those that were released. */
static uint64 transactions_ended = 0;

static void
at_transaction_event(XactEvent event, void *arg)
{
	if (event == XACT_EVENT_COMMIT || event == XACT_EVENT_ABORT || event == XACT_EVENT_PREPARE)
		transactions_ended++;
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	if (event == SUBXACT_EVENT_ABORT_SUB)
		transactions_ended++;
}

static bool
has_changed(const ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
		if (shard_transaction_has_changed(links->connections[i]))
			return true;
	return false;
}

/*
 * A number that changes with the state of the mesh, and with the user: what one may read on the servers, another
 * may not. What a transaction has changed is a state of its own until it ends: if it is undone, its versions will
 * be those of other changes.
 */
static uint64
stamp_of(const Generation *generation, const ShardLinks *links)
{
	uint64		stamp = hash_bytes_extended((const unsigned char *) generation->token, (int) strlen(generation->token),
											(uint64) generation->number);

	stamp = hash_uint32_extended(GetUserId(), stamp);
	if (has_changed(links))
		stamp = hash_bytes_extended((const unsigned char *) &transactions_ended, sizeof(transactions_ended), stamp);
	return hash_bytes_extended((const unsigned char *) generation->versions,
							   generation->shards * (int) sizeof(generation->versions[0]), stamp);
}

static void
read_names(abacus_header *header, const Generation *generation)
{
	header->facts.columns.attributes = (uint32) generation->attribute_count;
	if (generation->attribute_count > ABACUS_MAX_ATTRIBUTES)
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("the table of mesh \"%s\" is damaged", get_rel_name(generation->relid)),
				 errdetail("It has more attributes than a mesh can have.")));
	for (int i = 0; i < generation->attribute_count; i++)
		strlcpy(header->names[i], generation->attributes[i], ABACUS_NAME_BYTES);
}

/* Adds what the shards own. */
static void
count_census(RemotePages *remote, abacus_census *census)
{
	const Generation *generation = &remote->generation;
	TupleDesc	columns = link_columns(3, (Oid[]) {INT8OID, INT8OID, INT8OID}, NULL);

	for (int i = 0; i < generation->shards; i++)
	{
		char	   *mesh = generation_mesh(generation, i);

		link_send(&remote->links, i,
				  psprintf("SELECT simplices, ghosts, greatest(vertices - (SELECT count(*) FROM %s_guests WHERE inserted), 0) "
						   "FROM abacus_shard_facts('%s', %s)", mesh, mesh, shard_sql_stretch(generation, i)));
	}
	for (int i = 0; i < generation->shards; i++)
	{
		LinkRows   *rows = link_rows(&remote->links, i, columns);

		census->simplices += (uint64) DatumGetInt64(link_value(rows, 0, 1));
		census->ghosts += (uint64) DatumGetInt64(link_value(rows, 0, 2));
		census->vertices += (uint64) DatumGetInt64(link_value(rows, 0, 3));
		link_rows_free(rows);
	}
	if (census->simplices == 0)
		census->vertices = 0;
}

/* The header of the mesh in its new state. What shards own is counted once in a session for each state. */
static void
make_header(RemotePages *remote, uint64 stamp)
{
	static struct
	{
		Oid			mesh;
		uint64		stamp;
		abacus_census census;
	}			counted;
	abacus_header *header = remote->header;
	abacus_facts *facts = &header->facts;

	MemSet(facts, 0, sizeof(*facts));
	MemSet(&header->counters, 0, sizeof(header->counters));
	facts->form = remote->generation.form;
	read_names(header, &remote->generation);
	facts->columns.apart = abacus_are_apart(facts->form.dimension, facts->columns.attributes);
	facts->standing = ABACUS_DELAUNAY;
	if (counted.mesh != remote->mesh || counted.stamp != stamp)
	{
		counted.mesh = InvalidOid;
		MemSet(&counted.census, 0, sizeof(counted.census));
		if (remote->generation.points > 0)
			count_census(remote, &counted.census);
		counted.mesh = remote->mesh;
		counted.stamp = stamp;
	}
	facts->census = counted.census;
	header->stamp = stamp;
}

/* Reads under the active snapshot which state of the mesh it sees. Pages of another one are forgotten. */
static void
remote_read_header(RemotePages *remote, abacus_header *header)
{
	MemoryContext former = remote->state;
	MemoryContext state = AllocSetContextCreate(remote->memory, "Abacus remote mesh", ALLOCSET_SMALL_SIZES);
	MemoryContext old;
	Generation	generation;
	ShardLinks	links;
	uint64		stamp;

	SPI_connect();
	remote->state = NULL;
	generation_read_links(remote->mesh, &generation, &links);
	old = MemoryContextSwitchTo(state);
	generation_copy(&remote->generation, &generation);
	remote->links = links;
	remote->links.servers = remote->generation.servers;
	remote->links.connections = palloc(links.count * sizeof(Connection *));
	memcpy(remote->links.connections, links.connections, links.count * sizeof(Connection *));
	remote->columns = link_columns(PAGE_COLUMNS, (Oid[]) {INT8OID, INT8OID, BYTEAOID}, NULL);
	stamp = stamp_of(&remote->generation, &remote->links);
	if (former == NULL || stamp != remote->header->stamp)
	{
		for (int i = 0; i < KINDS; i++)
			shelf_clear(&remote->kinds[i].shelf);
		make_header(remote, stamp);
	}
	MemoryContextSwitchTo(old);
	SPI_finish();
	remote->state = state;
	if (former != NULL)
		MemoryContextDelete(former);
	abacus_header_copy(header, remote->header);
}

/* ---- Opening -------------------------------------------------------------------------------- */

static RemotePages *
remote_open(Host *host, MeshPages *pages)
{
	RemotePages *remote = MemoryContextAllocZero(host->home, sizeof(RemotePages));

	remote->mesh = pages->mesh;
	remote->memory = host->home;
	remote->header = MemoryContextAllocZero(host->home, sizeof(abacus_header));
	for (int i = 0; i < KINDS; i++)
		shelf_init(&remote->kinds[i].shelf, host->home, Max(LEAST_KEPT, (size_t) work_mem * 1024 / KINDS));
	host_register_pages(host, ABACUS_SIMPLEX_PAGES, &remote_functions, pages);
	host_register_pages(host, ABACUS_ATTRIBUTE_PAGES, &remote_functions, pages);
	host_register_pages(host, ABACUS_STAGED_PAGES, &no_points, pages);
	host_register_pages(host, ABACUS_REPEATED_PAGES, &no_points, pages);
	return remote;
}

/* Meshes over several servers are read in this way from now on. */
void
remote_pages_init(void)
{
	static const RemoteMeshes functions = {remote_open, remote_read_header};

	mesh_pages_set_remote(&functions);
	RegisterXactCallback(at_transaction_event, NULL);
	RegisterSubXactCallback(at_subtransaction_event, NULL);
}

/*
 * shard_resolve.c: changes of shards that were prepared, and whose end is not known there: the coordinator, a
 * server or a connection failed between PREPARE TRANSACTION and COMMIT PREPARED.
 *
 * The name under which a change is prepared has the version that it gives the shard, and the number of the
 * coordinator's transaction. As long as that one is in progress, so is the change. After that, the row on the
 * coordinator says whether it was committed: it has this version, or a later one.
 */
#include "postgres.h"

#include "access/transam.h"
#include "catalog/pg_type.h"
#include "storage/procarray.h"
#include "utils/builtins.h"
#include "utils/snapmgr.h"

#include "pg/shards/shard_resolve.h"
#include "pg/shards/shard_sql.h"

typedef struct Doubt
{
	int			shard;
	char	   *name;
	int64		version;
} Doubt;

typedef struct Resolving
{
	const Generation *generation;
	int64		resolved;
} Resolving;

/* Whether the coordinator's transaction may still commit. */
static bool
is_in_progress(uint64 number)
{
	FullTransactionId id = FullTransactionIdFromU64(number);

	return FullTransactionIdPrecedes(id, ReadNextFullTransactionId()) &&
		ReadNextFullTransactionId().value - number < PG_INT32_MAX &&
		TransactionIdIsNormal(XidFromFullTransactionId(id)) && TransactionIdIsInProgress(XidFromFullTransactionId(id));
}

/* The changes of a shard that nobody is about to end. */
static List *
add_doubts(const Generation *generation, ShardLinks *links, int shard, List *doubts)
{
	char	   *prefix = generation_change_prefix(generation, shard);
	LinkRows   *rows;

	link_send(links, shard, shard_sql_prepared(generation, shard));
	rows = link_rows(links, shard, link_columns(1, (Oid[]) {TEXTOID}, NULL));
	for (uint64 i = 0; i < rows->count; i++)
	{
		Doubt	   *doubt = palloc(sizeof(Doubt));
		unsigned long long transaction;
		long long	version;

		doubt->shard = shard;
		doubt->name = TextDatumGetCString(link_value(rows, i, 1));
		if (strncmp(doubt->name, prefix, strlen(prefix)) != 0 ||
			sscanf(doubt->name + strlen(prefix), "_%lld_%llu", &version, &transaction) != 2 || is_in_progress(transaction))
			continue;
		doubt->version = version;
		doubts = lappend(doubts, doubt);
	}
	link_rows_free(rows);
	return doubts;
}

static void
resolve(ShardLinks *links, void *context)
{
	Resolving  *resolving = context;
	const Generation *generation = resolving->generation;
	Generation	newest = {0};
	List	   *doubts = NIL;
	ListCell   *cell;

	for (int i = 0; i < links->count; i++)
		doubts = add_doubts(generation, links, i, doubts);
	/* what these transactions have done to the row can be seen from now on */
	PushActiveSnapshot(GetLatestSnapshot());
	if (!generation_read_numbered(generation->relid, generation->number, &newest))
		newest.versions = palloc0(links->count * sizeof(int64));
	PopActiveSnapshot();
	foreach(cell, doubts)
	{
		const Doubt *doubt = lfirst(cell);
		bool		committed = doubt->version <= newest.versions[doubt->shard];

		link_do(links, doubt->shard, psprintf("%s PREPARED %s", committed ? "COMMIT" : "ROLLBACK",
											  quote_literal_cstr(doubt->name)));
		resolving->resolved++;
	}
}

/* Ends these changes; returns how many there were. */
int64
shard_resolve(const Generation *generation)
{
	Resolving	resolving = {generation};
	ShardLinks	links;

	links_prepare(&links, generation->servers, generation->shards);
	links_run(&links, resolve, &resolving);
	return resolving.resolved;
}

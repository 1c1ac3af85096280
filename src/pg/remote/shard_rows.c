/*
 * shard_rows.c: everything in a mesh over several servers, or in a window: the same functions, called on
 * the servers.
 *
 * Each simplex and each point belongs to one shard; each server returns what belongs to its own. Meshes on
 * the servers are those of one published generation, which no build changes. So all rows are of the same
 * mesh.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "funcapi.h"
#include "utils/tuplestore.h"

#include "pg/mesh/mesh.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/remote/shard_call.h"
#include "pg/remote/shard_read.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_sql.h"

/* Whether a function's first argument is a mesh over several servers. */
bool
is_over_shards(FunctionCallInfo fcinfo)
{
	const CachedMesh *cached;

	if (PG_ARGISNULL(0))
		return false;
	cached = mesh_cache_peek(PG_GETARG_OID(0));
	return cached == NULL ? mesh_is_sharded(PG_GETARG_OID(0)) : mesh_pages(cached->host)->remote != NULL;
}

typedef struct RowsRead
{
	FunctionCallInfo fcinfo;
	ReturnSetInfo *set;
	Generation	generation;
	ShardRows	rows;
} RowsRead;

static char *
owned_rows(const RowsRead *read, int shard)
{
	char	   *mesh = generation_mesh(&read->generation, shard);

	if (read->rows == ROWS_BY_CODE)
		return shard_sql_interval(&read->generation, shard, "r.code");
	return psprintf("NOT EXISTS (SELECT FROM %s_guests AS g WHERE g.x = r.x AND g.y = r.y AND "
					"g.z = coalesce(r.z, 0))", mesh);
}

static void
put_row(void *context, HeapTuple row, TupleDesc desc)
{
	ReturnSetInfo *set = context;

	tuplestore_puttuple(set->setResult, row);
}

static void
read_rows(RowsRead *read, ShardLinks *links)
{
	TupleDesc	columns = link_columns(0, NULL, read->set->setDesc);

	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("SELECT r.* FROM %s AS r WHERE %s",
									 shard_call(read->fcinfo, generation_mesh(&read->generation, i), 0, NULL),
									 owned_rows(read, i)));
	for (int i = 0; i < links->count; i++)
		(void) link_each_row(links, i, columns, put_row, read->set);
}

/* The rows of a function, of all shards. */
Datum
shard_read_rows(FunctionCallInfo fcinfo, ShardRows rows)
{
	RowsRead	read = {.fcinfo = fcinfo,.set = (ReturnSetInfo *) fcinfo->resultinfo,.rows = rows};
	ShardLinks	links;

	InitMaterializedSRF(fcinfo, 0);
	SPI_connect();
	generation_read_links(PG_GETARG_OID(0), &read.generation, &links);
	read_rows(&read, &links);
	SPI_finish();
	PG_RETURN_NULL();
}

/*
 * fn_shards.c: abacus_shards, the shards of a mesh over several servers, and abacus_shard_resolve, which ends
 * changes of theirs.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "funcapi.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/mesh.h"
#include "pg/shards/shard_resolve.h"
#include "pg/shards/shard_state.h"

SQL_FUNCTION(abacus_sql_shards);
SQL_FUNCTION(abacus_sql_shard_resolve);

/* Columns of the result */
enum
{
	SHARD_NUMBER,
	SHARD_SERVER,
	SHARD_MESH,
	SHARD_FIRST,
	SHARD_END,
	SHARD_STATE,
	SHARD_DOING,
	SHARD_POINTS,
	SHARD_GUESTS,
	SHARD_BYTES,
	SHARD_COLUMNS
};

typedef struct Listing
{
	ReturnSetInfo *set;
	const Generation *generation;
} Listing;

static void
put_shard(const Listing *listing, int shard, const ShardState *state)
{
	const Generation *generation = listing->generation;
	bool		has_borders = generation->borders != NULL;
	bool		isnull[SHARD_COLUMNS] = {
		[SHARD_FIRST] = !has_borders,[SHARD_END] = !has_borders || shard + 1 == generation->shards,
		[SHARD_DOING] = state->doing == NULL,[SHARD_POINTS] = !state->exists,[SHARD_GUESTS] = !state->exists,
		[SHARD_BYTES] = !state->exists
	};
	Datum		values[SHARD_COLUMNS] = {
		[SHARD_NUMBER] = Int32GetDatum(shard + 1),
		[SHARD_SERVER] = CStringGetTextDatum(generation->servers[shard]),
		[SHARD_MESH] = CStringGetTextDatum(generation_mesh(generation, shard)),
		[SHARD_STATE] = CStringGetTextDatum(state->exists ? phase_name(generation->phase) : "absent"),
		[SHARD_POINTS] = Int64GetDatum(state->points),[SHARD_GUESTS] = Int64GetDatum(state->guests),
		[SHARD_BYTES] = Int64GetDatum(state->bytes)
	};

	if (!isnull[SHARD_FIRST])
		values[SHARD_FIRST] = Int64GetDatum(shard == 0 ? 0 : (int64) generation->borders[shard - 1]);
	if (!isnull[SHARD_END])
		values[SHARD_END] = Int64GetDatum((int64) generation->borders[shard]);
	if (!isnull[SHARD_DOING])
		values[SHARD_DOING] = CStringGetTextDatum(state->doing);
	tuplestore_putvalues(listing->set->setResult, listing->set->setDesc, values, isnull);
}

static void
list_shards(ShardLinks *links, void *context)
{
	const Listing *listing = context;
	ShardState *states = shard_states(listing->generation, links);

	for (int i = 0; i < listing->generation->shards; i++)
		put_shard(listing, i, &states[i]);
}

/*
 * abacus_shards(mesh regclass)
 *     -> shard, server, mesh, first, end, state, doing, points, guests, bytes
 */
Datum
abacus_sql_shards(PG_FUNCTION_ARGS)
{
	Oid			relid = PG_GETARG_OID(0);
	Generation	generation;
	Listing		listing = {(ReturnSetInfo *) fcinfo->resultinfo, &generation};
	ShardLinks	links;

	InitMaterializedSRF(fcinfo, 0);
	mesh_require_sharded(relid);
	SPI_connect();
	if (generation_read(relid, false, &generation))
	{
		links_prepare(&links, generation.servers, generation.shards);
		links_run(&links, list_shards, &listing);
	}
	SPI_finish();
	PG_RETURN_NULL();
}

/* abacus_shard_resolve(mesh regclass) -> bigint */
Datum
abacus_sql_shard_resolve(PG_FUNCTION_ARGS)
{
	Oid			relid = PG_GETARG_OID(0);
	Generation	generation;
	int64		resolved;

	PreventCommandIfReadOnly("abacus_shard_resolve()");
	mesh_require_sharded(relid);
	SPI_connect();
	generation_require_published(relid, &generation);
	resolved = shard_resolve(&generation);
	SPI_finish();
	PG_RETURN_INT64(resolved);
}

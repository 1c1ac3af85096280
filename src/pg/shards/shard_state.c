/*
 * shard_state.c: what there is of each shard on its server.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "utils/builtins.h"

#include "pg/shards/shard_state.h"

#define STATE_COLUMNS \
	"points bigint, vertices bigint, duplicates bigint, guests bigint, bytes bigint, doing text"

static char *
state_query(const char *mesh)
{
	return psprintf("WITH figures AS MATERIALIZED (SELECT name, value::bigint AS value FROM abacus_stats('%1$s')), "
					"guests AS MATERIALIZED (SELECT count(*) AS n, count(*) FILTER (WHERE inserted) AS inserted "
					"FROM %1$s_guests) "
					"SELECT (SELECT value FROM figures WHERE name = 'points') - inserted, "
					"greatest((SELECT value FROM figures WHERE name = 'vertices') - inserted, 0), "
					"(SELECT value FROM figures WHERE name = 'duplicates'), n, "
					"pg_total_relation_size('%1$s') + pg_total_relation_size('%1$s_vertices') + "
					"pg_total_relation_size('%1$s_guests'), "
					"(SELECT min(phase) FROM abacus_progress WHERE mesh = '%1$s'::regclass) FROM guests",
					mesh);
}

static bool
exists(const Generation *generation, ShardLinks *links, int shard)
{
	bool		isnull;
	bool		is;

	link_send(links, shard, psprintf("SELECT to_regclass('%s') IS NOT NULL", generation_mesh(generation, shard)));
	(void) link_rows(links, shard, "exists boolean");
	is = DatumGetBool(SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull));
	SPI_freetuptable(SPI_tuptable);
	return is;
}

static void
read_state(ShardLinks *links, int shard, ShardState *state)
{
	int64	   *const figures[] = {&state->points, &state->vertices, &state->duplicates, &state->guests, &state->bytes};
	HeapTuple	row;
	TupleDesc	desc;

	(void) link_rows(links, shard, STATE_COLUMNS);
	row = SPI_tuptable->vals[0];
	desc = SPI_tuptable->tupdesc;
	for (int i = 0; i < lengthof(figures); i++)
	{
		bool		isnull;

		*figures[i] = DatumGetInt64(SPI_getbinval(row, desc, i + 1, &isnull));
	}
	state->doing = SPI_getvalue(row, desc, lengthof(figures) + 1);
	SPI_freetuptable(SPI_tuptable);
}

/* One for each shard; those without a mesh have nothing. */
ShardState *
shard_states(const Generation *generation, ShardLinks *links)
{
	ShardState *states = palloc0(generation->shards * sizeof(ShardState));

	for (int i = 0; i < generation->shards; i++)
	{
		states[i].exists = exists(generation, links, i);
		if (states[i].exists)
			link_send(links, i, state_query(generation_mesh(generation, i)));
	}
	for (int i = 0; i < generation->shards; i++)
		if (states[i].exists)
			read_state(links, i, &states[i]);
	return states;
}

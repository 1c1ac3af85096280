/*
 * shard_state.c: what there is of each shard on its server.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"

#include "pg/shards/shard_state.h"

/* Columns: the figures of ShardState, and what it does */
static const Oid state_columns[] = {INT8OID, INT8OID, INT8OID, INT8OID, INT8OID, TEXTOID};

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
					"coalesce((SELECT min(phase) FROM abacus_progress WHERE mesh = '%1$s'::regclass), "
					"(SELECT 'prepared: ' || min(gid) FROM pg_catalog.pg_prepared_xacts "
					"WHERE pg_catalog.starts_with(gid, '%1$s_'))) FROM guests",
					mesh);
}

static bool
exists(const Generation *generation, ShardLinks *links, int shard)
{
	link_send(links, shard, psprintf("SELECT count(to_regclass('%s'))", generation_mesh(generation, shard)));
	return link_int64(links, shard) > 0;
}

/* How many have no mesh. */
int
shard_count_missing(const Generation *generation, ShardLinks *links)
{
	int			missing = 0;

	for (int i = 0; i < generation->shards; i++)
		missing += !exists(generation, links, i);
	return missing;
}

static void
read_state(ShardLinks *links, int shard, ShardState *state)
{
	int64	   *const figures[] = {&state->points, &state->vertices, &state->duplicates, &state->guests, &state->bytes};
	LinkRows   *rows = link_rows(links, shard, link_columns(lengthof(state_columns), state_columns, NULL));
	Datum		doing;
	bool		isnull;

	for (int i = 0; i < lengthof(figures); i++)
		*figures[i] = DatumGetInt64(link_value(rows, 0, i + 1));
	doing = link_value_or_null(rows, 0, lengthof(figures) + 1, &isnull);
	state->doing = isnull ? NULL : TextDatumGetCString(doing);
	link_rows_free(rows);
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

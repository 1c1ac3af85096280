/*
 * exchange.c: the later phases of a build over several servers: each triangulates its own points, and
 * then they send each other vertices until none is missing (docs/design/servers.md).
 *
 * A round is a transaction on each server: guests come, and are inserted. Guests that are there already
 * are left out. So a round can be repeated, and what a failed call has committed is only a part of the
 * work of the next one.
 */
#include "postgres.h"

#include "miscadmin.h"

#include "utils/lsyscache.h"

#include "pg/mesh/notices.h"
#include "pg/shards/build_progress.h"
#include "pg/shards/exchange.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_state.h"

static void
send_to_all(ShardLinks *links, const char *statement)
{
	for (int i = 0; i < links->count; i++)
		link_send(links, i, statement);
}

static void
finish_all(ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
}

/* Each server inserts the points that wait, in a transaction of its own. */
void
triangulate_shards(Generation *generation, ShardLinks *links)
{
	build_progress(SHOWN_TRIANGULATING, 0, links->count, 0);
	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("%s; %s", shard_sql_take(generation, i), shard_sql_taken(generation, i)));
	for (int i = 0; i < links->count; i++)
	{
		link_finish(links, i);
		build_progress_add(1);
	}
}

/*
 * A round; returns how many vertices were sent. A server whose mesh has not changed since it searched last
 * has nothing new to send; `changed` says which ones have, and then, which do.
 */
static int64
exchange_once(const Generation *generation, ShardLinks *links, bool *changed)
{
	int64		sent = 0;

	for (int i = 0; i < links->count; i++)
		link_send(links, i, changed[i] ? psprintf("BEGIN; %s", shard_sql_export(generation, i)) : "BEGIN");
	finish_all(links);
	for (int i = 0; i < links->count; i++)
		if (changed[i])
			sent += relay_exported(generation, links, i, shard_sql_receive);
	finish_all(links);
	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_take(generation, i));
	for (int i = 0; i < links->count; i++)
		changed[i] = link_int64(links, i) > 0;
	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("%s; COMMIT", shard_sql_taken(generation, i)));
	finish_all(links);
	return sent;
}

/* Each server counts those that it owns. */
static int64
count_simplices(const Generation *generation, ShardLinks *links)
{
	int64		count = 0;

	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_count(generation, i));
	for (int i = 0; i < links->count; i++)
		count += link_int64(links, i);
	return count;
}

/* Reports what a single server would have reported of all points. */
static void
report_points(const Generation *generation, ShardLinks *links)
{
	const char *mesh = get_rel_name(generation->relid);
	ShardState *states = shard_states(generation, links);
	int64		duplicates = 0;

	for (int i = 0; i < generation->shards; i++)
		duplicates += states[i].duplicates;
	if (generation->simplices > 0)
		notice_equal_points(mesh, (uint64) duplicates, false);
	else
		notice_waiting_points(mesh, generation->form.dimension, (uint64) generation->points);
}

void
exchange_vertices(Generation *generation, ShardLinks *links)
{
	int64		sent;
	bool	   *changed = palloc(links->count * sizeof(bool));

	memset(changed, true, links->count * sizeof(bool));
	generation->rounds = 0;
	generation->sent = 0;
	send_to_all(links, shard_sql_begin_exchange());
	finish_all(links);
	do
	{
		CHECK_FOR_INTERRUPTS();
		build_progress(SHOWN_EXCHANGING, generation->sent, 0, generation->rounds + 1);
		sent = exchange_once(generation, links, changed);
		generation->sent += sent;
		generation->rounds++;
	} while (sent > 0);
	send_to_all(links, shard_sql_end_exchange());
	finish_all(links);
	generation->simplices = count_simplices(generation, links);
	report_points(generation, links);
}

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

#include "pg/shards/exchange.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_sql.h"

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
	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_take(generation, i));
	finish_all(links);
}

/* A round; returns how many vertices were sent. */
static int64
exchange_once(const Generation *generation, ShardLinks *links)
{
	int64		sent = 0;

	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("BEGIN; %s", shard_sql_export(generation, i)));
	finish_all(links);
	for (int i = 0; i < links->count; i++)
		sent += relay_exported(generation, links, i, shard_sql_receive);
	finish_all(links);
	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("%s; COMMIT", shard_sql_take(generation, i)));
	finish_all(links);
	return sent;
}

/* Each server counts those that it owns. */
static int64
count_simplices(const Generation *generation, ShardLinks *links)
{
	int64		count = 0;

	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("SELECT abacus_shard_count('%s', %s)", generation_mesh(generation, i),
									 shard_sql_stretch(generation, i)));
	for (int i = 0; i < links->count; i++)
		count += link_int64(links, i);
	return count;
}

void
exchange_vertices(Generation *generation, ShardLinks *links)
{
	int64		sent;

	generation->rounds = 0;
	generation->sent = 0;
	send_to_all(links, shard_sql_begin_exchange());
	finish_all(links);
	do
	{
		CHECK_FOR_INTERRUPTS();
		sent = exchange_once(generation, links);
		generation->sent += sent;
		generation->rounds++;
	} while (sent > 0);
	send_to_all(links, shard_sql_end_exchange());
	finish_all(links);
	generation->simplices = count_simplices(generation, links);
}

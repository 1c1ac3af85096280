/*
 * shard_steps.c: the steps of a change of a mesh over several servers.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "miscadmin.h"

#include "pg/mesh/header.h"
#include "pg/shards/change/shard_steps.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_transaction.h"

/* Columns that abacus_shard_change returns */
static const Oid change_columns[] = {
	BOOLOID, INT8OID, INT8OID, INT8OID, INT8OID, INT8OID, FLOAT8ARRAYOID, INT8OID, INT8OID, INT8OID, INT8OID, BOOLOID
};

enum
{
	CHANGE_CREATED,
	CHANGE_POINTS = 7,
	CHANGE_MORE,
	CHANGE_DUPLICATES,
	CHANGE_GAINED,
	CHANGE_IS_ALL_NEW,
	CHANGE_COLUMNS
};
StaticAssertDecl(CHANGE_COLUMNS == lengthof(change_columns), "the columns of abacus_shard_change");

/* ---- Steps on a shard ----------------------------------------------------------------------- */

void
step_will_change(ShardChange *change, int shard)
{
	change->parts[shard].is_touched = true;
	shard_transaction_change(change->links.connections[shard], generation_change_prefix(change->generation, shard));
}

static void
take_row(void *context, HeapTuple row, TupleDesc desc)
{
	ShardChange *change = context;
	Datum		values[CHANGE_COLUMNS];
	bool		isnull[CHANGE_COLUMNS];
	int64		points;

	heap_deform_tuple(row, desc, values, isnull);
	if (!isnull[CHANGE_CREATED])
	{
		if (change->net != NULL)
			shard_net_add(change->net, values, isnull);
		return;
	}
	points = DatumGetInt64(link_row_value(row, desc, CHANGE_POINTS + 1));
	change->points += points;
	change->more += DatumGetInt64(link_row_value(row, desc, CHANGE_MORE + 1));
	change->duplicates += DatumGetInt64(link_row_value(row, desc, CHANGE_DUPLICATES + 1));
	change->generation->simplices += DatumGetInt64(link_row_value(row, desc, CHANGE_GAINED + 1));
	if (points == 0)
		return;
	change->part->is_changed = change->part->is_active = true;
	change->part->is_all_new |= DatumGetBool(link_row_value(row, desc, CHANGE_IS_ALL_NEW + 1));
}

/* Shards chosen by `which` insert or delete what has come, side by side. Returns how many points that were. */
int64
step_run(ShardChange *change, const bool *which, Arrival kind, const char *how)
{
	ShardLinks *links = &change->links;
	TupleDesc	columns = link_columns(lengthof(change_columns), change_columns, NULL);

	change->points = change->more = change->duplicates = 0;
	for (int i = 0; i < links->count; i++)
		if (which[i])
		{
			link_finish(links, i);
			link_send(links, i, shard_sql_change(change->generation, i, kind, how, change->net != NULL));
		}
	for (int i = 0; i < links->count; i++)
		if (which[i])
		{
			change->part = &change->parts[i];
			(void) link_each_row(links, i, columns, take_row, change);
		}
	return change->points;
}

/* ---- The query's points --------------------------------------------------------------------- */

/* Sends points to their owner. Others get them too if their guests there may change. */
static void
send_points(ShardChange *change, int owner)
{
	PointBatch *batch = &change->parts[owner].batch;

	for (int i = 0; i < change->links.count && change->tells && batch->points > 0; i++)
	{
		if (i == owner)
			continue;
		step_will_change(change, i);
		link_finish(&change->links, i);
		link_send(&change->links, i, shard_sql_arrive_named(change->generation, owner, i, batch));
	}
	relay_batch(change->generation, &change->links, owner, owner, batch, shard_sql_arrive_point);
}

/* The source's rows have the shape of the header, which may have other attributes than the mesh. */
static void
deal_out(ShardChange *change, const uint64 *record, bool widens)
{
	Generation *generation = change->generation;
	const double *point = (const double *) (record + 1);
	int			dimension = (int) generation->form.dimension;
	abacus_error error;
	uint64		code;
	int			owner;

	if (abacus_codes(&generation->form, point, 1, &code, &error) != ABACUS_OK)
		elog(ERROR, "could not compute a code: %s", error.message);
	for (int i = 0; widens && i < dimension; i++)
	{
		generation->extent.lower[i] = Min(generation->extent.lower[i], point[i]);
		generation->extent.upper[i] = Max(generation->extent.upper[i], point[i]);
	}
	owner = (int) generation_owner(generation, code);
	if (change->parts[owner].batch.points == 0)
		step_will_change(change, owner);
	point_batch_add(&change->parts[owner].batch, (int64) record[0], point, point + dimension);
	change->parts[owner].is_active = true;
	if (point_batch_is_full(&change->parts[owner].batch))
		send_points(change, owner);
}

/* Returns how many there are; `owners` says which shards have got any. */
uint64
step_read_points(ShardChange *change, Source *source, bool widens, bool *owners)
{
	Generation *generation = change->generation;
	abacus_names names = abacus_names_of(change->header);
	int			attributes = (int) names.facts->columns.attributes;
	int			words = 1 + (int) generation->form.dimension + attributes;
	const uint64 *points;
	size_t		count;
	uint64		all = 0;

	for (int i = 0; i < generation->shards; i++)
		point_batch_init(&change->parts[i].batch, generation->form.dimension, attributes);
	source_open(source, names, false);
	while ((count = source_fetch(source, &points)) > 0)
	{
		for (size_t i = 0; i < count; i++)
			deal_out(change, points + i * words, widens);
		all += count;
	}
	source_close(source);
	for (int i = 0; i < generation->shards; i++)
	{
		send_points(change, i);
		owners[i] = change->parts[i].is_active;
		change->parts[i].is_active = false;
	}
	return all;
}

/* ---- Guests --------------------------------------------------------------------------------- */

/* Shards with guests at places of the query's points ask the owners; `asked`: these. */
static void
ask_owners(ShardChange *change, bool *asked)
{
	ShardLinks *links = &change->links;
	LinkRows  **first = palloc0(links->count * sizeof(LinkRows *));

	for (int i = 0; i < links->count; i++)
		if (change->parts[i].is_touched)
		{
			link_finish(links, i);
			relay_begin_query(links, i, shard_sql_named(change->generation, i));
		}
	for (int i = 0; i < links->count; i++)
		if (change->parts[i].is_touched)
			first[i] = relay_first_rows(links, i);
	for (int i = 0; i < links->count; i++)
		if (first[i] != NULL)
		{
			bool		any = first[i]->count > 0;
			int64	   *sent = relay_query(change->generation, links, i, first[i], shard_sql_arrive_asked);

			for (int to = 0; to < links->count; to++)
				asked[to] |= sent[to] > 0;
			if (any)
				link_send(links, i, shard_sql_forget_named(change->generation, i));
		}
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
}

/* Shards tell the others of their vertices at these places, or of those that have gone. */
static void
tell_states(ShardChange *change, const bool *owners, bool gone, bool *told)
{
	ShardLinks *links = &change->links;
	LinkRows  **first = palloc0(links->count * sizeof(LinkRows *));

	for (int i = 0; i < links->count; i++)
		if (owners[i])
		{
			link_finish(links, i);
			relay_begin_query(links, i, shard_sql_states(change->generation, i, gone));
		}
	for (int i = 0; i < links->count; i++)
		if (owners[i])
			first[i] = relay_first_rows(links, i);
	for (int i = 0; i < links->count; i++)
		if (owners[i])
		{
			int64	   *sent;

			for (int to = 0; to < links->count; to++)
				if (to != i && first[i]->count > 0)
					step_will_change(change, to);
			sent = relay_query(change->generation, links, i, first[i], gone ? shard_sql_arrive_gone : shard_sql_arrive_other);
			for (int to = 0; to < links->count; to++)
				told[to] |= sent[to] > 0;
		}
}

/* Guests of other shards become as their owners have them. */
void
step_follow_owners(ShardChange *change)
{
	static const Oid counts[] = {INT8OID, INT8OID, INT8OID};
	Generation *generation = change->generation;
	ShardLinks *links = &change->links;
	bool	   *asked = palloc0(links->count * sizeof(bool));
	bool	   *told = palloc0(links->count * sizeof(bool));
	bool	   *which[3];

	ask_owners(change, asked);
	tell_states(change, asked, true, told);
	tell_states(change, asked, false, told);
	for (int kind = 0; kind < lengthof(which); kind++)
		which[kind] = palloc0(links->count * sizeof(bool));
	for (int i = 0; i < links->count; i++)
		if (told[i])
		{
			link_finish(links, i);
			link_send(links, i, shard_sql_arrived(generation, i));
		}
	for (int i = 0; i < links->count; i++)
		if (told[i])
		{
			LinkRows   *rows = link_rows(links, i, link_columns(lengthof(counts), counts, NULL));

			for (int kind = 0; kind < lengthof(which); kind++)
				which[kind][i] = DatumGetInt64(link_value(rows, 0, kind + 1)) > 0;
			link_rows_free(rows);
		}
	(void) step_run(change, which[1], ARRIVES_GONE, "delete");
	(void) step_run(change, which[0], ARRIVES_GUEST, "keep");
	for (int i = 0; i < links->count; i++)
		if (which[2][i])
		{
			link_send(links, i, shard_sql_update(generation, i, ARRIVES_OTHER, generation->attributes,
												 generation->attribute_count));
			change->parts[i].is_changed = true;
		}
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
}

/* What comes from now on is of the next round. */
static void
clear_arrivals(ShardChange *change, const bool *which)
{
	for (int i = 0; i < change->links.count; i++)
		if (which[i])
			link_send(&change->links, i, shard_sql_clear(change->generation, i));
}

/* Active shards send what others need; returns whether there were any. */
static bool
send_round(ShardChange *change)
{
	Generation *generation = change->generation;
	ShardLinks *links = &change->links;
	LinkRows  **first = palloc0(links->count * sizeof(LinkRows *));
	bool	   *which = palloc0(links->count * sizeof(bool));
	bool		any = false;

	for (int i = 0; i < links->count; i++)
	{
		Part	   *part = &change->parts[i];

		if (!part->is_active)
			continue;
		link_finish(links, i);
		relay_begin_query(links, i, shard_sql_exports_around(generation, i, part->is_all_new));
		any = which[i] = true;
		part->is_active = part->is_all_new = false;
	}
	for (int i = 0; i < links->count; i++)
		if (which[i])
			first[i] = relay_first_rows(links, i);
	clear_arrivals(change, which);
	for (int i = 0; i < links->count; i++)
		if (which[i])
		{
			int64	   *sent;

			link_finish(links, i);
			for (int to = 0; to < links->count; to++)
				if (to != i && first[i]->count > 0)
					step_will_change(change, to);
			sent = relay_query(generation, links, i, first[i], shard_sql_arrive_guest);
			for (int to = 0; to < links->count; to++)
				change->parts[to].has_new_guests |= sent[to] > 0;
		}
	return any;
}

void
step_exchange(ShardChange *change)
{
	ShardLinks *links = &change->links;
	bool	   *which = palloc(links->count * sizeof(bool));

	while (send_round(change))
	{
		CHECK_FOR_INTERRUPTS();
		for (int i = 0; i < links->count; i++)
		{
			which[i] = change->parts[i].has_new_guests;
			change->parts[i].has_new_guests = false;
		}
		(void) step_run(change, which, ARRIVES_GUEST, "keep");
	}
}

/*
 * relay.c: points from one server to others, by way of the coordinator.
 *
 * A server has them in a temporary table, from which some thousand are read at a time: the coordinator
 * never holds all of them.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/float.h"
#include "utils/memutils.h"

#include "pg/shards/relay.h"
#include "pg/shards/shard_sql.h"

#define ROWS_A_TIME 4096

/* Columns of what is exported, and of what was split off */
static const Oid export_columns[] = {INT4OID, INT8OID, FLOAT8OID, FLOAT8OID, FLOAT8OID, FLOAT8ARRAYOID};
static const Oid split_columns[] = {INT4OID, BYTEAOID};

typedef struct Relay
{
	const Generation *generation;
	ShardLinks *links;
	int			from;
	RelayStatement statement;
	PointBatch *batches;		/* for each receiver */
	double	   *attributes;
	int64	   *sent;			/* to each */
} Relay;

/* Sends a batch, unless it is empty, when the server has dealt with what was sent before. */
void
relay_batch(const Generation *generation, ShardLinks *links, int from, int to, PointBatch *batch,
			RelayStatement statement)
{
	MemoryContext scratch;
	MemoryContext old;

	if (batch->points == 0)
		return;
	link_finish(links, to);
	scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus batch", ALLOCSET_DEFAULT_SIZES);
	old = MemoryContextSwitchTo(scratch);
	link_send(links, to, statement(generation, from, to, batch));
	MemoryContextSwitchTo(old);
	MemoryContextDelete(scratch);
	point_batch_clear(batch);
}

/* ---- Points that are spread, as bytes ------------------------------------------------------- */

/* Sends points of a query to a server, unless there are none; then the bytes are empty. */
void
relay_bytes(ShardLinks *links, int from, int to, StringInfo bytes)
{
	char	   *text;
	char	   *statement;

	if (bytes->len == 0)
		return;
	text = palloc(2 * bytes->len + 1);
	text[hex_encode(bytes->data, bytes->len, text)] = '\0';
	statement = shard_sql_arrive(from, to, text);
	link_finish(links, to);
	link_send(links, to, statement);
	pfree(statement);
	pfree(text);
	resetStringInfo(bytes);
}

typedef struct SplitRelay
{
	ShardLinks *links;
	int			from;
	StringInfoData bytes;
} SplitRelay;

static void
relay_split_row(void *context, HeapTuple row, TupleDesc desc)
{
	SplitRelay *relay = context;
	int			to = DatumGetInt32(link_row_value(row, desc, 1));
	bytea	   *points = DatumGetByteaPP(link_row_value(row, desc, 2));

	if (to < 0 || to >= relay->links->count || to == relay->from)
		elog(ERROR, "server \"%s\" sends points to shard %d", relay->links->servers[relay->from], to);
	appendBinaryStringInfo(&relay->bytes, VARDATA_ANY(points), (int) VARSIZE_ANY_EXHDR(points));
	relay_bytes(relay->links, relay->from, to, &relay->bytes);
}

/* Passes on what a server has split off its own query. The points are not unpacked here. */
void
relay_split(ShardLinks *links, int from)
{
	SplitRelay	relay = {links, from};

	initStringInfo(&relay.bytes);
	link_finish(links, from);
	link_send(links, from, shard_sql_split_rows(from));
	(void) link_each_row(links, from, link_columns(lengthof(split_columns), split_columns, NULL), relay_split_row, &relay);
	pfree(relay.bytes.data);
}

/* ---- Guests --------------------------------------------------------------------------------- */

/* Reads attributes; NaN stands for one that is missing. */
static void
read_attributes(Datum array, double *attributes, int count)
{
	Datum	   *values;
	bool	   *nulls;
	int			found;

	deconstruct_array(DatumGetArrayTypeP(array), FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
					  &values, &nulls, &found);
	for (int i = 0; i < count; i++)
		attributes[i] = i >= found || nulls[i] ? get_float8_nan() : DatumGetFloat8(values[i]);
	pfree(values);
	pfree(nulls);
}

static void
relay_row(Relay *relay, HeapTuple row, TupleDesc desc)
{
	Datum		values[lengthof(export_columns)];
	double		point[ABACUS_MAX_DIMENSION];
	int			to;

	for (int i = 0; i < lengthof(values); i++)
		values[i] = link_row_value(row, desc, i + 1);
	to = DatumGetInt32(values[0]);
	if (to < 0 || to >= relay->generation->shards || to == relay->from)
		elog(ERROR, "server \"%s\" sends points to shard %d", relay->links->servers[relay->from], to);
	for (int axis = 0; axis < ABACUS_MAX_DIMENSION; axis++)
		point[axis] = DatumGetFloat8(values[2 + axis]);
	read_attributes(values[5], relay->attributes, relay->generation->attribute_count);
	relay->sent[to]++;
	point_batch_add(&relay->batches[to], DatumGetInt64(values[1]), point, relay->attributes);
	if (point_batch_is_full(&relay->batches[to]))
		relay_batch(relay->generation, relay->links, relay->from, to, &relay->batches[to], relay->statement);
}

static void
begin_relay(Relay *relay, const Generation *generation, ShardLinks *links, int from, RelayStatement statement)
{
	*relay = (Relay) {generation, links, from, statement};
	relay->attributes = palloc(Max(1, generation->attribute_count) * sizeof(double));
	relay->batches = palloc(generation->shards * sizeof(PointBatch));
	relay->sent = palloc0(generation->shards * sizeof(int64));
	for (int i = 0; i < generation->shards; i++)
		point_batch_init(&relay->batches[i], generation->form.dimension, generation->attribute_count);
}

/* Frees the rows; returns how many they were. */
static uint64
relay_rows(Relay *relay, LinkRows *rows)
{
	uint64		count = rows->count;

	for (uint64 i = 0; i < count; i++)
		relay_row(relay, rows->rows[i], rows->desc);
	link_rows_free(rows);
	return count;
}

static void
end_relay(Relay *relay)
{
	for (int i = 0; i < relay->generation->shards; i++)
		relay_batch(relay->generation, relay->links, relay->from, i, &relay->batches[i], relay->statement);
}

static LinkRows *
fetch(ShardLinks *links, int from)
{
	return link_rows(links, from, link_columns(lengthof(export_columns), export_columns, NULL));
}

/* Passes on what a server has to send, in its temporary table; returns how many points that were. */
int64
relay_exported(const Generation *generation, ShardLinks *links, int from, RelayStatement statement)
{
	Relay		relay;
	int64		sent = 0;
	uint64		count;

	begin_relay(&relay, generation, links, from, statement);
	link_finish(links, from);
	do
	{
		link_send(links, from, shard_sql_exported(sent, sent + ROWS_A_TIME));
		count = relay_rows(&relay, fetch(links, from));
		sent += (int64) count;
	} while (count == ROWS_A_TIME);
	end_relay(&relay);
	return sent;
}

/* Sends a query whose rows have these columns; what it reads is read when the first rows have come. */
void
relay_begin_query(ShardLinks *links, int from, const char *query)
{
	link_send(links, from, psprintf("DECLARE abacus_relay NO SCROLL CURSOR FOR %s; FETCH %d FROM abacus_relay", query,
									ROWS_A_TIME));
}

LinkRows *
relay_first_rows(ShardLinks *links, int from)
{
	return fetch(links, from);
}

/* Passes on these rows and those that follow. Returns to whom: numbers of points, by shard. */
int64 *
relay_query(const Generation *generation, ShardLinks *links, int from, LinkRows *first, RelayStatement statement)
{
	Relay		relay;
	uint64		count;

	begin_relay(&relay, generation, links, from, statement);
	for (count = relay_rows(&relay, first); count == ROWS_A_TIME; count = relay_rows(&relay, fetch(links, from)))
	{
		link_finish(links, from);
		link_send(links, from, psprintf("FETCH %d FROM abacus_relay", ROWS_A_TIME));
	}
	link_finish(links, from);
	link_do(links, from, "CLOSE abacus_relay");
	end_relay(&relay);
	return relay.sent;
}

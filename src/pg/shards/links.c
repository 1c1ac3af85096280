/*
 * links.c: connections to the servers of a mesh's shards, over foreign servers and user mappings that
 * the user has made. So passwords stay where PostgreSQL keeps them.
 *
 * A query is sent to each server, and then the results are collected: so servers work side by side.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "access/xact.h"
#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/memutils.h"

#include "pg/shards/links.h"

#define FIRST_ROOM 64

/* Connects to no server yet. */
void
links_prepare(ShardLinks *links, char **servers, int count)
{
	if (IsInParallelMode())
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TRANSACTION_STATE),
				 errmsg("cannot access a mesh over several servers in a parallel query"),
				 errhint("SET max_parallel_workers_per_gather = 0 for this query.")));
	links->count = count;
	links->servers = servers;
	links->connections = palloc0(count * sizeof(Connection *));
}

/* Connects to the servers to which the session has no connection yet, for a mesh, of a transaction. */
void
links_open(ShardLinks *links, ConnectionKind kind, Oid mesh)
{
	for (int i = 0; i < links->count; i++)
		links->connections[i] = connection_get(links->servers[i], i, kind, mesh);
}

/* Opens connections and does the work with them. After an error they are closed. */
void
links_run(ShardLinks *links, void (*work) (ShardLinks *links, void *context), void *context)
{
	links_open(links, CONNECTION_OF_BUILD, InvalidOid);
	for (int i = 0; i < links->count; i++)
		connection_hold(links->connections[i]);
	work(links, context);
	for (int i = 0; i < links->count; i++)
		connection_let_go(links->connections[i]);
}

/* ---- Queries -------------------------------------------------------------------------------- */

/* Sends a query, or several, to a server that has none to answer. */
void
link_send(ShardLinks *links, int i, const char *query)
{
	connection_send(links->connections[i], query);
}

/*
 * Calls take() for each row of the single query that was sent, whose columns have these types. Returns how
 * many they are.
 */
uint64
link_each_row(ShardLinks *links, int i, TupleDesc columns, ConnectionRow take, void *context)
{
	return connection_rows(links->connections[i], columns, take, context);
}

static void
keep_row(void *context, HeapTuple row, TupleDesc desc)
{
	LinkRows   *rows = context;
	MemoryContext old = MemoryContextSwitchTo(rows->memory);

	if (rows->rows == NULL)
	{
		rows->room = FIRST_ROOM;
		rows->rows = palloc(rows->room * sizeof(HeapTuple));
	}
	else if (rows->count == rows->room)
	{
		rows->room *= 2;
		rows->rows = repalloc_huge(rows->rows, rows->room * sizeof(HeapTuple));
	}
	rows->rows[rows->count++] = heap_copytuple(row);
	MemoryContextSwitchTo(old);
}

/* All these rows. */
LinkRows *
link_rows(ShardLinks *links, int i, TupleDesc columns)
{
	MemoryContext memory = AllocSetContextCreate(CurrentMemoryContext, "Abacus rows", ALLOCSET_DEFAULT_SIZES);
	LinkRows   *rows = MemoryContextAllocZero(memory, sizeof(LinkRows));

	rows->memory = memory;
	rows->server = links->servers[i];
	rows->desc = columns;
	(void) link_each_row(links, i, columns, keep_row, rows);
	return rows;
}

void
link_rows_free(LinkRows *rows)
{
	MemoryContextDelete(rows->memory);
}

/* The single number that a query returns. */
int64
link_int64(ShardLinks *links, int i)
{
	LinkRows   *rows = link_rows(links, i, link_columns(1, (Oid[]) {INT8OID}, NULL));
	int64		number = DatumGetInt64(link_value(rows, 0, 1));

	link_rows_free(rows);
	return number;
}

/* Waits for what was sent, and leaves its rows out. */
void
link_finish(ShardLinks *links, int i)
{
	connection_finish(links->connections[i]);
}

/* Sends them and waits. */
void
link_do(ShardLinks *links, int i, const char *commands)
{
	link_send(links, i, commands);
	link_finish(links, i);
}

/* ---- Rows ----------------------------------------------------------------------------------- */

/* Columns of these types, and behind them those of another row, or none. */
TupleDesc
link_columns(int count, const Oid *types, TupleDesc more)
{
	int			others = more == NULL ? 0 : more->natts;
	TupleDesc	columns = CreateTemplateTupleDesc(count + others);

	for (int i = 0; i < count; i++)
		TupleDescInitEntry(columns, (AttrNumber) (i + 1), NULL, types[i], -1, 0);
	for (int i = 0; i < others; i++)
		TupleDescInitEntry(columns, (AttrNumber) (count + i + 1), NULL, TupleDescAttr(more, i)->atttypid,
						   TupleDescAttr(more, i)->atttypmod, 0);
	return columns;
}

/* A value, from column 1 on, that is not NULL. */
Datum
link_row_value(HeapTuple row, TupleDesc desc, int column)
{
	bool		isnull;
	Datum		value = heap_getattr(row, column, desc, &isnull);

	if (isnull)
		ereport(ERROR,
				(errcode(ERRCODE_FDW_ERROR),
				 errmsg("a server of the mesh returned NULL in column %d", column),
				 errhint("Let coordinator and servers have the same version of abacus.")));
	return value;
}

Datum
link_value(const LinkRows *rows, uint64 row, int column)
{
	if (row >= rows->count)
		ereport(ERROR,
				(errcode(ERRCODE_FDW_ERROR),
				 errmsg("server \"%s\" returned no row", rows->server)));
	return link_row_value(rows->rows[row], rows->desc, column);
}

Datum
link_value_or_null(const LinkRows *rows, uint64 row, int column, bool *isnull)
{
	if (row >= rows->count)
		ereport(ERROR,
				(errcode(ERRCODE_FDW_ERROR),
				 errmsg("server \"%s\" returned no row", rows->server)));
	return heap_getattr(rows->rows[row], column, rows->desc, isnull);
}

/*
 * links.c: connections to the servers of a mesh's shards, by dblink, over foreign servers and user
 * mappings that the user has made. So passwords stay where PostgreSQL keeps them, and dblink's
 * checks of who may connect apply.
 *
 * A query is sent to each server, and then the results are collected: so servers work side by side.
 * dblink waits for a result without looking at interrupts, in older versions; so its question whether
 * the result is there is asked instead, with short sleeps in between.
 *
 * Connections stay open for the next call of the session. They outlive a failure of the local
 * transaction, with whatever runs there. So all that uses them runs under links_run(): after an error
 * it cancels and closes them, and an open transaction of a server ends.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/pg_foreign_server.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "foreign/foreign.h"
#include "miscadmin.h"
#include "storage/latch.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/resowner.h"
#include "utils/wait_event.h"

#include "pg/port/port.h"
#include "pg/shards/links.h"

/* Checks before sleeping; later checks between short sleeps; then longer ones. */
#define QUICK_LOOKS 20
#define SHORT_SLEEP 1			/* ms */
#define SHORT_LOOKS 1000
#define LONG_SLEEP 5

/* ---- Calls of dblink ----------------------------------------------------------------------- */

/* Runs a query of dblink's functions with up to two texts as arguments; keeps the memory context. */
static void
ask(const char *query, const char *first, const char *second)
{
	MemoryContext caller = CurrentMemoryContext;
	MemoryContext scratch = AllocSetContextCreate(caller, "Abacus link", ALLOCSET_DEFAULT_SIZES);
	Oid			types[] = {TEXTOID, TEXTOID};
	Datum		values[2];
	int			status;

	MemoryContextSwitchTo(scratch);
	values[0] = CStringGetTextDatum(first);
	values[1] = second == NULL ? (Datum) 0 : CStringGetTextDatum(second);
	status = SPI_execute_with_args(query, second == NULL ? 1 : 2, types, values, NULL, false, 0);
	MemoryContextSwitchTo(caller);
	MemoryContextDelete(scratch);
	if (status != SPI_OK_SELECT)
		elog(ERROR, "could not call dblink: %s", SPI_result_code_string(status));
}

/* The single value of the last query. */
static Datum
answer(void)
{
	bool		isnull;
	Datum		value = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull);

	return isnull ? (Datum) 0 : value;
}

static int32
ask_number(const ShardLinks *links, const char *function, int i)
{
	int32		number;

	ask(psprintf("SELECT %s.%s($1)", links->dblink, function), links->names[i], NULL);
	number = DatumGetInt32(answer());
	SPI_freetuptable(SPI_tuptable);
	return number;
}

static bool
is_open(const ShardLinks *links, int i)
{
	bool		open;

	ask(psprintf("SELECT coalesce($1 OPERATOR(pg_catalog.=) ANY (%s.dblink_get_connections()), false)",
				 links->dblink), links->names[i], NULL);
	open = DatumGetBool(answer());
	SPI_freetuptable(SPI_tuptable);
	return open;
}

/* ---- Opening and closing -------------------------------------------------------------------- */

/* The schema of dblink, in SQL; NULL if it is not installed. */
static char *
dblink_schema(void)
{
	char	   *schema = NULL;

	ask("SELECT pg_catalog.quote_ident(n.nspname) FROM pg_catalog.pg_extension AS e, pg_catalog.pg_namespace AS n "
		"WHERE e.extname OPERATOR(pg_catalog.=) $1::name AND n.oid OPERATOR(pg_catalog.=) e.extnamespace", "dblink", NULL);
	if (SPI_processed > 0)
		schema = TextDatumGetCString(answer());
	SPI_freetuptable(SPI_tuptable);
	return schema;
}

/* Checks that the servers exist and may be used; connects to none. */
void
links_prepare(ShardLinks *links, char **servers, int count)
{
	links->dblink = dblink_schema();
	if (links->dblink == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("a mesh over several servers needs the extension dblink"),
				 errhint("CREATE EXTENSION dblink.")));
	if (IsInParallelMode())
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TRANSACTION_STATE),
				 errmsg("cannot access a mesh over several servers in a parallel query"),
				 errhint("SET max_parallel_workers_per_gather = 0 for this query.")));
	links->count = count;
	links->servers = servers;
	links->names = palloc(count * sizeof(char *));
	links->busy = palloc0(count * sizeof(bool));
	for (int i = 0; i < count; i++)
	{
		ForeignServer *server = GetForeignServerByName(servers[i], false);

		if (object_aclcheck(ForeignServerRelationId, server->serverid, GetUserId(), ACL_USAGE) != ACLCHECK_OK)
			aclcheck_error(ACLCHECK_NO_PRIV, OBJECT_FOREIGN_SERVER, server->servername);
		links->names[i] = psprintf("abacus_%u_%u_%d", server->serverid, GetUserId(), i);
	}
}

/* Connects, and lets names of this extension's functions be found there. */
static void
open_link(ShardLinks *links, int i)
{
	ask(psprintf("SELECT %s.dblink_connect($1, $2)", links->dblink), links->names[i], links->servers[i]);
	SPI_freetuptable(SPI_tuptable);
	link_send(links, i,
			  "SELECT pg_catalog.set_config('search_path', pg_catalog.concat_ws(', ', "
			  "nullif(pg_catalog.current_setting('search_path'), ''), pg_catalog.quote_ident(n.nspname)), false) "
			  "FROM pg_catalog.pg_extension AS e JOIN pg_catalog.pg_namespace AS n ON n.oid = e.extnamespace "
			  "WHERE e.extname = 'abacus'");
	if (link_rows(links, i, "path text") == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("server \"%s\" does not have the extension abacus", links->servers[i]),
				 errhint("CREATE EXTENSION abacus in the database of the server.")));
	link_do(links, i, "SET extra_float_digits = 1; SET client_min_messages = error");
}

/* Connects to the servers to which the session has no connection yet. */
void
links_open(ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
		if (!is_open(links, i))
			open_link(links, i);
}

/* Ends whatever runs, and all connections; reports no error of theirs. */
void
links_close(ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
	{
		if (!is_open(links, i))
			continue;
		if (links->busy[i])
			ask(psprintf("SELECT %s.dblink_cancel_query($1)", links->dblink), links->names[i], NULL);
		ask(psprintf("SELECT %s.dblink_disconnect($1)", links->dblink), links->names[i], NULL);
		links->busy[i] = false;
	}
}

/* Opens the connections and does the work with them. After an error they are closed. */
void
links_run(ShardLinks *links, void (*work) (ShardLinks *links, void *context), void *context)
{
	MemoryContext memory = CurrentMemoryContext;
	ResourceOwner owner = CurrentResourceOwner;

	BeginInternalSubTransaction(NULL);
	MemoryContextSwitchTo(memory);
	PG_TRY();
	{
		links_open(links);
		work(links, context);
		ReleaseCurrentSubTransaction();
		MemoryContextSwitchTo(memory);
		CurrentResourceOwner = owner;
	}
	PG_CATCH();
	{
		ErrorData  *error;

		MemoryContextSwitchTo(memory);
		error = CopyErrorData();
		FlushErrorState();
		RollbackAndReleaseCurrentSubTransaction();
		MemoryContextSwitchTo(memory);
		CurrentResourceOwner = owner;
		links_close(links);
		ReThrowError(error);
	}
	PG_END_TRY();
}

/* ---- Queries -------------------------------------------------------------------------------- */

/* Sends a query, or several, to a server that has none to answer. */
void
link_send(ShardLinks *links, int i, const char *query)
{
	ask(psprintf("SELECT %s.dblink_send_query($1, $2)", links->dblink), links->names[i], query);
	if (DatumGetInt32(answer()) != 1)
		ereport(ERROR,
				(errcode(ERRCODE_CONNECTION_FAILURE),
				 errmsg("connection to server \"%s\" is lost", links->servers[i]),
				 errhint("Call the function again: it connects anew.")));
	SPI_freetuptable(SPI_tuptable);
	links->busy[i] = true;
}

/*
 * Waits until a result can be fetched at once. Each check also takes what has come so far, no more than
 * the socket holds: so sleeps are short.
 */
static void
wait_for_result(ShardLinks *links, int i)
{
	for (int looks = 0; ask_number(links, "dblink_is_busy", i) != 0; looks++)
	{
		CHECK_FOR_INTERRUPTS();
		if (looks < QUICK_LOOKS)
			continue;
		(void) WaitLatch(MyLatch, WL_LATCH_SET | WL_TIMEOUT | WL_EXIT_ON_PM_DEATH,
						 looks < SHORT_LOOKS ? SHORT_SLEEP : LONG_SLEEP, PG_WAIT_EXTENSION);
		ResetLatch(MyLatch);
	}
}

/* The next result, in SPI_tuptable; returns how many rows it has. */
static uint64
next_result(ShardLinks *links, int i, const char *columns)
{
	wait_for_result(links, i);
	ask(psprintf("SELECT * FROM %s.dblink_get_result($1) AS t(%s)", links->dblink, columns), links->names[i],
		NULL);
	return SPI_processed;
}

/*
 * The rows of the single query that was sent, which has these columns, are in SPI_tuptable. Returns how
 * many they are.
 */
uint64
link_rows(ShardLinks *links, int i, const char *columns)
{
	uint64		count = next_result(links, i, columns);
	SPITupleTable *rows = SPI_tuptable;

	(void) next_result(links, i, columns);	/* none: the connection is free again */
	SPI_freetuptable(SPI_tuptable);
	links->busy[i] = false;
	SPI_tuptable = rows;
	SPI_processed = count;
	return count;
}

/* Waits for what was sent: commands, or queries that return one text each. */
void
link_finish(ShardLinks *links, int i)
{
	uint64		count;

	if (!links->busy[i])
		return;
	do
	{
		count = next_result(links, i, "status text");
		SPI_freetuptable(SPI_tuptable);
	} while (count > 0);
	links->busy[i] = false;
}

/* Sends them and waits. */
void
link_do(ShardLinks *links, int i, const char *commands)
{
	link_send(links, i, commands);
	link_finish(links, i);
}

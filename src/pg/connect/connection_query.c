/*
 * connection_query.c: what is sent to another server, and what comes back.
 *
 * A query is sent, and its rows are taken one by one: so a result need not fit into memory, and servers
 * work side by side while the answer of one of them is read. All waiting is for the socket and the latch,
 * and ends with an interrupt.
 */
#include "postgres.h"

#include "funcapi.h"
#include "mb/pg_wchar.h"
#include "miscadmin.h"
#include "storage/latch.h"
#include "utils/builtins.h"
#include "utils/memutils.h"
#include "utils/timestamp.h"
#include "utils/wait_event.h"

#include "pg/connect/connection_record.h"
#include "pg/port/port.h"

const char *
connection_server(const Connection *connection)
{
	return connection->name;
}

bool
connection_is_busy(const Connection *connection)
{
	return connection->is_busy;
}

/* Waits for the socket. An interrupt ends it. */
void
connection_wait(PGconn *conn, int events)
{
	int			happened;

	CHECK_FOR_INTERRUPTS();		/* one may be pending whose latch was reset by a wait without errors */
	happened = WaitLatchOrSocket(MyLatch, WL_LATCH_SET | WL_EXIT_ON_PM_DEATH | events, PQsocket(conn), -1,
								 PG_WAIT_EXTENSION);
	if (happened & WL_LATCH_SET)
	{
		ResetLatch(MyLatch);
		CHECK_FOR_INTERRUPTS();
	}
}

/* ---- Errors and warnings -------------------------------------------------------------------- */

/* Reports what the server has sent so far; so outside of libpq's functions, which nothing may leave. */
static void
report_warnings(Connection *connection)
{
	char	   *text;

	if (connection->warnings.len == 0)
		return;
	text = pstrdup(connection->warnings.data);
	resetStringInfo(&connection->warnings);
	ereport(WARNING,
			(errmsg_internal("%s", pchomp(text)),
			 errcontext("server \"%s\"", connection->name)));
	pfree(text);
}

/* Called by libpq. There must be room: an error cannot leave it. */
void
connection_keep_warning(void *arg, const PGresult *result)
{
	Connection *connection = arg;
	const char *text = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
	size_t		length = text == NULL ? 0 : strlen(text);

	if (connection->warnings.len + length + 2 > (size_t) connection->warnings.maxlen)
		return;
	appendBinaryStringInfo(&connection->warnings, text, (int) length);
	appendStringInfoChar(&connection->warnings, '\n');
}

void
connection_report_lost(Connection *connection)
{
	char	   *why = pchomp(PQerrorMessage(connection->conn));

	ereport(ERROR,
			(errcode(ERRCODE_CONNECTION_FAILURE),
			 errmsg("connection to server \"%s\" is lost", connection->name),
			 why[0] != '\0' ? errdetail_internal("%s", why) : 0,
			 errhint("Call the function again: it connects anew.")));
}

/* What to do if a part of a mesh is missing on its server. */
static const char *
hint_of_missing(int code, const char *message)
{
	if (code != ERRCODE_UNDEFINED_TABLE || message == NULL || strstr(message, "\"abacus_") == NULL)
		return NULL;
	return "If the mesh was built again meanwhile, repeat the transaction. Else its part on this server was dropped, or "
		"never restored: build the mesh again with abacus_shard_build().";
}

/* Errors of the server name this mesh there as it is named here. */
void
connection_name_mesh(Connection *connection, const char *there, const char *here)
{
	strlcpy(connection->there, there, NAMEDATALEN);
	strlcpy(connection->here, here, NAMEDATALEN);
}

static const char *
named_here(const Connection *connection, const char *text)
{
	size_t		length = strlen(connection->there);
	StringInfoData named;

	initStringInfo(&named);
	while (*text != '\0')
		if (length > 0 && strncmp(text, connection->there, length) == 0 && text[length] != '_')
		{
			appendStringInfoString(&named, connection->here);
			text += length;
		}
		else
			appendStringInfoChar(&named, *text++);
	return named.data;
}

/* Raises the error of a result, which is freed. */
static void
report_error(Connection *connection, PGresult *result)
{
	const char *state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
	const char *texts[] = {
		PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY), PQresultErrorField(result, PG_DIAG_MESSAGE_DETAIL),
		PQresultErrorField(result, PG_DIAG_MESSAGE_HINT)
	};
	int			code;

	if (state == NULL || PQstatus(connection->conn) == CONNECTION_BAD)
	{
		PQclear(result);
		connection_report_lost(connection);
	}
	code = MAKE_SQLSTATE(state[0], state[1], state[2], state[3], state[4]);
	for (int i = 0; i < lengthof(texts); i++)
		if (texts[i] != NULL)	/* some are about the table there */
			texts[i] = code == ERRCODE_INSUFFICIENT_PRIVILEGE || code == ERRCODE_UNDEFINED_TABLE ? pstrdup(texts[i])
				: named_here(connection, texts[i]);
	PQclear(result);
	if (texts[2] == NULL)
		texts[2] = hint_of_missing(code, texts[0]);
	ereport(ERROR,
			(errcode(code),
			 errmsg_internal("%s", texts[0] == NULL ? "unknown error" : texts[0]),
			 texts[1] == NULL ? 0 : errdetail_internal("%s", texts[1]),
			 texts[2] == NULL ? 0 : errhint("%s", texts[2]),
			 errcontext("server \"%s\"", connection->name)));
}

/* ---- Queries -------------------------------------------------------------------------------- */

/* Sends a query, or several, to a server that has none to answer. */
void
connection_send(Connection *connection, const char *query)
{
	int			left;

	if (connection->is_busy)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_IN_USE),
				 errmsg("the connection to server \"%s\" is busy with another query of this session",
						connection->name)));
	if (PQsendQuery(connection->conn, query) != 1)
		connection_report_lost(connection);
	connection->is_busy = true;
	if (PQsetSingleRowMode(connection->conn) != 1)
		connection_report_lost(connection);
	while ((left = PQflush(connection->conn)) > 0)
	{
		connection_wait(connection->conn, WL_SOCKET_READABLE | WL_SOCKET_WRITEABLE);
		if (PQconsumeInput(connection->conn) != 1)
			connection_report_lost(connection);
	}
	if (left < 0)
		connection_report_lost(connection);
}

/* The next result, or NULL after the last. */
static PGresult *
next_result(Connection *connection)
{
	PGresult   *result;

	while (PQisBusy(connection->conn))
	{
		connection_wait(connection->conn, WL_SOCKET_READABLE);
		if (PQconsumeInput(connection->conn) != 1)
			connection_report_lost(connection);
	}
	report_warnings(connection);
	result = PQgetResult(connection->conn);
	if (result == NULL)
		connection->is_busy = false;
	return result;
}

/* After an error the rest comes, too: the connection is free again, and the error is raised. */
static void
fail(Connection *connection, PGresult *result)
{
	PGresult   *next;

	PG_TRY();
	{
		while (PQstatus(connection->conn) != CONNECTION_BAD && (next = next_result(connection)) != NULL)
			PQclear(next);
	}
	PG_CATCH();
	{
		PQclear(result);
		PG_RE_THROW();
	}
	PG_END_TRY();
	report_error(connection, result);
}

/* The rows of a result; frees it. */
static uint64
take_rows(Connection *connection, PGresult *result, AttInMetadata *meta, char **values, MemoryContext rows,
		  ConnectionRow take, void *context)
{
	TupleDesc	columns = meta->tupdesc;
	uint64		count = (uint64) PQntuples(result);

	PG_TRY();
	{
		MemoryContext old = CurrentMemoryContext;

		if (PQnfields(result) != columns->natts)
			ereport(ERROR,
					(errcode(ERRCODE_FDW_ERROR),
					 errmsg("server \"%s\" returned %d columns instead of %d", connection->name, PQnfields(result),
							columns->natts),
					 errhint("Let coordinator and servers have the same version of abacus.")));
		for (int row = 0; row < PQntuples(result); row++)
		{
			HeapTuple	tuple;

			MemoryContextSwitchTo(rows);
			for (int i = 0; i < columns->natts; i++)
				values[i] = PQgetisnull(result, row, i) ? NULL : PQgetvalue(result, row, i);
			tuple = BuildTupleFromCStrings(meta, values);
			MemoryContextSwitchTo(old);
			take(context, tuple, columns);
			MemoryContextReset(rows);
		}
	}
	PG_FINALLY();
	{
		PQclear(result);
	}
	PG_END_TRY();
	return count;
}

/*
 * Calls take() for each row of the single query that was sent, whose columns have these types. Returns how
 * many they are.
 */
uint64
connection_rows(Connection *connection, TupleDesc columns, ConnectionRow take, void *context)
{
	AttInMetadata *meta = TupleDescGetAttInMetadata(columns);
	char	  **values = palloc(Max(1, columns->natts) * sizeof(char *));
	MemoryContext rows = AllocSetContextCreate(CurrentMemoryContext, "Abacus rows of a server", ALLOCSET_DEFAULT_SIZES);
	uint64		count = 0;
	PGresult   *result;

	while ((result = next_result(connection)) != NULL)
		switch (PQresultStatus(result))
		{
			case PGRES_SINGLE_TUPLE:
			case PGRES_TUPLES_OK:
				count += take_rows(connection, result, meta, values, rows, take, context);
				break;
			case PGRES_COMMAND_OK:
				PQclear(result);
				break;
			default:
				fail(connection, result);
		}
	MemoryContextDelete(rows);
	pfree(values);
	return count;
}

/* Waits for what was sent, and leaves its rows out. */
void
connection_finish(Connection *connection)
{
	PGresult   *result;

	if (!connection->is_busy)
		return;
	while ((result = next_result(connection)) != NULL)
		switch (PQresultStatus(result))
		{
			case PGRES_SINGLE_TUPLE:
			case PGRES_TUPLES_OK:
			case PGRES_COMMAND_OK:
			case PGRES_EMPTY_QUERY:
				PQclear(result);
				break;
			default:
				fail(connection, result);
		}
}

/* ---- At the end of transactions ---------------------------------------------------------------- */

/* Sends a command and waits for nothing; the next use of the connection does. Raises no error. */
void
connection_fire(Connection *connection, const char *command)
{
	if (connection->is_busy || PQsendQuery(connection->conn, command) != 1 || PQflush(connection->conn) < 0)
		connection_abandon(connection);
	else
		connection->is_busy = connection->is_ending = true;
}

/* Waits without raising errors until a result can be taken; false at the end of patience. */
static bool
wait_patiently(Connection *connection, TimestampTz end)
{
	while (PQisBusy(connection->conn) || PQflush(connection->conn) > 0)
	{
		long		left = TimestampDifferenceMilliseconds(GetCurrentTimestamp(), end);
		int			happened;

		if (left <= 0 || ProcDiePending || QueryCancelPending)
			return false;
		happened = WaitLatchOrSocket(MyLatch, WL_LATCH_SET | WL_SOCKET_READABLE | WL_TIMEOUT | WL_EXIT_ON_PM_DEATH,
									 PQsocket(connection->conn), left, PG_WAIT_EXTENSION);
		if (happened & WL_LATCH_SET)
			ResetLatch(MyLatch);
		if (PQconsumeInput(connection->conn) != 1)
			return false;
	}
	return true;
}

static bool
take_results(Connection *connection, TimestampTz end, char *state)
{
	bool		succeeds = true;

	while (wait_patiently(connection, end))
	{
		PGresult   *result = PQgetResult(connection->conn);

		if (result == NULL)
		{
			connection->is_busy = false;
			return succeeds;
		}
		if (PQresultStatus(result) == PGRES_FATAL_ERROR || PQresultStatus(result) == PGRES_BAD_RESPONSE)
		{
			const char *found = PQresultErrorField(result, PG_DIAG_SQLSTATE);

			succeeds = false;
			if (state != NULL)
				strlcpy(state, found == NULL ? "" : found, 6);
		}
		PQclear(result);
		if (PQstatus(connection->conn) != CONNECTION_OK)
			return false;
	}
	return false;
}

/*
 * Waits for what runs, and then, if there is a command, runs it; at most so long, and until a cancel
 * request. Returns whether the last of both succeeded; `state`, of six bytes, gets the SQLSTATE of its
 * error, or is empty. If the connection is busy then, it is of no more use. Raises no error.
 */
bool
connection_try(Connection *connection, const char *command, int milliseconds, char *state)
{
	volatile bool succeeds = false;
	MemoryContext memory = CurrentMemoryContext;

	if (state != NULL)
		state[0] = '\0';
	if (connection->conn == NULL)
		return false;
	PG_TRY();
	{
		TimestampTz end = TimestampTzPlusMilliseconds(GetCurrentTimestamp(), milliseconds);

		succeeds = !connection->is_busy || take_results(connection, end, state);
		if (command != NULL && !connection->is_busy)
		{
			connection->is_busy = PQsendQuery(connection->conn, command) == 1;
			succeeds = connection->is_busy && take_results(connection, end, state);
		}
	}
	PG_CATCH();
	{
		MemoryContextSwitchTo(memory);
		FlushErrorState();
		succeeds = false;
	}
	PG_END_TRY();
	return succeeds;
}

/*
 * shard_transaction.c: what servers of a mesh do belongs to the local transaction.
 *
 * Each server has a transaction of its own, from the first question of the local one to its end. It sees one
 * snapshot, and what it has changed itself. Without changes it may end earlier: the next one is as good, since
 * all readers compare versions (generation_links.c).
 *
 * With changes, it follows the local one (docs/design/servers.md):
 *
 *   1. Savepoints are set before a change or a question in a subtransaction, up to its level, beginning with
 *      the level after that of the first change. They are released and rolled back with their levels. If the
 *      level of the first change fails, all fails.
 *   2. Before the local transaction commits, all are prepared. The row of the mesh on the coordinator, which
 *      is changed in the local transaction, says which versions are good. So its commit decides.
 *   3. After that, prepared transactions are committed, or rolled back if it failed. No error may leave
 *      there: what cannot be reached remains prepared, until abacus_shard_resolve().
 */
#include "postgres.h"

#include <libpq-fe.h>

#include "access/transam.h"
#include "access/xact.h"
#include "miscadmin.h"

#include "pg/connect/connection_record.h"
#include "pg/shards/shard_transaction.h"

/* For ends of transactions, in milliseconds */
#define PATIENCE 10000
/* SQLSTATE of COMMIT PREPARED for a transaction that somebody else has resolved */
#define NOT_PREPARED "42704"

/* Calls work() for the connections of transactions. */
static void
for_all(void (*work) (Connection *connection, int level), int level)
{
	Connection *connection = NULL;

	while ((connection = connection_next(connection)) != NULL)
		if (connection->kind == CONNECTION_OF_TRANSACTION && (connection->conn != NULL || connection->is_lost))
			work(connection, level);
}

/* No transaction is open any more. */
static void
forget(Connection *connection)
{
	connection->is_open = connection->knows_version = connection->is_lost = false;
	connection->changed = connection->depth = 0;
	connection->prepared[0] = '\0';
}

/* ---- During a transaction ------------------------------------------------------------------- */

bool
shard_transaction_is_open(const Connection *connection)
{
	return connection->is_open;
}

bool
shard_transaction_has_changed(const Connection *connection)
{
	return connection->changed > 0;
}

static void
require_whole(const Connection *connection)
{
	if (connection->is_lost)
		ereport(ERROR,
				(errcode(ERRCODE_CONNECTION_FAILURE),
				 errmsg("connection to server \"%s\" is lost, with changes of this transaction", connection->name),
				 errhint("Repeat the transaction.")));
}

/* Sends a query; begins a transaction if there is none. */
void
shard_transaction_send(Connection *connection, const char *query)
{
	require_whole(connection);
	if (connection->is_open)
	{
		connection_send(connection, query);
		return;
	}
	connection->is_open = true;
	connection_send(connection, psprintf("BEGIN ISOLATION LEVEL REPEATABLE READ; %s", query));
}

/* Ends a transaction without changes: the next one has another snapshot. */
void
shard_transaction_end(Connection *connection)
{
	Assert(connection->changed == 0);
	if (!connection->is_open)
		return;
	connection_finish(connection);
	connection_send(connection, "ROLLBACK");
	connection_finish(connection);
	forget(connection);
}

/* For work on a mesh over other connections, which do not see what the transaction has changed. */
void
shard_transaction_refuse_changed(Oid mesh, const char *work)
{
	Connection *connection = NULL;

	while ((connection = connection_next(connection)) != NULL)
		if (connection->kind == CONNECTION_OF_TRANSACTION && connection->mesh == mesh && connection->changed > 0)
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_IN_USE),
					 errmsg("cannot %s a mesh over several servers in the transaction that has changed it", work),
					 errhint("Commit the change first, or roll it back.")));
}

/* Before a mesh is dropped, over other connections: servers keep no locks on it for this transaction. */
void
shard_transaction_leave(Oid mesh)
{
	Connection *connection = NULL;

	shard_transaction_refuse_changed(mesh, "drop");
	while ((connection = connection_next(connection)) != NULL)
		if (connection->kind == CONNECTION_OF_TRANSACTION && connection->mesh == mesh && connection->conn != NULL)
			shard_transaction_end(connection);
}

/* Before anything that may fail: if it does, changes of levels above are kept. */
void
shard_transaction_guard(Connection *connection)
{
	int			level = GetCurrentTransactionNestLevel();

	require_whole(connection);
	while (connection->changed > 0 && connection->depth < level)
	{
		connection_send(connection, psprintf("SAVEPOINT s%d", connection->depth + 1));
		connection_finish(connection);
		connection->depth++;
	}
}

/* Before a change; `prefix` is that of the name under which the transaction is prepared. */
void
shard_transaction_change(Connection *connection, const char *prefix)
{
	shard_transaction_guard(connection);
	if (connection->changed > 0)
		return;
	connection->changed = connection->depth = GetCurrentTransactionNestLevel();
	strlcpy(connection->prefix, prefix, sizeof(connection->prefix));
}

/* Nothing was changed after all. */
void
shard_transaction_unchange(Connection *connection)
{
	connection->changed = connection->depth = 0;
}

/* The version of the mesh of a generation that the transaction sees. */
void
shard_transaction_set_version(Connection *connection, int64 generation, int64 version)
{
	connection->knows_version = true;
	connection->generation = generation;
	connection->version = version;
}

bool
shard_transaction_knows_version(const Connection *connection, int64 generation, int64 *version)
{
	*version = connection->version;
	return connection->is_open && connection->knows_version && connection->generation == generation;
}

/* ---- Its end -------------------------------------------------------------------------------- */

static void
send_prepare(Connection *connection, int level)
{
	require_whole(connection);
	if (connection->changed == 0)
		return;
	snprintf(connection->prepared, sizeof(connection->prepared), "%s_" INT64_FORMAT "_" UINT64_FORMAT,
			 connection->prefix, connection->version, U64FromFullTransactionId(GetTopFullTransactionId()));
	connection_finish(connection);
	connection_send(connection, psprintf("PREPARE TRANSACTION '%s'", connection->prepared));
}

static void
finish_prepare(Connection *connection, int level)
{
	if (connection->prepared[0] != '\0')
		connection_finish(connection);
}

static void
warn_of_doubt(const Connection *connection)
{
	ereport(WARNING,
			(errcode(ERRCODE_CONNECTION_FAILURE),
			 errmsg("a change of a mesh waits on server \"%s\" for its end", connection->name),
			 errdetail("It is prepared there as \"%s\".", connection->prepared),
			 errhint("Call abacus_shard_resolve() for the mesh when the server can be reached.")));
}

static void
send_commit_prepared(Connection *connection, int level)
{
	char		command[200];

	if (connection->prepared[0] == '\0')
		return;
	snprintf(command, sizeof(command), "COMMIT PREPARED '%s'", connection->prepared);
	if (PQsendQuery(connection->conn, command) == 1)
	{
		connection->is_busy = true;
		(void) PQflush(connection->conn);
	}
}

static void
end_committed(Connection *connection, int level)
{
	char		state[6] = "";

	if (connection->prepared[0] != '\0')
	{
		if (!connection->is_busy || (!connection_try(connection, NULL, PATIENCE, state) && strcmp(state, NOT_PREPARED) != 0))
		{
			warn_of_doubt(connection);
			connection_abandon(connection);
		}
	}
	else if (connection->is_open)
		connection_fire(connection, "COMMIT");
	forget(connection);
}

static void
end_aborted(Connection *connection, int level)
{
	char		command[200];
	char		state[6];

	if (connection->prepared[0] != '\0')
	{
		/* it may have failed, or be under way still, or not have begun */
		(void) connection_try(connection, NULL, PATIENCE, NULL);
		if (PQtransactionStatus(connection->conn) != PQTRANS_IDLE)
			(void) connection_try(connection, "ROLLBACK", PATIENCE, NULL);
		snprintf(command, sizeof(command), "ROLLBACK PREPARED '%s'", connection->prepared);
		if (!connection_try(connection, command, PATIENCE, state) && strcmp(state, NOT_PREPARED) != 0)
			warn_of_doubt(connection);
		if (connection->is_busy || PQtransactionStatus(connection->conn) != PQTRANS_IDLE)
			connection_abandon(connection);
	}
	else if (connection->is_busy && !connection->is_ending)
		connection_abandon(connection);
	else if (connection->is_open)
		connection_fire(connection, "ROLLBACK");
	forget(connection);
}

static void
refuse_prepare(Connection *connection, int level)
{
	if (connection->changed > 0)
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("cannot PREPARE a transaction that has changed a mesh over several servers"),
				 errhint("Use COMMIT: the servers prepare their parts.")));
}

static void
at_transaction_event(XactEvent event, void *arg)
{
	switch (event)
	{
		case XACT_EVENT_PRE_COMMIT:
			for_all(send_prepare, 0);
			for_all(finish_prepare, 0);
			break;
		case XACT_EVENT_COMMIT:
			for_all(send_commit_prepared, 0);
			for_all(end_committed, 0);
			break;
		case XACT_EVENT_PRE_PREPARE:
			for_all(refuse_prepare, 0);
			break;
		case XACT_EVENT_PREPARE:
			for_all(end_committed, 0);
			break;
		case XACT_EVENT_ABORT:
			for_all(end_aborted, 0);
			break;
		default:
			break;
	}
}

/* ---- Subtransactions ------------------------------------------------------------------------ */

static void
commit_level(Connection *connection, int level)
{
	if (connection->changed == 0 || connection->depth < level)
		return;
	if (connection->changed < level)
	{
		connection_finish(connection);
		connection_send(connection, psprintf("RELEASE SAVEPOINT s%d", level));
		connection_finish(connection);
	}
	connection->depth = level - 1;
	connection->changed = Min(connection->changed, level - 1);
}

static void
abort_level(Connection *connection, int level)
{
	char		command[80];

	if (!connection->is_open)
		return;
	if (connection->changed == 0 || connection->changed >= level)
	{
		bool		failed = PQtransactionStatus(connection->conn) == PQTRANS_INERROR;

		if (connection->is_busy)
			connection_abandon(connection);
		else if (failed || connection->changed > 0)
			connection_fire(connection, "ROLLBACK");
		if (connection->changed > 0 || failed || connection->conn == NULL)
			forget(connection);
		return;
	}
	if (connection->depth < level)
		return;
	connection_cancel(connection);
	snprintf(command, sizeof(command), "ROLLBACK TO SAVEPOINT s%d; RELEASE SAVEPOINT s%d", level, level);
	if (!connection_try(connection, command, PATIENCE, NULL))
	{
		connection_abandon(connection);
		connection->is_lost = true;
	}
	connection->knows_version = false;
	connection->depth = level - 1;
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	if (event == SUBXACT_EVENT_PRE_COMMIT_SUB)
		for_all(commit_level, GetCurrentTransactionNestLevel());
	else if (event == SUBXACT_EVENT_ABORT_SUB)
		for_all(abort_level, GetCurrentTransactionNestLevel());
}

void
shard_transaction_init(void)
{
	RegisterXactCallback(at_transaction_event, NULL);
	RegisterSubXactCallback(at_subtransaction_event, NULL);
}

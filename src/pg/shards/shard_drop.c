/*
 * shard_drop.c: the meshes of a generation go from their servers with the local transaction.
 *
 * They are dropped in transactions on the servers, over connections that nothing else uses. These are
 * committed after the local one, so a rollback, of a savepoint too, loses nothing; connections that failed
 * transactions hold are closed (connection.c). If a server cannot be reached then, its tables remain, and a
 * warning names them: nobody knows them any more, so no harm is done.
 */
#include "postgres.h"

#include "access/xact.h"
#include "nodes/pg_list.h"
#include "utils/memutils.h"

#include "pg/connect/connection_record.h"
#include "pg/shards/shard_drop.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_transaction.h"

/* Numbers of the connections, above those of shards */
#define FIRST_NUMBER 1000000
/* For commits, in milliseconds */
#define PATIENCE 10000

/* A mesh that was dropped in a transaction of its server. */
typedef struct Dropped
{
	Connection *connection;
	PGconn	   *conn;			/* the one that has the transaction */
	char	   *mesh;
	int			level;			/* nesting of the local transaction */
} Dropped;

static List *all_dropped = NIL; /* in the memory of the local transaction */

/* Ends the transaction that has dropped a mesh; others were perhaps dropped in the same one. */
static bool
commit_there(const Dropped *dropped)
{
	Connection *connection = dropped->connection;

	if (connection->conn == NULL || connection->conn != dropped->conn)
		return false;
	return PQtransactionStatus(connection->conn) == PQTRANS_IDLE ||
		(PQtransactionStatus(connection->conn) == PQTRANS_INTRANS && connection_try(connection, "COMMIT", PATIENCE, NULL));
}

static void
commit_all(void)
{
	ListCell   *cell;

	foreach(cell, all_dropped)
	{
		Dropped    *dropped = lfirst(cell);

		if (!commit_there(dropped))
			ereport(WARNING,
					(errcode(ERRCODE_CONNECTION_FAILURE),
					 errmsg("tables %1$s, %1$s_guests, %1$s_arrivals and %1$s_version remain on server \"%2$s\"", dropped->mesh,
							dropped->connection->name),
					 errhint("Drop them there.")));
	}
	all_dropped = NIL;
}

static void
at_transaction_event(XactEvent event, void *arg)
{
	if (event == XACT_EVENT_COMMIT)
		commit_all();
	else if (event == XACT_EVENT_ABORT)
		all_dropped = NIL;
	else if (event == XACT_EVENT_PRE_PREPARE && all_dropped != NIL)
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("cannot PREPARE a transaction that has dropped a mesh over several servers"),
				 errhint("Use COMMIT.")));
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	int			level = GetCurrentTransactionNestLevel();
	ListCell   *cell;

	foreach(cell, all_dropped)
	{
		Dropped    *dropped = lfirst(cell);

		if (dropped->level < level)
			continue;
		if (event == SUBXACT_EVENT_ABORT_SUB)
			all_dropped = foreach_delete_current(all_dropped, cell);
		else if (event == SUBXACT_EVENT_COMMIT_SUB)
			dropped->level = level - 1;
	}
}

static void
remember(Connection *connection, char *mesh)
{
	MemoryContext old = MemoryContextSwitchTo(TopTransactionContext);
	Dropped    *dropped = palloc(sizeof(Dropped));

	*dropped = (Dropped) {connection, connection->conn, pstrdup(mesh), GetCurrentTransactionNestLevel()};
	all_dropped = lappend(all_dropped, dropped);
	MemoryContextSwitchTo(old);
}

/* The meshes go when the local transaction commits. */
void
shard_drop(const Generation *generation)
{
	static bool is_registered = false;

	if (!is_registered)
	{
		RegisterXactCallback(at_transaction_event, NULL);
		RegisterSubXactCallback(at_subtransaction_event, NULL);
		is_registered = true;
	}
	shard_transaction_leave(generation->relid);
	for (int i = 0; i < generation->shards; i++)
	{
		Connection *connection = connection_get(generation->servers[i], FIRST_NUMBER + i, CONNECTION_OF_BUILD,
												InvalidOid);
		bool		is_idle = PQtransactionStatus(connection->conn) == PQTRANS_IDLE;

		connection_hold(connection);
		if (!is_idle && GetCurrentTransactionNestLevel() > connection->level)
			ereport(ERROR,
					(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
					 errmsg("cannot drop a mesh over several servers in a savepoint after another one"),
					 errhint("Drop them in transactions of their own.")));
		connection_send(connection, psprintf("%s%s", is_idle ? "BEGIN; " : "", shard_sql_drop(generation, i)));
		remember(connection, generation_mesh(generation, i));
		connection_finish(connection);
	}
}

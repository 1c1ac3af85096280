/*
 * connection.c: a session's connections to other servers, opened and closed.
 *
 * Connections stay open for the next call of the session, and end with it. After an error, those that the
 * failed (sub)transaction holds are of no use: whatever runs there is cancelled, and they are closed. If
 * the server or the user mapping is altered, a connection is closed before it is used again.
 *
 * Connections are records in memory that lasts, and never move.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/pg_foreign_server.h"
#include "foreign/foreign.h"
#include "funcapi.h"
#include "miscadmin.h"
#include "storage/fd.h"
#include "storage/ipc.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/inval.h"
#include "utils/memutils.h"
#include "utils/syscache.h"
#include "utils/wait_event.h"

#include "pg/connect/cancel_request.h"
#include "pg/connect/connection_options.h"
#include "pg/connect/connection_record.h"
#include "pg/port/port.h"

/* For the end of a transaction that was sent before, in milliseconds. */
#define END_PATIENCE 10000

static slist_head connections = SLIST_STATIC_INIT(connections);
static MemoryContext memory;

/* ---- Closing -------------------------------------------------------------------------------- */

static void
disconnect(Connection *connection)
{
	if (connection->conn == NULL)
		return;
	PQfinish(connection->conn);
	ReleaseExternalFD();
	connection->conn = NULL;
	connection->is_busy = connection->is_ending = connection->is_open = connection->knows_version = false;
	connection->level = 0;
}

/* Cancels what runs there. Raises no error. */
void
connection_cancel(Connection *connection)
{
	if (connection->is_busy)
		cancel_request(connection->conn);
}

/* Ends what runs there, and the connection. Raises no error. */
void
connection_abandon(Connection *connection)
{
	connection_cancel(connection);
	disconnect(connection);
}

static void
abandon_from(int level)
{
	slist_iter	iter;

	slist_foreach(iter, &connections)
	{
		Connection *connection = slist_container(Connection, node, iter.cur);

		if (connection->level >= level && connection->conn != NULL)
			connection_abandon(connection);
	}
}

/* Connections held at this level or a deeper one are held by the one above. */
static void
pass_up(int level)
{
	slist_iter	iter;

	slist_foreach(iter, &connections)
	{
		Connection *connection = slist_container(Connection, node, iter.cur);

		connection->level = Min(connection->level, level - 1);
	}
}

static void
at_transaction_event(XactEvent event, void *arg)
{
	if (event == XACT_EVENT_ABORT)
		abandon_from(1);
	else if (event == XACT_EVENT_COMMIT || event == XACT_EVENT_PREPARE)
		pass_up(1);
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	if (event == SUBXACT_EVENT_ABORT_SUB)
		abandon_from(GetCurrentTransactionNestLevel());
	else if (event == SUBXACT_EVENT_COMMIT_SUB)
		pass_up(GetCurrentTransactionNestLevel());
}

static void
at_exit(int code, Datum arg)
{
	slist_iter	iter;

	slist_foreach(iter, &connections)
		disconnect(slist_container(Connection, node, iter.cur));
}

/* A foreign server or a user mapping was altered; 0 stands for all. */
static void
at_change(Datum arg, int cache, uint32 hash)
{
	slist_iter	iter;

	slist_foreach(iter, &connections)
	{
		Connection *connection = slist_container(Connection, node, iter.cur);

		connection->is_stale |= hash == 0 ||
			hash == (cache == FOREIGNSERVEROID ? connection->server_hash : connection->mapping_hash);
	}
}

void
connection_init(void)
{
	RegisterXactCallback(at_transaction_event, NULL);
	RegisterSubXactCallback(at_subtransaction_event, NULL);
	CacheRegisterSyscacheCallback(FOREIGNSERVEROID, at_change, (Datum) 0);
	CacheRegisterSyscacheCallback(USERMAPPINGOID, at_change, (Datum) 0);
}

/* ---- Opening -------------------------------------------------------------------------------- */

static void
require_connection(Connection *connection, bool needs_password)
{
	char	   *why;

	if (PQstatus(connection->conn) != CONNECTION_OK)
	{
		why = pchomp(PQerrorMessage(connection->conn));
		disconnect(connection);
		ereport(ERROR,
				(errcode(ERRCODE_SQLCLIENT_UNABLE_TO_ESTABLISH_SQLCONNECTION),
				 errmsg("could not connect to server \"%s\"", connection->name),
				 errdetail_internal("%s", why)));
	}
	if (needs_password && !PQconnectionUsedPassword(connection->conn))
	{
		disconnect(connection);
		connection_require_password(connection->name);
	}
}

static void
wait_for_connection(PGconn *conn)
{
	PostgresPollingStatusType state = PGRES_POLLING_WRITING;

	while (PQstatus(conn) != CONNECTION_BAD && state != PGRES_POLLING_OK && state != PGRES_POLLING_FAILED)
	{
		connection_wait(conn, state == PGRES_POLLING_READING ? WL_SOCKET_READABLE : WL_SOCKET_WRITEABLE);
		state = PQconnectPoll(conn);
	}
}

static void
begin_connection(Connection *connection, const ConnectionOptions *options)
{
	if (!AcquireExternalFD())
		ereport(ERROR,
				(errcode(ERRCODE_SQLCLIENT_UNABLE_TO_ESTABLISH_SQLCONNECTION),
				 errmsg("could not connect to server \"%s\"", connection->name),
				 errdetail("There are too many open files on the local server."),
				 errhint("Raise the server's max_files_per_process and/or \"ulimit -n\" limits.")));
	connection->conn = PQconnectStartParams(options->names, options->values, false);
	if (connection->conn == NULL)
	{
		ReleaseExternalFD();
		ereport(ERROR,
				(errcode(ERRCODE_OUT_OF_MEMORY),
				 errmsg("out of memory")));
	}
	PG_TRY();
	{
		wait_for_connection(connection->conn);
		require_connection(connection, options->needs_password);
		if (PQsetnonblocking(connection->conn, 1) != 0)
			connection_report_lost(connection);
	}
	PG_CATCH();
	{
		disconnect(connection);
		PG_RE_THROW();
	}
	PG_END_TRY();
	(void) PQsetNoticeReceiver(connection->conn, connection_keep_warning, connection);
}

static void
keep_count(void *context, HeapTuple row, TupleDesc desc)
{
}

/* Lets names of this extension's functions be found there, and doubles come with all their digits. */
static void
begin_session(Connection *connection)
{
	TupleDesc	columns = CreateTemplateTupleDesc(1);

	TupleDescInitEntry(columns, 1, "path", TEXTOID, -1, 0);
	connection_send(connection, "SET extra_float_digits = 1; SET client_min_messages = warning; SET DateStyle = ISO; "
					"SET IntervalStyle = postgres");
	connection_finish(connection);
	connection_send(connection,
					"SELECT pg_catalog.set_config('search_path', pg_catalog.concat_ws(', ', "
					"nullif(pg_catalog.current_setting('search_path'), ''), pg_catalog.quote_ident(n.nspname)), false) "
					"FROM pg_catalog.pg_extension AS e JOIN pg_catalog.pg_namespace AS n ON n.oid = e.extnamespace "
					"WHERE e.extname = 'abacus'");
	if (connection_rows(connection, columns, keep_count, NULL) == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("server \"%s\" does not have the extension abacus", connection->name),
				 errhint("CREATE EXTENSION abacus in the database of the server.")));
}

static void
open_connection(Connection *connection, ForeignServer *server)
{
	UserMapping *mapping = GetUserMapping(GetUserId(), server->serverid);
	ConnectionOptions options = connection_options(server, mapping);

	connection->server_hash = GetSysCacheHashValue1(FOREIGNSERVEROID, ObjectIdGetDatum(server->serverid));
	connection->mapping_hash = GetSysCacheHashValue1(USERMAPPINGOID, ObjectIdGetDatum(mapping->umid));
	connection->is_stale = false;
	begin_connection(connection, &options);
	PG_TRY();
	{
		begin_session(connection);
	}
	PG_CATCH();
	{
		connection_abandon(connection);
		PG_RE_THROW();
	}
	PG_END_TRY();
}

static Connection *
find(Oid server, int number, ConnectionKind kind, Oid mesh)
{
	slist_iter	iter;

	slist_foreach(iter, &connections)
	{
		Connection *connection = slist_container(Connection, node, iter.cur);

		if (connection->server == server && connection->user == GetUserId() && connection->number == number &&
			connection->kind == kind && connection->mesh == mesh)
			return connection;
	}
	return NULL;
}

static Connection *
new_connection(ForeignServer *server, int number, ConnectionKind kind, Oid mesh)
{
	Connection *connection;
	MemoryContext old;

	if (memory == NULL)
	{
		memory = AllocSetContextCreate(TopMemoryContext, "Abacus connections", ALLOCSET_SMALL_SIZES);
		on_proc_exit(at_exit, (Datum) 0);
	}
	old = MemoryContextSwitchTo(memory);
	connection = palloc0(sizeof(Connection));
	connection->server = server->serverid;
	connection->user = GetUserId();
	connection->number = number;
	connection->kind = kind;
	connection->mesh = mesh;
	connection->name = pstrdup(server->servername);
	initStringInfo(&connection->warnings);
	enlargeStringInfo(&connection->warnings, 8192);
	MemoryContextSwitchTo(old);
	slist_push_head(&connections, &connection->node);
	return connection;
}

/* The next of all connections, in no order; NULL: the first, or none. */
Connection *
connection_next(Connection *before)
{
	slist_node *node = before != NULL ? before->node.next : connections.head.next;

	return node == NULL ? NULL : slist_container(Connection, node, node);
}

/* The session's connection of this kind and number to a server; connects if there is none. */
Connection *
connection_get(const char *name, int number, ConnectionKind kind, Oid mesh)
{
	ForeignServer *server = GetForeignServerByName(name, false);
	Connection *connection = find(server->serverid, number, kind, mesh);

	if (object_aclcheck(ForeignServerRelationId, server->serverid, GetUserId(), ACL_USAGE) != ACLCHECK_OK)
		aclcheck_error(ACLCHECK_NO_PRIV, OBJECT_FOREIGN_SERVER, server->servername);
	if (connection == NULL)
		connection = new_connection(server, number, kind, mesh);
	if (connection->is_ending && !connection_try(connection, NULL, END_PATIENCE, NULL))
		connection_abandon(connection);
	connection->is_ending = false;
	if (connection->conn != NULL && connection->level == 0 && !connection->is_open &&
		(connection->is_stale || PQstatus(connection->conn) != CONNECTION_OK))
		disconnect(connection);
	if (connection->conn == NULL)
		open_connection(connection, server);
	return connection;
}

/* Until it is let go, the connection ends if this (sub)transaction fails. */
void
connection_hold(Connection *connection)
{
	if (connection->level == 0)
		connection->level = GetCurrentTransactionNestLevel();
}

void
connection_let_go(Connection *connection)
{
	connection->level = 0;
}

/*
 * connection.h: a session's connections to other servers, by libpq.
 */
#ifndef ABACUS_CONNECTION_H
#define ABACUS_CONNECTION_H

#include "postgres.h"

#include "access/htup.h"
#include "access/tupdesc.h"

typedef struct Connection Connection;

/* Whose transactions a connection has. */
typedef enum ConnectionKind
{
	CONNECTION_OF_BUILD,		/* the caller's, which begins and ends them */
	CONNECTION_OF_TRANSACTION	/* the local transaction's (shard_transaction.h) */
} ConnectionKind;

/* Takes a row, which is gone afterwards. */
typedef void (*ConnectionRow) (void *context, HeapTuple row, TupleDesc desc);

extern Connection *connection_get(const char *server, int number, ConnectionKind kind, Oid mesh);
extern void connection_name_mesh(Connection *connection, const char *there, const char *here);
extern void connection_hold(Connection *connection);
extern void connection_let_go(Connection *connection);
extern const char *connection_server(const Connection *connection);
extern bool connection_is_busy(const Connection *connection);
extern void connection_send(Connection *connection, const char *query);
extern uint64 connection_rows(Connection *connection, TupleDesc columns, ConnectionRow take, void *context);
extern void connection_finish(Connection *connection);
extern void connection_init(void);

#endif

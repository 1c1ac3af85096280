/*
 * connection_record.h: what a connection is, for the files that make and use it.
 */
#ifndef ABACUS_CONNECTION_RECORD_H
#define ABACUS_CONNECTION_RECORD_H

#include "postgres.h"

#include <libpq-fe.h>

#include "lib/ilist.h"
#include "lib/stringinfo.h"

#include "pg/connect/connection.h"
#include "pg/port/port.h"

struct Connection
{
	slist_node	node;			/* in `connections` */
	Oid			server;
	Oid			user;
	int			number;			/* several shards may be on one server */
	ConnectionKind kind;
	PGconn	   *conn;			/* NULL: not connected */
	char	   *name;			/* of the server */
	uint32		server_hash;	/* of the catalogue's entries that it was made from */
	uint32		mapping_hash;
	bool		is_stale;		/* they were changed */
	bool		is_busy;		/* a query was sent, and not all of its results are in */
	int			level;			/* nesting of the transaction that holds it; 0: none */
	char		there[NAMEDATALEN]; /* a mesh there, which errors name as here */
	char		here[NAMEDATALEN];
	Oid			mesh;			/* of a transaction's: one mesh has it */
	bool		is_ending;		/* the end of a transaction was sent, and nobody has waited for it */
	/* the local transaction's (shard_transaction.c) */
	bool		is_open;		/* a transaction of the server is open */
	bool		is_lost;		/* ... was, with changes, and it failed */
	int			changed;		/* the level from which on it has changes; 0: it has none */
	int			depth;			/* then: savepoints are set up to this level */
	char		prefix[96];		/* then: of the name under which it is prepared */
	char		prepared[160];	/* that name, from when it is sent on; or empty */
	bool		knows_version;	/* of the generation */
	int64		generation;
	int64		version;
	StringInfoData warnings;	/* of the server, not yet reported */
};

extern void connection_cancel(Connection *connection);
extern void connection_abandon(Connection *connection);
extern Connection *connection_next(Connection *before);
extern void connection_fire(Connection *connection, const char *command);
extern bool connection_try(Connection *connection, const char *command, int milliseconds, char *state);
extern void connection_wait(PGconn *conn, int events);
extern void connection_keep_warning(void *arg, const PGresult *result);
pg_noreturn extern void connection_report_lost(Connection *connection);

#endif

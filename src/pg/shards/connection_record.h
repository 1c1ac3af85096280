/*
 * connection_record.h: what a connection is, for the files that make and use it.
 */
#ifndef ABACUS_CONNECTION_RECORD_H
#define ABACUS_CONNECTION_RECORD_H

#include "postgres.h"

#include <libpq-fe.h>

#include "lib/ilist.h"
#include "lib/stringinfo.h"

#include "pg/port/port.h"
#include "pg/shards/connection.h"

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
	StringInfoData warnings;	/* of the server, not yet reported */
};

extern void connection_wait(PGconn *conn, int events);
extern void connection_keep_warning(void *arg, const PGresult *result);
pg_noreturn extern void connection_report_lost(Connection *connection);

#endif

/*
 * links.h: connections to the servers of a mesh's shards, which work side by side.
 */
#ifndef ABACUS_LINKS_H
#define ABACUS_LINKS_H

#include "postgres.h"

#include "pg/connect/connection.h"

/* A connection, one for each shard; all functions take its number. */
typedef struct ShardLinks
{
	int			count;
	char	  **servers;		/* foreign servers */
	Connection **connections;
} ShardLinks;

/* The rows of a query. */
typedef struct LinkRows
{
	MemoryContext memory;		/* of this and of all below */
	const char *server;
	TupleDesc	desc;
	uint64		count;
	uint64		room;
	HeapTuple  *rows;
} LinkRows;

extern void links_prepare(ShardLinks *links, char **servers, int count);
extern void links_open(ShardLinks *links, ConnectionKind kind, Oid mesh);
extern void links_run(ShardLinks *links, void (*work) (ShardLinks *links, void *context), void *context);
extern void link_send(ShardLinks *links, int i, const char *query);
extern uint64 link_each_row(ShardLinks *links, int i, TupleDesc columns, ConnectionRow take, void *context);
extern LinkRows *link_rows(ShardLinks *links, int i, TupleDesc columns);
extern void link_rows_free(LinkRows *rows);
extern int64 link_int64(ShardLinks *links, int i);
extern void link_finish(ShardLinks *links, int i);
extern void link_do(ShardLinks *links, int i, const char *commands);

extern TupleDesc link_columns(int count, const Oid *types, TupleDesc more);
extern Datum link_value(const LinkRows *rows, uint64 row, int column);
extern Datum link_value_or_null(const LinkRows *rows, uint64 row, int column, bool *isnull);
extern Datum link_row_value(HeapTuple row, TupleDesc desc, int column);

#endif

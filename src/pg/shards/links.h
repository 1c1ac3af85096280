/*
 * links.h: connections to the servers of a mesh's shards, which work side by side.
 */
#ifndef ABACUS_LINKS_H
#define ABACUS_LINKS_H

#include "postgres.h"

/* A connection, one for each shard; all functions take its number. SPI must be connected. */
typedef struct ShardLinks
{
	int			count;
	char	  **names;			/* as dblink knows them */
	char	  **servers;		/* foreign servers */
	bool	   *busy;			/* a query was sent, and not all of its results are in */
	const char *dblink;			/* its schema, in SQL */
} ShardLinks;

extern void links_prepare(ShardLinks *links, char **servers, int count);
extern void links_open(ShardLinks *links);
extern void links_close(ShardLinks *links);
extern void links_run(ShardLinks *links, void (*work) (ShardLinks *links, void *context), void *context);
extern void link_send(ShardLinks *links, int i, const char *query);
extern uint64 link_rows(ShardLinks *links, int i, const char *columns);
extern void link_finish(ShardLinks *links, int i);
extern void link_do(ShardLinks *links, int i, const char *commands);

#endif

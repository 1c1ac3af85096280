/*
 * spread.h: the first phase of a build over several servers.
 */
#ifndef ABACUS_SPREAD_H
#define ABACUS_SPREAD_H

#include "pg/shards/generation.h"

/* Where the points come from. */
typedef struct ShardSource
{
	char	  **queries;		/* one for each shard, run there; or one in all */
	bool		is_here;		/* ... which is run on the coordinator */
} ShardSource;

extern void spread_points(Generation *generation, ShardLinks *links, const ShardSource *source);

#endif

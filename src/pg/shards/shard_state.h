/*
 * shard_state.h: what there is of each shard on its server.
 */
#ifndef ABACUS_SHARD_STATE_H
#define ABACUS_SHARD_STATE_H

#include "pg/shards/generation.h"

typedef struct ShardState
{
	bool		exists;
	int64		points;			/* that it owns */
	int64		vertices;		/* of them, those in simplices */
	int64		duplicates;
	int64		guests;
	int64		bytes;
	char	   *doing;			/* a phase of abacus_progress, or NULL */
} ShardState;

extern int	shard_count_missing(const Generation *generation, ShardLinks *links);
extern ShardState *shard_states(const Generation *generation, ShardLinks *links);

#endif

/*
 * shard_steps.h: the steps of a change of a mesh over several servers.
 */
#ifndef ABACUS_SHARD_STEPS_H
#define ABACUS_SHARD_STEPS_H

#include "postgres.h"

#include "pg/input/source.h"
#include "pg/shards/change/shard_net.h"
#include "pg/shards/change/shard_sql_change.h"

typedef struct Part
{
	PointBatch	batch;
	bool		is_touched;		/* something may have come, in this call */
	bool		is_changed;		/* its mesh was, in this call */
	bool		is_active;		/* simplices of it are new since it has sent vertices */
	bool		is_all_new;		/* ... all of them */
	bool		has_new_guests;
} Part;

typedef struct ShardChange
{
	Generation *generation;
	ShardLinks	links;
	Part	   *parts;
	ShardNet   *net;			/* NULL: simplices are not returned */
	abacus_header *header;		/* the shape of the points */
	bool		tells;			/* guests of others may change */
	bool	   *was_changed;	/* before this call, in the transaction */
	/* of the step that runs */
	Part	   *part;
	int64		points;
	int64		more;
	int64		duplicates;
} ShardChange;

extern void step_will_change(ShardChange *change, int shard);
extern uint64 step_read_points(ShardChange *change, Source *source, bool widens, bool *owners);
extern int64 step_run(ShardChange *change, const bool *which, Arrival kind, const char *how);
extern void step_follow_owners(ShardChange *change);
extern void step_exchange(ShardChange *change);

#endif

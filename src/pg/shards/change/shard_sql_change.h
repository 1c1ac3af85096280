/*
 * shard_sql_change.h: what the coordinator says to the servers when a mesh is changed, in SQL.
 */
#ifndef ABACUS_SHARD_SQL_CHANGE_H
#define ABACUS_SHARD_SQL_CHANGE_H

#include "pg/shards/generation.h"
#include "pg/shards/point_batch.h"

/* What a row of <mesh>_arrivals is. */
typedef enum Arrival
{
	ARRIVES_POINT,				/* of the query */
	ARRIVES_GUEST,				/* a new one */
	ARRIVES_GONE,				/* a guest that is to go */
	ARRIVES_OTHER,				/* a guest with other attributes */
	ARRIVES_AROUND,				/* a vertex with new simplices */
	ARRIVES_NAMED,				/* a guest at the place of a point of the query; its id is the owner's number */
	ARRIVES_ASKED				/* a place where another shard has a guest */
} Arrival;

extern char *shard_sql_arrive_point(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_arrive_guest(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_arrive_gone(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_arrive_other(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_arrive_named(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_arrive_asked(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_named(const Generation *generation, int shard);
extern char *shard_sql_forget_named(const Generation *generation, int shard);
extern char *shard_sql_change(const Generation *generation, int shard, Arrival kind, const char *how, bool with_simplices);
extern char *shard_sql_update(const Generation *generation, int shard, Arrival kind, char **names, int count);
extern char *shard_sql_states(const Generation *generation, int shard, bool gone);
extern char *shard_sql_arrived(const Generation *generation, int shard);
extern char *shard_sql_exports_around(const Generation *generation, int shard, bool all);
extern char *shard_sql_clear(const Generation *generation, int shard);
extern char *shard_sql_set_version(const Generation *generation, int shard);

#endif

/*
 * shard_sql.h: what the coordinator says to the servers, in SQL.
 */
#ifndef ABACUS_SHARD_SQL_H
#define ABACUS_SHARD_SQL_H

#include "pg/shards/generation.h"
#include "pg/shards/point_batch.h"

extern char *shard_sql_drop(const Generation *generation, int shard);
extern char *shard_sql_begin(const Generation *generation, int shard);
extern char *shard_sql_take(const Generation *generation, int shard);
extern char *shard_sql_taken(const Generation *generation, int shard);
extern char *shard_sql_begin_spread(const Generation *generation, int shard);
extern char *shard_sql_survey(const Generation *generation, int shard, const char *query);
extern char *shard_sql_split(const Generation *generation, int shard);
extern char *shard_sql_split_rows(int shard);
extern char *shard_sql_arrive(int from, int shard, const char *bytes);
extern char *shard_sql_stage(const Generation *generation, int shard);
extern char *shard_sql_attributes(int attributes);
extern char *shard_sql_arguments(const Generation *generation, int shard);
extern const char *shard_sql_begin_exchange(void);
extern char *shard_sql_export(const Generation *generation, int shard);
extern char *shard_sql_count(const Generation *generation, int shard);
extern char *shard_sql_exported(int64 from, int64 to);
extern char *shard_sql_receive(const Generation *generation, int from, int shard, const PointBatch *batch);
extern const char *shard_sql_end_exchange(void);
extern char *shard_sql_stretch(const Generation *generation, int shard);
extern char *shard_sql_interval(const Generation *generation, int shard, const char *code);

extern char *shard_sql_version(const Generation *generation, int shard);
extern char *shard_sql_readiness(const Generation *generation, int shard);
extern char *shard_sql_prepared(const Generation *generation, int shard);

extern const char *shard_sql_make_room(void);
extern char *shard_sql_list_arrived(const Generation *generation, int from, int shard, const PointBatch *batch);
extern char *shard_sql_strangers(const Generation *generation, int shard);
extern char *shard_sql_list_guests(const Generation *generation, int shard);
extern char *shard_sql_count_unknown(const Generation *generation, int shard);
extern char *shard_sql_list_exports(const Generation *generation, int shard);
extern char *shard_sql_count_missing(const Generation *generation, int shard);

#endif

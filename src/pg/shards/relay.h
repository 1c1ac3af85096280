/*
 * relay.h: points from one server to others, by way of the coordinator.
 */
#ifndef ABACUS_RELAY_H
#define ABACUS_RELAY_H

#include "pg/shards/generation.h"
#include "pg/shards/point_batch.h"

/* The statement with which a server takes points of another one. */
typedef char *(*RelayStatement) (const Generation *generation, int from, int shard, const PointBatch *batch);

extern void relay_batch(const Generation *generation, ShardLinks *links, int from, int to, PointBatch *batch,
						RelayStatement statement);
extern void relay_bytes(ShardLinks *links, int from, int to, StringInfo bytes);
extern void relay_split(ShardLinks *links, int from);
extern int64 relay_exported(const Generation *generation, ShardLinks *links, int from, RelayStatement statement);
extern void relay_begin_query(ShardLinks *links, int from, const char *query);
extern LinkRows *relay_first_rows(ShardLinks *links, int from);
extern int64 *relay_query(const Generation *generation, ShardLinks *links, int from, LinkRows *first,
						  RelayStatement statement);

#endif

/*
 * exchange.h: the later phases of a build over several servers.
 */
#ifndef ABACUS_EXCHANGE_H
#define ABACUS_EXCHANGE_H

#include "pg/shards/generation.h"

extern void triangulate_shards(Generation *generation, ShardLinks *links);
extern void exchange_vertices(Generation *generation, ShardLinks *links);

#endif

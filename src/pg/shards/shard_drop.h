/*
 * shard_drop.h: the meshes of a generation go from their servers with the local transaction.
 */
#ifndef ABACUS_SHARD_DROP_H
#define ABACUS_SHARD_DROP_H

#include "pg/shards/generation.h"

extern void shard_drop(const Generation *generation);

#endif

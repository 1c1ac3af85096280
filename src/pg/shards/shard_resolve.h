/*
 * shard_resolve.h: changes of shards that were prepared, and whose end is not known there.
 */
#ifndef ABACUS_SHARD_RESOLVE_H
#define ABACUS_SHARD_RESOLVE_H

#include "pg/shards/generation.h"

extern int64 shard_resolve(const Generation *generation);

#endif

/*
 * shard_net.h: the simplices that a change has created and removed, over all of its steps.
 */
#ifndef ABACUS_SHARD_NET_H
#define ABACUS_SHARD_NET_H

#include "postgres.h"

#include "access/htup.h"
#include "nodes/execnodes.h"

typedef struct ShardNet ShardNet;

extern ShardNet *shard_net_begin(ReturnSetInfo *set);
extern void shard_net_add(ShardNet *net, Datum *values, bool *isnull);
extern void shard_net_end(ShardNet *net);

#endif

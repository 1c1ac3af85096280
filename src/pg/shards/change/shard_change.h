/*
 * shard_change.h: a mesh over several servers is changed.
 */
#ifndef ABACUS_SHARD_CHANGE_H
#define ABACUS_SHARD_CHANGE_H

#include "postgres.h"

#include "nodes/execnodes.h"

#include "pg/input/source.h"

extern uint64 shard_insert(Oid mesh, Source *source, const char *on_duplicate, ReturnSetInfo *set, const char *command);
extern uint64 shard_delete(Oid mesh, Source *source, ReturnSetInfo *set, const char *command);
extern uint64 shard_update(Oid mesh, Source *source, const char *command);

#endif

/*
 * shard_check.h: the verification of a mesh over several servers, and its figures.
 */
#ifndef ABACUS_SHARD_CHECK_H
#define ABACUS_SHARD_CHECK_H

#include "postgres.h"

#include "fmgr.h"

extern Datum shard_check(FunctionCallInfo fcinfo);
extern Datum shard_stats(FunctionCallInfo fcinfo);

#endif

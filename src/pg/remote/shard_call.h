/*
 * shard_call.h: the call of a function on the coordinator's mesh as a call on a shard's, in SQL.
 */
#ifndef ABACUS_SHARD_CALL_H
#define ABACUS_SHARD_CALL_H

#include "postgres.h"

#include "fmgr.h"

extern char *shard_call(FunctionCallInfo fcinfo, const char *mesh, int replaced, const char *const *replacements);
extern bool shard_call_has_text(FunctionCallInfo fcinfo, const char *name, const char *value);
extern bool shard_call_has_null(FunctionCallInfo fcinfo, const char *name);

#endif

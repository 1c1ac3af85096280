/*
 * shard_read.h: questions to a mesh over several servers: the same functions, called on the servers.
 */
#ifndef ABACUS_SHARD_READ_H
#define ABACUS_SHARD_READ_H

#include "postgres.h"

#include "abacus/facts.h"
#include "fmgr.h"

/* What belongs to a shard of the rows that a function returns there. */
typedef enum ShardRows
{
	ROWS_BY_CODE,				/* simplices whose code it owns */
	ROWS_WITHOUT_GUESTS			/* points that it owns */
} ShardRows;

extern bool is_over_shards(FunctionCallInfo fcinfo);
extern Datum shard_read_rows(FunctionCallInfo fcinfo, ShardRows rows);
extern bool shard_can_answer(FunctionCallInfo fcinfo);
extern Datum shard_read_places(FunctionCallInfo fcinfo, bool has_row_outside);
extern Datum shard_read_nearest(FunctionCallInfo fcinfo, int coordinates);
extern Datum shard_read_nearest_places(FunctionCallInfo fcinfo);

#endif

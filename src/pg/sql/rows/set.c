/*
 * set.c: functions that return the rows of a mesh one by one.
 *
 * Between calls only the core's scan is kept, which holds a few decoded pages in memory and nothing
 * of PostgreSQL. So a query that stops early (LIMIT, a closed cursor) leaves nothing behind.
 */
#include "postgres.h"

#include "pg/sql/rows/set.h"

/* First call of a set: opens the mesh, its first argument, for the later calls. */
Reader *
set_begin(FunctionCallInfo fcinfo, FuncCallContext *set,
		  TupleDesc (*row_type) (FunctionCallInfo fcinfo))
{
	return set_begin_of(fcinfo, set, ABACUS_MESH, row_type);
}

/* The same for an object of another type. */
Reader *
set_begin_of(FunctionCallInfo fcinfo, FuncCallContext *set, uint32 type,
			 TupleDesc (*row_type) (FunctionCallInfo fcinfo))
{
	MemoryContext old = MemoryContextSwitchTo(set->multi_call_memory_ctx);
	Reader	   *reader = reader_open_of(PG_GETARG_OID(0), type, set->multi_call_memory_ctx);

	set->tuple_desc = row_type(fcinfo);
	set->user_fctx = reader;
	MemoryContextSwitchTo(old);
	return reader;
}

/*
 * set.h: functions that return the rows of a mesh one by one.
 */
#ifndef ABACUS_SET_H
#define ABACUS_SET_H

#include "funcapi.h"
#include "pg/mesh/reader.h"

extern Reader *set_begin(FunctionCallInfo fcinfo, FuncCallContext *set,
						 TupleDesc (*row_type) (FunctionCallInfo fcinfo));

extern Reader *set_begin_of(FunctionCallInfo fcinfo, FuncCallContext *set, uint32 type,
							TupleDesc (*row_type) (FunctionCallInfo fcinfo));

#endif

/*
 * simplex_row.h: the composite type abacus_simplex.
 */
#ifndef ABACUS_SIMPLEX_ROW_H
#define ABACUS_SIMPLEX_ROW_H

#include "abacus/abacus.h"

#include "access/tupdesc.h"
#include "fmgr.h"

extern TupleDesc result_row_type(FunctionCallInfo fcinfo);
extern TupleDesc cached_row_type(FunctionCallInfo fcinfo);
extern Datum simplex_row(TupleDesc row_type, const abacus_simplex *simplex, uint32 dimension);
extern bool simplex_from_row(Datum row, TupleDesc row_type, uint32 dimension, uint64 *code,
							 int64 *ids);

#endif

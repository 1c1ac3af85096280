/*
 * simplex_row.h: the composite type abacus_simplex.
 */
#ifndef ABACUS_SIMPLEX_ROW_H
#define ABACUS_SIMPLEX_ROW_H

#include "abacus/simplex.h"

#include "access/htup.h"
#include "access/tupdesc.h"
#include "fmgr.h"

/* The data that a function called for many rows keeps. */
typedef struct SimplexRows
{
	TupleDesc	row_type;
	HeapTupleHeader model[ABACUS_MAX_DIMENSION + 1];	/* the first row of each dimension */
	MemoryContext memory;
} SimplexRows;

/* (code, v0, v1, v2, v3) */
#define SIMPLEX_COLUMNS (2 + ABACUS_MAX_DIMENSION)

extern TupleDesc simplex_row_type(FunctionCallInfo fcinfo);
extern SimplexRows *simplex_rows(FunctionCallInfo fcinfo);
extern void simplex_columns(const abacus_simplex *simplex, uint32 dimension, Datum *values,
							bool *isnull);
extern Datum simplex_row(TupleDesc row_type, const abacus_simplex *simplex, uint32 dimension);
extern Datum simplex_row_again(SimplexRows *rows, const abacus_simplex *simplex, uint32 dimension);
extern bool simplex_from_row(Datum row, TupleDesc row_type, uint32 dimension, uint64 *code,
							 int64 *ids);
extern bool simplex_from_argument(Datum row, uint32 dimension, uint64 *code, int64 *ids);

#endif

/*
 * result.h: the results of SQL functions: rows, and rows of figures.
 */
#ifndef ABACUS_RESULT_H
#define ABACUS_RESULT_H

#include "access/tupdesc.h"
#include "fmgr.h"
#include "nodes/execnodes.h"

#include "pg/base/float_array.h"

/* A result with a row for each figure: name, value, description. */
typedef struct Figures
{
	ReturnSetInfo *set;
	const char *prefix;			/* of the next names */
} Figures;

extern TupleDesc result_row_type(FunctionCallInfo fcinfo);
extern void result_require_type(TupleDesc row_type, const char *name, const Oid *types, int count,
								const char *attributes, const char *hint);
extern void put_figure(const Figures *figures, const char *name, double value,
					   const char *description);
extern double bytes_of(PGFunction size, Oid relid);

#endif

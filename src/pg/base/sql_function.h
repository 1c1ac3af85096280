/*
 * sql_function.h: declares a function that SQL can call.
 *
 * Symbols are hidden unless exported, since all modules of a backend share one name space. Before
 * PostgreSQL 16, PG_FUNCTION_INFO_V1 exports the record that describes a function, but not the
 * function.
 */
#ifndef ABACUS_SQL_FUNCTION_H
#define ABACUS_SQL_FUNCTION_H

#include "fmgr.h"
#include "utils/tuplestore.h"	/* rows that are returned; before 19 it came with funcapi.h */

#define SQL_FUNCTION(name) \
	extern PGDLLEXPORT Datum name(PG_FUNCTION_ARGS); \
	PG_FUNCTION_INFO_V1(name)

#endif

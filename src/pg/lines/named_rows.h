/*
 * named_rows.h: rows in a tuplestore, which queries of the same SPI connection can name like a
 * table.
 */
#ifndef ABACUS_NAMED_ROWS_H
#define ABACUS_NAMED_ROWS_H

#include "access/tupdesc.h"
#include "utils/tuplestore.h"

/* A column of them. */
typedef struct NamedColumn
{
	const char *name;
	Oid			type;
} NamedColumn;

typedef struct NamedRows
{
	const char *name;
	TupleDesc	desc;
	Tuplestorestate *store;
	uint64		count;
} NamedRows;

extern NamedRows *named_rows_create(const char *name, const NamedColumn *columns, int count);
extern void named_rows_put(NamedRows *rows, const Datum *values, const bool *isnull);
extern void named_rows_register(NamedRows *rows);
extern NamedRows *named_rows_of_query(const char *name, const NamedColumn *columns, int count,
									  const char *query);

extern void named_rows_free(NamedRows *rows);

extern int	plain_names_begin(bool writes);
extern void plain_names_end(int level);

extern uint64 query_into(Tuplestorestate *store, const char *query);
extern uint64 query_run(const char *query);
extern void query_change(const char *table, const char *contents, const char *statement, uint64 rows);
extern bool query_first(const char *query, Datum *values, bool *isnull, int count);

#endif

/* new_table.h: the place for a new table, and the table once it is made. */
#ifndef ABACUS_NEW_TABLE_H
#define ABACUS_NEW_TABLE_H

#include "nodes/primnodes.h"

extern RangeVar *new_table_name(text *name);
extern Oid	new_table_schema(RangeVar *name);
extern void new_table_check_name(Oid schema, const char *name);
extern void new_table_create(const char *command, const char *name);
extern Oid	new_table_id(Oid schema, const char *name);
extern void new_table_describe(Oid table, const char *what, Oid row, int columns);

#endif

/* new_table.h: the place for a new table, and the table once it is made. */
#ifndef ABACUS_NEW_TABLE_H
#define ABACUS_NEW_TABLE_H

#include "nodes/primnodes.h"
#include "utils/rel.h"

/* A table of rows beside the pages of a mesh. */
typedef struct NewSideTable
{
	const char *suffix;			/* of its name, after the mesh's */
	const char *type;			/* of its rows */
	int			columns;
	const char *options;		/* of its columns, and its primary key, in SQL */
	const char *partitioning;	/* in SQL, or NULL */
	const char *contents;		/* what is in it, for messages */
	const char *maker;			/* the function that makes it */
	const char *reader;			/* the function that shows what is in it */
} NewSideTable;

extern RangeVar *new_table_name(text *name);
extern Oid	new_table_schema(RangeVar *name);
extern void new_table_check_name(Oid schema, const char *name);
extern void new_table_create(const char *command, const char *name);
extern Oid	new_table_id(Oid schema, const char *name);
extern void new_table_describe(Oid table, const char *what, Oid row, int columns);
extern Oid	side_table_make(Relation mesh, const NewSideTable *made);
extern void side_table_create(Relation mesh, const char *command, const char *name);

#endif

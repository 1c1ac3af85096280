/*
 * side_table.h: makes a table of rows beside the pages of a mesh.
 */
#ifndef ABACUS_SIDE_TABLE_H
#define ABACUS_SIDE_TABLE_H

#include "utils/rel.h"

typedef struct NewSideTable
{
	const char *suffix;			/* of its name, after the mesh's */
	const char *type;			/* of its rows */
	int			columns;
	const char *options;		/* of its columns, and its primary key, in SQL */
	const char *contents;		/* what is in it, for messages */
	const char *maker;			/* the function that makes it */
	const char *reader;			/* the function that shows what is in it */
} NewSideTable;

extern Oid	side_table_make(Relation mesh, const NewSideTable *made);
extern void side_table_create(Relation mesh, const char *command, const char *name);

#endif

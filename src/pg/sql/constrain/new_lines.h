/*
 * new_lines.h: lines that a mesh gets, and those that they replace.
 */
#ifndef ABACUS_NEW_LINES_H
#define ABACUS_NEW_LINES_H

#include "pg/mesh/change.h"

/* What happens if there is a line with the id of a new one. */
typedef enum ExistingLines
{
	EXISTING_ERROR,
	EXISTING_REPLACE
} ExistingLines;

extern void new_lines_check_mesh(const Change *change);
extern char *new_lines_vertices(Oid function, Oid mesh);
extern uint64 new_lines_add(Change *change, Source *source, const char *vertices, const char *kind,
							ExistingLines existing, const char *z);
extern uint64 new_lines_delete(Change *change, const char *table, const char *ids,
							   int64 *soft);

#endif

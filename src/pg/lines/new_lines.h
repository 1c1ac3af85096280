/*
 * new_lines.h: lines that a mesh gets, and those that they replace.
 */
#ifndef ABACUS_NEW_LINES_H
#define ABACUS_NEW_LINES_H

#include "pg/lines/line_points.h"
#include "pg/mesh/change.h"

/* What happens if there is a line with the id of a new one. */
typedef enum ExistingLines
{
	EXISTING_ERROR,
	EXISTING_REPLACE
} ExistingLines;

/* What happens to points of new lines that the mesh lacks. */
typedef struct NewPoints
{
	void		(*allow) (const Change *change);	/* an error if it must not get any; or NULL */
	bool		insert_waiting;	/* inserts points that wait, too; otherwise new points wait with them */
} NewPoints;

/* What becomes of the points of new lines in the table of lines: SQL over a row p of LINE_POINTS. */
typedef struct LineValues
{
	const char *kind;			/* of the line */
	const char *made;			/* whether a line has made the vertex */
	const char *joins;			/* other rows that these name */
} LineValues;

extern void new_lines_check_mesh(const Change *change);
extern char *new_lines_vertices(Oid function, Oid mesh);
extern uint64 new_lines_put(Change *change, const NamedRows *points, const char *kind,
							ExistingLines existing, const NewPoints *allowed);
extern uint64 new_lines_add(Change *change, Source *source, const char *vertices, const char *kind,
							ExistingLines existing, const char *z, const NewPoints *points);
extern void new_lines_write(const char *table, const LineValues *values, const NamedRows *points);
extern void new_lines_join(Change *change, const LineValues *values, const NewPoints *points);
extern uint64 new_lines_delete(Change *change, const char *table, const char *ids,
							   int64 *soft);

#endif

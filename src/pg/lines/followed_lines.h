/*
 * followed_lines.h: lines of a table that a mesh follows, as the mesh catches up with them.
 */
#ifndef ABACUS_FOLLOWED_LINES_H
#define ABACUS_FOLLOWED_LINES_H

#include "pg/lines/new_lines.h"

/* Rows with a name: the ids of lines that have changed. Queries for rows of the table may name them. */
#define CHANGED_LINES "abacus_changed_lines"

/* What is known about the table. All queries are for changed lines only, unless all have changed. */
typedef struct LineQueries
{
	const char *rows;			/* of lines, as line_rows_read() takes them */
	const char *kinds;			/* line and kind; NULL: all lines have `kind` */
	const char *kind;
	const char *least;			/* the least id of points, which vertices made by lines are below */
	const char *vertices;		/* a call of abacus_vertices() for the mesh, in SQL */
	LineReading reading;
} LineQueries;

typedef struct FollowedLines FollowedLines;

extern FollowedLines *followed_lines_begin(Change *change, Oid table, bool all);
extern void followed_lines_note(FollowedLines *lines, int64 line);
extern void followed_lines_note_place(FollowedLines *lines, const double place[2]);
extern bool followed_lines_leave(FollowedLines *lines, const LineQueries *queries);
extern void followed_lines_come(FollowedLines *lines);
extern uint64 followed_lines_compare(FollowedLines *lines, const LineQueries *queries);
extern void followed_lines_end(FollowedLines *lines);

#endif

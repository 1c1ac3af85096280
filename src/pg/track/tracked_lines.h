/*
 * tracked_lines.h: the lines of a table that a mesh follows.
 */
#ifndef ABACUS_TRACKED_LINES_H
#define ABACUS_TRACKED_LINES_H

#include "commands/trigger.h"
#include "nodes/pg_list.h"
#include "utils/array.h"
#include "utils/rel.h"

#include "pg/lines/followed_lines.h"
#include "pg/track/tracking.h"

/*
 * Arguments of the triggers: name of the mesh, the kind of all lines or '', the column that has it or
 * '', the attribute that gets the Z of geometries or '', and the columns: line and geometry, or line,
 * position, point and perhaps part.
 */
enum
{
	LINE_ARGUMENT_KIND = 1,
	LINE_ARGUMENT_KIND_COLUMN,
	LINE_ARGUMENT_Z,
	LINE_ARGUMENT_COLUMNS
};

/* How a table gives lines. */
typedef struct TrackedLines
{
	Oid			table;
	Oid			user;			/* whose rights are used to read it */
	const char *kind;			/* 'hard' or 'soft'; NULL: the column has it */
	const char *kind_column;
	const char *z;				/* NULL: none */
	List	   *columns;
} TrackedLines;

extern TrackedLines *tracked_lines_given(Relation table, abacus_names names, ArrayType *columns,
										 const char *kind, const char *z);
extern void tracked_lines_check_types(const TrackedLines *lines, Relation table);
extern TrackedLines *tracked_lines_of(Relation mesh);
extern bool tracked_lines_read(TrackedLines *lines, char **arguments, int count);
extern List *tracked_lines_arguments(const TrackedLines *lines);
extern List *tracked_lines_columns(const TrackedLines *lines);
extern void tracked_lines_queries(const TrackedLines *lines, const Change *change, bool all,
								  LineQueries *queries);
extern char *tracked_lines_of_one_table(Relation table, const TrackedLines *lines);

#endif

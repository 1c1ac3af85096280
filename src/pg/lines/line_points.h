/*
 * line_points.h: the points of lines that a query gives: checked, found in the mesh, or new.
 */
#ifndef ABACUS_LINE_POINTS_H
#define ABACUS_LINE_POINTS_H

#include "abacus/mesh_header.h"
#include "pg/lines/line_rows.h"
#include "pg/mesh/change.h"

/* Rows with a name: line, position, point, x, y, attributes, is_new, part. */
#define LINE_POINTS "abacus_points"

/* Rows with a name: points of the mesh that lines name. */
#define FOUND_POINTS "abacus_found"

/* The columns of these rows. */
enum
{
	FOUND_ID,
	FOUND_X,
	FOUND_Y,
	FOUND_VERTEX,				/* that stands for the point; NULL while it waits */
	FOUND_SEQUENCE,				/* NULL unless it waits */
	FOUND_ATTRIBUTES,
	FOUND_BY_ID,				/* a row has its id */
	FOUND_COLUMNS
};

/* Lines being added to a mesh. */
typedef struct NewLines
{
	const char *table;			/* of the lines that the mesh has, or NULL */
	const char *vertices;		/* a call of abacus_vertices() for the mesh, in SQL */
	LineReading reading;
	LineShape	shape;
	bool		is_known;		/* points with an id are in the mesh, at the places of the rows */
	const char *new_ids;		/* SELECT of x, y, id, from rows of `nameless` in `known` without an id;
								 * NULL: ids above the greatest */
	abacus_census *census;		/* of the mesh that is being changed: knows the greatest id, or learns it */
} NewLines;

extern void line_points_check(const NewLines *lines);
extern NamedRows *line_points_found(void);
extern NamedRows *line_points_scan(const NewLines *lines);
extern NamedRows *line_points_find(Change *change, const NewLines *lines);
extern NamedRows *line_points_of_query(const char *query);
extern NamedRows *line_points_resolve(const NewLines *lines, NamedRows *found);

#endif

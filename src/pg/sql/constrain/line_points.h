/*
 * line_points.h: the points of lines that a query gives: checked, found in the mesh, or new.
 */
#ifndef ABACUS_LINE_POINTS_H
#define ABACUS_LINE_POINTS_H

#include "abacus/mesh_header.h"
#include "pg/sql/constrain/line_rows.h"

/* Rows with a name: line, position, point, x, y, attributes, is_new, part. */
#define LINE_POINTS "abacus_points"

/* Lines being added to a mesh. */
typedef struct NewLines
{
	const char *table;			/* of the lines that the mesh has, or NULL */
	const char *vertices;		/* a call of abacus_vertices() for the mesh, in SQL */
	abacus_names names;
	const char *z;				/* attribute for the Z of geometries, or NULL */
	LineShape	shape;
} NewLines;

extern void line_points_check(const NewLines *lines);
extern NamedRows *line_points_find(const NewLines *lines);

#endif

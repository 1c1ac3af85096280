/*
 * line_rows.h: the rows of a query that gives lines, or only their ids, read as rows with a name
 * (named_rows.h).
 */
#ifndef ABACUS_LINE_ROWS_H
#define ABACUS_LINE_ROWS_H

#include "abacus/mesh_header.h"
#include "pg/input/source.h"
#include "pg/lines/named_rows.h"

/* The columns of the rows of lines; those after y are NULL if the query does not have them. */
enum
{
	LINE_ROW_LINE,
	LINE_ROW_POSITION,
	LINE_ROW_POINT,				/* the id; may be NULL if there are coordinates */
	LINE_ROW_X,
	LINE_ROW_Y,
	LINE_ROW_ATTRIBUTES,		/* in the order of the mesh; NaN is none */
	LINE_ROW_PART,				/* neighbours in a line are joined if they have the same; NULL is 0 */
	LINE_ROW_COLUMNS
};

/* How the rows of a query of lines are read. */
typedef struct LineReading
{
	abacus_names names;			/* of the mesh */
	const char *z;				/* attribute for the Z of geometries, or NULL */
	const char *points_of;		/* table that gives points their places, for messages; NULL: the query does */
	bool		is_quiet;		/* without notices */
} LineReading;

/* What the rows of a query of lines have. */
typedef struct LineShape
{
	bool		has_places;		/* x and y after the ids */
	bool		has_nameless;	/* rows whose id is NULL */
	bool		has_attributes;
	bool		has_parts;		/* a column for them, or a geometry with several */
	bool		has_geometries; /* instead of rows of points */
	int32		srid;			/* of the geometries; -1: there are none */
} LineShape;

#define LINE_ROWS "abacus_given"
#define LINE_IDS "abacus_lines_given"

extern NamedRows *line_rows_read(Source *source, const LineReading *reading, LineShape *shape);
extern NamedRows *line_ids_read(Source *source);

#endif

/*
 * line_views.h: views that show the lines of a mesh and their fixed edges.
 */
#ifndef ABACUS_LINE_VIEWS_H
#define ABACUS_LINE_VIEWS_H

/* Which mesh they show, and how. */
typedef struct LineViews
{
	Oid			mesh;
	const char *schema;			/* of the views */
	const char *functions;		/* schema of ours */
	bool		has_geometry;
	int			srid;
	const char *z;				/* attribute that is the Z of geometries, or NULL */
} LineViews;

extern Oid	line_views_edges(const LineViews *views, const char *name);
extern Oid	line_views_lines(const LineViews *views, const char *name);

#endif

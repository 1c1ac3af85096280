/*
 * line_views.c: views that show the lines of a mesh and their fixed edges.
 *
 * They call functions, which read all lines. A condition, abacus_published('mesh'), which is true,
 * tells such views from others (shown.c).
 */
#include "postgres.h"

#include "catalog/namespace.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/utility.h"
#include "pg/fdw/line_views.h"
#include "pg/mesh/shown.h"
#include "pg/port/port.h"
#include "pg/postgis/catalogue.h"

/* A call of a function of ours for the mesh, in SQL. */
static char *
call(const LineViews *views, const char *function)
{
	return psprintf("%s('%u'::pg_catalog.regclass)",
					quote_qualified_identifier(views->functions, function), views->mesh);
}

/* A point at a place of the mesh, in SQL. A missing value is NaN, as in the other published tables. */
static char *
point_at(const LineViews *views, Oid type, const char *x, const char *y)
{
	char	   *point = geometry_function(type, "st_makepoint");

	if (views->z == NULL)
		return psprintf("%s(%s, %s)", point, x, y);
	return psprintf("%s(%s, %s, coalesce(%s('%u'::pg_catalog.regclass, %s, %s, %s), 'NaN'))", point, x, y,
					quote_qualified_identifier(views->functions, "abacus_interpolate"), views->mesh, x, y,
					quote_literal_cstr(views->z));
}

/* The type of a column of lines, with its SRID. */
static char *
column_type(const LineViews *views, Oid type, const char *kind)
{
	return psprintf("%s(%s%s, %d)", geometry_function(type, "geometry"), kind, views->z != NULL ? "Z" : "",
					views->srid);
}

/* Makes a view, unless the name is that of one that shows the mesh. */
static Oid
make_view(const LineViews *views, const char *name, const char *query)
{
	Oid			schema = LookupExplicitNamespace(views->schema, false);
	Oid			view = get_relname_relid(name, schema);

	if (OidIsValid(view) && list_member_oid(shown_views(views->mesh), view))
		return view;
	utility_run(psprintf("CREATE VIEW %s AS %s", quote_qualified_identifier(views->schema, name), query));
	view = get_relname_relid(name, schema);
	shown_bind(views->mesh, view);
	return view;
}

/* The view of fixed edges: v0, v1, length, lines, kind, and a line as geometry. */
Oid
line_views_edges(const LineViews *views, const char *name)
{
	Oid			type = postgis_geometry();
	char	   *geometry = "";

	if (views->has_geometry)
		geometry = psprintf(", %s(%s(%s, %s), %d)::%s AS geom", geometry_function(type, "st_setsrid"),
							geometry_function(type, "st_makeline"), point_at(views, type, "path[1]", "path[2]"),
							point_at(views, type, "path[3]", "path[4]"), views->srid,
							column_type(views, type, "LineString"));
	return make_view(views, name,
					 psprintf("SELECT v0, v1, length, lines, kind%s FROM %s WHERE %s", geometry,
							  call(views, "_abacus_fixed_edges"), call(views, SHOWN_MESH_FUNCTION)));
}

/* The view of lines: line, kind and geometry; without geometries, a row for each point. */
Oid
line_views_lines(const LineViews *views, const char *name)
{
	Oid			type = postgis_geometry();
	char	   *lines = call(views, "abacus_lines");
	char	   *condition = call(views, SHOWN_MESH_FUNCTION);

	if (!views->has_geometry)
		return make_view(views, name,
						 psprintf("SELECT line, \"position\", point, x, y, kind, part FROM %s WHERE %s",
								  lines, condition));
	return make_view(views, name,
					 psprintf("SELECT line, kind, %s(%s(path ORDER BY part), %d)::%s AS geom "
							  "FROM (SELECT line, kind, coalesce(part, 0) AS part, %s(%s ORDER BY \"position\") AS path FROM %s "
							  "WHERE %s GROUP BY line, kind, coalesce(part, 0)) AS part GROUP BY line, kind",
							  geometry_function(type, "st_setsrid"), geometry_function(type, "st_collect"),
							  views->srid, column_type(views, type, "MultiLineString"),
							  geometry_function(type, "st_makeline"), point_at(views, type, "x", "y"),
							  lines, condition));
}

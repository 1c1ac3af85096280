/*
 * fn_triangulate.c: abacus_triangulate, which turns staged points into simplex pages, or a query
 * into a finished mesh at once.
 */
#include "postgres.h"

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/lines/new_lines.h"
#include "pg/mesh/change.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"

SQL_FUNCTION(abacus_sql_triangulate);
SQL_FUNCTION(abacus_sql_triangulate_query);

/* abacus_triangulate(mesh regclass) -> bigint */
Datum
abacus_sql_triangulate(PG_FUNCTION_ARGS)
{
	Change	   *change = change_begin(PG_GETARG_OID(0), "abacus_triangulate()");
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	uint64		simplices;
	int			rekeyed;

	change_open_build(change);
	host_run(host, abacus_build_rekey, change->build, setting_sort_bytes(), header, &rekeyed);
	host_run(host, abacus_build_run, change->build, 0, header);
	mesh_lines_fix_waiting(&change->writer, change->build, &change->fixed);
	simplices = header->facts.census.simplices;
	change->inserts = true;
	change_end(change);
	PG_RETURN_INT64((int64) simplices);
}

/* Names the attributes after the columns that follow the coordinates. */
static void
name_attributes(abacus_header *header, const Source *source)
{
	int			first = source_first_attribute(source, header->facts.form.dimension);

	for (int i = first; i < source_columns(source); i++)
	{
		const char *name = source_column_name(source, i);

		shape_attribute(header, name);
		if (header->facts.form.dimension == 2 && first == 3 && strcmp(name, "z") == 0) /* after x, y */
			ereport(NOTICE,
					(errmsg("column \"z\" is an attribute of a mesh of dimension 2"),
					 errhint("Use dimension => 3 to make it a coordinate. To keep it as an "
							 "attribute without this notice, rename it or give attributes => '{z}'.")));
	}
}

/*
 * Inserts points into a new mesh, and then lines, in one change; *header is that of the mesh.
 * `vertices` is a call of abacus_vertices() in SQL.
 */
static void
insert_with_lines(Oid mesh, Source *points, Source *lines, const char *vertices,
				  abacus_header *header)
{
	static const NewPoints new_points = {0};
	Change	   *change = change_begin(mesh, "abacus_triangulate()");

	new_lines_check_mesh(change);
	change_read(change, points);
	change_insert(change);
	change_show(change);		/* the points of lines are found by a query */
	new_lines_add(change, lines, vertices, "hard", EXISTING_ERROR, NULL, &new_points);
	abacus_header_copy(header, change->writer.header);
	change_end(change);
}

/*
 * abacus_triangulate(mesh text, query text, attributes text[], dimension int,
 * lower float8[], upper float8[], lines text) -> bigint
 */
Datum
abacus_sql_triangulate_query(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Source		source;
	Source		lines;
	bool		has_lines = !PG_ARGISNULL(6);
	Oid			mesh;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, query and dimension must not be NULL")));
	shape_dimension(&header->facts.form, PG_GETARG_INT32(3));
	if (!PG_ARGISNULL(2))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(2));
	shape_domain(&header->facts.form, PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4),
				 PG_ARGISNULL(5) ? NULL : PG_GETARG_ARRAYTYPE_P(5));

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	if (has_lines)
		source_prepare(&lines, text_to_cstring(PG_GETARG_TEXT_PP(6)));
	if (PG_ARGISNULL(2))
		name_attributes(header, &source);
	mesh = new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid), header,
					"abacus_triangulate()");
	if (has_lines)
		insert_with_lines(mesh, &source, &lines, new_lines_vertices(fcinfo->flinfo->fn_oid, mesh), header);
	else
		change_insert_query(mesh, &source, "abacus_triangulate()", header);
	if (has_lines)
		source_finish(&lines);
	source_finish(&source);
	PG_RETURN_INT64((int64) header->facts.census.simplices);
}

/*
 * fn_load.c: abacus_load, which makes a mesh from a triangulation made elsewhere.
 *
 * The vertices are read first, then the simplices. The core sorts and checks both within
 * maintenance_work_mem, beyond that in temporary files, and writes the pages. If the simplices are
 * not Abacus' own Delaunay triangulation, it triangulates the vertices instead if the caller
 * wishes. Labels and markers then stay with what is in both, as in any change. With lines, the triangulation may be one that is Delaunay but for their edges. Then these
 * become fixed, and ties between cocircular vertices are flipped.
 */
#include "postgres.h"

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/lines/loaded_lines.h"
#include "pg/lines/new_lines.h"
#include "pg/mesh/change.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"
#include "pg/sql/load/retriangulate.h"

SQL_FUNCTION(abacus_sql_load);

/* Whether a column has a name of its own: PostgreSQL names others column5 or ?column?. */
static bool
is_named(const char *name)
{
	return strncmp(name, "column", strlen("column")) != 0 && name[0] != '?';
}

/* A simplex has one vertex more than its mesh has dimensions; labels follow. */
static int
dimension_of(const Source *simplices, int labels)
{
	int			columns = source_columns(simplices);
	int			vertices = columns - labels;
	const char *last;

	if (vertices >= 3 && vertices <= ABACUS_MAX_DIMENSION + 1)
		return vertices - 1;
	last = vertices > 3 ? source_column_name(simplices, columns - 1) : "";
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("simplices query returns %d columns, not %d or %d", columns, 3 + labels, 4 + labels),
			 labels > 0
			 ? errdetail("Columns are matched by position: v0, v1, v2 of triangles or v0, v1, v2, "
						 "v3 of tetrahedra, then the labels.")
			 : errdetail("Columns are matched by position: v0, v1, v2 of triangles; v0, v1, v2, v3 "
						 "of tetrahedra."),
			 vertices > 3
			 ? errhint("To take labels after the vertices, name all of them, as in labels => '{%s}'.",
					   is_named(last) ? last : "material") : 0));
}

/*
 * Four columns may also be a triangle and its label. They are read as a tetrahedron, and the height
 * of its vertices as z.
 */
static void
tell_dimension(const abacus_form *form, const Source *vertices, const Source *simplices)
{
	const char *z;

	if (form->dimension != 3 || source_first_attribute(vertices, 3) != 4 || source_columns(vertices) < 4)
		return;
	z = source_column_name(vertices, 3);
	if (is_named(z) && strchr(z, 'z') == NULL)
		ereport(NOTICE,
				(errmsg("simplices with four columns are tetrahedra: \"%s\" of the vertices is "
						"taken as z, \"%s\" as v3", z, source_column_name(simplices, 3)),
				 errhint("If these are triangles with a label, name it, as in labels => '{%s}'.",
						 is_named(source_column_name(simplices, 3))
						 ? source_column_name(simplices, 3) : "material")));
}

/*
 * Checks the input. The detail of an error may have many lines, all of which are reported.
 */
static abacus_delaunay
check(Host *host, abacus_load *load)
{
	abacus_delaunay delaunay = ABACUS_DELAUNAY;
	abacus_status status;

	host_enter(host);
	status = abacus_load_check(load, &delaunay, &host->failure);
	if (status != ABACUS_ERROR || host->failure.kind != ABACUS_ERROR_ARGUMENT)
	{
		host_leave(host, status);
		return delaunay;
	}
	host_leave(host, ABACUS_OK);
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg_internal("%s", host->failure.message),
			 abacus_load_detail(load)[0] != '\0' ?
			 errdetail_internal("%s", abacus_load_detail(load)) : 0,
			 errhint("%s", host->failure.hint)));
}

/* ---- The queries ------------------------------------------------------------------------ */

/* What is loaded. */
typedef struct Loading
{
	Source		vertices;
	Source		simplices;
	Source		facets;
	Source		lines;
	bool		has_facets;
	bool		has_lines;
	int			labels;
	bool		reorient;
	bool		split_nodes;
	bool		inherit;
} Loading;

/* Prepares an optional query; returns whether it is there. */
static bool
prepare_optional(Source *source, FunctionCallInfo fcinfo, int argument)
{
	if (PG_ARGISNULL(argument))
		return false;
	source_prepare(source, text_to_cstring(PG_GETARG_TEXT_PP(argument)));
	return true;
}

static void
prepare(Loading *loading, FunctionCallInfo fcinfo)
{
	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2) || PG_ARGISNULL(6) || PG_ARGISNULL(7) ||
		PG_ARGISNULL(10) || PG_ARGISNULL(12))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, vertices, simplices, reorient, retriangulate, split_nodes and inherit must not be NULL")));
	source_prepare(&loading->vertices, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	source_prepare(&loading->simplices, text_to_cstring(PG_GETARG_TEXT_PP(2)));
	loading->has_facets = prepare_optional(&loading->facets, fcinfo, 9);
	loading->has_lines = prepare_optional(&loading->lines, fcinfo, 11);
	loading->reorient = PG_GETARG_BOOL(6);
	loading->split_nodes = PG_GETARG_BOOL(10);
	loading->inherit = PG_GETARG_BOOL(12);
}

/* Ends the queries, the last one first. */
static void
finish(Loading *loading)
{
	if (loading->has_lines)
		source_finish(&loading->lines);
	if (loading->has_facets)
		source_finish(&loading->facets);
	source_finish(&loading->simplices);
	source_finish(&loading->vertices);
}

/* Passes the rows of the prepared queries to the core, which checks them. */
static abacus_delaunay
read_triangulation(Change *change, Loading *loading)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	const uint64 *records;
	size_t		count;

	host_run(host, abacus_load_open, &host->table, &header->facts, setting_sort_bytes(), loading->reorient,
			 loading->split_nodes, &change->load);
	source_open(&loading->vertices, abacus_names_of(header), true);
	while ((count = source_fetch(&loading->vertices, &records)) > 0)
		host_run(host, abacus_load_vertices, change->load, records, count);
	change_take_srid(change, loading->vertices.packer->srid);
	source_close(&loading->vertices);
	source_open_simplices(&loading->simplices, abacus_names_of(header));
	while ((count = source_fetch(&loading->simplices, &records)) > 0)
		host_run(host, abacus_load_simplices, change->load, records, count);
	source_close(&loading->simplices);
	if (loading->has_facets)
	{
		source_open_loaded_facets(&loading->facets, abacus_names_of(header));
		while ((count = source_fetch(&loading->facets, &records)) > 0)
			host_run(host, abacus_load_facets, change->load, records, count);
		source_close(&loading->facets);
	}
	if (loading->has_lines)
		loaded_lines_read(change, &loading->lines);
	return check(host, change->load);
}

/* ---- Notices ---------------------------------------------------------------------------- */

/* A mesh that is as it was given, and cannot be changed. */
static void
tell_unchangeable(abacus_delaunay delaunay, const Loading *loading)
{
	ereport(NOTICE,
			(errmsg("%s", abacus_delaunay_clause(delaunay)),
			 errdetail("%s %sThe mesh can be read, and have other attributes, but not other points.%s",
					   abacus_delaunay_reason(delaunay),
					   loading->has_lines && delaunay == ABACUS_NOT_DELAUNAY ? "Edges on lines do not count. " : "",
					   loading->has_lines ? " It has no lines." : ""),
			 errhint("Use retriangulate => true for Abacus' own triangulation of the vertices%s, "
					 "which can be changed.", loading->has_lines ? " and lines" : "")));
}

/* Edges between vertices on one circle that have been flipped. */
static void
tell_ties(uint64 ties, const Loading *loading)
{
	if (ties == 0)
		return;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " edge between vertices on one circle is not the one that Abacus makes",
						   UINT64_FORMAT " edges between vertices on one circle are not those that Abacus makes",
						   (unsigned long) ties, ties),
			 errdetail("Edges there have been replaced by Abacus' own."),
			 loading->has_facets ? errhint("The new edges have no markers. Give edges that must stay as lines.") :
			 errhint("Give edges that must stay as lines.")));
}

/* ---- Writing ------------------------------------------------------------------------------ */

/*
 * Writes a triangulation that is Abacus' own, but for ties; returns how many ties there were.
 * `edges` are NULL, or those of its lines. Where ties are flipped, triangles inherit the labels of those
 * that their centroids lay in.
 */
static uint64
write_own(Change *change, NamedRows *edges)
{
	abacus_columns *columns = &change->writer.header->facts.columns;
	uint64		ties;

	host_run(change->writer.host, abacus_load_write, change->load, 0, change->writer.header);
	if (edges == NULL)
		return 0;
	loaded_lines_add(change, edges);
	columns->inherits = columns->labels > 0 ? 1 : 0;
	ties = change_restore_ties(change);
	change_settle(change);
	columns->inherits = 0;
	return ties;
}

/* Reads the queries into the mesh, which is empty, and says what has become of them. */
static void
load(Change *change, Loading *loading, bool retriangulates, const char *facets)
{
	Retriangulation anew = {
		.labels = loading->labels > 0,
		.markers = loading->has_facets,
		.inherit = loading->inherit,
		.facets = facets
	};

	abacus_delaunay delaunay = read_triangulation(change, loading);
	NamedRows  *edges = loading->has_lines ? loaded_lines_take(change) : NULL;

	if (delaunay == ABACUS_DELAUNAY || (delaunay == ABACUS_WEAKLY_DELAUNAY && loading->has_lines))
	{
		tell_ties(write_own(change, edges), loading);
		return;
	}
	if (retriangulates)
	{
		retriangulate(change, &anew, edges, delaunay);
		return;
	}
	if (edges != NULL)
		named_rows_free(edges);
	host_run(change->writer.host, abacus_load_write, change->load, 0, change->writer.header);
	tell_unchangeable(delaunay, loading);
}

/*
 * abacus_load(mesh text, vertices text, simplices text, attributes text[],
 * lower float8[], upper float8[], reorient boolean, retriangulate boolean, labels text[], facets text,
 * split_nodes boolean, lines text, inherit boolean)
 *     -> bigint
 */
Datum
abacus_sql_load(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Loading		loading = {.has_facets = false};
	Oid			mesh;
	Change	   *change;
	uint64		loaded;
	Datum	   *labels = NULL;

	prepare(&loading, fcinfo);
	if (!PG_ARGISNULL(8))
		labels = shape_names(PG_GETARG_ARRAYTYPE_P(8), "labels", &loading.labels);
	shape_dimension(&header->facts.form, dimension_of(&loading.simplices, loading.labels));
	if (loading.labels == 0)
		tell_dimension(&header->facts.form, &loading.vertices, &loading.simplices);
	if (!PG_ARGISNULL(3))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(3));
	else
		for (int i = source_first_attribute(&loading.vertices, header->facts.form.dimension);
			 i < source_columns(&loading.vertices); i++)
			shape_attribute(header, source_column_name(&loading.vertices, i));
	for (int i = 0; i < loading.labels; i++)
		shape_label(header, TextDatumGetCString(labels[i]));
	if (loading.split_nodes)
		shape_check_split(header->facts.columns.attributes);
	shape_domain(&header->facts.form, PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4),
				 PG_ARGISNULL(5) ? NULL : PG_GETARG_ARRAYTYPE_P(5));

	mesh = new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid), header,
					"abacus_load()");
	change = change_begin(mesh, "abacus_load()");
	if (loading.has_lines)
		new_lines_check_mesh(change);
	/* attributes that are apart are found by their places only */
	if (loading.split_nodes)
		change->writer.header->facts.columns.apart = 0;
	load(change, &loading, PG_GETARG_BOOL(7),
		 quote_qualified_identifier(get_namespace_name(get_func_namespace(fcinfo->flinfo->fn_oid)), "abacus_facets"));
	loaded = change->writer.header->facts.census.simplices;
	change_end(change);
	finish(&loading);
	PG_RETURN_INT64((int64) loaded);
}

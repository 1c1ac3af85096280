/*
 * fn_load.c: abacus_load, which makes a mesh from a triangulation made elsewhere.
 *
 * The vertices are read first, then the simplices. The core sorts and checks both within
 * maintenance_work_mem, beyond that in temporary files, and writes the pages. If the simplices are
 * not Abacus' own Delaunay triangulation, it triangulates the vertices instead if the caller
 * wishes.
 */
#include "postgres.h"

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"

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

/*
 * Passes the rows of two prepared queries to the core, and those of a third for facets unless it is
 * NULL. The core checks them.
 */
static abacus_delaunay
read_triangulation(Change *change, Source *vertices, Source *simplices, Source *facets,
				   bool reorient, bool split_nodes)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	const uint64 *records;
	size_t		count;

	host_run(host, abacus_load_open, &host->table, &header->facts, setting_sort_bytes(), reorient,
			 split_nodes, &change->load);
	source_open(vertices, abacus_names_of(header), true);
	while ((count = source_fetch(vertices, &records)) > 0)
		host_run(host, abacus_load_vertices, change->load, records, count);
	change_take_srid(change, vertices->packer->srid);
	source_close(vertices);
	source_open_simplices(simplices, abacus_names_of(header));
	while ((count = source_fetch(simplices, &records)) > 0)
		host_run(host, abacus_load_simplices, change->load, records, count);
	source_close(simplices);
	if (facets != NULL)
	{
		source_open_loaded_facets(facets, abacus_names_of(header));
		while ((count = source_fetch(facets, &records)) > 0)
			host_run(host, abacus_load_facets, change->load, records, count);
		source_close(facets);
	}
	return check(host, change->load);
}

/* Reports the kind of a triangulation that is not Abacus' own. */
static void
tell(abacus_delaunay delaunay, bool retriangulated, bool labelled, bool marked)
{
	const char *reason = abacus_delaunay_reason(delaunay);

	if (retriangulated)
		ereport(NOTICE,
				(errmsg("the vertices have been triangulated anew"),
				 errdetail("About the triangulation that was given: %s", reason),
				 labelled ? errhint("The simplices are new: their labels are NULL.") :
				 marked ? errhint("The facets are new: they have no markers.") : 0));
	else
		ereport(NOTICE,
				(errmsg("%s", abacus_delaunay_clause(delaunay)),
				 errdetail("%s The mesh can be read, and have other attributes, but not other points.", reason),
				 errhint("Use retriangulate => true for Abacus' own triangulation of the vertices, "
						 "which can be changed.")));
}

/* Triangulates the loaded vertices. */
static void
triangulate_vertices(Change *change)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;

	/* vertices at one place are now repeated points, as in any mesh */
	header->facts.columns.apart = abacus_are_apart(header->facts.form.dimension,
												   header->facts.columns.attributes);
	change_open_stage(change, &header->facts);
	host_run(host, abacus_load_stage, change->load, change->stage);
	abacus_load_close(change->load);
	change->load = NULL;
	change_insert(change);
}

/*
 * abacus_load(mesh text, vertices text, simplices text, attributes text[],
 * lower float8[], upper float8[], reorient boolean, retriangulate boolean, labels text[], facets text,
 * split_nodes boolean)
 *     -> bigint
 */
Datum
abacus_sql_load(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Source		vertices;
	Source		simplices;
	Source		facets;
	bool		has_facets = !PG_ARGISNULL(9);
	bool		split_nodes = PG_GETARG_BOOL(10);
	Oid			mesh;
	Change	   *change;
	Host	   *host;
	abacus_delaunay delaunay;
	bool		retriangulate;
	uint64		loaded;
	Datum	   *labels = NULL;
	int			label_count = 0;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2) || PG_ARGISNULL(6) || PG_ARGISNULL(7) ||
		PG_ARGISNULL(10))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, vertices, simplices, reorient, retriangulate and split_nodes must not be NULL")));
	source_prepare(&vertices, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	source_prepare(&simplices, text_to_cstring(PG_GETARG_TEXT_PP(2)));
	if (has_facets)
		source_prepare(&facets, text_to_cstring(PG_GETARG_TEXT_PP(9)));
	if (!PG_ARGISNULL(8))
		labels = shape_names(PG_GETARG_ARRAYTYPE_P(8), "labels", &label_count);
	shape_dimension(&header->facts.form, dimension_of(&simplices, label_count));
	if (label_count == 0)
		tell_dimension(&header->facts.form, &vertices, &simplices);
	if (!PG_ARGISNULL(3))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(3));
	else
		for (int i = source_first_attribute(&vertices, header->facts.form.dimension);
			 i < source_columns(&vertices); i++)
			shape_attribute(header, source_column_name(&vertices, i));
	for (int i = 0; i < label_count; i++)
		shape_label(header, TextDatumGetCString(labels[i]));
	if (split_nodes)
		shape_check_split(header->facts.columns.attributes);
	shape_domain(&header->facts.form, PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4),
				 PG_ARGISNULL(5) ? NULL : PG_GETARG_ARRAYTYPE_P(5));

	mesh = new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid), header,
					"abacus_load()");
	change = change_begin(mesh, "abacus_load()");
	host = change->writer.host;
	/* attributes that are apart are found by their places only */
	if (split_nodes)
		change->writer.header->facts.columns.apart = 0;
	delaunay = read_triangulation(change, &vertices, &simplices, has_facets ? &facets : NULL,
								  PG_GETARG_BOOL(6), split_nodes);
	retriangulate = PG_GETARG_BOOL(7) && delaunay != ABACUS_DELAUNAY;
	if (retriangulate)
		triangulate_vertices(change);
	else
		host_run(host, abacus_load_write, change->load, change->writer.header);
	loaded = change->writer.header->facts.census.simplices;
	change_end(change);
	if (delaunay != ABACUS_DELAUNAY)
		tell(delaunay, retriangulate, label_count > 0, has_facets);
	if (has_facets)
		source_finish(&facets);
	source_finish(&simplices);
	source_finish(&vertices);
	PG_RETURN_INT64((int64) loaded);
}

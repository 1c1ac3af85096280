/*
 * fn_surface.c: surfaces through a mesh in space: abacus_isosurface, where an attribute has a given
 * value, and abacus_section, where a plane cuts the mesh.
 *
 * The corners of an isosurface have numbers, which are known only when the whole surface has been
 * found. So its rows go into a tuplestore, as those of a function in FROM do anyway. A section is
 * returned polygon by polygon.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/surface.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/missing.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_isosurface);
SQL_FUNCTION(abacus_sql_section);

/* ---- Isosurfaces ------------------------------------------------------- */

/* Arguments of abacus_isosurface */
enum
{
	SURFACE_MESH,
	SURFACE_VALUE,
	SURFACE_ATTRIBUTE,
	SURFACE_CARRY,
	SURFACE_LOWER,
	SURFACE_UPPER,
	SURFACE_MAX_EDGE
};

/* Columns of its result */
enum
{
	TRIANGLE_V0,
	TRIANGLE_CORNERS = TRIANGLE_V0 + 3,
	TRIANGLE_VALUES,
	TRIANGLE_COLUMNS
};

typedef struct Triangles
{
	Host	   *host;
	ReturnSetInfo *set;
	bool		carries;
	MemoryContext row;			/* for the arrays of a row */
} Triangles;

static void
put_row(Triangles *triangles, const abacus_surface_triangle *triangle)
{
	MemoryContext old = MemoryContextSwitchTo(triangles->row);
	Datum		values[TRIANGLE_COLUMNS] = {0};
	bool		isnull[TRIANGLE_COLUMNS] = {false};

	for (int i = 0; i < 3; i++)
		values[TRIANGLE_V0 + i] = Int64GetDatum(triangle->corner[i]);
	values[TRIANGLE_CORNERS] = float_matrix(triangle->point[0], 3, 3);
	isnull[TRIANGLE_VALUES] = !triangles->carries;
	if (triangles->carries)
		values[TRIANGLE_VALUES] = attribute_array(triangle->value, 3);
	MemoryContextSwitchTo(old);
	tuplestore_putvalues(triangles->set->setResult, triangles->set->setDesc, values, isnull);
	MemoryContextReset(triangles->row);
}

/* Adds the row of a triangle; called by the core. */
static abacus_host_status
put_triangle(void *context, const abacus_surface_triangle *triangle)
{
	Triangles  *triangles = context;

	GUARD_BEGIN();
	put_row(triangles, triangle);
	GUARD_END(triangles->host);
	return ABACUS_HOST_OK;
}

static void
surface_arguments(FunctionCallInfo fcinfo, abacus_names names,
				  abacus_isosurface_query *query)
{
	query->value = PG_GETARG_FLOAT8(SURFACE_VALUE);
	if (!isfinite(query->value))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("value must be a finite number"),
				 errhint("abacus_attributes() shows the range of each attribute.")));
	query->attribute = attribute_argument(fcinfo, SURFACE_ATTRIBUTE, names);
	query->carried = attribute_or_none(fcinfo, SURFACE_CARRY, names);
	window_arguments(fcinfo, SURFACE_LOWER, WINDOW_BOX, &names.facts->form, &query->window);
	query->extent.max_edge = extent_max_edge(fcinfo, SURFACE_MAX_EDGE);
}

/*
 * abacus_isosurface(mesh regclass, value float8, attribute text, carry text,
 *                   lower float8[], upper float8[], max_edge float8)
 *     -> v0, v1, v2, corners, values
 */
Datum
abacus_sql_isosurface(PG_FUNCTION_ARGS)
{
	Triangles	triangles = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	abacus_isosurface_query query = {0};
	Reader	   *reader;
	Host	   *host;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(SURFACE_MESH) || PG_ARGISNULL(SURFACE_VALUE))
		PG_RETURN_NULL();
	reader = reader_open(PG_GETARG_OID(SURFACE_MESH), CurrentMemoryContext);
	host = reader->host;
	header_require_dimension(&reader->header.facts.form, 3,
							 "Use abacus_contours for a mesh of dimension 2.");
	surface_arguments(fcinfo, abacus_names_of(&reader->header), &query);
	triangles.host = host;
	triangles.carries = query.carried >= 0;
	triangles.row = AllocSetContextCreate(CurrentMemoryContext, "Abacus row",
										  ALLOCSET_SMALL_SIZES);
	progress_begin(&host->progress, PG_GETARG_OID(SURFACE_MESH));
	host_run(host, abacus_isosurface, &host->table, &reader->header.facts, &query,
			 setting_query_sort_bytes(), put_triangle, &triangles);
	progress_end(&host->progress);
	if (tuplestore_tuple_count(triangles.set->setResult) == 0)
		notice_missing_values(reader, query.attribute);
	host_release(host);
	host_destroy(host);
	PG_RETURN_NULL();
}

/* ---- Sections ------------------------------------------------------------ */

/* Arguments of abacus_section */
enum
{
	SECTION_MESH,
	SECTION_THROUGH,
	SECTION_NORMAL,
	SECTION_ATTRIBUTE,
	SECTION_MAX_EDGE
};

/* Columns of its result */
enum
{
	POLYGON_CODE,
	POLYGON_CORNERS,
	POLYGON_VALUES,
	POLYGON_LABELS,
	POLYGON_COLUMNS
};

typedef struct Section
{
	Reader	   *reader;
	bool		has_values;
} Section;

/* Three finite coordinates. */
static void
vector_argument(FunctionCallInfo fcinfo, int argument, const abacus_form *form,
				const char *name, double *vector)
{
	shape_point(form, PG_GETARG_ARRAYTYPE_P(argument), name, vector);
	for (int i = 0; i < 3; i++)
		if (!isfinite(vector[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("%s must be finite on axis %c", name, "xyz"[i]),
					 errhint("Give a point of the plane and the direction at right angles to it.")));
}

static void
section_arguments(FunctionCallInfo fcinfo, abacus_names names,
				  abacus_section_query *query)
{
	header_require_dimension(&names.facts->form, 3,
							 "Use abacus_profile for the section of a mesh of dimension 2.");
	vector_argument(fcinfo, SECTION_THROUGH, &names.facts->form, "through", query->through);
	vector_argument(fcinfo, SECTION_NORMAL, &names.facts->form, "normal", query->normal);
	if (query->normal[0] == 0 && query->normal[1] == 0 && query->normal[2] == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("normal must not be zero"),
				 errhint("Give a normal of any other length.")));
	query->attribute = attribute_or_none(fcinfo, SECTION_ATTRIBUTE, names);
	if (query->attribute < 0 && names.facts->columns.attributes > 0)
		query->attribute = header_only_attribute(names);
	query->extent.max_edge = extent_max_edge(fcinfo, SECTION_MAX_EDGE);
}

static void
begin_section(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Section    *section = MemoryContextAllocZero(set->multi_call_memory_ctx, sizeof(Section));
	Reader	   *reader = set_begin(fcinfo, set, result_row_type);
	Host	   *host = reader->host;
	abacus_section_query query = {{0}};
	abacus_sections *sections = NULL;

	section_arguments(fcinfo, abacus_names_of(&reader->header), &query);
	section->reader = reader;
	section->has_values = query.attribute >= 0;
	set->user_fctx = section;
	host_run(host, abacus_sections_open, &host->table, &reader->header.facts, &query, &sections);
	host_own(host, sections, (void (*) (void *)) abacus_sections_close);
}

static Datum
polygon_row(TupleDesc row_type, const abacus_polygon *polygon, bool has_values,
			const double *labels, uint32 label_count)
{
	Datum		values[POLYGON_COLUMNS] = {0};
	bool		isnull[POLYGON_COLUMNS] = {false, false, !has_values, label_count == 0};

	values[POLYGON_CODE] = Int64GetDatum((int64) polygon->code);
	values[POLYGON_CORNERS] = attribute_array(polygon->point[0], polygon->corners * 3);
	if (has_values)
		values[POLYGON_VALUES] = attribute_array(polygon->value, polygon->corners);
	if (label_count > 0)
		values[POLYGON_LABELS] = attribute_array(labels, (int) label_count);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/*
 * abacus_section(mesh regclass, through float8[], normal float8[], attribute text,
 *                max_edge float8)
 *     -> code, polygon, values, labels
 */
Datum
abacus_sql_section(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Section    *section;
	Host	   *host;
	abacus_polygon polygon;
	const double *labels = NULL;
	uint32		label_count;
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(SECTION_MESH) || PG_ARGISNULL(SECTION_THROUGH) ||
			PG_ARGISNULL(SECTION_NORMAL))
			SRF_RETURN_DONE(set);
		begin_section(fcinfo, set);
	}
	set = SRF_PERCALL_SETUP();
	section = set->user_fctx;
	host = section->reader->host;
	label_count = section->reader->header.facts.columns.labels;
	status = host_run(host, abacus_sections_next, host->handle, &polygon);
	if (status != ABACUS_END && label_count > 0)
		host_run(host, abacus_sections_labels, host->handle, &labels);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, polygon_row(set->tuple_desc, &polygon, section->has_values, labels,
									 label_count));
}

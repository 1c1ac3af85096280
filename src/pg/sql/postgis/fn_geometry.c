/*
 * fn_geometry.c: the C part of the functions of the extension abacus_postgis: converts coordinates
 * that functions of the extension abacus return to geometries, and geometries to arguments of these
 * functions.
 *
 * The functions themselves are SQL (sql/install_postgis), which the planner inlines.
 */
#include "postgres.h"

#include <float.h>
#include <math.h>

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "pg/geos/area_text.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/postgis/geometry_write.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/line.h"
#include "pg/sql/postgis/geometry_place.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_polygon_text);
SQL_FUNCTION(abacus_sql_geometry_facts);
SQL_FUNCTION(abacus_sql_geometry_corner);
SQL_FUNCTION(abacus_sql_geometry_area);
SQL_FUNCTION(abacus_sql_geometry_point);
SQL_FUNCTION(abacus_sql_geometry_path);
SQL_FUNCTION(abacus_sql_cell_geometry);
SQL_FUNCTION(abacus_sql_point_geometry);
SQL_FUNCTION(abacus_sql_line_geometry);
SQL_FUNCTION(abacus_sql_polygon_geometry);
SQL_FUNCTION(abacus_sql_triangles_geometry);

/* ---- Arguments ------------------------------------------------------------- */

/*
 * _abacus_facts(mesh regclass, attribute text) -> srid, dimension, attribute
 *
 * The number of the attribute, from 1; NULL without a name.
 */
Datum
abacus_sql_geometry_facts(PG_FUNCTION_ARGS)
{
	Datum		values[3] = {0};
	bool		isnull[3] = {false, false, PG_ARGISNULL(1)};
	abacus_names names;

	if (PG_ARGISNULL(0))
		PG_RETURN_NULL();
	names = abacus_names_of(&mesh_cache_get(PG_GETARG_OID(0))->header);
	values[0] = Int32GetDatum((int32) names.facts->form.srid);
	values[1] = Int32GetDatum((int32) names.facts->form.dimension);
	if (!isnull[2])
		values[2] = Int32GetDatum(1 + header_find_attribute(names, text_to_cstring(PG_GETARG_TEXT_PP(1))));
	PG_RETURN_DATUM(HeapTupleGetDatum(heap_form_tuple(result_row_type(fcinfo), values, isnull)));
}

/*
 * _abacus_corner(mesh regclass, srid int, corner float8[]) -> float8[]
 *
 * A corner {x, y, z} of the box around a geometry, as an argument of functions that take a window.
 * For a geometry without z, z is infinite. There is no window for an empty geometry, whose box is
 * NULL.
 */
Datum
abacus_sql_geometry_corner(PG_FUNCTION_ARGS)
{
	const abacus_facts *facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	ArrayType  *array = PG_GETARG_ARRAYTYPE_P(2);
	double		corner[ABACUS_MAX_DIMENSION] = {0};

	geometry_check_srid(&facts->form, PG_GETARG_INT32(1));
	if (!array_contains_nulls(array))
		memcpy(corner, geometry_numbers(array, ABACUS_MAX_DIMENSION, &(size_t) {0}), sizeof(corner));
	for (uint32 i = 0; i < facts->form.dimension; i++)
		if (isnan(corner[i]))
			geometry_refuse_coordinate("the geometry");
		else if (isinf(corner[i]))
			corner[i] = corner[i] < 0 ? -DBL_MAX : DBL_MAX;
	PG_RETURN_DATUM(attribute_array(corner, (int) facts->form.dimension));
}

/*
 * _abacus_area(mesh regclass, area geometry) -> geometry: the same; an error unless it is valid
 * polygons in the mesh's system
 */
Datum
abacus_sql_geometry_area(PG_FUNCTION_ARGS)
{
	const abacus_facts *facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	GeometryBytes bytes = geometry_bytes(geometry_argument_type(fcinfo, 1), PG_GETARG_DATUM(1));
	GeometryHead head = geometry_head(&bytes);

	header_require_dimension(&facts->form, 2, "Use a mesh of dimension 2.");
	if (head.kind != GEOMETRY_POLYGON && head.kind != GEOMETRY_MULTIPOLYGON)
		geometry_refuse_kind("the geometry", head.kind, "a Polygon or MultiPolygon");
	geometry_check_srid(&facts->form, head.srid);
	(void) area_text_read("area", geometry_hex(geometry_argument_type(fcinfo, 1), PG_GETARG_DATUM(1)));
	PG_RETURN_DATUM(PG_GETARG_DATUM(1));
}

/* _abacus_polygon_text(mesh regclass, within text) -> text: within, as it is; NULL if it is the name of a region */
Datum
abacus_sql_polygon_text(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	const abacus_header *header = &mesh_cache_get(mesh)->header;
	abacus_extent extent = {0};

	extent_within(fcinfo, 1, mesh, &header->facts, header->stamp, NULL, &extent);
	if (extent.area == NULL)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(PG_GETARG_DATUM(1));
}

/* _abacus_place(mesh regclass, point geometry) -> float8[]: its coordinates; NULL for an empty point */
Datum
abacus_sql_geometry_point(PG_FUNCTION_ARGS)
{
	const abacus_facts *facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	double		place[ABACUS_MAX_DIMENSION];

	if (!geometry_place(fcinfo, 1, "the geometry", &facts->form, place))
		PG_RETURN_NULL();
	PG_RETURN_DATUM(attribute_array(place, (int) facts->form.dimension));
}

/* _abacus_path(mesh regclass, line geometry) -> float8[]: its corners; NULL for an empty line */
Datum
abacus_sql_geometry_path(PG_FUNCTION_ARGS)
{
	const abacus_facts *facts = &mesh_cache_get(PG_GETARG_OID(0))->header.facts;
	GeometryBytes bytes = geometry_bytes(geometry_argument_type(fcinfo, 1), PG_GETARG_DATUM(1));
	GeometryHead head = geometry_head(&bytes);
	int			dimension = (int) facts->form.dimension;
	double	   *path;
	uint32		count;

	if (head.kind != GEOMETRY_LINE)
		geometry_refuse_kind("the geometry", head.kind, "a LineString");
	geometry_check_srid(&facts->form, head.srid);
	if (dimension > 2 && !head.has_z)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the geometry has no z, but the mesh has dimension %d", dimension),
				 errhint("Add one with ST_Force3DZ(geometry, z).")));
	count = geometry_count(&bytes);
	if (count == 0)
		PG_RETURN_NULL();
	path = palloc((Size) count * dimension * sizeof(double));
	for (uint32 i = 0; i < count; i++)
	{
		double		at[GEOMETRY_COORDINATES];

		geometry_coordinates(&bytes, &head, at);
		for (int k = 0; k < dimension; k++)
			if (!isfinite(at[k]))
				geometry_refuse_coordinate("the geometry");
		memcpy(path + (Size) i * dimension, at, dimension * sizeof(double));
	}
	PG_RETURN_DATUM(attribute_array(path, (int) (count * dimension)));
}

/* ---- Results --------------------------------------------------------------- */

/* The triangle of a cell's corners, with the attribute as z if its number is not NULL. */
static bool
put_triangle_of_cell(FunctionCallInfo fcinfo, StringInfo bytes, const double *corners)
{
	int			dimension = PG_ARGISNULL(2) ? 2 : 3;
	GeometryHead head = {GEOMETRY_POLYGON, PG_GETARG_INT32(3), dimension == 3};
	double		ring[3 * 3];

	for (int i = 0; i < 3; i++)
		memcpy(ring + i * dimension, corners + i * 2, 2 * sizeof(double));
	if (dimension == 3)
	{
		double		values[3];

		if (!geometry_corner_values(PG_GETARG_ARRAYTYPE_P(1), PG_GETARG_INT32(2), values))
			return false;
		for (int i = 0; i < 3; i++)
			ring[i * 3 + 2] = values[i];
	}
	geometry_put_triangle(bytes, &head, ring);
	return true;
}

/*
 * _abacus_cell(corners float8[], values float8[], attribute int, srid int) -> geometry
 *
 * NULL if the attribute is missing at a corner.
 */
Datum
abacus_sql_cell_geometry(PG_FUNCTION_ARGS)
{
	size_t		count;
	const double *corners;
	StringInfoData bytes;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3))
		PG_RETURN_NULL();
	corners = geometry_numbers(PG_GETARG_ARRAYTYPE_P(0), 6, &count);
	initStringInfo(&bytes);
	if (count == 4 * 3)
		geometry_put_tetrahedron(&bytes, corners, PG_GETARG_INT32(3));
	else if (!put_triangle_of_cell(fcinfo, &bytes, corners))
		PG_RETURN_NULL();
	PG_RETURN_DATUM(geometry_made(geometry_argument_type(fcinfo, -1), &bytes));
}

/* _abacus_point(x float8, y float8, z float8, srid int) -> geometry; without z if it is NULL */
Datum
abacus_sql_point_geometry(PG_FUNCTION_ARGS)
{
	GeometryHead head = {GEOMETRY_POINT, 0, !PG_ARGISNULL(2)};
	double		place[ABACUS_MAX_DIMENSION];
	StringInfoData bytes;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3))
		PG_RETURN_NULL();
	place[0] = PG_GETARG_FLOAT8(0);
	place[1] = PG_GETARG_FLOAT8(1);
	if (head.has_z)
		place[2] = PG_GETARG_FLOAT8(2);
	head.srid = PG_GETARG_INT32(3);
	initStringInfo(&bytes);
	geometry_put_head(&bytes, &head);
	geometry_put_numbers(&bytes, place, 2 + head.has_z);
	PG_RETURN_DATUM(geometry_made(geometry_argument_type(fcinfo, -1), &bytes));
}

/* A list of places as a line, or as a polygon with one ring. */
static Datum
of_places(FunctionCallInfo fcinfo, uint32 kind, bool closes)
{
	int			dimension = PG_GETARG_INT32(1) == 2 ? 2 : 3;
	GeometryHead head = {kind, PG_GETARG_INT32(2), dimension == 3};
	size_t		count;
	const double *places = geometry_numbers(PG_GETARG_ARRAYTYPE_P(0), dimension, &count);
	StringInfoData bytes;

	initStringInfo(&bytes);
	geometry_put_head(&bytes, &head);
	if (kind == GEOMETRY_POLYGON)
		geometry_put_count(&bytes, 1);
	geometry_put_places(&bytes, places, count / dimension, dimension, closes);
	PG_RETURN_DATUM(geometry_made(geometry_argument_type(fcinfo, -1), &bytes));
}

/* _abacus_line(places float8[], dimension int, srid int, closes boolean) -> geometry */
Datum
abacus_sql_line_geometry(PG_FUNCTION_ARGS)
{
	return of_places(fcinfo, GEOMETRY_LINE, PG_GETARG_BOOL(3));
}

/* _abacus_polygon(places float8[], dimension int, srid int) -> geometry */
Datum
abacus_sql_polygon_geometry(PG_FUNCTION_ARGS)
{
	return of_places(fcinfo, GEOMETRY_POLYGON, true);
}

/* _abacus_triangles(corners float8[], srid int) -> geometry: one triangle in space, or a TIN of several */
Datum
abacus_sql_triangles_geometry(PG_FUNCTION_ARGS)
{
	const int	size = 3 * 3;
	size_t		count;
	const double *corners = geometry_numbers(PG_GETARG_ARRAYTYPE_P(0), size, &count);
	size_t		triangles = count / size;
	int32		srid = PG_GETARG_INT32(1);
	GeometryHead tin = {GEOMETRY_TIN, srid, true};
	GeometryHead triangle = {GEOMETRY_TRIANGLE, triangles == 1 ? srid : 0, true};
	StringInfoData bytes;

	initStringInfo(&bytes);
	if (triangles != 1)
	{
		geometry_put_head(&bytes, &tin);
		geometry_put_count(&bytes, triangles);
	}
	for (size_t i = 0; i < triangles; i++)
		geometry_put_triangle(&bytes, &triangle, corners + i * size);
	PG_RETURN_DATUM(geometry_made(geometry_argument_type(fcinfo, -1), &bytes));
}

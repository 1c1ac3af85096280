/*
 * line_geometries.c: lines given as geometries of PostGIS, as rows of points (line_rows.h).
 *
 * Positions count from 1 in each line. If a geometry has several lines or rings, each is a part of
 * the line, with a number from 1. Points have no id: they are vertices of the mesh, or become such.
 */
#include "postgres.h"

#include <math.h>

#include "miscadmin.h"

#include "pg/base/float_array.h"
#include "pg/lines/line_geometries.h"
#include "pg/mesh/header.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/postgis/geometry_read.h"

struct LineGeometries
{
	NamedRows  *rows;
	GeometryType type;
	abacus_names names;
	int			z;				/* the attribute that gets Z; -1: none */
	int32		srid;			/* of the mesh or of the first geometry; -1: unknown so far */
	bool		any_z;			/* that is left out */
	bool		any_parts;		/* a geometry has several */
	uint64		empty;			/* geometries without a point ... */
	int64		first_empty;	/* ... and the line of the first */
	/* the geometry being read: */
	int64		line;
	int64		position;		/* of the last point */
	int64		part;			/* of the last point; 0: there is only one */
};

/* Begins to put rows for geometries of a type; `z` is the name of an attribute, or NULL. */
LineGeometries *
line_geometries_begin(NamedRows *rows, Oid type, abacus_names names, const char *z)
{
	LineGeometries *geometries = palloc0(sizeof(LineGeometries));
	uint32		srid = names.facts->form.srid;

	geometries->rows = rows;
	geometries->names = names;
	geometries->z = z == NULL ? -1 : header_find_attribute(names, z);
	geometries->srid = srid == 0 ? -1 : (int32) srid;
	geometry_open(&geometries->type, type, CurrentMemoryContext);
	return geometries;
}

static char *
what(const LineGeometries *geometries)
{
	return psprintf("geometry of line " INT64_FORMAT, geometries->line);
}

/* ---- Checks ---------------------------------------------------------------------- */

/* A mesh without SRID takes that of the geometries, which must have the same. */
static void
check_srid(LineGeometries *geometries, int32 srid)
{
	int32		wanted = (int32) geometries->names.facts->form.srid;

	if (geometries->srid < 0)
		geometries->srid = srid;
	if (srid == geometries->srid)
		return;
	if (wanted != 0)
		geometry_refuse_srid(what(geometries), srid, wanted, "mesh");
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s has SRID %d, but earlier geometries have SRID %d", what(geometries), srid,
					geometries->srid),
			 errhint("Transform all to one system with ST_Transform(geometry, srid).")));
}

/* ---- Points ---------------------------------------------------------------------- */

/* The attributes of a point: Z is the only one known. */
static Datum
attributes_of(const LineGeometries *geometries, const GeometryHead *head, const double *at)
{
	double		numbers[ABACUS_MAX_ATTRIBUTES];
	int			count = (int) geometries->names.facts->columns.attributes;

	for (int i = 0; i < count; i++)
		numbers[i] = NAN;
	if (head->has_z)
		numbers[geometries->z] = at[2];
	return attribute_array(numbers, count);
}

static void
put_point(LineGeometries *geometries, const GeometryHead *head, const double *at)
{
	Datum		values[LINE_ROW_COLUMNS];
	bool		isnull[LINE_ROW_COLUMNS] = {false};

	if (!isfinite(at[0]) || !isfinite(at[1]))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s is not finite", what(geometries)),
				 errhint("Leave such rows out with a WHERE clause.")));
	values[LINE_ROW_LINE] = Int64GetDatum(geometries->line);
	values[LINE_ROW_POSITION] = Int64GetDatum(++geometries->position);
	isnull[LINE_ROW_POINT] = true;
	values[LINE_ROW_X] = Float8GetDatum(at[0] + 0.0);	/* no negative zero */
	values[LINE_ROW_Y] = Float8GetDatum(at[1] + 0.0);
	isnull[LINE_ROW_ATTRIBUTES] = geometries->z < 0;
	if (geometries->z >= 0)
		values[LINE_ROW_ATTRIBUTES] = attributes_of(geometries, head, at);
	isnull[LINE_ROW_PART] = geometries->part == 0;
	values[LINE_ROW_PART] = Int64GetDatum(geometries->part);
	named_rows_put(geometries->rows, values, isnull);
}

/* Reads the points of one line or ring; without `puts` only passes over them. Returns whether it has some. */
static bool
read_part(LineGeometries *geometries, GeometryBytes *bytes, const GeometryHead *head, bool puts)
{
	uint32		count = geometry_count(bytes);

	for (uint32 i = 0; i < count; i++)
	{
		double		at[GEOMETRY_COORDINATES];

		CHECK_FOR_INTERRUPTS();
		geometry_coordinates(bytes, head, at);
		if (puts && i == 0 && geometries->part > 0)
			geometries->part += geometries->position > 0;
		if (puts)
			put_point(geometries, head, at);
	}
	return count > 0;
}

/* Reads a geometry with all inside it, as read_part() does; returns how many parts it has. */
static uint64
read_geometry(LineGeometries *geometries, GeometryBytes *bytes, bool puts, bool is_inside)
{
	GeometryHead head = geometry_head(bytes);
	uint64		parts = 0;

	check_stack_depth();
	if (head.has_z && geometries->z < 0)
		geometries->any_z = true;
	switch (head.kind)
	{
		case GEOMETRY_LINE:
			return read_part(geometries, bytes, &head, puts);
		case GEOMETRY_POLYGON:
			for (uint32 rings = geometry_count(bytes); rings > 0; rings--)
				parts += read_part(geometries, bytes, &head, puts);
			return parts;
		case GEOMETRY_MULTILINE:
		case GEOMETRY_MULTIPOLYGON:
		case GEOMETRY_COLLECTION:
			for (uint32 inside = geometry_count(bytes); inside > 0; inside--)
				parts += read_geometry(geometries, bytes, puts, true);
			return parts;
		default:
			geometry_refuse_kind(psprintf(is_inside ? "part of the %s" : "%s", what(geometries)),
								 head.kind, "a line or polygon");
	}
	return 0;					/* not reached */
}

/* ---- Lines ------------------------------------------------------------------------ */

/* Puts the rows of a line. */
void
line_geometries_put(LineGeometries *geometries, int64 line, Datum geometry, bool is_null)
{
	GeometryBytes bytes;
	GeometryBytes start;
	uint64		parts;

	geometries->line = line;
	geometries->position = 0;
	if (is_null)
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("%s is NULL", what(geometries)),
				 errhint("Leave such rows out with a WHERE clause.")));
	bytes = start = geometry_bytes(&geometries->type, geometry);
	check_srid(geometries, geometry_head(&bytes).srid);
	bytes = start;
	parts = read_geometry(geometries, &bytes, false, false);
	geometries->part = parts > 1 ? 1 : 0;
	geometries->any_parts |= parts > 1;
	if (parts == 0 && geometries->empty++ == 0)
		geometries->first_empty = line;
	bytes = start;
	(void) read_geometry(geometries, &bytes, true, false);
}

/* Says what the rows have. */
void
line_geometries_end(LineGeometries *geometries, LineShape *shape)
{
	shape->has_places = true;
	shape->has_nameless = true;
	shape->has_attributes = geometries->z >= 0;
	shape->has_parts = geometries->any_parts;
	shape->has_geometries = true;
	shape->srid = geometries->srid;
}

/* Tells what has been left out. */
void
line_geometries_tell(const LineGeometries *geometries)
{
	if (geometries->any_z)
		ereport(NOTICE,
				(errmsg("Z of lines is left out"),
				 errhint("Name the attribute for it with z => '...'.")));
	if (geometries->empty > 0)
		ereport(NOTICE,
				(errmsg_plural("empty geometry of line " INT64_FORMAT " is left out",
							   "empty geometries of line " INT64_FORMAT " and others are left out",
							   (unsigned long) geometries->empty, geometries->first_empty)));
}

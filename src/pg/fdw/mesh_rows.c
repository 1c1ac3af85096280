/*
 * mesh_rows.c: the rows of a published mesh, one by one.
 *
 * The core's scan returns one simplex or vertex at a time, and reads a page after the rows of the
 * page before have been returned. Between two rows nothing of PostgreSQL is held. So a query that
 * stops early has read only the pages that it needed.
 */
#include "postgres.h"

#include <math.h>

#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "abacus/windows.h"
#include "pg/base/float_array.h"
#include "pg/base/settings.h"
#include "pg/fdw/geometry_column.h"
#include "pg/fdw/mesh_rows.h"
#include "pg/fdw/nearest.h"
#include "pg/mesh/reader.h"
#include "pg/postgis/geometry_read.h"

struct MeshRows
{
	const Published *published;
	const Bitmapset *wanted;	/* columns, from 0; others are NULL */
	bool		wants_values;	/* of the corners of cells */
	bool		wants_labels;	/* of cells */
	MemoryContext memory;
	Reader	   *reader;
	abacus_cells *cells;		/* one of the two, once begun */
	abacus_faces *points;
	Nearest    *nearest;		/* or instead of them */
	uint64		pages;			/* read by earlier scans */
	Numbering  *numbering;		/* of attributes */
	RegionNames *regions;		/* if wanted, otherwise NULL */
	int		   *positions;		/* of the attribute in each wanted column; -1 if none */
	GeometryMaker **makers;		/* of columns with geometries */
	int32		srid;			/* of these; SRID_UNKNOWN if they differ, or without geometries */
};

/* The data from which a row is made. */
typedef struct MeshRow
{
	uint32		dimension;
	uint32		attributes;
	abacus_vertex vertex;
	abacus_simplex simplex;
	const double *labels;
	double		values[(ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_ATTRIBUTES];
} MeshRow;

static Datum geometry(const MeshRows *rows, MeshRow *row, GeometryMaker *maker, int number);

/* ---- Opening ------------------------------------------------------------- */

/* An error if a column's attributes have been dropped. */
static void
check_attributes(const MeshRows *rows, Relation table, int at)
{
	if (!published_has(&rows->published->columns[at], rows->numbering))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("column \"%s\" of foreign table \"%s\" shows an attribute that mesh \"%s\" no longer has",
						NameStr(TupleDescAttr(RelationGetDescr(table), at)->attname),
						RelationGetRelationName(table), get_rel_name(rows->published->mesh)),
				 errhint("Call abacus_unpublish() and then abacus_publish().")));
}

/* An error if the mesh lacks the content of a column. */
static void
check_column(const MeshRows *rows, Relation table, int at)
{
	const abacus_facts *facts = &rows->reader->header.facts;
	const Column *column = &rows->published->columns[at];
	bool		has = true;

	if (column->holds == HOLDS_CORNER)
		has = column->number <= facts->form.dimension;
	else if (column->holds == HOLDS_COORDINATE)
		has = column->number < facts->form.dimension;
	else if (column->holds == HOLDS_LABEL)
		has = column->number < facts->columns.labels;
	if (!has)
		ereport(ERROR,
				(errcode(ERRCODE_FDW_COLUMN_NAME_NOT_FOUND),
				 errmsg("mesh has no data for column \"%s\" of foreign table \"%s\"",
						NameStr(TupleDescAttr(RelationGetDescr(table), at)->attname),
						RelationGetRelationName(table)),
				 errhint("Unpublish the mesh and publish it again.")));
	check_attributes(rows, table, at);
}

/* The position of a column's attribute in the mesh; -1 if there is none. */
static int
position_of(const MeshRows *rows, const Column *column)
{
	bool		is_of_attribute = column->holds == HOLDS_ATTRIBUTE || column->holds == HOLDS_GEOMETRY;

	return is_of_attribute && column->number >= 0
		? numbering_position(rows->numbering, (uint32) column->number) : -1;
}

/* The SRID that a column's geometries get, read from a geometry at 0. */
static int32
srid_of(const MeshRows *rows, GeometryMaker *maker, int number)
{
	MeshRow		row = {
		.dimension = rows->reader->header.facts.form.dimension,
		.attributes = rows->reader->header.facts.columns.attributes
	};
	GeometryBytes bytes;

	row.vertex.attributes = row.values;
	bytes = geometry_bytes(&maker->type, geometry(rows, &row, maker, number));
	return geometry_head(&bytes).srid;
}

static void
prepare_columns(MeshRows *rows, Relation table, Oid user)
{
	const Published *published = rows->published;
	int			geometries = 0;
	int32		srid;

	rows->makers = palloc0(published->count * sizeof(GeometryMaker *));
	rows->positions = palloc(published->count * sizeof(int));
	rows->srid = SRID_UNKNOWN;
	for (int i = 0; i < published->count; i++)
	{
		const Column *column = &published->columns[i];

		if (!bms_is_member(i, rows->wanted))
			continue;
		rows->positions[i] = position_of(rows, column);
		check_column(rows, table, i);
		if (column->holds == HOLDS_GEOMETRY)
		{
			Form_pg_attribute attribute = TupleDescAttr(RelationGetDescr(table), i);

			rows->makers[i] = geometry_maker(attribute->atttypid, attribute->atttypmod);
			srid = srid_of(rows, rows->makers[i], rows->positions[i]);
			rows->srid = geometries++ == 0 || srid == rows->srid ? srid : SRID_UNKNOWN;
		}
		rows->wants_values |= column->holds == HOLDS_VALUES || column->holds == HOLDS_ATTRIBUTE ||
			(column->holds == HOLDS_GEOMETRY && column->number >= 0);
		rows->wants_labels |= column->holds == HOLDS_LABEL;
		if (column->holds == HOLDS_REGION && rows->regions == NULL)
			rows->regions = published_region_names(published, user, &rows->reader->header.facts);
	}
}

/*
 * Opens the mesh for reading under the active snapshot, with the rights of a user. `wanted`: the
 * columns whose values are needed, from 0.
 */
MeshRows *
mesh_rows_open(Relation table, const Published *published, const Bitmapset *wanted, Oid user,
			   MemoryContext parent)
{
	MemoryContext memory = AllocSetContextCreate(parent, "Abacus rows", ALLOCSET_SMALL_SIZES);
	MemoryContext old = MemoryContextSwitchTo(memory);
	MeshRows   *rows = palloc0(sizeof(MeshRows));

	rows->published = published;
	rows->wanted = wanted;
	rows->memory = memory;
	rows->numbering = palloc(sizeof(Numbering));
	rows->reader = published_open_mesh(published, user, memory, rows->numbering);
	prepare_columns(rows, table, user);
	MemoryContextSwitchTo(old);
	return rows;
}

uint32
mesh_rows_dimension(const MeshRows *rows)
{
	return rows->reader->header.facts.form.dimension;
}

int32
mesh_rows_srid(const MeshRows *rows)
{
	return rows->srid;
}

/* Ends the scan that was begun. */
static void
end(MeshRows *rows)
{
	rows->pages = mesh_rows_pages(rows);
	rows->cells = NULL;
	rows->points = NULL;
	host_own(rows->reader->host, NULL, NULL);
	if (rows->nearest != NULL)
		nearest_end(rows->nearest);
	rows->nearest = NULL;
}

/* All simplices count. */
static const abacus_extent all;

static void
begin_cells(MeshRows *rows, const Bounds *bounds)
{
	Reader	   *reader = rows->reader;
	Host	   *host = reader->host;

	if (bounds->has_codes)
		host_run(host, abacus_cells_open_stretch, &host->table, &reader->header.facts,
				 bounds->least_code, bounds->greatest_code, &rows->cells);
	else
		host_run(host, abacus_cells_open, &host->table, &reader->header.facts, &bounds->window, &all, NULL,
				 &rows->cells);
	host_own(host, rows->cells, (void (*) (void *)) abacus_cells_close);
}

static void
begin_points(MeshRows *rows, const Bounds *bounds)
{
	Reader	   *reader = rows->reader;
	Host	   *host = reader->host;
	abacus_range range = bounds->range;
	int			position = bounds->has_range ? numbering_position(rows->numbering, range.attribute) : -1;

	range.attribute = (uint32) position;
	if (position >= 0)
		host_run(host, abacus_faces_open_range, &host->table, &reader->header.facts, &bounds->window,
				 &range, setting_cache_bytes(), &rows->points);
	else
		host_run(host, abacus_faces_open, &host->table, &reader->header.facts, &bounds->window, 0, &all,
				 setting_cache_bytes(), &rows->points);
	host_own(host, rows->points, (void (*) (void *)) abacus_faces_close);
}

/* Begins with the first row; may be called again. */
void
mesh_rows_begin(MeshRows *rows, const Bounds *bounds)
{
	end(rows);
	if (bounds->nothing)
		return;
	if (rows->published->content == CONTENT_CELLS)
		begin_cells(rows, bounds);
	else
		begin_points(rows, bounds);
}

/* ---- Rows ---------------------------------------------------------------- */

/* An attribute, NaN if it is missing: the value of a point, or the mean of a cell's corners. */
static double
attribute(const MeshRows *rows, const MeshRow *row, int number)
{
	double		sum = 0;

	if (rows->published->content == CONTENT_POINTS)
		return row->vertex.attributes[number];
	for (uint32 i = 0; i <= row->dimension; i++)
		sum += row->values[i * row->attributes + number];
	return sum / (row->dimension + 1);
}

static Datum
corners(const MeshRow *row)
{
	double		corners[(ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_DIMENSION];
	uint32		dimension = row->dimension;

	for (uint32 i = 0; i <= dimension; i++)
		memcpy(corners + i * dimension, row->simplex.corner[i], dimension * sizeof(double));
	return float_matrix(corners, (int) dimension + 1, (int) dimension);
}

static Datum
geometry(const MeshRows *rows, MeshRow *row, GeometryMaker *maker, int number)
{
	double		z[ABACUS_MAX_DIMENSION + 1];

	if (rows->published->content == CONTENT_POINTS)
		return geometry_of_point(maker, row->vertex.point, (int) row->dimension,
								 number < 0 ? NULL : &row->vertex.attributes[number]);
	for (uint32 i = 0; number >= 0 && i <= row->dimension; i++)
		z[i] = row->values[i * row->attributes + number];
	return geometry_of_cell(maker, row->simplex.corner, (int) row->dimension,
							number < 0 ? NULL : z);
}

static Datum
column_value(const MeshRows *rows, MeshRow *row, int at, bool *isnull)
{
	const Column *column = &rows->published->columns[at];
	const char *region;
	double		value;

	switch (column->holds)
	{
		case HOLDS_CODE:
			return Int64GetDatum((int64) row->simplex.code);
		case HOLDS_CORNER:
			return Int64GetDatum(row->simplex.id[column->number]);
		case HOLDS_CORNERS:
			return corners(row);
		case HOLDS_VALUES:
			/* GDAL reads NULL within an array as 0. */
			return float_matrix_of_nan(row->values, (int) row->dimension + 1,
									   (int) row->attributes);
		case HOLDS_ID:
			return Int64GetDatum(row->vertex.id);
		case HOLDS_COORDINATE:
			return Float8GetDatum(row->vertex.point[column->number]);
		case HOLDS_ATTRIBUTE:
			value = attribute(rows, row, rows->positions[at]);
			*isnull = isnan(value) != 0;
			return Float8GetDatum(value);
		case HOLDS_LABEL:
			*isnull = isnan(row->labels[column->number]) != 0;
			return Float8GetDatum(row->labels[column->number]);
		case HOLDS_REGION:
			region = region_names_find(rows->regions, row->simplex.region);
			*isnull = region == NULL;
			return *isnull ? (Datum) 0 : CStringGetTextDatum(region);
		case HOLDS_GEOMETRY:
			return geometry(rows, row, rows->makers[at], rows->positions[at]);
		case HOLDS_NOTHING:
			break;
	}
	*isnull = true;
	return (Datum) 0;
}

/* Gets the next simplex or vertex from the core. */
static bool
fetch(MeshRows *rows, MeshRow *row)
{
	Host	   *host = rows->reader->host;
	abacus_status status;

	if (rows->cells != NULL)
		status = host_run(host, abacus_cells_next, rows->cells, &row->simplex,
						  rows->wants_values ? row->values : NULL);
	else if (rows->points != NULL)
		status = host_run(host, abacus_faces_next_vertex, rows->points, &row->vertex);
	else
		return false;
	if (rows->wants_labels && status != ABACUS_END)
		host_run(host, abacus_cells_labels, rows->cells, &row->simplex, &row->labels);
	host_release(host);
	return status != ABACUS_END;
}

static void
make_row(const MeshRows *rows, MeshRow *row, Datum *values, bool *isnull)
{
	row->dimension = rows->reader->header.facts.form.dimension;
	row->attributes = rows->reader->header.facts.columns.attributes;
	for (int i = 0; i < rows->published->count; i++)
	{
		isnull[i] = !bms_is_member(i, rows->wanted);
		values[i] = isnull[i] ? (Datum) 0 : column_value(rows, row, i, &isnull[i]);
	}
}

static void
make_nearest_row(void *context, const abacus_vertex *vertex, Datum *values, bool *isnull)
{
	MeshRow		row;

	row.vertex = *vertex;
	make_row(context, &row, values, isnull);
}

/* Begins with the nearest point to a place in the plane; about `first` points are wanted. */
void
mesh_rows_begin_nearest(MeshRows *rows, Relation table, Oid user, const double *place,
						uint64 first)
{
	end(rows);
	rows->nearest = nearest_begin(table, rows->published->mesh, user, place, first,
								  make_nearest_row, rows, rows->memory);
}

/*
 * The next row; false after the last. It lives in the current memory context or until the next
 * call. Columns that are not wanted are NULL.
 */
bool
mesh_rows_next(MeshRows *rows, Datum *values, bool *isnull)
{
	MeshRow		row;

	if (rows->nearest != NULL)
		return nearest_next(rows->nearest, values, isnull);
	if (!fetch(rows, &row))
		return false;
	make_row(rows, &row, values, isnull);
	return true;
}

/* How many pages have been read so far. */
uint64
mesh_rows_pages(const MeshRows *rows)
{
	if (rows->cells != NULL)
		return rows->pages + abacus_cells_pages(rows->cells);
	return rows->pages + (rows->points != NULL ? abacus_faces_pages(rows->points) : 0);
}

void
mesh_rows_close(MeshRows *rows)
{
	end(rows);
	MemoryContextDelete(rows->memory);
}

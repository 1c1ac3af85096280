/*
 * new_lines.c: lines that a mesh gets, and those that they replace.
 *
 * The lines themselves are rows of a table of the mesh (lines_table.c); the core fixes and frees
 * the edges on their segments. All checks of the rows come first. Then the rows are written, new
 * points are inserted, edges of lines that go are freed, and last those of new lines are fixed.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/lines/line_points.h"
#include "pg/lines/new_lines.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/mesh/regions_table.h"
#include "pg/port/port.h"

static Relation
mesh_of(const Change *change)
{
	return mesh_pages(change->writer.host)->simplices.heap;
}

/* ---- Which meshes ------------------------------------------------------------------ */

/* Refuses a mesh that cannot have lines. */
void
new_lines_check_mesh(const Change *change)
{
	const abacus_facts *facts = &change->writer.header->facts;

	if (facts->form.dimension != 2)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has dimension %u", RelationGetRelationName(mesh_of(change)),
						facts->form.dimension),
				 errdetail("Lines fix edges in the plane only."),
				 errhint("Use a mesh of dimension 2, with z as an attribute.")));
	if (!abacus_is_editable(facts->standing))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("%s", abacus_delaunay_clause(facts->standing)),
				 errdetail("%s The mesh was loaded by abacus_load() and cannot have other points.",
						   abacus_delaunay_reason(facts->standing)),
				 errhint("Triangulate its vertices anew, by abacus_load() with retriangulate => true or by "
						 "abacus_triangulate().")));
}

/* ---- Lines that go ------------------------------------------------------------------- */

/*
 * Deletes the lines of a query of ids from the table, and keeps their segments; returns how many
 * there were, and how many of them were soft.
 */
uint64
new_lines_delete(Change *change, const char *table, const char *ids, int64 *soft)
{
	Datum		counts[3];
	bool		isnull[3];

	query_first(psprintf("SELECT count(*), count(*) FILTER (WHERE kind = 'soft'), coalesce(sum(n), 0)::bigint FROM "
						 "(SELECT count(*) AS n, l.kind FROM %s AS l WHERE l.line IN (%s) GROUP BY l.line, l.kind) AS s",
						 table, ids), counts, isnull, 3);
	*soft = DatumGetInt64(counts[1]);
	if (DatumGetInt64(counts[0]) == 0)
		return 0;
	if (change->writer.header->facts.census.regions > 0)
		regions_table_refuse_lines(mesh_of(change), ids);
	mesh_lines_open(&change->writer, &change->freed);
	mesh_lines_add(change->writer.host, change->freed,
				   psprintf("SELECT l.line, l.x, l.y, l.part, l.kind OPERATOR(pg_catalog.=) 'soft' FROM %s AS l WHERE l.line IN (%s) "
							"ORDER BY l.line, l.position", table, ids));
	query_change(table, "lines", psprintf("DELETE FROM %s AS l WHERE l.line IN (%s)", table, ids),
				(uint64) DatumGetInt64(counts[2]));
	return (uint64) DatumGetInt64(counts[0]);
}

/* ---- Lines that come ------------------------------------------------------------------ */

static void
refuse_existing(const char *table)
{
	Datum		line;
	bool		isnull;

	if (query_first(psprintf("SELECT g.line FROM (SELECT DISTINCT line FROM " LINE_POINTS ") AS g "
							 "WHERE EXISTS (SELECT FROM %s AS l WHERE l.line = g.line) ORDER BY g.line LIMIT 1",
							 table), &line, &isnull, 1))
		ereport(ERROR,
				(errcode(ERRCODE_UNIQUE_VIOLATION),
				 errmsg("the mesh already has a line " INT64_FORMAT, DatumGetInt64(line)),
				 errhint("Use existing => 'replace' to put the new line in its place.")));
}

/* The new points of lines, and those read from them so far. */
typedef struct PointReader
{
	Change	   *change;
	uint32		attributes;
	uint64	   *record;			/* of the last point: its id, its place and its attributes */
	bool		any;
} PointReader;

/* The attributes that the last point lacks, from a row that names it. */
static void
take_attributes(PointReader *reader, Datum array)
{
	double	   *attributes = (double *) (reader->record + 3);
	Datum	   *values;
	bool	   *nulls;
	int			count;

	deconstruct_array(DatumGetArrayTypeP(array), FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
					  TYPALIGN_DOUBLE, &values, &nulls, &count);
	for (int i = 0; i < count && i < (int) reader->attributes; i++)
		if (!nulls[i] && isnan(attributes[i]))
			attributes[i] = DatumGetFloat8(values[i]);
	pfree(values);
	pfree(nulls);
}

/* Takes a row of a new point: its id, place and attributes. */
static void
take_point(PointReader *reader, HeapTuple tuple, TupleDesc desc)
{
	double	   *numbers = (double *) (reader->record + 1);
	bool		isnull;
	uint64		id = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
	Datum		array;

	if (!reader->any || id != reader->record[0])
	{
		if (reader->any)
			change_add(reader->change, reader->record, 1);
		reader->any = true;
		reader->record[0] = id;
		for (int axis = 0; axis < 2; axis++)
			numbers[axis] = DatumGetFloat8(SPI_getbinval(tuple, desc, 2 + axis, &isnull));
		for (uint32 i = 0; i < reader->attributes; i++)
			numbers[2 + i] = NAN;
	}
	array = SPI_getbinval(tuple, desc, 4, &isnull);
	if (!isnull)
		take_attributes(reader, array);
}

/*
 * Puts the new points of the lines into the change's stage, in the order of the first rows that name
 * them. What one row does not say about a point, another one may.
 */
static void
stage_points(Change *change)
{
	const abacus_facts *facts = &change->writer.header->facts;
	PointReader reader = {.change = change,.attributes = facts->columns.attributes};
	Portal		portal = SPI_cursor_open_with_args(
		NULL, "SELECT point, x, y, attributes FROM (SELECT point, x, y, attributes, line, position, "
		"first_value(line) OVER w AS line0, first_value(position) OVER w AS position0 FROM " LINE_POINTS
		" WHERE is_new WINDOW w AS (PARTITION BY point ORDER BY line, position)) AS s "
		"ORDER BY line0, position0, line, position", 0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);

	reader.record = palloc((3 + reader.attributes) * sizeof(uint64));
	change_open_stage(change, facts);
	for (;;)
	{
		SPI_cursor_fetch(portal, true, 1024);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
			take_point(&reader, SPI_tuptable->vals[i], SPI_tuptable->tupdesc);
		SPI_freetuptable(SPI_tuptable);
	}
	if (reader.any)
		change_add(change, reader.record, 1);
	SPI_cursor_close(portal);
}

/* Inserts the new points; if points wait already, they wait as well, and the lines too. */
static void
insert_points(Change *change, const NewPoints *kind)
{
	abacus_census *census = &change->writer.header->facts.census;
	bool		waiting = !kind->insert_waiting && census->inserted < census->staged;

	stage_points(change);
	if (waiting || census->vertices == 0)
		census->lines_wait = 1;
	if (change->points == 0)
		return;
	if (kind->allow != NULL)
		kind->allow(change);
	if (waiting)
		change_stage(change);
	else
		change_insert(change);
}

/* Fixes the edges of the new lines, and frees those of lines that they have replaced. */
static void
change_edges(Change *change, const LineValues *values)
{
	abacus_census *census = &change->writer.header->facts.census;
	bool		fixed = census->lines_wait == 0;

	if (change->freed != NULL)
		change_unfix(change);	/* also fixes lines that have waited, unless they cross */
	if (!fixed || census->lines_wait > 0)
		return;
	mesh_lines_open(&change->writer, &change->fixed);
	mesh_lines_add(change->writer.host, change->fixed,
				   psprintf("SELECT p.line, p.x, p.y, p.part, %s = 'soft' FROM " LINE_POINTS " AS p %s "
							"ORDER BY p.line, p.position", values->kind, values->joins));
	change_fix(change);
}

/* Writes the points of new lines, LINE_POINTS, into the table of lines. */
void
new_lines_write(const char *table, const LineValues *values, const NamedRows *points)
{
	query_change(table, "lines",
				psprintf("INSERT INTO %s (line, position, point, x, y, part, kind, made) SELECT p.line, p.position, "
						 "p.point, p.x, p.y, p.part, %s, %s FROM " LINE_POINTS " AS p %s "
						 "ORDER BY p.line, p.position", table, values->kind, values->made, values->joins),
				points->count);
}

/* Makes the points of lines that have been written vertices, and their segments fixed edges. */
void
new_lines_join(Change *change, const LineValues *values, const NewPoints *points)
{
	insert_points(change, points);
	change_edges(change, values);
}

/* Adds the lines whose points are known, LINE_POINTS; returns how many they are. */
uint64
new_lines_put(Change *change, const NamedRows *points, const char *kind, ExistingLines existing,
			  const NewPoints *allowed)
{
	Datum		count;
	bool		isnull;
	uint64		replaced = 0;
	int64		soft = 0;
	char	   *table;
	bool		is_new;
	LineValues	values = {psprintf("'%s'", kind), "NULL", ""};
	int			level = plain_names_begin(true);

	query_first("SELECT count(*) FROM (SELECT DISTINCT line FROM " LINE_POINTS ") AS s", &count, &isnull, 1);
	plain_names_end(level);
	table = lines_table_name(lines_table_make(mesh_of(change), &is_new));
	level = plain_names_begin(true);
	if (existing == EXISTING_ERROR)
		refuse_existing(table);
	else
		replaced = new_lines_delete(change, table, "SELECT line FROM " LINE_POINTS, &soft);
	new_lines_write(table, &values, points);
	if (is_new)
		lines_table_index(mesh_of(change));
	change_lines(change, DatumGetInt64(count) - (int64) replaced,
				 (strcmp(kind, "soft") == 0 ? DatumGetInt64(count) : 0) - soft);
	new_lines_join(change, &values, allowed);
	plain_names_end(level);
	return (uint64) DatumGetInt64(count);
}

/* Adds the lines whose rows have been read; returns how many they are. */
static uint64
add_lines(Change *change, const NewLines *lines, const char *kind, ExistingLines existing, const NewPoints *allowed)
{
	NamedRows  *points;
	uint64		count;
	int			level = plain_names_begin(true);

	line_points_check(lines);
	points = line_points_resolve(lines, line_points_find(change, lines));
	plain_names_end(level);
	count = new_lines_put(change, points, kind, existing, allowed);
	named_rows_free(points);
	return count;
}

/* A call of abacus_vertices() for a mesh, in SQL; `function` is one of the same extension. */
char *
new_lines_vertices(Oid function, Oid mesh)
{
	return psprintf("%s('%u'::regclass)",
					quote_qualified_identifier(get_namespace_name(get_func_namespace(function)),
											   "abacus_vertices"), mesh);
}

/*
 * Reads the rows of a prepared query, and adds its lines; returns how many they are. `z` names the
 * attribute for the Z of geometries, or is NULL. `points` is for points that the mesh lacks. Without
 * any lines, nothing has changed.
 */
uint64
new_lines_add(Change *change, Source *source, const char *vertices, const char *kind,
			  ExistingLines existing, const char *z, const NewPoints *points)
{
	Oid			table = lines_table_of(mesh_of(change), change->writer.header->facts.census.lines);
	NewLines	lines = {
		.vertices = vertices,
		.reading = {abacus_names_of(change->writer.header), z, NULL},
		.census = &change->writer.header->facts.census
	};
	NamedRows  *rows = line_rows_read(source, &lines.reading, &lines.shape);
	uint64		count = 0;

	lines.table = OidIsValid(table) ? lines_table_name(table) : NULL;
	if (rows->count > 0)
	{
		named_rows_register(rows);
		count = add_lines(change, &lines, kind, existing, points);
	}
	named_rows_free(rows);
	if (count > 0)
	{
		change_take_srid(change, lines.shape.srid);
		mesh_lines_notice_waiting(&change->writer);
	}
	return count;
}

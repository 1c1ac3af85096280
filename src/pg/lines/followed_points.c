/*
 * followed_points.c: vertices of a mesh that lines of a table have made, or name: removed and found.
 *
 * Each is looked up in the mesh as it is being changed, or one query finds all.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "lib/stringinfo.h"

#include "pg/base/float_array.h"
#include "pg/lines/followed_parts.h"

#define ROWS_A_FETCH 1024

/*
 * Whether vertices are looked up one by one. Otherwise a query finds points: those that wait, and
 * those whose attributes are apart, in pages of their own.
 */
static bool
are_looked_up(const FollowedLines *lines)
{
	const abacus_facts *facts = &lines->change->writer.header->facts;

	return facts->census.vertices > 0 && !facts->columns.apart;
}

/* Reads the vertex at a place, as its record; false if there is none. */
static bool
read_vertex(FollowedLines *lines, const double *place, uint64 *record)
{
	Host	   *host = lines->change->writer.host;

	change_open_build(lines->change);
	return host_run(host, abacus_build_vertex_at, lines->change->build, place, record) == ABACUS_OK;
}

/* Receives a row of a query. */
typedef void (*RowSink) (FollowedLines *lines, HeapTuple tuple, TupleDesc desc, uint64 *record);

static void
each_row(FollowedLines *lines, const char *query, RowSink sink)
{
	const abacus_facts *facts = &lines->change->writer.header->facts;
	uint64	   *record = palloc((3 + facts->columns.attributes) * sizeof(uint64));
	Portal		portal = SPI_cursor_open_with_args(NULL, query, 0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);

	for (;;)
	{
		SPITupleTable *rows;

		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		rows = SPI_tuptable;
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0, count = SPI_processed; i < count; i++)
			sink(lines, rows->vals[i], rows->tupdesc, record);
		SPI_freetuptable(rows);
	}
	SPI_cursor_close(portal);
	pfree(record);
}

static double
number_at(HeapTuple tuple, TupleDesc desc, int column)
{
	bool		isnull;

	return DatumGetFloat8(SPI_getbinval(tuple, desc, column, &isnull));
}

/* Stages a vertex that leaves: point, x and y are found in the mesh, for the attributes. */
static void
stage_made(FollowedLines *lines, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	double		place[2] = {number_at(tuple, desc, 2), number_at(tuple, desc, 3)};
	bool		isnull;
	uint64		id = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));

	if (read_vertex(lines, place, record) && record[0] == id)
		change_add(lines->change, record, 1);
}

/* The same with the attributes in the row. */
static void
stage_found(FollowedLines *lines, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	double	   *numbers = (double *) (record + 1);
	int			count = (int) lines->change->writer.header->facts.columns.attributes;
	bool		isnull;

	record[0] = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
	for (int axis = 0; axis < 2; axis++)
		numbers[axis] = number_at(tuple, desc, 2 + axis);
	for (int i = 0; i < count; i++)
	{
		Datum		value = SPI_getbinval(tuple, desc, 4 + i, &isnull);

		numbers[2 + i] = isnull ? NAN : DatumGetFloat8(value);
	}
	change_add(lines->change, record, 1);
}

/* A query for the points of these vertices, with their attributes. */
static char *
found_made(const FollowedLines *lines)
{
	StringInfoData query;

	initStringInfo(&query);
	appendStringInfoString(&query, "SELECT v.id, v.x, v.y");
	for (uint32 i = 1; i <= lines->change->writer.header->facts.columns.attributes; i++)
		appendStringInfo(&query, ", v.attributes[%u]", i);
	appendStringInfo(&query, " FROM %s AS v JOIN " MADE_GONE " AS m ON m.point = v.id AND m.x = v.x AND m.y = v.y",
					 lines->lines.vertices);
	return query.data;
}

/* Removes the vertices that only lines which have left had made. */
void
followed_points_remove(FollowedLines *lines)
{
	Change	   *change = lines->change;

	if (lines->gone->count == 0)
		return;
	change_open_stage(change, &change->writer.header->facts);
	if (are_looked_up(lines))
		each_row(lines, "SELECT point, x, y FROM " MADE_GONE, stage_made);
	else
	{
		change_show(change);
		each_row(lines, found_made(lines), stage_found);
	}
	if (change->points > 0)
		(void) change_delete(change, true);
}

/* ---- Vertices that lines name --------------------------------------------------------- */

/* Puts the vertex at a place where a line has a corner. */
static void
put_found(FollowedLines *lines, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	double		place[2] = {number_at(tuple, desc, 1), number_at(tuple, desc, 2)};
	const double *numbers = (const double *) (record + 1);
	Datum		values[FOUND_COLUMNS];
	bool		isnull[FOUND_COLUMNS] = {false};
	int			count = (int) lines->change->writer.header->facts.columns.attributes;

	if (!read_vertex(lines, place, record))
		return;
	values[FOUND_ID] = values[FOUND_VERTEX] = Int64GetDatum((int64) record[0]);
	values[FOUND_X] = Float8GetDatum(place[0]);
	values[FOUND_Y] = Float8GetDatum(place[1]);
	isnull[FOUND_SEQUENCE] = true;
	isnull[FOUND_ATTRIBUTES] = !lines->lines.shape.has_attributes;
	if (!isnull[FOUND_ATTRIBUTES])
		values[FOUND_ATTRIBUTES] = attribute_array(numbers + 2, count);
	values[FOUND_BY_ID] = BoolGetDatum(false);
	named_rows_put(lines->found, values, isnull);
}

/* The points of the mesh that the lines name, registered. */
NamedRows *
followed_points_find(FollowedLines *lines)
{
	bool		by_place = lines->lines.shape.has_nameless;

	if (by_place ? !are_looked_up(lines) : !lines->lines.is_known)
	{
		change_show(lines->change);
		return line_points_scan(&lines->lines);
	}
	lines->found = line_points_found();
	if (by_place)
		each_row(lines, "SELECT DISTINCT x, y FROM " LINE_ROWS, put_found);
	named_rows_register(lines->found);
	return lines->found;
}

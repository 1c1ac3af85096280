/*
 * followed_points.c: vertices of a mesh that lines of a table have made, or name: removed and found.
 *
 * Each is looked up in the mesh as it is being changed, or one query finds all.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "lib/stringinfo.h"

#include "pg/lines/followed_parts.h"
#include "pg/lines/vertex_lookup.h"

/* Stages a vertex that leaves: point, x and y are found in the mesh, for the attributes. */
static void
stage_made(void *context, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	FollowedLines *lines = context;
	double		place[2] = {vertex_lookup_number(tuple, desc, 2), vertex_lookup_number(tuple, desc, 3)};
	bool		isnull;
	uint64		id = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));

	if (vertex_lookup(lines->change, place, record) && record[0] == id)
		change_add(lines->change, record, 1);
}

/* The same with the attributes in the row. */
static void
stage_found(void *context, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	FollowedLines *lines = context;
	double	   *numbers = (double *) (record + 1);
	int			count = (int) lines->change->writer.header->facts.columns.attributes;
	bool		isnull;

	record[0] = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
	for (int axis = 0; axis < 2; axis++)
		numbers[axis] = vertex_lookup_number(tuple, desc, 2 + axis);
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
	if (vertex_lookup_can(lines->change))
		vertex_lookup_rows(change, "SELECT point, x, y FROM " MADE_GONE, stage_made, lines);
	else
	{
		change_show(change);
		vertex_lookup_rows(change, found_made(lines), stage_found, lines);
	}
	if (change->points > 0)
		(void) change_delete(change, true);
}

/* ---- Vertices that lines name --------------------------------------------------------- */

/* Puts the vertex at a place where a line has a corner. */
static void
put_found(void *context, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	FollowedLines *lines = context;
	double		place[2] = {vertex_lookup_number(tuple, desc, 1), vertex_lookup_number(tuple, desc, 2)};

	if (vertex_lookup(lines->change, place, record))
		vertex_lookup_put(lines->change, lines->found, record, lines->lines.shape.has_attributes, false);
}

/* The points of the mesh that the lines name, registered. */
NamedRows *
followed_points_find(FollowedLines *lines)
{
	bool		by_place = lines->lines.shape.has_nameless;

	if (by_place ? !vertex_lookup_can(lines->change) : !lines->lines.is_known)
	{
		change_show(lines->change);
		return line_points_scan(&lines->lines);
	}
	lines->found = line_points_found();
	if (by_place)
		vertex_lookup_rows(lines->change, "SELECT DISTINCT x, y FROM " LINE_ROWS, put_found, lines);
	named_rows_register(lines->found);
	return lines->found;
}

/*
 * found_points.c: the points of the mesh that lines name, by their ids or by their places.
 *
 * There is no index of ids. But where rows have places, each is looked up in the mesh. Only an id that is
 * not that of the vertex at its place, and may be that of another point, needs a scan of the mesh. So
 * do very many places, and points that wait.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/array.h"

#include "pg/lines/line_points.h"
#include "pg/lines/vertex_lookup.h"

/* A scan reads so many vertices while one is looked up. */
#define SCANNED_MEANWHILE 16

/* What lines of the mesh name at places of rows, by the ids of these. */
#define NAMED_AT_PLACE \
	"JOIN (SELECT DISTINCT point, x, y FROM " LINE_ROWS ") AS g ON g.x = l.x AND g.y = l.y AND g.point = l.point"

static const NamedColumn found_columns[FOUND_COLUMNS] = {
	{"id", INT8OID}, {"x", FLOAT8OID}, {"y", FLOAT8OID}, {"vertex", INT8OID},
	{"sequence", INT8OID}, {"attributes", FLOAT8ARRAYOID}, {"by_id", BOOLOID}
};

/* No points so far; the caller puts them, and registers the rows. */
NamedRows *
line_points_found(void)
{
	return named_rows_create(FOUND_POINTS, found_columns, FOUND_COLUMNS);
}

/*
 * Finds the points of the mesh with the ids of rows, or at their places, by a scan of the mesh. A line
 * can name a point that is gone, if its place still has another one. So what the lines of the mesh name
 * counts as found as well: a place with its id, or, where rows have no places, an id that the mesh lacks.
 */
NamedRows *
line_points_scan(const NewLines *lines)
{
	const char *by_place = lines->shape.has_nameless || lines->shape.has_attributes
		? "LEFT JOIN (SELECT DISTINCT point FROM " LINE_ROWS ") AS g ON g.point = v.id "
		"LEFT JOIN (SELECT DISTINCT x, y FROM " LINE_ROWS ") AS p ON p.x = v.x AND p.y = v.y "
		"WHERE g.point IS NOT NULL OR p.x IS NOT NULL"
		: "JOIN (SELECT DISTINCT point FROM " LINE_ROWS ") AS g ON g.point = v.id";
	const char *named = lines->shape.has_places ? NAMED_AT_PLACE
		: "JOIN (SELECT point FROM " LINE_ROWS " EXCEPT SELECT id FROM there) AS g ON g.point = l.point";
	char	   *query = psprintf("WITH there AS MATERIALIZED (SELECT v.id, v.x, v.y, v.vertex, v.sequence, %s, "
								 "g.point IS NOT NULL FROM %s AS v %s) TABLE there",
								 lines->shape.has_attributes ? "v.attributes" : "NULL::float8[]",
								 lines->vertices, by_place);

	if (lines->table != NULL)
		query = psprintf("%s UNION ALL SELECT DISTINCT l.point, l.x, l.y, NULL::bigint, NULL::bigint, "
						 "NULL::float8[], true FROM %s AS l %s", query, lines->table, named);
	return named_rows_of_query(FOUND_POINTS, found_columns, FOUND_COLUMNS, query);
}

/* ---- Look-ups ---------------------------------------------------------------------- */

typedef struct Lookup
{
	Change	   *change;
	const NewLines *lines;
	NamedRows  *found;
} Lookup;

static bool
has_id(Datum array, int64 id)
{
	Datum	   *ids;
	int			count;
	bool		has = false;

	deconstruct_array(DatumGetArrayTypeP(array), INT8OID, sizeof(int64), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
					  &ids, NULL, &count);
	for (int i = 0; i < count; i++)
		has = has || DatumGetInt64(ids[i]) == id;
	pfree(ids);
	return has;
}

/* Puts the vertex at a place, if there is one. The third column has the ids that rows give there. */
static void
put_vertex(void *context, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	Lookup	   *lookup = context;
	double		place[2] = {vertex_lookup_number(tuple, desc, 1), vertex_lookup_number(tuple, desc, 2)};
	bool		isnull;
	Datum		ids = SPI_getbinval(tuple, desc, 3, &isnull);

	if (vertex_lookup(lookup->change, place, record))
		vertex_lookup_put(lookup->change, lookup->found, record, lookup->lines->shape.has_attributes,
						  !isnull && has_id(ids, (int64) record[0]));
}

/* Puts a point that a line of the mesh names. */
static void
put_named(void *context, HeapTuple tuple, TupleDesc desc, uint64 *record)
{
	Lookup	   *lookup = context;
	Datum		values[FOUND_COLUMNS];
	bool		isnull[FOUND_COLUMNS] = {false};

	values[FOUND_ID] = SPI_getbinval(tuple, desc, 1, &isnull[FOUND_ID]);
	values[FOUND_X] = SPI_getbinval(tuple, desc, 2, &isnull[FOUND_X]);
	values[FOUND_Y] = SPI_getbinval(tuple, desc, 3, &isnull[FOUND_Y]);
	isnull[FOUND_VERTEX] = isnull[FOUND_SEQUENCE] = isnull[FOUND_ATTRIBUTES] = true;
	values[FOUND_BY_ID] = BoolGetDatum(true);
	named_rows_put(lookup->found, values, isnull);
}

/* Whether a row gives an id that another point of the mesh may have. */
static bool
may_be_elsewhere(const NewLines *lines)
{
	Datum		value;
	bool		isnull;
	char	   *above = lines->census->knows_ids
		? psprintf("g.point <= '" INT64_FORMAT "'::bigint AND ", lines->census->greatest_id) : "";

	return query_first(psprintf("SELECT 1 FROM " LINE_ROWS " AS g WHERE g.point IS NOT NULL AND %sNOT EXISTS (SELECT FROM "
								FOUND_POINTS " AS f WHERE f.id = g.point AND f.x = g.x AND f.y = g.y) LIMIT 1", above),
					   &value, &isnull, 1);
}

/* Whether look-ups may find all points, and cost less than a scan. */
static bool
is_looked_up(const Change *change, const NewLines *lines)
{
	const abacus_census *census = &change->writer.header->facts.census;
	Datum		places;
	bool		isnull;

	if (!lines->shape.has_places || census->inserted < census->staged || !vertex_lookup_can(change))
		return false;
	query_first("SELECT count(*) FROM (SELECT DISTINCT x, y FROM " LINE_ROWS ") AS g", &places, &isnull, 1);
	return (uint64) DatumGetInt64(places) < census->vertices / SCANNED_MEANWHILE;
}

/* The points of the mesh that the lines name, registered. */
NamedRows *
line_points_find(Change *change, const NewLines *lines)
{
	Lookup		lookup = {change, lines};

	if (!is_looked_up(change, lines))
		return line_points_scan(lines);
	lookup.found = line_points_found();
	vertex_lookup_rows(change, "SELECT x, y, array_agg(point) FILTER (WHERE point IS NOT NULL) FROM " LINE_ROWS
					   " GROUP BY x, y", put_vertex, &lookup);
	if (lines->table != NULL)
		vertex_lookup_rows(change, psprintf("SELECT DISTINCT l.point, l.x, l.y FROM %s AS l " NAMED_AT_PLACE, lines->table),
						   put_named, &lookup);
	named_rows_register(lookup.found);
	if (!may_be_elsewhere(lines))
		return lookup.found;
	named_rows_free(lookup.found);
	return line_points_scan(lines);
}

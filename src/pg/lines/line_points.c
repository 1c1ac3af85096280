/*
 * line_points.c: the points of lines that a query gives: checked, found in the mesh, or new.
 *
 * All is SQL over the rows of the query (LINE_ROWS), the points of the mesh that have their ids or
 * their places (FOUND_POINTS, found_points.c), and what comes of both (LINE_POINTS). Points without id
 * that are new need the greatest id. The mesh knows it, or a scan finds it once.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"

#include "pg/lines/line_points.h"

/* The ids among them that rows give, each with its places. */
#define FOUND_PLACES "(SELECT DISTINCT id, x, y FROM " FOUND_POINTS " WHERE by_id)"

static char *
number_of(Datum value)
{
	return psprintf("%.17g", DatumGetFloat8(value));
}

/* A double for messages: the fewest digits that say which. */
static char *
shown(Datum value)
{
	return DatumGetCString(DirectFunctionCall1(float8out, value));
}

/* "(1, 2)", from two values of a row. */
static char *
place(const Datum *values)
{
	return psprintf("(%s, %s)", shown(values[0]), shown(values[1]));
}

/* ---- Checks of the rows alone ------------------------------------------------------ */

/* A part of a line that has one point, or whose points do not follow one another. */
static void
check_parts(void)
{
	Datum		values[3];
	bool		isnull[3];

	if (!query_first("SELECT line, part, min(position) FROM (SELECT line, position, coalesce(part, 0) AS part, "
					 "lag(coalesce(part, 0)) OVER (PARTITION BY line ORDER BY position) AS before "
					 "FROM " LINE_ROWS ") AS s GROUP BY line, part "
					 "HAVING count(*) = 1 OR count(*) FILTER (WHERE part IS DISTINCT FROM before) > 1 "
					 "ORDER BY line, min(position) LIMIT 1", values, isnull, 3))
		return;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("part " INT64_FORMAT " of line " INT64_FORMAT " has one point alone, or begins twice",
					DatumGetInt64(values[1]), DatumGetInt64(values[0])),
			 errdetail("Its first point is at position " INT64_FORMAT ".", DatumGetInt64(values[2])),
			 errhint("Number the points of each part in sequence.")));
}

static void
check_positions(const NewLines *lines)
{
	bool		is_drawn = lines->shape.has_geometries;
	Datum		values[2];
	bool		isnull[2];

	if (query_first("SELECT line, position FROM " LINE_ROWS " GROUP BY line, position "
					"HAVING count(*) > 1 ORDER BY line, position LIMIT 1", values, isnull, 2))
		ereport(ERROR,
				(errcode(ERRCODE_UNIQUE_VIOLATION),
				 is_drawn ? errmsg("line " INT64_FORMAT " has two geometries", DatumGetInt64(values[0]))
				 : errmsg("line " INT64_FORMAT " has position " INT64_FORMAT " twice",
						  DatumGetInt64(values[0]), DatumGetInt64(values[1])),
				 is_drawn ? errhint("Make them one with ST_Collect(geometry), or give each an id of its own.")
				 : errhint("Number the points of each line in their order, for instance with row_number().")));
	if (query_first("SELECT line FROM " LINE_ROWS " GROUP BY line HAVING count(*) = 1 ORDER BY line LIMIT 1",
					values, isnull, 1))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("line " INT64_FORMAT " has only one point", DatumGetInt64(values[0])),
				 errhint("A line has two points or more. A single point is inserted by abacus_insert().")));
}

/* The place that a row gives for an id, the least or the greatest. */
#define GIVEN_AT \
	"SELECT x, y, line, position FROM " LINE_ROWS " WHERE point = '" INT64_FORMAT \
	"' ORDER BY x %s, y %s, line, position LIMIT 1"

/* An error if there is an id that a query returns. */
static void
refuse_two_places(const char *query)
{
	Datum		values[1];
	Datum		first[4];
	Datum		second[4];
	bool		isnull[4];
	int64		id;

	if (!query_first(query, values, isnull, 1))
		return;
	id = DatumGetInt64(values[0]);
	query_first(psprintf(GIVEN_AT, id, "ASC", "ASC"), first, isnull, 4);
	query_first(psprintf(GIVEN_AT, id, "DESC", "DESC"), second, isnull, 4);
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("point " INT64_FORMAT " is given with two places", id),
			 errdetail("It is %s at position " INT64_FORMAT " of line " INT64_FORMAT ", and %s at position "
					   INT64_FORMAT " of line " INT64_FORMAT ".", place(first), DatumGetInt64(first[3]),
					   DatumGetInt64(first[2]), place(second), DatumGetInt64(second[3]),
					   DatumGetInt64(second[2])),
			 errhint("Give each place an id of its own, or NULL.")));
}

/* Checks that need no mesh. */
void
line_points_check(const NewLines *lines)
{
	/* a table of points may have an id twice, and then each position comes twice */
	if (lines->reading.points_of != NULL)
		refuse_two_places("SELECT point FROM " LINE_ROWS " WHERE point IS NOT NULL GROUP BY point "
						  "HAVING min(x) <> max(x) OR min(y) <> max(y) ORDER BY point LIMIT 1");
	check_positions(lines);
	if (lines->shape.has_parts)
		check_parts();
}

/* ---- Points of the mesh -------------------------------------------------------------- */

/* An id alone that the mesh has at two places. */
static void
check_found_ids(void)
{
	Datum		values[5];
	bool		isnull[5];

	if (query_first("SELECT id, min(x), min(y), max(x), max(y) FROM " FOUND_POINTS " WHERE by_id GROUP BY id "
					"HAVING min(x) <> max(x) OR min(y) <> max(y) ORDER BY id LIMIT 1", values, isnull, 5))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("several points of the mesh have the id " INT64_FORMAT, DatumGetInt64(values[0])),
				 errdetail("Their x is from %s to %s, and their y from %s to %s.", shown(values[1]),
						   shown(values[3]), shown(values[2]), shown(values[4])),
				 errhint("Give NULL instead of the id, and x and y: the point is then found by its place.")));
}

/* An id without coordinates that the mesh does not have. */
static void
check_known(void)
{
	Datum		values[3];
	bool		isnull[3];

	if (query_first("SELECT g.point, g.line, g.position FROM " LINE_ROWS " AS g "
					"LEFT JOIN " FOUND_POINTS " AS f ON f.id = g.point WHERE f.id IS NULL "
					"ORDER BY g.line, g.position LIMIT 1", values, isnull, 3))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("mesh has no point " INT64_FORMAT, DatumGetInt64(values[0])),
				 errdetail("It is at position " INT64_FORMAT " of line " INT64_FORMAT ".",
						   DatumGetInt64(values[2]), DatumGetInt64(values[1])),
				 errhint("Insert it first with abacus_insert(), or give x and y after the id.")));
}

/* An id that rows give with two places, of which the mesh lacks one. */
static void
check_ids(void)
{
	refuse_two_places("SELECT g.point FROM " LINE_ROWS " AS g LEFT JOIN " FOUND_PLACES
					  " AS f ON f.id = g.point AND f.x = g.x AND f.y = g.y WHERE g.point IS NOT NULL GROUP BY g.point "
					  "HAVING (min(g.x) <> max(g.x) OR min(g.y) <> max(g.y)) AND bool_or(f.id IS NULL) "
					  "ORDER BY g.point LIMIT 1");
}

/* An id that rows give with another place than the mesh. */
static void
check_places(void)
{
	Datum		values[7];
	bool		isnull[7];

	if (query_first("SELECT g.point, g.line, g.position, g.x, g.y, f.x, f.y FROM " LINE_ROWS " AS g "
					"JOIN " FOUND_PLACES " AS f ON f.id = g.point LEFT JOIN " FOUND_PLACES
					" AS same ON same.id = g.point AND same.x = g.x AND same.y = g.y WHERE same.id IS NULL "
					"ORDER BY g.line, g.position, f.x, f.y LIMIT 1", values, isnull, 7))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("point " INT64_FORMAT " is at another place in the mesh", DatumGetInt64(values[0])),
				 errdetail("It is %s at position " INT64_FORMAT " of line " INT64_FORMAT ", and %s in the mesh.",
						   place(values + 3), DatumGetInt64(values[2]), DatumGetInt64(values[1]),
						   place(values + 5)),
				 errhint("Give the place of the mesh, another id, or NULL.")));
}

/* ---- Attributes ------------------------------------------------------------------------ */

/* A point found that is the vertex at its place, or, while all wait, will be: the first one there. */
#define IS_VERTEX \
	"(f.vertex = f.id OR f.vertex IS NULL AND NOT EXISTS (SELECT FROM " FOUND_POINTS " AS o WHERE o.x = f.x " \
	"AND o.y = f.y AND (o.vertex = o.id OR o.sequence < f.sequence)))"

/* All values of attributes at places of rows, of the rows and of vertices. */
#define VALUES_AT_PLACES \
	"(SELECT g.x, g.y, a.n, a.value, concat('position ', g.position, ' of line ', g.line) AS what FROM " \
	LINE_ROWS " AS g, unnest(g.attributes) WITH ORDINALITY AS a (value, n) " \
	"UNION ALL " \
	"SELECT f.x, f.y, a.n, a.value, concat('vertex ', f.id) FROM " FOUND_POINTS \
	" AS f, unnest(f.attributes) WITH ORDINALITY AS a (value, n) WHERE " IS_VERTEX ") AS s"

/* What gives the least or the greatest value of an attribute at a place. */
static char *
giver(const Datum *values, const char *order)
{
	Datum		what;
	bool		isnull;

	if (!query_first(psprintf("SELECT what FROM " VALUES_AT_PLACES " WHERE x = '%s'::float8 AND "
							  "y = '%s'::float8 AND n = " INT64_FORMAT " AND value IS NOT NULL "
							  "ORDER BY value %s LIMIT 1", number_of(values[0]), number_of(values[1]),
							  DatumGetInt64(values[2]), order), &what, &isnull, 1))
		return pstrdup("");
	return TextDatumGetCString(what);
}

/* An attribute with two values at one place. */
static void
check_attributes(const NewLines *lines)
{
	Datum		values[5];
	bool		isnull[5];

	if (query_first("SELECT x, y, n, min(value), max(value) FROM " VALUES_AT_PLACES
					" GROUP BY x, y, n HAVING min(value) <> max(value) ORDER BY x, y, n LIMIT 1",
					values, isnull, 5))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("attribute \"%s\" has two values at %s", lines->reading.names.of[DatumGetInt64(values[2]) - 1],
						place(values)),
				 errdetail("It is %s at %s, and %s at %s.", shown(values[3]), giver(values, "ASC"),
						   shown(values[4]), giver(values, "DESC")),
				 errhint("Give one of them, or NULL.")));
}

/* ---- Points of the lines ----------------------------------------------------------------- */

/* The id above which new ids begin. */
static int64
greatest_id(const NewLines *lines)
{
	Datum		value;
	Datum		count;
	bool		isnull;

	if (!lines->census->knows_ids)
	{
		query_first(psprintf("SELECT max(v.id) FROM %s AS v", lines->vertices), &value, &isnull, 1);
		lines->census->greatest_id = isnull ? 0 : DatumGetInt64(value);
		lines->census->knows_ids = 1;
	}
	query_first(psprintf("SELECT greatest('" INT64_FORMAT "'::bigint, (SELECT max(g.point) FROM " LINE_ROWS " AS g))",
						 lines->census->greatest_id), &value, &isnull, 1);
	query_first("SELECT count(*) FROM " LINE_ROWS " WHERE point IS NULL", &count, &isnull, 1);
	if (DatumGetInt64(value) > PG_INT64_MAX - DatumGetInt64(count))
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("no id is left above the greatest one, " INT64_FORMAT, DatumGetInt64(value)),
				 errhint("Give the new points of the lines ids.")));
	return DatumGetInt64(value);
}

/* Ids for new points of rows that have none. */
static const char *
new_ids(const NewLines *lines)
{
	return lines->new_ids != NULL ? lines->new_ids
		: psprintf("SELECT x, y, '" INT64_FORMAT "'::bigint + row_number() OVER (ORDER BY line, position) "
				   "FROM known WHERE id IS NULL", greatest_id(lines));
}

/*
 * The points of lines whose rows have places, if some have no id. The vertex at the place is meant,
 * or else the first point that a row names there, or else a new one.
 */
static const char *
points_by_place(const NewLines *lines)
{
	return psprintf(
		"WITH there AS (SELECT x, y, coalesce(min(vertex), (array_agg(id ORDER BY sequence))[1]) AS id "
		" FROM " FOUND_POINTS " GROUP BY x, y), "
		"named AS (SELECT DISTINCT ON (x, y) x, y, point AS id FROM " LINE_ROWS " WHERE point IS NOT NULL "
		" ORDER BY x, y, line, position), "
		"nameless AS (SELECT DISTINCT ON (x, y) x, y, line, position FROM " LINE_ROWS " WHERE point IS NULL "
		" ORDER BY x, y, line, position), "
		"known AS (SELECT n.x, n.y, n.line, n.position, coalesce(there.id, named.id) AS id "
		" FROM nameless AS n LEFT JOIN there ON there.x = n.x AND there.y = n.y "
		" LEFT JOIN named ON named.x = n.x AND named.y = n.y), "
		"numbered AS (SELECT x, y, id, false AS is_new FROM known WHERE id IS NOT NULL UNION ALL "
		" SELECT x, y, id, true FROM (%s) AS n (x, y, id)) "
		"SELECT g.line, g.position, coalesce(g.point, n.id), g.x, g.y, g.attributes, "
		" CASE WHEN g.point IS NULL THEN n.is_new ELSE f.id IS NULL END, g.part "
		"FROM " LINE_ROWS " AS g "
		"LEFT JOIN numbered AS n ON g.point IS NULL AND n.x = g.x AND n.y = g.y "
		"LEFT JOIN " FOUND_PLACES " AS f ON f.id = g.point AND f.x = g.x AND f.y = g.y",
		new_ids(lines));
}

/* The query that finds the points of lines. */
static const char *
points_query(const NewLines *lines)
{
	if (lines->shape.has_nameless)
		return points_by_place(lines);
	if (lines->is_known)
		return "SELECT line, position, point, x, y, NULL::float8[], false, part FROM " LINE_ROWS;
	return lines->shape.has_places
		? "SELECT g.line, g.position, g.point, g.x, g.y, g.attributes, f.id IS NULL, g.part FROM " LINE_ROWS " AS g "
		"LEFT JOIN " FOUND_PLACES " AS f ON f.id = g.point AND f.x = g.x AND f.y = g.y"
		: "SELECT g.line, g.position, g.point, f.x, f.y, NULL::float8[], false, g.part FROM " LINE_ROWS " AS g "
		"JOIN (SELECT DISTINCT id, x, y FROM " FOUND_POINTS ") AS f ON f.id = g.point";
}

static void
check_lengths(const NewLines *lines)
{
	Datum		values[5];
	bool		isnull[5];

	if (query_first("SELECT x, y, line, before, position FROM (SELECT x, y, line, position, coalesce(part, 0) AS part, "
					"lag(x) OVER w AS x0, lag(y) OVER w AS y0, lag(position) OVER w AS before, "
					"lag(coalesce(part, 0)) OVER w AS part0 FROM " LINE_POINTS
					" WINDOW w AS (PARTITION BY line ORDER BY position)) AS s "
					"WHERE x = x0 AND y = y0 AND part = part0 "
					"ORDER BY line, position LIMIT 1", values, isnull, 5))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("line " INT64_FORMAT " has a segment of length zero", DatumGetInt64(values[2])),
				 errdetail("Its positions " INT64_FORMAT " and " INT64_FORMAT " are both at %s.",
						   DatumGetInt64(values[3]), DatumGetInt64(values[4]), place(values)),
				 lines->shape.has_geometries ? errhint("Leave it out with ST_RemoveRepeatedPoints(geometry).")
				 : errhint("Leave one of the two points out.")));
}

/* The points of lines, LINE_POINTS, from a query. */
NamedRows *
line_points_of_query(const char *query)
{
	static const NamedColumn columns[] = {
		{"line", INT8OID}, {"position", INT8OID}, {"point", INT8OID}, {"x", FLOAT8OID},
		{"y", FLOAT8OID}, {"attributes", FLOAT8ARRAYOID}, {"is_new", BOOLOID}, {"part", INT8OID}
	};

	return named_rows_of_query(LINE_POINTS, columns, lengthof(columns), query);
}

/*
 * The points of the lines, LINE_POINTS: those found in the mesh, which are registered and then freed,
 * or new ones, which get ids.
 */
NamedRows *
line_points_resolve(const NewLines *lines, NamedRows *found)
{
	NamedRows  *points;

	if (lines->shape.has_places)
	{
		check_places();
		check_ids();
	}
	else
	{
		check_found_ids();
		check_known();
	}
	if (lines->shape.has_attributes)
		check_attributes(lines);
	points = line_points_of_query(points_query(lines));
	named_rows_free(found);
	check_lengths(lines);
	return points;
}

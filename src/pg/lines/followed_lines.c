/*
 * followed_lines.c: lines of a table that a mesh follows, as the mesh catches up with them.
 *
 * A line that has changed leaves the mesh, and comes back as the table has it now: so it does not
 * matter how often it has changed, or in which order. Lines at places where points of the mesh come
 * or go are treated as changed, too. First all these lines leave. Then the caller changes the points,
 * which no line names any more. Then the lines come.
 *
 * Lines that are geometries have no points with ids. Where there is no vertex, a line makes one
 * (`made` in the table of lines). It is there as long as a line names it, and only while the mesh has
 * no other point there. So the vertices are a function of the points and the lines of both tables;
 * only the ids of those that are made depend on the past.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/guc.h"

#include "pg/lines/followed_parts.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_lines.h"

/* Rows with names. */
#define NOTED_LINES "abacus_noted_lines"
#define NOTED_PLACES "abacus_noted_places"
#define KINDS "abacus_kinds"

static const NamedColumn line_columns[] = {{"line", INT8OID}};
static const NamedColumn place_columns[] = {{"x", FLOAT8OID}, {"y", FLOAT8OID}};
static const NamedColumn kind_columns[] = {{"line", INT8OID}, {"kind", TEXTOID}};
static const NamedColumn made_columns[] = {{"point", INT8OID}, {"x", FLOAT8OID}, {"y", FLOAT8OID}};

/* ---- Notes ------------------------------------------------------------------------ */

/*
 * Begins with no line that has changed, or with `all`. `table` is the mesh's table of lines. SPI is
 * connected until the end.
 */
FollowedLines *
followed_lines_begin(Change *change, Oid table, bool all)
{
	FollowedLines *lines = palloc0(sizeof(FollowedLines));

	lines->change = change;
	lines->table = lines_table_name(table);
	lines->all = all;
	lines->noted = named_rows_create(NOTED_LINES, line_columns, lengthof(line_columns));
	lines->places = named_rows_create(NOTED_PLACES, place_columns, lengthof(place_columns));
	return lines;
}

/* A line of the table has changed, come or gone. */
void
followed_lines_note(FollowedLines *lines, int64 line)
{
	Datum		value = Int64GetDatum(line);
	bool		isnull = false;

	named_rows_put(lines->noted, &value, &isnull);
}

/* A point comes to a place, or leaves it. */
void
followed_lines_note_place(FollowedLines *lines, const double place[2])
{
	Datum		values[2] = {Float8GetDatum(place[0] + 0.0), Float8GetDatum(place[1] + 0.0)};
	bool		isnull[2] = {false, false};

	named_rows_put(lines->places, values, isnull);
}

/* ---- Which lines change -------------------------------------------------------------- */

static void
release(NamedRows **rows)
{
	if (*rows != NULL)
		named_rows_free(*rows);
	*rows = NULL;
}

/* Policies of the table are an error, and do not hide lines. */
static int
begin_queries(void)
{
	int			level = plain_names_begin(true);

	(void) set_config_option("row_security", "off", PGC_USERSET, PGC_S_SESSION, GUC_ACTION_SAVE, true, 0,
							 false);
	return level;
}

/* The lines that were noted, and those with a corner at a noted place. */
static void
find_changed(FollowedLines *lines)
{
	if (!lines->is_compared)
		named_rows_register(lines->noted);
	named_rows_register(lines->places);
	lines->changed = named_rows_of_query(CHANGED_LINES, line_columns, lengthof(line_columns),
										 psprintf("SELECT line FROM " NOTED_LINES " UNION SELECT l.line FROM %s AS l "
												  "JOIN (SELECT DISTINCT x, y FROM " NOTED_PLACES ") AS p "
												  "ON p.x = l.x AND p.y = l.y", lines->table));
}

/* Reads the changed lines as the table has them. */
static void
read_rows(FollowedLines *lines, const LineQueries *queries)
{
	Source		source = {.query = queries->rows};

	release(&lines->rows);
	source.plan = SPI_prepare_cursor(queries->rows, 0, NULL, CURSOR_OPT_NO_SCROLL);
	if (source.plan == NULL)
		elog(ERROR, "could not prepare the query of lines: %s", SPI_result_code_string(SPI_result));
	lines->rows = line_rows_read(&source, &lines->lines.reading, &lines->lines.shape);
	SPI_freeplan(source.plan);
	named_rows_register(lines->rows);
}

/*
 * A vertex that lines have made has the values of all of them. So if one changes, all at its corners,
 * old and new, are read, and give them anew; whether there are any.
 */
static bool
find_neighbours(FollowedLines *lines)
{
	static const char *const query =
		"SELECT line FROM " CHANGED_LINES " UNION "
		"SELECT m.line FROM %1$s AS l JOIN " CHANGED_LINES " AS c ON c.line = l.line "
		"JOIN %1$s AS m ON m.x = l.x AND m.y = l.y UNION "
		"SELECT l.line FROM %1$s AS l JOIN (SELECT DISTINCT x, y FROM " LINE_ROWS ") AS g ON g.x = l.x AND g.y = l.y";
	NamedRows  *more = named_rows_create(CHANGED_LINES, line_columns, lengthof(line_columns));
	bool		any;

	more->count = query_into(more->store, psprintf(query, lines->table));
	any = more->count > lines->changed->count;
	release(&lines->changed);
	lines->changed = more;
	named_rows_register(more);
	return any;
}

/* Reads the changed lines, with all checks that need no mesh; whether there are any, here or there. */
static bool
read_lines(FollowedLines *lines, const LineQueries *queries)
{
	lines->lines.vertices = queries->vertices;
	lines->lines.census = &lines->change->writer.header->facts.census;
	lines->lines.reading = queries->reading;
	lines->kind = queries->kind;
	if (!lines->all && lines->changed == NULL)
		find_changed(lines);
	if (!lines->all && lines->changed->count == 0)
		return false;
	read_rows(lines, queries);
	if (lines->lines.shape.has_attributes && !lines->all && find_neighbours(lines))
		read_rows(lines, queries);
	lines->lines.is_known = lines->lines.shape.has_places && !lines->lines.shape.has_geometries;
	line_points_check(&lines->lines);
	return true;
}

/* A line of another kind, or of two. */
static void
check_kinds(void)
{
	Datum		values[3];
	bool		isnull[3];

	if (query_first("SELECT line, min(kind), max(kind) FROM " KINDS " GROUP BY line HAVING count(*) > 1 "
					"ORDER BY line LIMIT 1", values, isnull, 3))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("line " INT64_FORMAT " has two kinds", DatumGetInt64(values[0])),
				 errdetail("They are \"%s\" and \"%s\".", TextDatumGetCString(values[1]),
						   TextDatumGetCString(values[2])),
				 errhint("Give all points of a line the same kind.")));
	if (query_first("SELECT line, kind FROM " KINDS " WHERE kind NOT IN ('hard', 'soft') ORDER BY line LIMIT 1",
					values, isnull, 2))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("line " INT64_FORMAT " has the kind \"%s\"", DatumGetInt64(values[0]),
						TextDatumGetCString(values[1])),
				 errhint("Use 'hard' or 'soft'.")));
}

static void
read_kinds(FollowedLines *lines, const LineQueries *queries)
{
	if (queries->kinds == NULL)
		return;
	lines->kinds = named_rows_of_query(KINDS, kind_columns, lengthof(kind_columns), queries->kinds);
	check_kinds();
}

/* ---- Lines leave --------------------------------------------------------------------- */

/* The vertices that the changed lines have made, or use, for lines without ids of points. */
static void
find_made(FollowedLines *lines, const LineQueries *queries)
{
	const char *others = lines->all ? "false" : "NOT EXISTS (SELECT FROM " CHANGED_LINES " AS c WHERE c.line = l.line)";
	Datum		least;
	bool		isnull;

	lines->kept = named_rows_of_query(MADE_KEPT, made_columns, lengthof(made_columns),
									  psprintf("SELECT DISTINCT l.point, l.x, l.y FROM %s AS l WHERE l.made AND %s AND EXISTS "
											   "(SELECT FROM " LINE_ROWS " AS g WHERE g.x = l.x AND g.y = l.y)",
											   lines->table, others));
	lines->gone = named_rows_of_query(MADE_GONE, made_columns, lengthof(made_columns),
									  psprintf("SELECT DISTINCT g.point, g.x, g.y FROM %1$s AS g %2$s WHERE g.made AND NOT EXISTS "
											   "(SELECT FROM %1$s AS l WHERE l.x = g.x AND l.y = g.y AND l.made AND %3$s)",
											   lines->table, lines->all ? "" : "JOIN " CHANGED_LINES " AS o ON o.line = g.line",
											   others));
	if (!lines->lines.shape.has_nameless)
		return;
	query_first(psprintf("SELECT min(l.point) FROM %s AS l WHERE l.made", lines->table), &least, &isnull, 1);
	if (isnull)
		query_first(queries->least, &least, &isnull, 1);
	lines->least = isnull ? 0 : Min(DatumGetInt64(least), 0);
}

/* Takes the changed lines out of the mesh, and frees their edges. */
static void
delete_lines(FollowedLines *lines)
{
	int64		soft = 0;
	uint64		count = new_lines_delete(lines->change, lines->table,
										 lines->all ? psprintf("SELECT line FROM %s", lines->table)
										 : "SELECT line FROM " CHANGED_LINES, &soft);

	if (count == 0)
		return;
	change_unfix(lines->change);
	change_lines(lines->change, -(int64) count, -soft);
}

/*
 * The changed lines leave, after they have been read as they will come. False if none has changed:
 * then no line comes.
 */
bool
followed_lines_leave(FollowedLines *lines, const LineQueries *queries)
{
	int			level = begin_queries();
	bool		any = read_lines(lines, queries);

	if (any)
	{
		read_kinds(lines, queries);
		find_made(lines, queries);
		delete_lines(lines);
	}
	plain_names_end(level);
	return any;
}

/* ---- Lines come ---------------------------------------------------------------------- */

/* Ids for vertices that lines make: those that they had there, or the next below the least. */
static char *
made_ids(const FollowedLines *lines)
{
	return psprintf("SELECT k.x, k.y, coalesce(m.point, '" INT64_FORMAT "'::bigint - row_number() OVER "
					"(PARTITION BY m.point IS NULL ORDER BY k.line, k.position)) FROM known AS k "
					"LEFT JOIN " MADE_GONE " AS m ON m.x = k.x AND m.y = k.y WHERE k.id IS NULL", lines->least);
}

/* What new_lines_write() takes: the kind of a line, and whether it has made a vertex. */
static LineValues
values_of(const FollowedLines *lines)
{
	LineValues	values;

	values.kind = lines->kinds == NULL ? psprintf("'%s'", lines->kind) : "k.kind";
	values.made = lines->lines.shape.has_nameless ? "nullif(p.is_new OR m.point IS NOT NULL, false)" : "NULL";
	values.joins = psprintf("LEFT JOIN " MADE_KEPT " AS m ON m.x = p.x AND m.y = p.y%s",
							lines->kinds == NULL ? "" : " LEFT JOIN " KINDS " AS k ON k.line = p.line");
	return values;
}

/* How many lines come, and how many of them are soft. */
static void
count_lines(const FollowedLines *lines, int64 *count, int64 *soft)
{
	Datum		values[2];
	bool		isnull[2];

	query_first(psprintf("SELECT count(*), count(*) FILTER (WHERE %s = 'soft') FROM "
						 "(SELECT DISTINCT line FROM " LINE_ROWS ") AS g%s",
						 lines->kinds == NULL ? psprintf("'%s'", lines->kind) : "k.kind",
						 lines->kinds == NULL ? "" : " LEFT JOIN " KINDS " AS k ON k.line = g.line"),
				values, isnull, 2);
	*count = DatumGetInt64(values[0]);
	*soft = DatumGetInt64(values[1]);
}

/* After the points of the mesh have changed: the changed lines come, as they were read. */
void
followed_lines_come(FollowedLines *lines)
{
	static const NewPoints points = {.insert_waiting = true};
	int			level = begin_queries();
	LineValues	values;
	NamedRows  *named;
	int64		count;
	int64		soft;

	followed_points_remove(lines);
	if (lines->rows->count > 0)
	{
		lines->lines.new_ids = made_ids(lines);
		named = line_points_resolve(&lines->lines, followed_points_find(lines));
		values = values_of(lines);
		new_lines_write(lines->table, &values, named);
		count_lines(lines, &count, &soft);
		change_lines(lines->change, count, soft);
		new_lines_join(lines->change, &values, &points);
		named_rows_free(named);
		change_take_srid(lines->change, lines->lines.shape.srid);
	}
	plain_names_end(level);
	mesh_lines_notice_waiting(&lines->change->writer);
}

/* ---- In step? ----------------------------------------------------------------------- */

/*
 * Compares all lines with those that the mesh has. Those that differ are noted: only they have
 * changed. Returns how many they are. `queries` are for all lines.
 */
uint64
followed_lines_compare(FollowedLines *lines, const LineQueries *queries)
{
	int			level = begin_queries();
	const LineShape *shape = &lines->lines.shape;
	char	   *columns;
	char	   *here;
	char	   *there;

	(void) read_lines(lines, queries);
	read_kinds(lines, queries);
	columns = psprintf("r.line, r.position, coalesce(r.part, 0)%s%s", shape->has_places ? ", r.x, r.y" : "",
					   shape->has_nameless ? "" : ", r.point");
	here = psprintf("SELECT %s, %s FROM " LINE_ROWS " AS r%s", columns,
					lines->kinds == NULL ? psprintf("'%s'", lines->kind) : "k.kind",
					lines->kinds == NULL ? "" : " JOIN " KINDS " AS k ON k.line = r.line");
	there = psprintf("SELECT %s, r.kind FROM %s AS r", columns, lines->table);
	release(&lines->noted);
	lines->noted = named_rows_of_query(NOTED_LINES, line_columns, lengthof(line_columns),
									   psprintf("SELECT DISTINCT line FROM ((%1$s EXCEPT ALL %2$s) UNION ALL "
												"(%2$s EXCEPT ALL %1$s)) AS d", here, there));
	release(&lines->rows);
	release(&lines->kinds);
	lines->all = false;
	lines->is_compared = true;
	plain_names_end(level);
	return lines->noted->count;
}

/* Ends the rows. */
void
followed_lines_end(FollowedLines *lines)
{
	release(&lines->rows);
	release(&lines->kinds);
	release(&lines->gone);
	release(&lines->kept);
	release(&lines->changed);
	release(&lines->places);
	release(&lines->noted);
}

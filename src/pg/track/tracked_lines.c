/*
 * tracked_lines.c: the lines of a table that a mesh follows: their columns, and queries for them.
 *
 * A row is a line with a geometry, or a point of a line. Points have ids of the table of points that
 * the mesh follows, which says where they are; without such a table they are points of the mesh.
 */
#include "postgres.h"

#include "access/table.h"
#include "catalog/pg_type.h"
#include "lib/stringinfo.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/lines/line_rows.h"
#include "pg/lines/line_values.h"
#include "pg/mesh/header.h"
#include "pg/mesh/shape.h"
#include "pg/postgis/catalogue.h"
#include "pg/track/tracked_lines.h"
#include "pg/track/tracked_points.h"
#include "pg/track/transition.h"

#define GEOMETRY_COLUMNS 2

/* ---- Columns -------------------------------------------------------------------------- */

static AttrNumber
column_number(Relation table, const char *name)
{
	AttrNumber	number = get_attnum(RelationGetRelid(table), name);

	if (number <= 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("column \"%s\" of table \"%s\" does not exist", name, RelationGetRelationName(table)),
				 errhint("Name the columns with the argument columns: line and geometry, or line, position, "
						 "point and perhaps part.")));
	return number;
}

static bool
has_column(Relation table, const char *name)
{
	return get_attnum(RelationGetRelid(table), name) > 0;
}

/* The columns of a table for which the caller has named none. */
static List *
default_columns(Relation table)
{
	char	   *geometry;
	List	   *columns = NIL;

	if (has_column(table, "position") && has_column(table, "point"))
	{
		columns = list_make3("line", "position", "point");
		return has_column(table, "part") ? lappend(columns, "part") : columns;
	}
	geometry = tracked_only_geometry(table);
	if (geometry == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("table \"%s\" has neither points of lines nor one geometry",
						RelationGetRelationName(table)),
				 errhint("Name the columns with the argument columns: line and geometry, or line, position, "
						 "point and perhaps part.")));
	return list_make2(has_column(table, "line") ? "line" : "id", geometry);
}

static List *
given_columns(ArrayType *given)
{
	List	   *columns = NIL;
	int			count;
	Datum	   *elements = shape_names(given, "columns", &count);

	for (int i = 0; i < count; i++)
		columns = lappend(columns, TextDatumGetCString(elements[i]));
	if (count < GEOMETRY_COLUMNS || count > 4)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("columns has %d elements", count),
				 errdetail("They are line and geometry, or line, position, point and perhaps part.")));
	return columns;
}

/* Refuses columns of other types; the table has them. */
void
tracked_lines_check_types(const TrackedLines *lines, Relation table)
{
	bool		is_drawn = list_length(lines->columns) == GEOMETRY_COLUMNS;
	ListCell   *cell;

	foreach(cell, lines->columns)
	{
		AttrNumber	number = get_attnum(RelationGetRelid(table), lfirst(cell));
		Oid			type = TupleDescAttr(RelationGetDescr(table), number - 1)->atttypid;
		bool		wants_geometry = is_drawn && foreach_current_index(cell) == 1;

		if (wants_geometry ? geometry_is_type(type) : line_value_is_integer(getBaseType(type)))
			continue;
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("column \"%s\" of table \"%s\" has type %s", (char *) lfirst(cell),
						RelationGetRelationName(table), format_type_be(type)),
				 wants_geometry ? errdetail("The second of two columns is a geometry.")
				 : errdetail("Lines, positions, points and parts are integers."),
				 errhint("Name another column with the argument columns of abacus_track_lines(), or give "
						 "this one such a type.")));
	}
}

/* How a table gives lines: as the caller of abacus_track_lines() says, checked. */
TrackedLines *
tracked_lines_given(Relation table, abacus_names names, ArrayType *columns, const char *kind,
					const char *z)
{
	TrackedLines *lines = palloc0(sizeof(TrackedLines));
	bool		is_word = strcmp(kind, "hard") == 0 || strcmp(kind, "soft") == 0;
	ListCell   *cell;

	lines->table = RelationGetRelid(table);
	lines->user = table->rd_rel->relowner;
	lines->columns = columns != NULL ? given_columns(columns) : default_columns(table);
	foreach(cell, lines->columns)
		tracked_check_column(table, column_number(table, lfirst(cell)));
	tracked_lines_check_types(lines, table);
	lines->kind = is_word ? kind : NULL;
	lines->kind_column = is_word ? NULL : kind;
	if (!is_word && !has_column(table, kind))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("table \"%s\" has no column \"%s\" for the kind of lines",
						RelationGetRelationName(table), kind),
				 errhint("Use 'hard' or 'soft', or name a column that has these words.")));
	if (!is_word)
		tracked_check_column(table, column_number(table, kind));
	lines->z = z;
	if (z != NULL)
		header_find_attribute(names, z);
	if (z != NULL && list_length(lines->columns) != GEOMETRY_COLUMNS)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("z is for lines given as geometries"),
				 errhint("Points of the other lines have the attributes of their own table.")));
	return lines;
}

/* All columns that count: those of lines and the one of kinds. */
List *
tracked_lines_columns(const TrackedLines *lines)
{
	List	   *columns = list_copy(lines->columns);

	return lines->kind_column == NULL ? columns
		: lappend(columns, unconstify(char *, lines->kind_column));
}

/* ---- Arguments of triggers ---------------------------------------------------------------- */

static const char *
word_or_null(const char *argument)
{
	return *argument == '\0' ? NULL : argument;
}

/* Reads arguments that tracked_lines_arguments() has made; false if someone else has. */
bool
tracked_lines_read(TrackedLines *lines, char **arguments, int count)
{
	int			columns = count - LINE_ARGUMENT_COLUMNS;

	if (columns < GEOMETRY_COLUMNS || columns > 4)
		return false;
	lines->kind = word_or_null(arguments[LINE_ARGUMENT_KIND]);
	lines->kind_column = word_or_null(arguments[LINE_ARGUMENT_KIND_COLUMN]);
	lines->z = word_or_null(arguments[LINE_ARGUMENT_Z]);
	lines->columns = NIL;
	for (int i = LINE_ARGUMENT_COLUMNS; i < count; i++)
		lines->columns = lappend(lines->columns, arguments[i]);
	return lines->kind == NULL ? lines->kind_column != NULL
		: strcmp(lines->kind, "hard") == 0 || strcmp(lines->kind, "soft") == 0;
}

/* The arguments of the triggers behind the name of the mesh. */
List *
tracked_lines_arguments(const TrackedLines *lines)
{
	List	   *arguments = NIL;

	arguments = lappend(arguments, pstrdup(lines->kind != NULL ? lines->kind : ""));
	arguments = lappend(arguments, pstrdup(lines->kind_column != NULL ? lines->kind_column : ""));
	arguments = lappend(arguments, pstrdup(lines->z != NULL ? lines->z : ""));
	return list_concat(arguments, lines->columns);
}

/* How the table of lines that a mesh follows gives them; NULL if it follows none. */
TrackedLines *
tracked_lines_of(Relation mesh)
{
	TrackingTrigger *trigger = tracking_followed(mesh, TRACKED_LINES);
	TrackedLines *lines;

	if (trigger == NULL)
		return NULL;
	lines = palloc0(sizeof(TrackedLines));
	lines->table = tracking_root(trigger->table);
	/* a trigger that is not bound has only the rights of the user */
	lines->user = trigger->bound ? mesh_table_owner(lines->table) : GetUserId();
	return tracked_lines_read(lines, trigger->arguments, trigger->count) ? lines : NULL;
}

/* ---- Queries ------------------------------------------------------------------------------ */

/* A column of the row t of the table. */
static char *
column(const TrackedLines *lines, int number)
{
	return psprintf("t.%s", quote_identifier(list_nth(lines->columns, number)));
}

/* The table in SQL, as t. */
static char *
table_as_t(const TrackedLines *lines)
{
	return psprintf("%s AS t", quote_qualified_identifier(get_namespace_name(get_rel_namespace(lines->table)),
														  get_rel_name(lines->table)));
}

/* Which rows of it: those of lines, of all or of those that have changed. */
static char *
condition(const TrackedLines *lines, bool all)
{
	bool		is_drawn = list_length(lines->columns) == GEOMETRY_COLUMNS;

	return psprintf("%s%s", is_drawn ? psprintf("%s IS NOT NULL", column(lines, 1)) : "true",
					all ? "" : psprintf(" AND %s IN (SELECT c.line FROM " CHANGED_LINES " AS c)",
										column(lines, 0)));
}

/* The table of points that the mesh follows, and its columns; NULL if it follows none. */
static Relation
table_of_points(Relation mesh, List **columns)
{
	TrackingTrigger *trigger = tracking_followed(mesh, TRACKED_POINTS);
	Relation	table;

	if (trigger == NULL)
		return NULL;
	*columns = NIL;
	for (int i = TRACKING_ARGUMENT_COLUMNS; i < trigger->count; i++)
		*columns = lappend(*columns, trigger->arguments[i]);
	table = table_open(tracking_root(trigger->table), AccessShareLock);
	tracked_check_places(table, *columns);
	return table;
}

/* The rows of lines; `points` is the table that has their points, or NULL. */
static char *
select_rows(const TrackedLines *lines, const char *where, Relation points, List *point_columns)
{
	const char *table = table_as_t(lines);
	StringInfoData query;
	char	   *join = "";

	if (list_length(lines->columns) == GEOMETRY_COLUMNS)
		return psprintf("SELECT %s, %s FROM %s WHERE %s", column(lines, 0), column(lines, 1), table, where);
	initStringInfo(&query);
	appendStringInfo(&query, "SELECT %s, %s, %s", column(lines, 0), column(lines, 1), column(lines, 2));
	if (points != NULL)
	{
		char	   *ids = psprintf("SELECT %s FROM %s WHERE %s", column(lines, 2), table, where);

		appendStringInfoString(&query, ", p.x, p.y");
		join = psprintf(" LEFT JOIN (%s) AS p (id, x, y) ON p.id = %s",
						tracked_places(points, point_columns, ids), column(lines, 2));
	}
	if (list_length(lines->columns) > LINE_ROW_POINT + 1)
		appendStringInfo(&query, ", %s AS part", column(lines, LINE_ROW_POINT + 1));
	appendStringInfo(&query, " FROM %s%s WHERE %s", table, join, where);
	return query.data;
}

/* The queries for changed lines, or for all, of a mesh that is being changed. */
void
tracked_lines_queries(const TrackedLines *lines, const Change *change, bool all, LineQueries *queries)
{
	Relation	mesh = mesh_pages(change->writer.host)->simplices.heap;
	bool		is_drawn = list_length(lines->columns) == GEOMETRY_COLUMNS;
	const char *schema = quote_identifier(get_namespace_name(tracking_extension(mesh)));
	List	   *point_columns;
	Relation	points = table_of_points(mesh, &point_columns);
	char	   *where = condition(lines, all);

	memset(queries, 0, sizeof(*queries));
	queries->rows = select_rows(lines, where, points, point_columns);
	queries->kind = lines->kind;
	if (lines->kind_column != NULL)
		queries->kinds = psprintf("SELECT DISTINCT %s::int8, coalesce(t.%s::text, 'hard') FROM %s WHERE %s",
								  column(lines, 0), quote_identifier(lines->kind_column), table_as_t(lines), where);
	queries->vertices = psprintf("%s.abacus_vertices('%u'::regclass)", schema, RelationGetRelid(mesh));
	queries->least = points != NULL ? tracked_least_id(points, point_columns)
		: psprintf("SELECT min(v.id) FROM %s AS v", queries->vertices);
	queries->reading.names = abacus_names_of(change->writer.header);
	queries->reading.z = lines->z;
	if (!is_drawn && points != NULL)
	{
		/* their columns are not attributes, whatever the names of these */
		abacus_facts *facts = palloc(sizeof(abacus_facts));

		*facts = change->writer.header->facts;
		facts->columns.attributes = 0;
		queries->reading.names.facts = facts;
		queries->reading.points_of = pstrdup(RelationGetRelationName(points));
	}
	if (points != NULL)
		table_close(points, NoLock);
}

/* SELECT of the ids of the lines in this table only, without its children. */
char *
tracked_lines_of_one_table(Relation table, const TrackedLines *lines)
{
	return psprintf("SELECT DISTINCT t.%s::pg_catalog.int8 FROM ONLY %s AS t",
					quote_identifier(linitial(lines->columns)),
					quote_qualified_identifier(get_namespace_name(RelationGetNamespace(table)),
											   RelationGetRelationName(table)));
}

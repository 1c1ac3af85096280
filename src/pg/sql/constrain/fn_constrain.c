/*
 * fn_constrain.c: abacus_constrain, which gives a mesh lines, and abacus_unconstrain, which takes
 * them away.
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

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/port/port.h"
#include "pg/sql/arguments/word.h"
#include "pg/sql/constrain/line_points.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_constrain);
SQL_FUNCTION(abacus_sql_unconstrain);

static const char *const kinds[] = {"hard", "soft", NULL};

enum
{
	EXISTING_ERROR,
	EXISTING_REPLACE
};
static const char *const existing_words[] = {"error", "replace", NULL};

static Relation
mesh_of(const Change *change)
{
	return mesh_pages(change->writer.host)->simplices.heap;
}

/* ---- Which meshes ------------------------------------------------------------------ */

static void
check_mesh(const Change *change)
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
				 errdetail("%s The mesh was loaded by abacus_load() and can be read, but not changed.",
						   abacus_delaunay_reason(facts->standing)),
				 errhint("Triangulate its vertices anew, by abacus_load() with retriangulate => true or by "
						 "abacus_triangulate().")));
}

/* ---- Lines that go ------------------------------------------------------------------- */

/*
 * Deletes the lines of a query of ids from the table, and keeps their segments; returns how many
 * there were, and how many of them were soft.
 */
static uint64
delete_lines(Change *change, const char *table, const char *ids, int64 *soft)
{
	Datum		counts[2];
	bool		isnull[2];

	query_first(psprintf("SELECT count(*), count(*) FILTER (WHERE kind = 'soft') FROM "
						 "(SELECT DISTINCT l.line, l.kind FROM %s AS l WHERE l.line IN (%s)) AS s",
						 table, ids), counts, isnull, 2);
	*soft = DatumGetInt64(counts[1]);
	if (DatumGetInt64(counts[0]) == 0)
		return 0;
	mesh_lines_open(&change->writer, &change->freed);
	mesh_lines_add(change->writer.host, change->freed,
				   psprintf("SELECT l.line, l.x, l.y, l.part FROM %s AS l WHERE l.line IN (%s) "
							"ORDER BY l.line, l.position", table, ids));
	query_run(psprintf("DELETE FROM %s AS l WHERE l.line IN (%s)", table, ids));
	return (uint64) DatumGetInt64(counts[0]);
}

/* ---- Lines that come ------------------------------------------------------------------ */

static void
refuse_existing(const char *table)
{
	Datum		line;
	bool		isnull;

	if (query_first(psprintf("SELECT g.line FROM (SELECT DISTINCT line FROM " LINE_ROWS ") AS g "
							 "WHERE EXISTS (SELECT FROM %s AS l WHERE l.line = g.line) ORDER BY g.line LIMIT 1",
							 table), &line, &isnull, 1))
		ereport(ERROR,
				(errcode(ERRCODE_UNIQUE_VIOLATION),
				 errmsg("the mesh already has a line " INT64_FORMAT, DatumGetInt64(line)),
				 errhint("Use existing => 'replace' to put the new line in its place.")));
}

/* The record of a new point, from a row of its id, place and attributes. */
static void
pack_point(const HeapTuple tuple, TupleDesc desc, uint64 *record, uint32 attributes)
{
	double	   *numbers = (double *) (record + 1);
	Datum	   *values;
	bool	   *nulls;
	bool		isnull;
	int			count = 0;
	Datum		array;

	record[0] = (uint64) DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
	for (int axis = 0; axis < 2; axis++)
		numbers[axis] = DatumGetFloat8(SPI_getbinval(tuple, desc, 2 + axis, &isnull));
	array = SPI_getbinval(tuple, desc, 4, &isnull);
	if (!isnull)
		deconstruct_array(DatumGetArrayTypeP(array), FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
						  TYPALIGN_DOUBLE, &values, &nulls, &count);
	for (uint32 i = 0; i < attributes; i++)
		numbers[2 + i] = (int) i < count && !nulls[i] ? DatumGetFloat8(values[i]) : NAN;
}

/* Puts the new points of the lines into the change's stage. */
static void
stage_points(Change *change)
{
	const abacus_facts *facts = &change->writer.header->facts;
	uint64	   *record = palloc((3 + facts->columns.attributes) * sizeof(uint64));
	Portal		portal = SPI_cursor_open_with_args(
		NULL, "SELECT point, x, y, attributes FROM (SELECT DISTINCT ON (point) point, x, y, attributes, "
		"line, position FROM " LINE_POINTS " WHERE is_new ORDER BY point, line, position) AS s "
		"ORDER BY line, position", 0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);

	change_open_stage(change, facts);
	for (;;)
	{
		SPI_cursor_fetch(portal, true, 1024);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
		{
			pack_point(SPI_tuptable->vals[i], SPI_tuptable->tupdesc, record, facts->columns.attributes);
			change_add(change, record, 1);
		}
		SPI_freetuptable(SPI_tuptable);
	}
	SPI_cursor_close(portal);
}

/* Inserts the new points; if points wait already, they wait as well, and the lines too. */
static void
insert_points(Change *change)
{
	abacus_census *census = &change->writer.header->facts.census;
	bool		waiting = census->inserted < census->staged;

	stage_points(change);
	if (waiting || census->vertices == 0)
		census->lines_wait = 1;
	if (change->points == 0)
		return;
	by_hand_refuse_points(change);
	if (waiting)
		change_stage(change);
	else
		change_insert(change);
}

static void
tell_of_waiting(const Change *change)
{
	const abacus_census *census = &change->writer.header->facts.census;

	if (census->lines_wait == 0)
		return;
	ereport(NOTICE,
			(errmsg("lines of mesh \"%s\" wait for points", RelationGetRelationName(mesh_of(change))),
			 errdetail(census->vertices == 0 ? "The mesh has no triangles yet."
					   : "Some points of the mesh have not been inserted yet."),
			 errhint("Their edges are fixed as soon as abacus_build() or abacus_insert() has inserted all "
					 "points.")));
}

/* Fixes the edges of the new lines, and frees those of lines that they have replaced. */
static void
change_edges(Change *change)
{
	abacus_census *census = &change->writer.header->facts.census;
	bool		fixed = census->lines_wait == 0;

	if (change->freed != NULL)
		change_unfix(change);	/* also fixes lines that have waited */
	if (!fixed || census->lines_wait > 0)
		return;
	mesh_lines_open(&change->writer, &change->fixed);
	mesh_lines_add(change->writer.host, change->fixed,
				   "SELECT line, x, y, part FROM " LINE_POINTS " ORDER BY line, position");
	change_fix(change);
}

/* Adds the lines whose rows have been read; returns how many they are. */
static uint64
add_lines(Change *change, const NewLines *lines, const char *kind, int existing)
{
	Datum		count;
	bool		isnull;
	uint64		replaced = 0;
	int64		soft = 0;
	char	   *table;
	bool		is_new;
	NamedRows  *points;
	int			level = plain_names_begin(true);

	line_points_check(lines);
	points = line_points_find(lines);
	query_first("SELECT count(*) FROM (SELECT DISTINCT line FROM " LINE_ROWS ") AS s", &count, &isnull, 1);
	plain_names_end(level);
	table = lines_table_name(lines_table_make(mesh_of(change), &is_new));
	level = plain_names_begin(true);
	if (existing == EXISTING_ERROR)
		refuse_existing(table);
	else
		replaced = delete_lines(change, table, "SELECT line FROM " LINE_ROWS, &soft);
	query_run(psprintf("INSERT INTO %s (line, position, point, x, y, kind, part) SELECT line, position, point, "
					   "x, y, '%s', part FROM " LINE_POINTS " ORDER BY line, position", table, kind));
	if (is_new)
		lines_table_index(mesh_of(change));
	change_lines(change, DatumGetInt64(count) - (int64) replaced,
				 (strcmp(kind, "soft") == 0 ? DatumGetInt64(count) : 0) - soft);
	insert_points(change);
	change_edges(change);
	plain_names_end(level);
	named_rows_free(points);
	return (uint64) DatumGetInt64(count);
}

/* Reads the rows of a prepared query, and adds its lines. */
static uint64
constrain(Change *change, Source *source, NewLines *lines, const char *kind, int existing)
{
	NamedRows  *rows;
	uint64		count;

	check_mesh(change);
	lines->names = abacus_names_of(change->writer.header);
	rows = line_rows_read(source, lines->names, lines->z, &lines->shape);
	if (rows->count == 0)
	{
		named_rows_free(rows);
		change_abandon(change);
		return 0;
	}
	named_rows_register(rows);
	count = add_lines(change, lines, kind, existing);
	named_rows_free(rows);
	change_take_srid(change, lines->shape.srid);
	tell_of_waiting(change);
	change_end(change);
	return count;
}

/* abacus_constrain(mesh regclass, query text, kind text, existing text, z text) -> bigint */
Datum
abacus_sql_constrain(PG_FUNCTION_ARGS)
{
	const char *kind;
	int			existing;
	Source		source;
	NewLines	lines = {0};
	uint64		count;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and query must not be NULL")));
	kind = kinds[word_argument(fcinfo, 2, kinds, "kind", "Use 'hard' or 'soft'.")];
	existing = word_argument(fcinfo, 3, existing_words, "existing", "Use 'error' or 'replace'.");
	if (!PG_ARGISNULL(4))
		lines.z = text_to_cstring(PG_GETARG_TEXT_PP(4));
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	lines.vertices = psprintf("%s('%u'::regclass)",
							  quote_qualified_identifier(get_namespace_name(get_func_namespace(fcinfo->flinfo->fn_oid)),
														 "abacus_vertices"), PG_GETARG_OID(0));
	count = constrain(change_begin(PG_GETARG_OID(0), "abacus_constrain()"), &source, &lines, kind,
					  existing);
	source_finish(&source);
	PG_RETURN_INT64((int64) count);
}

/* ---- abacus_unconstrain ------------------------------------------------------------------ */

static void
tell_of_unknown(const Change *change, uint64 ids, uint64 gone)
{
	if (ids > gone)
		ereport(NOTICE,
				(errmsg_plural("mesh \"%s\" has no line for " UINT64_FORMAT " id",
							   "mesh \"%s\" has no lines for " UINT64_FORMAT " ids",
							   (unsigned long) (ids - gone), RelationGetRelationName(mesh_of(change)),
							   ids - gone)));
}

/* Removes the lines whose ids have been read; returns how many there were. */
static uint64
remove_lines(Change *change)
{
	Oid			table = mesh_lines_table(mesh_of(change), MESH_WRITE);
	uint64		gone = 0;
	int64		soft = 0;
	Datum		ids;
	bool		isnull;
	int			level = plain_names_begin(true);

	query_first("SELECT count(DISTINCT line) FROM " LINE_IDS, &ids, &isnull, 1);
	if (OidIsValid(table))
		gone = delete_lines(change, lines_table_name(table), "SELECT line FROM " LINE_IDS, &soft);
	plain_names_end(level);
	tell_of_unknown(change, (uint64) DatumGetInt64(ids), gone);
	if (gone > 0)
	{
		change_unfix(change);
		change_lines(change, -(int64) gone, -soft);
	}
	return gone;
}

/* abacus_unconstrain(mesh regclass, query text) -> bigint */
Datum
abacus_sql_unconstrain(PG_FUNCTION_ARGS)
{
	Source		source;
	Change	   *change;
	NamedRows  *ids;
	uint64		gone = 0;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_unconstrain()");
	check_mesh(change);
	ids = line_ids_read(&source);
	named_rows_register(ids);
	if (ids->count > 0)
		gone = remove_lines(change);
	if (gone > 0)
		change_end(change);
	else
		change_abandon(change);
	named_rows_free(ids);
	source_finish(&source);
	PG_RETURN_INT64((int64) gone);
}

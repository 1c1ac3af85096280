/*
 * fixed_edges.c: the edges on the lines of a mesh.
 *
 * The core follows each segment of each line from edge to edge. An edge of several lines comes once
 * for each, so the rows are grouped. If only a window is wanted, its edges are found as
 * abacus_edges() finds them, and their lines from there (fixed_window.c); if there is no room for them, the
 * edges of all lines are joined with them.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/builtins.h"

#include "abacus/constrain.h"
#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/port/port.h"
#include "pg/sql/constrain/fixed_edges.h"
#include "pg/sql/constrain/fixed_window.h"

/* Rows with names. */
#define EDGES_ON_LINES "abacus_edges_on_lines"
#define EDGES_IN_WINDOW "abacus_edges_in_window"

enum
{
	EDGE_V0,
	EDGE_V1,
	EDGE_ENDS,					/* x and y of v0, then of v1: ids may not be unique */
	EDGE_LENGTH = EDGE_ENDS + 4,
	EDGE_LINE,
	EDGE_IS_HARD,
	EDGE_COLUMNS
};
static const NamedColumn edge_columns[EDGE_COLUMNS] = {
	{"v0", INT8OID}, {"v1", INT8OID}, {"x0", FLOAT8OID}, {"y0", FLOAT8OID}, {"x1", FLOAT8OID},
	{"y1", FLOAT8OID}, {"length", FLOAT8OID}, {"line", INT8OID}, {"is_hard", BOOLOID}
};

/* The edges of one segment after the other. */
typedef struct EdgeRows
{
	CachedMesh *cached;
	double		lower[2];		/* a box that contains the window */
	double		upper[2];
	NamedRows  *rows;
	int64		line;
	bool		is_hard;
	bool		checks;			/* looks for edges that are missing or free: no error then */
	bool		is_broken;		/* there is one, ... */
	int64		broken;			/* ... of this line */
	bool		has_wrong_kind; /* an edge of a hard line is soft */
} EdgeRows;

static void
note_broken(EdgeRows *edges)
{
	if (edges->checks && !edges->is_broken)
		edges->broken = edges->line;
	edges->is_broken = true;
}

/* Puts an edge of a line into the rows: x and y of both ends, in the order of the ids. */
static void
put_row(NamedRows *rows, const int64 ids[2], const double ends[4], int64 line, bool is_hard)
{
	bool		in_order = ids[0] <= ids[1];
	Datum		values[EDGE_COLUMNS];
	bool		isnull[EDGE_COLUMNS] = {false};

	values[EDGE_V0] = Int64GetDatum(ids[in_order ? 0 : 1]);
	values[EDGE_V1] = Int64GetDatum(ids[in_order ? 1 : 0]);
	for (int i = 0; i < 4; i++)
		values[EDGE_ENDS + i] = Float8GetDatum(ends[in_order ? i : i ^ 2]);
	values[EDGE_LENGTH] = Float8GetDatum(hypot(ends[2] - ends[0], ends[3] - ends[1]));
	values[EDGE_LINE] = Int64GetDatum(line);
	values[EDGE_IS_HARD] = BoolGetDatum(is_hard);
	named_rows_put(rows, values, isnull);
}

/* Called by the core. */
static abacus_host_status
put_edge(void *context, const int64_t ids[2], const double ends[2][2], abacus_edge_kind kind)
{
	EdgeRows   *edges = context;

	if (kind == ABACUS_FREE_EDGE)
	{
		note_broken(edges);
		return ABACUS_HOST_OK;
	}
	if (edges->is_hard && kind != ABACUS_HARD_EDGE)
		edges->has_wrong_kind = true;
	GUARD_BEGIN();
	put_row(edges->rows, ids, ends[0], edges->line, edges->is_hard);
	GUARD_END(edges->cached->host);
	return ABACUS_HOST_OK;
}

/* Called for the edges of a window. */
static void
put_window_edge(void *context, const int64 ids[2], const double ends[4], int64 line, bool is_hard)
{
	EdgeRows   *edges = context;

	put_row(edges->rows, ids, ends, line, is_hard);
}

/* Adds the edges of a segment of a line. */
static void
add_segment(EdgeRows *edges, const double *a, const double *b)
{
	CachedMesh *cached = edges->cached;
	int			is_whole;

	for (int axis = 0; axis < 2; axis++)
		if (Max(a[axis], b[axis]) < edges->lower[axis] || Min(a[axis], b[axis]) > edges->upper[axis])
			return;
	host_run(cached->host, abacus_edges_along, cached->mesh, a, b, put_edge, edges, &is_whole);
	host_release(cached->host);
	if (!is_whole)
		note_broken(edges);
	if (is_whole || edges->checks || cached->header.facts.census.lines_wait > 0)
		return;
	ereport(ERROR,
			(errcode(ERRCODE_DATA_CORRUPTED),
			 errmsg("mesh lacks an edge of line " INT64_FORMAT, edges->line),
			 errdetail("It is on the segment from (%g, %g) to (%g, %g).", a[0], a[1], b[0], b[1])));
}

/* Adds the edges of all lines. */
static void
add_lines(EdgeRows *edges, const char *table)
{
	Portal		portal = SPI_cursor_open_with_args(
		NULL, psprintf("SELECT line, x, y, kind = 'hard', coalesce(part, 0) FROM %s ORDER BY line, position", table),
		0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);
	bool		any = false;
	double		last[2];
	int64		last_part = 0;

	for (;;)
	{
		SPI_cursor_fetch(portal, true, 1024);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
		{
			HeapTuple	tuple = SPI_tuptable->vals[i];
			TupleDesc	desc = SPI_tuptable->tupdesc;
			bool		isnull;
			int64		line = DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
			int64		part = DatumGetInt64(SPI_getbinval(tuple, desc, 5, &isnull));
			double		at[2];

			for (int axis = 0; axis < 2; axis++)
				at[axis] = DatumGetFloat8(SPI_getbinval(tuple, desc, 2 + axis, &isnull));
			edges->is_hard = DatumGetBool(SPI_getbinval(tuple, desc, 4, &isnull));
			if (any && line == edges->line && part == last_part)
				add_segment(edges, last, at);
			any = true;
			edges->line = line;
			last_part = part;
			memcpy(last, at, sizeof(at));
		}
		SPI_freetuptable(SPI_tuptable);
	}
	SPI_cursor_close(portal);
}

/* The box that contains the window. */
static void
bound(EdgeRows *edges, const abacus_window *window)
{
	for (int axis = 0; axis < 2; axis++)
	{
		bool		is_ball = window->kind == ABACUS_BALL_WINDOW;
		bool		is_whole = window->kind == ABACUS_NO_WINDOW;

		edges->lower[axis] = is_whole ? -INFINITY
			: is_ball ? window->center[axis] - window->radius : window->lower[axis];
		edges->upper[axis] = is_whole ? INFINITY
			: is_ball ? window->center[axis] + window->radius : window->upper[axis];
	}
}

/* The edges of the window, whether they are fixed or not. */
static NamedRows *
read_window(Reader *reader, const abacus_window *window, const abacus_extent *extent)
{
	static const NamedColumn columns[] = {
		{"v0", INT8OID}, {"v1", INT8OID}, {"x0", FLOAT8OID}, {"y0", FLOAT8OID}, {"x1", FLOAT8OID},
		{"y1", FLOAT8OID}
	};
	NamedRows  *rows = named_rows_create(EDGES_IN_WINDOW, columns, lengthof(columns));
	Host	   *host = reader->host;
	abacus_faces *faces = NULL;
	abacus_edge edge;
	double		ends[4];

	host_run(host, abacus_faces_open, &host->table, &reader->header.facts, window, true, extent,
			 setting_cache_bytes(), &faces);
	host_own(host, faces, (void (*) (void *)) abacus_faces_close);
	while (host_run(host, abacus_faces_next_edge, faces, &edge, ends) != ABACUS_END)
	{
		Datum		values[6] = {Int64GetDatum(edge.id[0]), Int64GetDatum(edge.id[1])};
		bool		isnull[6] = {false};

		for (int i = 0; i < 4; i++)
			values[2 + i] = Float8GetDatum(ends[i]);
		named_rows_put(rows, values, isnull);
	}
	host_release(host);
	named_rows_register(rows);
	return rows;
}

/*
 * Looks for a fault of the lines of a sound mesh, which has so many fixed edges, and so many soft ones among them:
 * values that no line has, a line without one of its edges, fixed edges that belong to no line or to
 * lines of another kind, lines that are not counted. Returns what is wrong, or NULL.
 */
char *
fixed_edges_fault(Oid mesh, uint64 fixed, uint64 soft)
{
	EdgeRows	edges = {.checks = true};
	const abacus_census *census;
	Relation	heap = table_open(mesh, NoLock);
	char	   *table = lines_table_name(lines_table_require(heap, MESH_READ));
	char	   *fault = NULL;
	MemoryContext memory = CurrentMemoryContext;
	abacus_window whole = {.kind = ABACUS_NO_WINDOW};
	Datum		counts[3];
	bool		isnull[3];
	int			level;

	table_close(heap, NoLock);
	SPI_connect();
	edges.cached = mesh_cache_get(mesh);
	census = &edges.cached->header.facts.census;
	edges.rows = named_rows_create(EDGES_ON_LINES, edge_columns, lengthof(edge_columns));
	bound(&edges, &whole);
	level = plain_names_begin(false);
	query_first(psprintf("SELECT min(line) FROM %s WHERE x - x <> 0 OR y - y <> 0 OR "
						 "kind NOT IN ('hard', 'soft')", table), counts, isnull, 1);
	if (!isnull[0])
	{
		plain_names_end(level);
		fault = MemoryContextStrdup(memory, psprintf("Line " INT64_FORMAT " has a coordinate that is not "
													 "finite, or a kind that is not known.",
													 DatumGetInt64(counts[0])));
		named_rows_free(edges.rows);
		SPI_finish();
		return fault;
	}
	add_lines(&edges, table);
	named_rows_register(edges.rows);
	query_first(psprintf("SELECT count(*), count(*) FILTER (WHERE NOT is_hard), (SELECT count(DISTINCT line) FROM %s) "
						 "FROM (SELECT bool_or(is_hard) AS is_hard FROM " EDGES_ON_LINES
						 " GROUP BY v0, v1, x0, y0, x1, y1) AS e", table),
				counts, isnull, 3);
	plain_names_end(level);
	named_rows_free(edges.rows);
	if (edges.is_broken)
		fault = MemoryContextStrdup(memory, psprintf("Line " INT64_FORMAT " lacks a fixed edge.",
													 edges.broken));
	else if ((uint64) DatumGetInt64(counts[0]) != fixed)
		fault = MemoryContextStrdup(memory, "Edges are fixed that belong to no line.");
	else if (edges.has_wrong_kind || (uint64) DatumGetInt64(counts[1]) != soft)
		fault = MemoryContextStrdup(memory, "Edges are hard or soft, and their lines are not.");
	else if ((uint64) DatumGetInt64(counts[2]) != census->lines)
		fault = MemoryContextStrdup(memory, "The header counts more or fewer lines than there are.");
	SPI_finish();
	return fault;
}

/*
 * Puts the fixed edges of a mesh, or of a window, into the result of a function: v0, v1, length,
 * lines, kind, and, if wanted, the coordinates of both ends in an array.
 */
void
fixed_edges_put(Reader *reader, const abacus_window *window, const abacus_extent *extent, bool with_ends,
				ReturnSetInfo *set)
{
	const MeshPages *pages = mesh_pages(reader->host);
	bool		is_part = window->kind != ABACUS_NO_WINDOW || extent->max_edge > 0 || extent->region > 0 || extent->area != NULL;
	EdgeRows	edges = {0};
	NamedRows  *part = NULL;
	Oid			table;
	int			level;

	if (reader->header.facts.census.lines == 0 || reader->header.facts.census.vertices == 0)
		return;
	table = lines_table_require(pages->simplices.heap, MESH_READ);
	SPI_connect();
	edges.cached = mesh_cache_get(pages->mesh);
	edges.rows = named_rows_create(EDGES_ON_LINES, edge_columns, lengthof(edge_columns));
	bound(&edges, window);
	level = plain_names_begin(false);
	if (is_part && fixed_window_read(reader, edges.cached, window, extent, table, put_window_edge, &edges))
		is_part = false;
	else
		add_lines(&edges, lines_table_name(table));
	named_rows_register(edges.rows);
	if (is_part)
		part = read_window(reader, window, extent);
	query_into(set->setResult,
			   psprintf("SELECT e.v0, e.v1, min(e.length), array_agg(DISTINCT e.line ORDER BY e.line), "
						"CASE WHEN bool_or(e.is_hard) THEN 'hard' ELSE 'soft' END%s FROM " EDGES_ON_LINES
						" AS e%s GROUP BY e.v0, e.v1, e.x0, e.y0, e.x1, e.y1 ORDER BY e.v0, e.v1",
						with_ends ? ", ARRAY[e.x0, e.y0, e.x1, e.y1]" : "", is_part ? " JOIN " EDGES_IN_WINDOW " AS w USING (v0, v1, x0, y0, x1, y1)" : ""));
	plain_names_end(level);
	named_rows_free(edges.rows);
	if (part != NULL)
		named_rows_free(part);
	SPI_finish();
}

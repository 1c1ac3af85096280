/*
 * fn_lines.c: abacus_lines, the lines of a mesh as they were given, and abacus_fixed_edges, the
 * edges on them.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/constrain.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/mesh_pages.h"
#include "pg/mesh/reader.h"
#include "pg/port/port.h"
#include "pg/sql/constrain/named_rows.h"

SQL_FUNCTION(abacus_sql_lines);
SQL_FUNCTION(abacus_sql_fixed_edges);

/* The table of the lines of a mesh, as a name in SQL; NULL if it has no lines. */
static char *
table_of(Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);
	char	   *name = NULL;

	if (reader->header.facts.census.lines > 0)
		name = lines_table_name(lines_table_require(mesh_pages(reader->host)->simplices.heap, MESH_READ));
	host_release(reader->host);
	host_destroy(reader->host);
	return name;
}

/* abacus_lines(mesh regclass) -> line, position, point, x, y, kind */
Datum
abacus_sql_lines(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	char	   *table;
	int			level;

	InitMaterializedSRF(fcinfo, 0);
	table = table_of(PG_GETARG_OID(0));
	if (table == NULL)
		PG_RETURN_NULL();
	SPI_connect();
	level = plain_names_begin();
	query_into(set->setResult, psprintf("SELECT line, position, point, x, y, kind FROM %s "
										"ORDER BY line, position", table));
	plain_names_end(level);
	SPI_finish();
	PG_RETURN_NULL();
}

/* ---- Edges ------------------------------------------------------------------------- */

#define EDGES_ON_LINES "abacus_edges_on_lines"

enum
{
	EDGE_V0,
	EDGE_V1,
	EDGE_LENGTH,
	EDGE_LINE,
	EDGE_IS_HARD,
	EDGE_COLUMNS
};

/* The edges of one segment after the other. */
typedef struct EdgeRows
{
	CachedMesh *cached;
	NamedRows  *rows;
	int64		line;
	bool		is_hard;
} EdgeRows;

/* Called by the core. */
static abacus_host_status
put_edge(void *context, const int64_t ids[2], const double ends[2][2], int is_fixed)
{
	EdgeRows   *edges = context;
	bool		in_order = ids[0] <= ids[1];
	Datum		values[EDGE_COLUMNS];
	bool		isnull[EDGE_COLUMNS] = {false};

	if (!is_fixed)
		return ABACUS_HOST_OK;
	values[EDGE_V0] = Int64GetDatum(ids[in_order ? 0 : 1]);
	values[EDGE_V1] = Int64GetDatum(ids[in_order ? 1 : 0]);
	values[EDGE_LENGTH] = Float8GetDatum(hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]));
	values[EDGE_LINE] = Int64GetDatum(edges->line);
	values[EDGE_IS_HARD] = BoolGetDatum(edges->is_hard);
	GUARD_BEGIN();
	named_rows_put(edges->rows, values, isnull);
	GUARD_END(edges->cached->host);
	return ABACUS_HOST_OK;
}

/* Adds the edges of a segment of a line. */
static void
add_segment(EdgeRows *edges, const double *a, const double *b)
{
	CachedMesh *cached = edges->cached;
	int			is_whole;

	host_run(cached->host, abacus_edges_along, cached->mesh, a, b, put_edge, edges, &is_whole);
	host_release(cached->host);
	if (is_whole || cached->header.facts.census.lines_wait > 0)
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
		NULL, psprintf("SELECT line, x, y, kind = 'hard' FROM %s ORDER BY line, position", table),
		0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);
	bool		any = false;
	double		last[2];

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
			double		at[2];

			for (int axis = 0; axis < 2; axis++)
				at[axis] = DatumGetFloat8(SPI_getbinval(tuple, desc, 2 + axis, &isnull));
			edges->is_hard = DatumGetBool(SPI_getbinval(tuple, desc, 4, &isnull));
			if (any && line == edges->line)
				add_segment(edges, last, at);
			any = true;
			edges->line = line;
			memcpy(last, at, sizeof(at));
		}
		SPI_freetuptable(SPI_tuptable);
	}
	SPI_cursor_close(portal);
}

/* abacus_fixed_edges(mesh regclass) -> v0, v1, length, lines, kind */
Datum
abacus_sql_fixed_edges(PG_FUNCTION_ARGS)
{
	static const NamedColumn columns[] = {
		{"v0", INT8OID}, {"v1", INT8OID}, {"length", FLOAT8OID}, {"line", INT8OID}, {"is_hard", BOOLOID}
	};
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	EdgeRows	edges = {0};
	char	   *table;
	int			level;

	InitMaterializedSRF(fcinfo, 0);
	table = table_of(PG_GETARG_OID(0));
	if (table == NULL)
		PG_RETURN_NULL();
	SPI_connect();
	edges.cached = mesh_cache_get(PG_GETARG_OID(0));
	edges.rows = named_rows_create(EDGES_ON_LINES, columns, lengthof(columns));
	level = plain_names_begin();
	if (edges.cached->header.facts.census.vertices > 0)
		add_lines(&edges, table);
	named_rows_register(edges.rows);
	query_into(set->setResult,
			   "SELECT v0, v1, min(length), array_agg(DISTINCT line ORDER BY line), "
			   "CASE WHEN bool_or(is_hard) THEN 'hard' ELSE 'soft' END FROM " EDGES_ON_LINES
			   " GROUP BY v0, v1 ORDER BY v0, v1");
	plain_names_end(level);
	SPI_finish();
	PG_RETURN_NULL();
}

/*
 * fn_crossings.c: abacus_crossings, where segments of lines cross elsewhere than in a vertex: of the
 * lines of a query, and of those of the mesh that have other ids.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/input/source.h"
#include "pg/lines/line_points.h"
#include "pg/lines/line_values.h"
#include "pg/lines/new_lines.h"
#include "pg/mesh/line_crossings.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_cache.h"

SQL_FUNCTION(abacus_sql_crossings);

/* Columns of the result */
enum
{
	CROSSING_LINE_A,
	CROSSING_POSITION_A,
	CROSSING_LINE_B,
	CROSSING_POSITION_B,
	CROSSING_X,
	CROSSING_Y,
	CROSSING_COLUMNS
};

#define ROWS_A_BATCH 1024

/* So many columns name points of the mesh: line, position, point. */
#define POINT_COLUMNS 3

/* So many give corners: line, position, x, y; each is of the only part of its line. */
#define PLACE_COLUMNS 4

static const char *const corner_columns[PLACE_COLUMNS] = {"line", "position", "x", "y"};

/* The rows of a query, as corners of lines. */
typedef struct Corners
{
	TupleDesc	desc;
	int			at[PLACE_COLUMNS];	/* their columns, from 1 on */
	Oid			type[PLACE_COLUMNS];
	uint64		row;			/* rows seen */
} Corners;

/* Finds the columns, and checks their types. */
static void
corners_begin(Corners *corners, TupleDesc desc)
{
	corners->desc = desc;
	corners->row = 0;
	if (desc->natts < PLACE_COLUMNS)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("source query returns %d columns, but lines take at least %d", desc->natts,
						POINT_COLUMNS),
				 errdetail("Columns are matched by position: line, position, point, or line, position, "
						   "x, y, or line, position, point, x, y.")));
	for (int i = 0; i < PLACE_COLUMNS; i++)
	{
		bool		is_id = i < CORNER_X;
		int			column = i + 1 + (!is_id && desc->natts > PLACE_COLUMNS);
		Oid			type = TupleDescAttr(desc, column - 1)->atttypid;

		corners->at[i] = column;
		corners->type[i] = getBaseType(type);
		if (is_id ? line_value_is_integer(corners->type[i]) : line_value_is_number(corners->type[i]))
			continue;
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("column %d (%s) of the source query has type %s", column, corner_columns[i],
						format_type_be(type)),
				 is_id ? errdetail("Lines and positions must be smallint, integer or bigint.")
				 : errdetail("Coordinates must be double precision, real, numeric or integers."),
				 errhint("Cast the column in the query.")));
	}
}

/* The record of a row for line_crossings_add(). */
static void
pack_corner(Corners *corners, HeapTuple row, uint64 *record)
{
	corners->row++;
	for (int i = 0; i < PLACE_COLUMNS; i++)
	{
		bool		isnull;
		Datum		value = heap_getattr(row, corners->at[i], corners->desc, &isnull);
		double		number;

		if (isnull)
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("%s is NULL in row " UINT64_FORMAT " of the source query",
							corner_columns[i], corners->row),
					 errhint("Leave such rows out with a WHERE clause.")));
		if (i < CORNER_X)
		{
			record[i] = (uint64) line_value_integer(corners->type[i], value);
			continue;
		}
		number = line_value_number(corners->type[i], value);
		if (!isfinite(number))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("%s of line " INT64_FORMAT ", position " INT64_FORMAT " is not finite",
							corner_columns[i], (int64) record[CORNER_LINE],
							(int64) record[CORNER_POSITION]),
					 errhint("Leave such rows out with a WHERE clause.")));
		memcpy(&record[i], &number, sizeof(number));
	}
	record[CORNER_PART] = 0;
}

/* Notes the ids of lines, a few times each. */
static void
note_lines(NamedRows *ids, const uint64 *records, uint64 count)
{
	for (uint64 i = 0; i < count; i++)
	{
		Datum		id = Int64GetDatum((int64) records[i * CORNER_COLUMNS + CORNER_LINE]);
		bool		isnull = false;

		if (i == 0 || records[i * CORNER_COLUMNS + CORNER_LINE] != records[(i - 1) * CORNER_COLUMNS + CORNER_LINE])
			named_rows_put(ids, &id, &isnull);
	}
}

/* Gives the rows of a prepared query to the core; returns the ids of the lines. */
static NamedRows *
read_corners(Source *source, LineCrossings *crossings)
{
	static const NamedColumn columns[] = {{"line", INT8OID}};
	NamedRows  *ids = named_rows_create(LINE_IDS, columns, lengthof(columns));
	Portal		portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	uint64	   *records = palloc(ROWS_A_BATCH * CORNER_COLUMNS * sizeof(uint64));
	Corners		corners;

	corners_begin(&corners, portal->tupDesc);
	for (;;)
	{
		uint64		count;

		SPI_cursor_fetch(portal, true, ROWS_A_BATCH);
		count = SPI_processed;
		if (count == 0)
			break;
		for (uint64 i = 0; i < count; i++)
			pack_corner(&corners, SPI_tuptable->vals[i], records + i * CORNER_COLUMNS);
		SPI_freetuptable(SPI_tuptable);
		line_crossings_add(crossings, records, count);
		note_lines(ids, records, count);
	}
	SPI_freetuptable(SPI_tuptable);
	SPI_cursor_close(portal);
	pfree(records);
	named_rows_register(ids);
	return ids;
}

/* The same for rows that name points of the mesh by their ids. */
static NamedRows *
read_points(Source *source, LineCrossings *crossings, const char *vertices)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	NewLines	lines = {
		.vertices = vertices,
		.reading = {abacus_names_of(header), NULL, NULL},
		.census = &header->facts.census
	};
	NamedRows  *rows = line_rows_read(source, &lines.reading, &lines.shape);
	NamedRows  *points;
	int			level = plain_names_begin(false);

	named_rows_register(rows);
	line_points_check(&lines);
	points = line_points_resolve(&lines, line_points_scan(&lines));
	line_crossings_add_query(crossings, "SELECT line, position, x, y, coalesce(part, 0) FROM " LINE_POINTS, false);
	named_rows_free(points);
	plain_names_end(level);
	return rows;
}

/* Adds the lines of the mesh whose ids are not among those given. */
static void
add_present(LineCrossings *crossings, const char *table, const NamedRows *ids)
{
	int			level = plain_names_begin(false);

	line_crossings_add_query(crossings,
							 psprintf("SELECT l.line, l.position, l.x, l.y, coalesce(l.part, 0) FROM %s AS l WHERE NOT EXISTS "
									  "(SELECT FROM %s AS g WHERE g.line = l.line)", table, ids->name),
							 false);
	plain_names_end(level);
}

/* The mesh, for its vertices; only a mesh in the plane has lines. */
static CachedMesh *
get_mesh(Oid mesh)
{
	CachedMesh *cached = mesh_cache_get(mesh);

	header_require_dimension(&cached->header.facts.form, 2, "Lines cross in the plane.");
	return cached;
}

/* The table of its lines, as a name in SQL; NULL if it has none. */
static char *
get_lines(Oid mesh)
{
	CachedMesh *cached = get_mesh(mesh);
	uint64		lines = cached->header.facts.census.lines;
	Relation	heap;
	char	   *name;

	host_release(cached->host);
	if (lines == 0)
		return NULL;
	heap = table_open(mesh, NoLock);	/* locked since the mesh was got */
	name = lines_table_name(lines_table_require(heap, MESH_READ));
	table_close(heap, NoLock);
	return name;
}

static bool
is_vertex(void *context, const double *place)
{
	CachedMesh *cached = context;
	int64_t		id;

	return host_run(cached->host, abacus_mesh_vertex_at, cached->mesh, place, &id) == ABACUS_OK;
}

static void
put_crossing(ReturnSetInfo *set, const abacus_crossing *crossing)
{
	Datum		values[CROSSING_COLUMNS];
	bool		isnull[CROSSING_COLUMNS] = {false};

	values[CROSSING_LINE_A] = Int64GetDatum(crossing->line[0]);
	values[CROSSING_POSITION_A] = Int64GetDatum(crossing->position[0]);
	values[CROSSING_LINE_B] = Int64GetDatum(crossing->line[1]);
	values[CROSSING_POSITION_B] = Int64GetDatum(crossing->position[1]);
	values[CROSSING_X] = Float8GetDatum(crossing->place[0]);
	values[CROSSING_Y] = Float8GetDatum(crossing->place[1]);
	tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
}

/*
 * abacus_crossings(mesh regclass, query text)
 *     -> line_a, position_a, line_b, position_b, x, y
 */
Datum
abacus_sql_crossings(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	Oid			mesh = PG_GETARG_OID(0);
	CachedMesh *cached;
	Source		source;
	LineCrossings crossings;
	abacus_crossing crossing;
	NamedRows  *given;
	char	   *lines;

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	lines = get_lines(mesh);
	line_crossings_open(&crossings, setting_query_sort_bytes());
	given = source_columns(&source) == POINT_COLUMNS
		? read_points(&source, &crossings, new_lines_vertices(fcinfo->flinfo->fn_oid, mesh))
		: read_corners(&source, &crossings);
	if (lines != NULL)
		add_present(&crossings, lines, given);
	cached = get_mesh(mesh);	/* anew, since the query may have read meshes */
	while (line_crossings_next(&crossings, is_vertex, cached, &crossing))
		put_crossing(set, &crossing);
	host_release(cached->host);
	line_crossings_close(&crossings);
	named_rows_free(given);
	source_finish(&source);
	PG_RETURN_NULL();
}

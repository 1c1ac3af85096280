/*
 * fn_faces.c: the vertices and edges of a window: abacus_vertices with a window, or with the range
 * of an attribute, and abacus_edges.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/windows.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/constrain/fixed_edges.h"
#include "pg/sql/rows/faces.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"
#include "pg/sql/rows/vertex_row.h"

SQL_FUNCTION(abacus_sql_vertices_in_ball);
SQL_FUNCTION(abacus_sql_edges);
SQL_FUNCTION(abacus_sql_edges_in_ball);
SQL_FUNCTION(abacus_sql_edge_lines);

/* Columns of abacus_edges */
enum
{
	EDGE_V0,
	EDGE_V1,
	EDGE_LENGTH,
	EDGE_PATH,					/* if the places of the ends are wanted */
	EDGE_LINES = EDGE_PATH,		/* otherwise, NULL as no fixed edges are wanted */
	EDGE_KIND,
	EDGE_COLUMNS
};

typedef enum Wanted
{
	VERTICES,					/* mesh, a window, and for a box an attribute and its range */
	EDGES,						/* mesh, a window, max_edge, and within at the end */
	EDGE_PATHS					/* the same, with the coordinates of their ends */
} Wanted;

static bool
are_edges(Wanted wanted)
{
	return wanted == EDGES || wanted == EDGE_PATHS;
}

static void
begin(FunctionCallInfo fcinfo, FuncCallContext *set, WindowForm form, Wanted wanted)
{
	Reader	   *reader = set_begin(fcinfo, set, result_row_type);
	Host	   *host = reader->host;
	abacus_window window = {0};
	abacus_range range;
	abacus_faces *faces = NULL;
	abacus_extent extent = {0};
	bool		has_range = wanted == VERTICES && form == WINDOW_BOX &&
		window_attribute(fcinfo, 3, abacus_names_of(&reader->header), &range);

	window_arguments(fcinfo, 1, form, &reader->header.facts.form, &window);
	if (are_edges(wanted))
		extent_arguments(fcinfo, 3, PG_NARGS() - 1, PG_GETARG_OID(0), &reader->header, reader->host, &extent);
	if (has_range)
		host_run(host, abacus_faces_open_range, &host->table, &reader->header.facts, &window, &range,
				 setting_cache_bytes(), &faces);
	else
		host_run(host, abacus_faces_open, &host->table, &reader->header.facts, &window, are_edges(wanted),
				 &extent, setting_cache_bytes(), &faces);
	host_own(host, faces, (void (*) (void *)) abacus_faces_close);
}

static Datum
edge_row(TupleDesc row_type, Wanted wanted, const abacus_edge *edge, const double *ends,
		 uint32 dimension)
{
	Datum		values[EDGE_COLUMNS] = {0};
	bool		isnull[EDGE_COLUMNS] = {false};

	values[EDGE_V0] = Int64GetDatum(edge->id[0]);
	values[EDGE_V1] = Int64GetDatum(edge->id[1]);
	values[EDGE_LENGTH] = Float8GetDatum(edge->length);
	isnull[EDGE_LINES] = wanted == EDGES;
	isnull[EDGE_KIND] = wanted == EDGES;
	if (wanted == EDGE_PATHS)
		values[EDGE_PATH] = attribute_array(ends, (int) (2 * dimension));
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/* The next row; false after the last. */
static bool
next_row(FuncCallContext *set, Wanted wanted, Datum *row)
{
	Reader	   *reader = set->user_fctx;
	Host	   *host = reader->host;
	abacus_vertex vertex;
	abacus_edge edge;
	double		ends[2 * ABACUS_MAX_DIMENSION];
	abacus_status status = are_edges(wanted)
		? host_run(host, abacus_faces_next_edge, host->handle, &edge, wanted == EDGES ? NULL : ends)
		: host_run(host, abacus_faces_next_vertex, host->handle, &vertex);

	host_release(host);
	if (status == ABACUS_END)
		return false;
	*row = are_edges(wanted)
		? edge_row(set->tuple_desc, wanted, &edge, ends, reader->header.facts.form.dimension)
		: vertex_row(set->tuple_desc, &vertex, &reader->header.facts);
	return true;
}

static Datum
next(FunctionCallInfo fcinfo, WindowForm form, Wanted wanted)
{
	FuncCallContext *set;
	Datum		row;

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(0))
			SRF_RETURN_DONE(set);
		begin(fcinfo, set, form, wanted);
	}
	set = SRF_PERCALL_SETUP();
	if (!next_row(set, wanted, &row))
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, row);
}

/* abacus_vertices with a window, or the range of an attribute; no rows if the mesh is NULL. */
Datum
faces_vertices(FunctionCallInfo fcinfo)
{
	return next(fcinfo, WINDOW_BOX, VERTICES);
}

/*
 * abacus_vertices(mesh regclass, center float8[], radius float8)
 *     -> sequence, id, x, y, z, attributes, vertex
 */
Datum
abacus_sql_vertices_in_ball(PG_FUNCTION_ARGS)
{
	if (SRF_IS_FIRSTCALL() && is_over_shards(fcinfo))
		return shard_read_rows(fcinfo, ROWS_WITHOUT_GUESTS);
	return next(fcinfo, WINDOW_BALL, VERTICES);
}

/* Whether abacus_edges is called for fixed edges only. */
static bool
wants_fixed(FunctionCallInfo fcinfo)
{
	return PG_NARGS() > 4 && !PG_ARGISNULL(4) && PG_GETARG_BOOL(4);
}

/* abacus_edges for fixed edges. */
static Datum
fixed_edges(FunctionCallInfo fcinfo, WindowForm form)
{
	abacus_extent extent;
	abacus_window window = {0};
	Reader	   *reader;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(0))
		PG_RETURN_NULL();
	reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	extent_arguments(fcinfo, 3, PG_NARGS() - 1, PG_GETARG_OID(0), &reader->header, reader->host, &extent);
	window_arguments(fcinfo, 1, form, &reader->header.facts.form, &window);
	fixed_edges_put(reader, &window, &extent, false, (ReturnSetInfo *) fcinfo->resultinfo);
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}

/*
 * abacus_edges(mesh regclass, lower float8[], upper float8[], max_edge float8, fixed boolean,
 * within text)
 *     -> v0, v1, length, lines, kind
 */
Datum
abacus_sql_edges(PG_FUNCTION_ARGS)
{
	if (wants_fixed(fcinfo))
		return fixed_edges(fcinfo, WINDOW_BOX);
	return next(fcinfo, WINDOW_BOX, EDGES);
}

/*
 * abacus_edges(mesh regclass, center float8[], radius float8, max_edge float8, fixed boolean,
 * within text)
 *     -> the same
 */
Datum
abacus_sql_edges_in_ball(PG_FUNCTION_ARGS)
{
	if (wants_fixed(fcinfo))
		return fixed_edges(fcinfo, WINDOW_BALL);
	return next(fcinfo, WINDOW_BALL, EDGES);
}

/*
 * _abacus_edges(mesh regclass, lower float8[], upper float8[], max_edge float8, within text)
 *     -> v0, v1, length, path
 */
Datum
abacus_sql_edge_lines(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, EDGE_PATHS);
}

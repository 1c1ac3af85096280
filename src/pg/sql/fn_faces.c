/*
 * fn_faces.c: the vertices and edges of a window: abacus_vertices with one, or
 * with the range of an attribute, and abacus_edges.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/ask.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/sql/result.h"
#include "pg/sql/set.h"
#include "pg/sql/vertex_row.h"
#include "pg/sql/window.h"

SQL_FUNCTION(abacus_sql_vertices_in_box);
SQL_FUNCTION(abacus_sql_vertices_in_ball);
SQL_FUNCTION(abacus_sql_vertices_in_range);
SQL_FUNCTION(abacus_sql_edges);
SQL_FUNCTION(abacus_sql_edges_in_ball);
SQL_FUNCTION(abacus_sql_edge_lines);

/* Columns of abacus_edges */
enum
{
	EDGE_V0,
	EDGE_V1,
	EDGE_LENGTH,
	EDGE_PATH,					/* where lines are wanted */
	EDGE_COLUMNS
};

typedef enum Wanted
{
	VERTICES,					/* mesh, and a window */
	VERTICES_IN_RANGE,			/* mesh, attribute, least, greatest, and a window */
	EDGES,						/* mesh, a window, and max_edge */
	EDGE_LINES					/* the same, with the coordinates of their ends */
} Wanted;

static bool
are_edges(Wanted wanted)
{
	return wanted == EDGES || wanted == EDGE_LINES;
}

/* The range of an attribute: arguments 1 to 3. */
static void
range_arguments(FunctionCallInfo fcinfo, const abacus_header *header, abacus_range *range)
{
	range->attribute = (uint32_t) header_find_attribute(header,
														text_to_cstring(PG_GETARG_TEXT_PP(1)));
	range->least = PG_GETARG_FLOAT8(2);
	range->greatest = PG_GETARG_FLOAT8(3);
	if (!(range->least <= range->greatest))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("least must not be greater than greatest, and both numbers"),
				 errhint("Give '-Infinity' or 'Infinity' for a range without an end.")));
}

static void
begin(FunctionCallInfo fcinfo, FuncCallContext *set, WindowForm form, Wanted wanted)
{
	Reader	   *reader = set_begin(fcinfo, set, result_row_type);
	Host	   *host = reader->host;
	abacus_window window = {0};
	abacus_range range;
	abacus_faces *faces = NULL;
	double		max_edge = are_edges(wanted) ? window_max_edge(fcinfo, 3) : 0;

	if (wanted == VERTICES_IN_RANGE)
		range_arguments(fcinfo, &reader->header, &range);
	window_arguments(fcinfo, wanted == VERTICES_IN_RANGE ? 4 : 1, form, &reader->header, &window);
	if (wanted == VERTICES_IN_RANGE)
		host_run(host, abacus_faces_open_range, &host->table, &reader->header, &window, &range,
				 setting_cache_bytes(), &faces);
	else
		host_run(host, abacus_faces_open, &host->table, &reader->header, &window, are_edges(wanted),
				 max_edge, setting_cache_bytes(), &faces);
	host_own(host, faces, (void (*) (void *)) abacus_faces_close);
}

static Datum
edge_row(TupleDesc row_type, const abacus_edge *edge, const double *ends, uint32 dimension)
{
	Datum		values[EDGE_COLUMNS];
	bool		isnull[EDGE_COLUMNS] = {false};

	values[EDGE_V0] = Int64GetDatum(edge->id[0]);
	values[EDGE_V1] = Int64GetDatum(edge->id[1]);
	values[EDGE_LENGTH] = Float8GetDatum(edge->length);
	if (row_type->natts > EDGE_PATH)
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
		? edge_row(set->tuple_desc, &edge, ends, reader->header.dimension)
		: vertex_row(set->tuple_desc, &vertex, &reader->header);
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

/*
 * abacus_vertices(mesh regclass, lower float8[], upper float8[])
 *     -> sequence, id, x, y, z, attributes, vertex
 */
Datum
abacus_sql_vertices_in_box(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, VERTICES);
}

/* abacus_vertices(mesh regclass, center float8[], radius float8) -> the same */
Datum
abacus_sql_vertices_in_ball(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BALL, VERTICES);
}

/*
 * abacus_vertices(mesh regclass, attribute text, least float8, greatest float8,
 * lower float8[], upper float8[])
 *     -> the same
 */
Datum
abacus_sql_vertices_in_range(PG_FUNCTION_ARGS)
{
	if (SRF_IS_FIRSTCALL() && (PG_ARGISNULL(1) || PG_ARGISNULL(2) || PG_ARGISNULL(3)))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("attribute, least and greatest must not be NULL"),
				 errhint("Give '-Infinity' or 'Infinity' for a range without an end.")));
	return next(fcinfo, WINDOW_BOX, VERTICES_IN_RANGE);
}

/*
 * abacus_edges(mesh regclass, lower float8[], upper float8[], max_edge float8)
 *     -> v0, v1, length
 */
Datum
abacus_sql_edges(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, EDGES);
}

/* abacus_edges(mesh regclass, center float8[], radius float8, max_edge float8) -> the same */
Datum
abacus_sql_edges_in_ball(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BALL, EDGES);
}

/*
 * _abacus_edges(mesh regclass, lower float8[], upper float8[], max_edge float8)
 *     -> v0, v1, length, path
 */
Datum
abacus_sql_edge_lines(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, EDGE_LINES);
}

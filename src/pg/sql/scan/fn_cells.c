/*
 * fn_cells.c: the simplices of a window: abacus_simplices with a window, and abacus_cells, which
 * also returns their corners, attributes and labels.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/windows.h"
#include "pg/base/sql_function.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_simplices_in_box);
SQL_FUNCTION(abacus_sql_simplices_in_ball);
SQL_FUNCTION(abacus_sql_simplices_within);
SQL_FUNCTION(abacus_sql_cells);
SQL_FUNCTION(abacus_sql_cells_in_ball);

/* Columns of abacus_cells: those of abacus_simplex, the data of its corners, and its labels */
enum
{
	CELL_CORNERS = SIMPLEX_COLUMNS,
	CELL_VALUES,
	CELL_LABELS,
	CELL_COLUMNS
};

/* What is returned, and by which arguments it is chosen. */
typedef enum Wanted
{
	SIMPLICES,					/* mesh, a window, within */
	SIMPLICES_OF_REGION,		/* mesh, within */
	CELLS						/* mesh, a window, max_edge, a label and its range, within */
} Wanted;

static void
begin(FunctionCallInfo fcinfo, FuncCallContext *set, WindowForm form, Wanted wanted)
{
	bool		is_cells = wanted == CELLS;
	Reader	   *reader = set_begin(fcinfo, set, is_cells ? result_row_type : simplex_row_type);
	Host	   *host = reader->host;
	abacus_window window = {0};
	abacus_cells *cells = NULL;
	abacus_range label;
	abacus_extent extent = {0};
	bool		has_label = is_cells && window_label(fcinfo, 4, abacus_names_of(&reader->header), &label);

	if (wanted != SIMPLICES_OF_REGION)
		window_arguments(fcinfo, 1, form, &reader->header.facts.form, &window);
	if (is_cells)
		extent.max_edge = extent_max_edge(fcinfo, 3);
	extent_within(fcinfo, PG_NARGS() - 1, PG_GETARG_OID(0), &reader->header.facts, 0, host, &extent);
	host_run(host, abacus_cells_open, &host->table, &reader->header.facts, &window, &extent,
			 has_label ? &label : NULL, &cells);
	host_own(host, cells, (void (*) (void *)) abacus_cells_close);
}

static Datum
cell_row(TupleDesc row_type, const abacus_simplex *simplex, const double *attributes,
		 const double *labels, const abacus_facts *facts)
{
	int			dimension = (int) facts->form.dimension;
	double		corners[(ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_DIMENSION];
	Datum		values[CELL_COLUMNS];
	bool		isnull[CELL_COLUMNS] = {false};

	for (int i = 0; i <= dimension; i++)
		memcpy(corners + i * dimension, simplex->corner[i], dimension * sizeof(double));
	simplex_columns(simplex, facts->form.dimension, values, isnull);
	values[CELL_CORNERS] = float_matrix(corners, dimension + 1, dimension);
	values[CELL_VALUES] = float_matrix(attributes, dimension + 1, (int) facts->columns.attributes);
	isnull[CELL_LABELS] = facts->columns.labels == 0;
	values[CELL_LABELS] = facts->columns.labels == 0 ? (Datum) 0
		: attribute_array(labels, (int) facts->columns.labels);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

static Datum
next(FunctionCallInfo fcinfo, WindowForm form, Wanted wanted)
{
	bool		is_cells = wanted == CELLS;
	FuncCallContext *set;
	Reader	   *reader;
	Host	   *host;
	abacus_simplex simplex;
	double		values[(ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_ATTRIBUTES];
	const double *labels = NULL;
	abacus_status status;

	if (SRF_IS_FIRSTCALL() && is_over_shards(fcinfo))
		return shard_read_rows(fcinfo, ROWS_BY_CODE);
	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(0) || (wanted == SIMPLICES && (PG_ARGISNULL(1) || PG_ARGISNULL(2))))
			SRF_RETURN_DONE(set);
		begin(fcinfo, set, form, wanted);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	host = reader->host;
	status = host_run(host, abacus_cells_next, host->handle, &simplex, is_cells ? values : NULL);
	if (is_cells && status != ABACUS_END && reader->header.facts.columns.labels > 0)
		host_run(host, abacus_cells_labels, host->handle, &simplex, &labels);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, is_cells ? cell_row(set->tuple_desc, &simplex, values, labels, &reader->header.facts)
					: simplex_row(set->tuple_desc, &simplex, reader->header.facts.form.dimension));
}

/* abacus_simplices(mesh regclass, lower float8[], upper float8[], within text) -> SETOF abacus_simplex */
Datum
abacus_sql_simplices_in_box(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, SIMPLICES);
}

/* abacus_simplices(mesh regclass, center float8[], radius float8, within text) -> SETOF abacus_simplex */
Datum
abacus_sql_simplices_in_ball(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BALL, SIMPLICES);
}

/* abacus_simplices(mesh regclass, within text) -> SETOF abacus_simplex */
Datum
abacus_sql_simplices_within(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, SIMPLICES_OF_REGION);
}

/*
 * abacus_cells(mesh regclass, lower float8[], upper float8[], max_edge float8, label text,
 * range float8[], within text)
 *     -> code, v0, v1, v2, v3, corners, values, labels
 */
Datum
abacus_sql_cells(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BOX, CELLS);
}

/*
 * abacus_cells(mesh regclass, center float8[], radius float8, max_edge float8, label text,
 * range float8[], within text)
 *     -> the same
 */
Datum
abacus_sql_cells_in_ball(PG_FUNCTION_ARGS)
{
	return next(fcinfo, WINDOW_BALL, CELLS);
}

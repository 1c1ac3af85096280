/*
 * fn_voronoi.c: abacus_voronoi, the cell of each vertex, and abacus_voronoi_facets, the facets
 * between the cells.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/shapes.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_voronoi);
SQL_FUNCTION(abacus_sql_voronoi_facets);

/* Columns of abacus_voronoi */
enum
{
	CELL_VERTEX,
	CELL_BOUNDED,
	CELL_AREA,
	CELL_VOLUME,
	CELL_RING,
	CELL_COLUMNS
};

/* Columns of abacus_voronoi_facets */
enum
{
	FACET_VERTEX,
	FACET_NEIGHBOUR,
	FACET_BOUNDED,
	FACET_SIZE,
	FACET_RING,
	FACET_COLUMNS
};

static Datum
ring_matrix(const double *ring, size_t corners, const abacus_form *form)
{
	return float_matrix(ring, (int) corners, (int) form->dimension);
}

static Datum
cell_row(TupleDesc row_type, const abacus_voronoi_cell *cell, const abacus_form *form)
{
	Datum		values[CELL_COLUMNS] = {0};
	bool		isnull[CELL_COLUMNS] = {false};

	values[CELL_VERTEX] = Int64GetDatum(cell->vertex);
	values[CELL_BOUNDED] = BoolGetDatum(cell->bounded != 0);
	values[CELL_AREA] = Float8GetDatum(cell->area);
	values[CELL_VOLUME] = Float8GetDatum(cell->volume);
	isnull[CELL_VOLUME] = form->dimension == 2;
	isnull[CELL_RING] = cell->corners == 0;
	if (cell->corners > 0)
		values[CELL_RING] = ring_matrix(cell->ring, cell->corners, form);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

static Datum
facet_row(TupleDesc row_type, const abacus_voronoi_facet *facet, const abacus_form *form)
{
	Datum		values[FACET_COLUMNS] = {0};
	bool		isnull[FACET_COLUMNS] = {false};

	values[FACET_VERTEX] = Int64GetDatum(facet->vertex);
	values[FACET_NEIGHBOUR] = Int64GetDatum(facet->neighbour);
	isnull[FACET_NEIGHBOUR] = !facet->has_neighbour;
	values[FACET_BOUNDED] = BoolGetDatum(facet->bounded != 0);
	values[FACET_SIZE] = Float8GetDatum(facet->size);
	isnull[FACET_RING] = facet->corners == 0;
	if (facet->corners > 0)
		values[FACET_RING] = ring_matrix(facet->ring, facet->corners, form);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

static void
begin(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Reader	   *reader = set_begin(fcinfo, set, result_row_type);
	Host	   *host = reader->host;
	abacus_window window = {0};
	abacus_voronoi *voronoi = NULL;

	window_arguments(fcinfo, 1, WINDOW_BOX, &reader->header.facts.form, &window);
	host_run(host, abacus_voronoi_open, &host->table, &reader->header.facts, &window,
			 setting_cache_bytes(), &voronoi);
	host_own(host, voronoi, (void (*) (void *)) abacus_voronoi_close);
}

/* The next row; false after the last. */
static bool
next_row(FuncCallContext *set, bool is_facets, Datum *row)
{
	Reader	   *reader = set->user_fctx;
	Host	   *host = reader->host;
	abacus_voronoi_cell cell;
	abacus_voronoi_facet facet;
	abacus_status status = is_facets ? host_run(host, abacus_voronoi_next_facet, host->handle, &facet)
		: host_run(host, abacus_voronoi_next, host->handle, &cell);

	host_release(host);
	if (status == ABACUS_END)
		return false;
	*row = is_facets ? facet_row(set->tuple_desc, &facet, &reader->header.facts.form)
		: cell_row(set->tuple_desc, &cell, &reader->header.facts.form);
	return true;
}

static Datum
next(FunctionCallInfo fcinfo, bool is_facets)
{
	FuncCallContext *set;
	Datum		row;

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(0))
			SRF_RETURN_DONE(set);
		begin(fcinfo, set);
	}
	set = SRF_PERCALL_SETUP();
	if (!next_row(set, is_facets, &row))
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, row);
}

/*
 * abacus_voronoi(mesh regclass, lower float8[], upper float8[])
 *     -> vertex, bounded, area, volume, ring
 */
Datum
abacus_sql_voronoi(PG_FUNCTION_ARGS)
{
	return next(fcinfo, false);
}

/*
 * abacus_voronoi_facets(mesh regclass, lower float8[], upper float8[])
 *     -> vertex, neighbour, bounded, size, ring
 */
Datum
abacus_sql_voronoi_facets(PG_FUNCTION_ARGS)
{
	return next(fcinfo, true);
}

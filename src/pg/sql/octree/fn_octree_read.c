/*
 * fn_octree_read.c: reads leaves of octrees: at a place, or in a window.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/octree.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/octree/octant_row.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_octree_locate);
SQL_FUNCTION(abacus_sql_octants);
SQL_FUNCTION(abacus_sql_octants_in_ball);

/* The row type of a function that is called for many rows; looked up once. */
static TupleDesc
kept_row_type(FunctionCallInfo fcinfo)
{
	FmgrInfo   *function = fcinfo->flinfo;

	if (function->fn_extra == NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(function->fn_mcxt);

		function->fn_extra = octant_row_type(fcinfo);
		MemoryContextSwitchTo(old);
	}
	return function->fn_extra;
}

/* abacus_octree_locate(octree regclass, x float8, y float8[, z float8]) -> abacus_octant */
Datum
abacus_sql_octree_locate(PG_FUNCTION_ARGS)
{
	double		place[ABACUS_MAX_DIMENSION];
	CachedMesh *cached = mesh_cache_get_octree(PG_GETARG_OID(0));
	Host	   *host = cached->host;
	abacus_octant octant;
	abacus_status status;

	if (!place_arguments(fcinfo, PG_NARGS() - 1, &cached->header.facts.form, place))
		PG_RETURN_NULL();		/* outside every domain */
	status = host_run(host, abacus_octree_locate, cached->octree, place, &octant);
	host_release(host);
	if (status == ABACUS_END)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(octant_row(kept_row_type(fcinfo), &octant, &cached->header.facts));
}

static void
begin_octants(FunctionCallInfo fcinfo, FuncCallContext *set, WindowForm form)
{
	Reader	   *reader = set_begin_of(fcinfo, set, ABACUS_OCTREE, octant_row_type);
	Host	   *host = reader->host;
	abacus_window window = {0};
	abacus_octree_scan *scan = NULL;

	window_arguments(fcinfo, 1, form, &reader->header.facts.form, &window);
	host_run(host, abacus_octree_scan_open, &host->table, &reader->header.facts, &window,
			 setting_cache_bytes(), &scan);
	host_own(host, scan, (void (*) (void *)) abacus_octree_scan_close);
}

/* Returns leaves one by one. */
static Datum
octants(FunctionCallInfo fcinfo, WindowForm form)
{
	FuncCallContext *set;
	Reader	   *reader;
	abacus_octant octant;
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(0))
			SRF_RETURN_DONE(set);
		begin_octants(fcinfo, set, form);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	status = host_run(reader->host, abacus_octree_scan_next, reader->host->handle, &octant);
	host_release(reader->host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, octant_row(set->tuple_desc, &octant, &reader->header.facts));
}

/* abacus_octants(octree regclass, lower float8[], upper float8[]) -> SETOF abacus_octant */
Datum
abacus_sql_octants(PG_FUNCTION_ARGS)
{
	return octants(fcinfo, WINDOW_BOX);
}

/* abacus_octants(octree regclass, center float8[], radius float8) -> SETOF abacus_octant */
Datum
abacus_sql_octants_in_ball(PG_FUNCTION_ARGS)
{
	return octants(fcinfo, WINDOW_BALL);
}

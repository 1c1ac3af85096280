/*
 * fn_sets.c: abacus_simplices and abacus_vertices, the content of a mesh as
 * rows.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/scan.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/rows/faces.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"
#include "pg/sql/rows/simplex_row.h"
#include "pg/sql/rows/vertex_row.h"

SQL_FUNCTION(abacus_sql_simplices);
SQL_FUNCTION(abacus_sql_vertices);

/* abacus_simplices(mesh regclass) -> SETOF abacus_simplex */
Datum
abacus_sql_simplices(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	Host	   *host;
	abacus_simplex simplex;
	abacus_status status;

	if (SRF_IS_FIRSTCALL() && is_over_shards(fcinfo))
		return shard_read_rows(fcinfo, ROWS_BY_CODE);
	if (SRF_IS_FIRSTCALL())
	{
		abacus_scan *scan = NULL;

		set = SRF_FIRSTCALL_INIT();
		reader = set_begin(fcinfo, set, simplex_row_type);
		host = reader->host;
		host_run(host, abacus_scan_open, &host->table, &reader->header.facts, 0, &scan);
		host_own(host, scan, (void (*) (void *)) abacus_scan_close);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	host = reader->host;
	status = host_run(host, abacus_scan_next, host->handle, &simplex);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, simplex_row(set->tuple_desc, &simplex, reader->header.facts.form.dimension));
}

/* All points. */
static Datum
all_points(FunctionCallInfo fcinfo)
{
	FuncCallContext *set;
	Reader	   *reader;
	Host	   *host;
	abacus_vertex vertex;
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
	{
		abacus_vertex_scan *scan = NULL;

		set = SRF_FIRSTCALL_INIT();
		reader = set_begin(fcinfo, set, result_row_type);
		host = reader->host;
		header_open_vertices(host, &reader->header.facts);
		host_run(host, abacus_vertex_scan_open, &host->table, &reader->header.facts,
				 setting_cache_bytes(), &scan);
		host_own(host, scan, (void (*) (void *)) abacus_vertex_scan_close);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	host = reader->host;
	status = host_run(host, abacus_vertex_scan_next, host->handle, &vertex);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, vertex_row(set->tuple_desc, &vertex, &reader->header.facts));
}

/*
 * Whether a call has a window, or the range of an attribute. In 0.1.0 the mesh was the only
 * argument.
 */
static bool
is_about_part(FunctionCallInfo fcinfo)
{
	for (int i = 1; i < PG_NARGS(); i++)
		if (!PG_ARGISNULL(i))
			return true;
	return false;
}

/*
 * abacus_vertices(mesh regclass, lower float8[], upper float8[], attribute text, range float8[])
 *     -> sequence, id, x, y, z, attributes, vertex
 */
Datum
abacus_sql_vertices(PG_FUNCTION_ARGS)
{
	if (SRF_IS_FIRSTCALL() && is_over_shards(fcinfo))
		return shard_read_rows(fcinfo, ROWS_WITHOUT_GUESTS);
	return PG_ARGISNULL(0) || is_about_part(fcinfo) ? faces_vertices(fcinfo) : all_points(fcinfo);
}

/*
 * fn_quake.c: abacus_quake, the points of the earthquake data sets.
 *
 * Each call returns one point, so in a select list the points stream. In a FROM clause the executor
 * first collects a function's rows in a temporary file. Between calls, only the core's place in the
 * octree is kept.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/quake.h"
#include "pg/base/sql_function.h"
#include "pg/host/host.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_quake);

/* abacus_quake(frequency, points_per_wavelength) -> id, x, y, z, vs, vp, density */
Datum
abacus_sql_quake(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Host	   *host;
	abacus_quake_point point;
	Datum		values[7];
	bool		isnull[7] = {false};

	if (SRF_IS_FIRSTCALL())
	{
		abacus_quake *quake = NULL;
		MemoryContext old;

		set = SRF_FIRSTCALL_INIT();
		old = MemoryContextSwitchTo(set->multi_call_memory_ctx);
		set->tuple_desc = result_row_type(fcinfo);
		set->user_fctx = host = host_create(set->multi_call_memory_ctx);
		host_run(host, abacus_quake_open, &host->table, PG_GETARG_FLOAT8(0), PG_GETARG_FLOAT8(1),
				 &quake);
		host_own(host, quake, (void (*) (void *)) abacus_quake_close);
		MemoryContextSwitchTo(old);
	}
	set = SRF_PERCALL_SETUP();
	host = set->user_fctx;
	if (host_run(host, abacus_quake_next, host->handle, &point) == ABACUS_END)
		SRF_RETURN_DONE(set);
	values[0] = Int64GetDatum(point.id);
	for (int i = 0; i < 3; i++)
		values[1 + i] = Float8GetDatum(point.point[i]);
	values[4] = Float8GetDatum(point.vs);
	values[5] = Float8GetDatum(point.vp);
	values[6] = Float8GetDatum(point.density);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}

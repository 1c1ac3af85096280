/*
 * fn_sets.c: abacus_simplices and abacus_vertices, the content of a mesh as
 * rows.
 *
 * One row a call. Between calls only the core's scan is kept. It holds one decoded page
 * in memory and nothing of PostgreSQL, so a query that stops early (LIMIT, a closed
 * cursor) leaves nothing behind.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/array.h"

#include "abacus/read.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/sql/result.h"
#include "pg/sql/simplex_row.h"

SQL_FUNCTION(abacus_sql_simplices);
SQL_FUNCTION(abacus_sql_vertices);

/* First call of a set: opens the mesh for the calls that follow. */
static Reader *
begin_set(FunctionCallInfo fcinfo, FuncCallContext *set,
		  TupleDesc (*row_type) (FunctionCallInfo fcinfo))
{
	MemoryContext old = MemoryContextSwitchTo(set->multi_call_memory_ctx);
	Reader	   *reader = reader_open(PG_GETARG_OID(0), set->multi_call_memory_ctx);

	set->tuple_desc = row_type(fcinfo);
	set->user_fctx = reader;
	MemoryContextSwitchTo(old);
	return reader;
}

/* abacus_simplices(mesh regclass) -> SETOF abacus_simplex */
Datum
abacus_sql_simplices(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	Host	   *host;
	abacus_simplex simplex;
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
	{
		abacus_scan *scan = NULL;

		set = SRF_FIRSTCALL_INIT();
		reader = begin_set(fcinfo, set, simplex_row_type);
		host = reader->host;
		host_run(host, abacus_scan_open, &host->table, &reader->header, 0, &scan);
		host_own(host, scan, (void (*) (void *)) abacus_scan_close);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	host = reader->host;
	status = host_run(host, abacus_scan_next, host->handle, &simplex);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, simplex_row(set->tuple_desc, &simplex, reader->header.dimension));
}

/* Columns of abacus_vertices */
enum
{
	VERTEX_SEQUENCE,
	VERTEX_ID,
	VERTEX_X,
	VERTEX_ATTRIBUTES = VERTEX_X + ABACUS_MAX_DIMENSION,
	VERTEX_VERTEX,
	VERTEX_COLUMNS
};

/* Attributes as float8[]; the core's NaN is SQL's NULL. */
static Datum
attribute_array(const double *attributes, int count)
{
	Datum		values[ABACUS_MAX_ATTRIBUTES];
	bool		isnull[ABACUS_MAX_ATTRIBUTES];
	int			lower = 1;

	if (count == 0)
		return PointerGetDatum(construct_empty_array(FLOAT8OID));
	for (int i = 0; i < count; i++)
	{
		values[i] = Float8GetDatum(attributes[i]);
		isnull[i] = isnan(attributes[i]) != 0;
	}
	return PointerGetDatum(construct_md_array(values, isnull, 1, &count, &lower, FLOAT8OID,
											  sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE));
}

static Datum
vertex_row(TupleDesc row_type, const abacus_vertex *vertex, const abacus_header *header)
{
	Datum		values[VERTEX_COLUMNS];
	bool		isnull[VERTEX_COLUMNS] = {false};

	isnull[VERTEX_SEQUENCE] = !vertex->waits;
	values[VERTEX_SEQUENCE] = Int64GetDatum((int64) vertex->sequence);
	values[VERTEX_ID] = Int64GetDatum(vertex->id);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[VERTEX_X + i] = i >= header->dimension;
		values[VERTEX_X + i] = isnull[VERTEX_X + i] ? (Datum) 0 : Float8GetDatum(vertex->point[i]);
	}
	values[VERTEX_ATTRIBUTES] = attribute_array(vertex->attributes, header->attributes);
	isnull[VERTEX_VERTEX] = vertex->waits;
	values[VERTEX_VERTEX] = Int64GetDatum(vertex->vertex);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/* abacus_vertices(mesh regclass) -> sequence, id, x, y, z, attributes, vertex */
Datum
abacus_sql_vertices(PG_FUNCTION_ARGS)
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
		reader = begin_set(fcinfo, set, result_row_type);
		host = reader->host;
		header_open_vertices(host, &reader->header);
		host_run(host, abacus_vertex_scan_open, &host->table, &reader->header,
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
	SRF_RETURN_NEXT(set, vertex_row(set->tuple_desc, &vertex, &reader->header));
}

/*
 * fn_mark.c: abacus_mark and abacus_facets, integer markers of facets.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/labels.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_mark);
SQL_FUNCTION(abacus_sql_facets);

/* Marks the facets of a prepared query; returns how many rows it had. */
static uint64
mark_query(Oid mesh, Source *source)
{
	Change	   *change = change_begin(mesh, "abacus_mark()");
	Host	   *host = change->writer.host;
	const uint64 *rows;
	size_t		count;
	uint64		marked = 0;

	host_run(host, abacus_marking_open, &host->table, &change->writer.header->facts, setting_sort_bytes(),
			 setting_cache_bytes(), &change->marking);
	source_open_facets(source, abacus_names_of(change->writer.header));
	while ((count = source_fetch(source, &rows)) > 0)
	{
		host_run(host, abacus_marking_add, change->marking, rows, count);
		marked += count;
	}
	source_close(source);
	host_run(host, abacus_marking_end, change->marking, change->writer.header);
	change_end(change);
	return marked;
}

/* abacus_mark(mesh regclass, query text) -> bigint */
Datum
abacus_sql_mark(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		marked;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	marked = mark_query(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) marked);
}

/* Columns of abacus_facets */
enum
{
	FACET_MARKER,
	FACET_V0,
	FACET_CORNERS = FACET_V0 + ABACUS_MAX_DIMENSION,
	FACET_COLUMNS
};

static Datum
facet_row(TupleDesc row_type, const abacus_facet *facet, int dimension)
{
	double		corners[ABACUS_MAX_DIMENSION * ABACUS_MAX_DIMENSION];
	Datum		values[FACET_COLUMNS] = {0};
	bool		isnull[FACET_COLUMNS] = {false};

	values[FACET_MARKER] = Int32GetDatum((int32) facet->marker);
	for (int i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[FACET_V0 + i] = i >= dimension;
		if (i >= dimension)
			continue;
		values[FACET_V0 + i] = Int64GetDatum(facet->id[i]);
		memcpy(corners + i * dimension, facet->corner[i], dimension * sizeof(double));
	}
	values[FACET_CORNERS] = float_matrix(corners, dimension, dimension);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/*
 * abacus_facets(mesh regclass, marker int)
 *     -> marker, v0, v1, v2, corners
 */
Datum
abacus_sql_facets(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	Host	   *host;
	abacus_facet facet;
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
	{
		double		marker = PG_ARGISNULL(1) ? NAN : PG_GETARG_INT32(1);
		abacus_facets *facets = NULL;

		set = SRF_FIRSTCALL_INIT();
		if (PG_ARGISNULL(0))
			SRF_RETURN_DONE(set);
		reader = set_begin(fcinfo, set, result_row_type);
		host = reader->host;
		host_run(host, abacus_facets_open, &host->table, &reader->header.facts, marker,
				 setting_query_sort_bytes(), setting_cache_bytes(), &facets);
		host_own(host, facets, (void (*) (void *)) abacus_facets_close);
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	host = reader->host;
	status = host_run(host, abacus_facets_next, host->handle, &facet);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	SRF_RETURN_NEXT(set, facet_row(set->tuple_desc, &facet, (int) reader->header.facts.form.dimension));
}

/*
 * fn_numbered.c: abacus_numbered_vertices and abacus_numbered_simplices, a mesh as the two arrays
 * that other programs expect.
 */
#include "postgres.h"

#include "funcapi.h"

#include "abacus/arrays.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/temp_room.h"
#include "pg/mesh/reader.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_numbered_vertices);
SQL_FUNCTION(abacus_sql_numbered_simplices);

/* Columns of abacus_numbered_vertices */
enum
{
	VERTEX_NUMBER,
	VERTEX_ID,
	VERTEX_X,
	VERTEX_ATTRIBUTES = VERTEX_X + ABACUS_MAX_DIMENSION,
	VERTEX_COLUMNS
};

/* Columns of abacus_numbered_simplices: the code, the numbers of the corners, and the labels */
enum
{
	SIMPLEX_CODE,
	SIMPLEX_NUMBERS,
	SIMPLEX_LABELS = SIMPLEX_NUMBERS + ABACUS_MAX_DIMENSION + 1,
	SIMPLEX_COLUMNS
};

/*
 * All pages are read before the first row is known, and sorted data lies in spools. So the rows go
 * into a tuplestore, as those of a function in FROM do anyway.
 */
static Reader *
begin(FunctionCallInfo fcinfo, bool of_simplices)
{
	Oid			mesh = PG_GETARG_OID(0);
	Reader	   *reader;
	abacus_numbered *numbered = NULL;

	InitMaterializedSRF(fcinfo, 0);
	reader = reader_open(mesh, CurrentMemoryContext);
	/* number, id and coordinates; or code and numbers */
	temp_room_require_rows(of_simplices ? (double) reader->header.facts.census.simplices
						   : (double) reader->header.facts.census.vertices,
						   (2 + (int) reader->header.facts.form.dimension) * (int) sizeof(Datum));
	progress_begin(&reader->host->progress, mesh);
	host_run(reader->host, abacus_numbered_open, &reader->host->table, &reader->header.facts,
			 of_simplices, setting_query_sort_bytes(), &numbered);
	host_own(reader->host, numbered, (void (*) (void *)) abacus_numbered_close);
	return reader;
}

static void
done(Reader *reader)
{
	progress_end(&reader->host->progress);
	host_release(reader->host);
	host_destroy(reader->host);
}

static void
put_vertex(ReturnSetInfo *set, int64 number, const abacus_vertex *vertex,
		   const abacus_facts *facts)
{
	Datum		values[VERTEX_COLUMNS] = {0};
	bool		isnull[VERTEX_COLUMNS] = {false};

	values[VERTEX_NUMBER] = Int64GetDatum(number);
	values[VERTEX_ID] = Int64GetDatum(vertex->id);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[VERTEX_X + i] = i >= facts->form.dimension;
		values[VERTEX_X + i] = Float8GetDatum(vertex->point[i]);
	}
	values[VERTEX_ATTRIBUTES] = attribute_array(vertex->attributes, (int) facts->columns.attributes);
	tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	pfree(DatumGetPointer(values[VERTEX_ATTRIBUTES]));
}

/* abacus_numbered_vertices(mesh regclass) -> number, id, x, y, z, attributes */
Datum
abacus_sql_numbered_vertices(PG_FUNCTION_ARGS)
{
	Reader	   *reader = begin(fcinfo, false);
	Host	   *host = reader->host;
	abacus_vertex vertex;

	for (int64 number = 0;
		 host_run(host, abacus_numbered_next_vertex, host->handle, &vertex) != ABACUS_END;
		 number++)
		put_vertex((ReturnSetInfo *) fcinfo->resultinfo, number, &vertex, &reader->header.facts);
	done(reader);
	PG_RETURN_NULL();
}

static void
put_simplex(ReturnSetInfo *set, const abacus_simplex *simplex, const uint64 *numbers,
			const double *labels, const abacus_facts *facts)
{
	Datum		values[SIMPLEX_COLUMNS] = {0};
	bool		isnull[SIMPLEX_COLUMNS] = {false};

	values[SIMPLEX_CODE] = Int64GetDatum((int64) simplex->code);
	for (uint32 i = 0; i <= ABACUS_MAX_DIMENSION; i++)
	{
		isnull[SIMPLEX_NUMBERS + i] = i > facts->form.dimension;
		values[SIMPLEX_NUMBERS + i] = Int64GetDatum((int64) numbers[i]);
	}
	isnull[SIMPLEX_LABELS] = labels == NULL;
	if (labels != NULL)
		values[SIMPLEX_LABELS] = attribute_array(labels, (int) facts->columns.labels);
	tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	if (labels != NULL)
		pfree(DatumGetPointer(values[SIMPLEX_LABELS]));
}

/* abacus_numbered_simplices(mesh regclass) -> code, n0, n1, n2, n3, labels */
Datum
abacus_sql_numbered_simplices(PG_FUNCTION_ARGS)
{
	Reader	   *reader = begin(fcinfo, true);
	Host	   *host = reader->host;
	abacus_simplex simplex;
	uint64		numbers[ABACUS_MAX_DIMENSION + 1] = {0};
	const abacus_facts *facts = &reader->header.facts;
	const double *labels = NULL;

	while (host_run(host, abacus_numbered_next_simplex, host->handle, &simplex, numbers) !=
		   ABACUS_END)
	{
		if (facts->columns.labels > 0)
			host_run(host, abacus_numbered_labels, host->handle, &simplex, &labels);
		put_simplex((ReturnSetInfo *) fcinfo->resultinfo, &simplex, numbers, labels, facts);
	}
	done(reader);
	PG_RETURN_NULL();
}

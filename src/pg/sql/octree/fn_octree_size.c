/*
 * fn_octree_size.c: abacus_octree_from_size, an octree as fine as a query says.
 *
 * The query is called for many octants at once: it gets their centers as arrays, and returns an
 * array of sizes. It runs under the change's snapshot, read-only, with the caller's rights.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/memutils.h"

#include "abacus/octree.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/sql/octree/octree_growth.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_octree_from_size);

typedef struct SizeQuery
{
	Host	   *host;
	uint32		dimension;
	SPIPlanPtr	plan;
	MemoryContext scratch;		/* of one call */
} SizeQuery;

static void
refuse_answer(const char *detail)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("the query does not return one array of sizes"),
			 errdetail("%s", detail),
			 errhint("Write a query that takes the arrays $1, $2 (and $3) of the coordinates of "
					 "centres and returns one float8[] with a size for each: "
					 "SELECT my_sizes($1, $2).")));
}

static void
take_sizes(ArrayType *array, size_t count, double *sizes)
{
	Datum	   *elements;
	bool	   *isnull;
	int			found;

	if (ARR_NDIM(array) != 1 || ARR_DIMS(array)[0] != (int) count)
		refuse_answer(psprintf("It returned %d sizes for %zu octants.",
							   ArrayGetNItems(ARR_NDIM(array), ARR_DIMS(array)), count));
	deconstruct_array(array, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
					  &elements, &isnull, &found);
	for (int i = 0; i < found; i++)
		sizes[i] = isnull[i] ? NAN : DatumGetFloat8(elements[i]);
}

/* Runs the query for an array of octants. */
static void
run(SizeQuery *query, size_t count, const double *const *centers, double *sizes)
{
	Datum		arguments[ABACUS_MAX_DIMENSION];
	bool		isnull;
	Datum		answer;

	for (uint32 i = 0; i < query->dimension; i++)
		arguments[i] = attribute_array(centers[i], (int) count);
	if (SPI_execute_plan(query->plan, arguments, NULL, true, 2) != SPI_OK_SELECT)
		refuse_answer("It is not a SELECT.");
	MemoryContextSwitchTo(query->scratch);	/* SPI has switched to its own */
	if (SPI_processed != 1 || SPI_tuptable->tupdesc->natts != 1)
		refuse_answer("It did not return exactly one row with one column.");
	if (SPI_gettypeid(SPI_tuptable->tupdesc, 1) != FLOAT8ARRAYOID)
		refuse_answer(psprintf("It returned a value of type %s.",
							   format_type_be(SPI_gettypeid(SPI_tuptable->tupdesc, 1))));
	answer = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull);
	if (isnull)
		refuse_answer("It returned NULL.");
	take_sizes(DatumGetArrayTypeP(answer), count, sizes);
	SPI_freetuptable(SPI_tuptable);
}

/* Returns the sizes of octants; called by the core. */
static abacus_host_status
sizes_of(void *context, size_t count, const double *const *centers, const double *edges,
		 double *sizes)
{
	SizeQuery  *query = context;
	MemoryContext old = CurrentMemoryContext;

	GUARD_BEGIN();
	MemoryContextSwitchTo(query->scratch);
	run(query, count, centers, sizes);
	MemoryContextSwitchTo(old);
	MemoryContextReset(query->scratch);
	GUARD_END(query->host);
	return ABACUS_HOST_OK;
}

/* abacus_octree_from_size(octree regclass, query text) -> bigint */
Datum
abacus_sql_octree_from_size(PG_FUNCTION_ARGS)
{
	Oid			types[ABACUS_MAX_DIMENSION] = {FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID};
	SizeQuery	query;
	Writer		writer;
	Host	   *host;
	int64		leaves;

	SPI_connect();
	writer_begin_of(&writer, PG_GETARG_OID(0), ABACUS_OCTREE, "abacus_octree_from_size()");
	host = query.host = writer.host;
	query.dimension = writer.header->facts.form.dimension;
	query.plan = SPI_prepare(text_to_cstring(PG_GETARG_TEXT_PP(1)), (int) query.dimension, types);
	if (query.plan == NULL)
		elog(ERROR, "could not prepare the query: %s", SPI_result_code_string(SPI_result));
	query.scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus sizes",
										  ALLOCSET_DEFAULT_SIZES);
	octree_growth_open(&writer);
	host_run(host, abacus_octree_growth_sizes, host->handle, sizes_of, &query, writer.header);
	leaves = (int64) writer.header->facts.census.leaves;
	writer_end(&writer);
	SPI_finish();
	PG_RETURN_INT64(leaves);
}

/*
 * fn_octree_size.c: abacus_octree_from_size, an octree as fine as a query says.
 *
 * The query is called for many octants at once: it gets their centers as arrays, and how long they
 * are as one more; it returns an array of sizes. Each octant may have several places instead of its
 * center. It runs under the change's snapshot, read-only, with the caller's rights.
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

/* Coordinates, and edges. */
#define SIZE_ARGUMENTS (ABACUS_MAX_DIMENSION + 1)

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
			 errhint("Write a query that takes the arrays $1, $2 (in space $3, too) of the coordinates "
					 "of places, and one more of the longest edges of the octants around them, and "
					 "returns one float8[] with a size for each place: SELECT my_sizes($1, $2).")));
}

static void
take_sizes(ArrayType *array, size_t count, double *sizes)
{
	Datum	   *elements;
	bool	   *isnull;
	int			found;

	if (ARR_NDIM(array) != 1 || ARR_DIMS(array)[0] != (int) count)
		refuse_answer(psprintf("It returned %d sizes for %zu places.",
							   ArrayGetNItems(ARR_NDIM(array), ARR_DIMS(array)), count));
	deconstruct_array(array, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
					  &elements, &isnull, &found);
	for (int i = 0; i < found; i++)
		sizes[i] = isnull[i] ? NAN : DatumGetFloat8(elements[i]);
}

/* Runs the query for an array of places. */
static void
run(SizeQuery *query, size_t count, const double *const *places, const double *edges, double *sizes)
{
	Datum		arguments[SIZE_ARGUMENTS];
	bool		isnull;
	Datum		answer;

	for (uint32 i = 0; i < query->dimension; i++)
		arguments[i] = attribute_array(places[i], (int) count);
	arguments[query->dimension] = attribute_array(edges, (int) count);
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

/* Returns the sizes at places in octants; called by the core. */
static abacus_host_status
sizes_of(void *context, size_t count, const double *const *places, const double *edges,
		 double *sizes)
{
	SizeQuery  *query = context;
	MemoryContext old = CurrentMemoryContext;

	GUARD_BEGIN();
	MemoryContextSwitchTo(query->scratch);
	run(query, count, places, edges, sizes);
	MemoryContextSwitchTo(old);
	MemoryContextReset(query->scratch);
	GUARD_END(query->host);
	return ABACUS_HOST_OK;
}

static int
samples_of(int samples)
{
	if (samples < 1 || samples > ABACUS_MAX_SAMPLES)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("samples must be from 1 to %d, not %d", ABACUS_MAX_SAMPLES, samples)));
	return samples;
}

static void
tell_longer(uint64 longer, uint64 leaves)
{
	if (longer > 0)
		ereport(NOTICE,
				(errmsg(UINT64_FORMAT " of " UINT64_FORMAT " leaves are longer than a size that the query "
						"returned for a place in them", longer, leaves),
				 errdetail("The place was that of a larger octant, which was split, or the leaf has the "
						   "finest level."),
				 errhint("Use more samples, or let the query return the least size within the edge "
						 "length that its last array has.")));
}

/* abacus_octree_from_size(octree regclass, query text, samples integer) -> bigint */
Datum
abacus_sql_octree_from_size(PG_FUNCTION_ARGS)
{
	Oid			types[SIZE_ARGUMENTS] = {FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID};
	int			samples = samples_of(PG_GETARG_INT32(2));
	SizeQuery	query;
	Writer		writer;
	Host	   *host;
	uint64		leaves;
	uint64		longer;

	SPI_connect();
	writer_begin_of(&writer, PG_GETARG_OID(0), ABACUS_OCTREE, "abacus_octree_from_size()");
	host = query.host = writer.host;
	query.dimension = writer.header->facts.form.dimension;
	query.plan = SPI_prepare(text_to_cstring(PG_GETARG_TEXT_PP(1)), (int) query.dimension + 1, types);
	if (query.plan == NULL)
		elog(ERROR, "could not prepare the query: %s", SPI_result_code_string(SPI_result));
	query.scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus sizes",
										  ALLOCSET_DEFAULT_SIZES);
	octree_growth_open(&writer);
	host_run(host, abacus_octree_growth_sizes, host->handle, sizes_of, &query,
			 (uint32) samples, writer.header, &longer);
	leaves = writer.header->facts.census.leaves;
	writer_end(&writer);
	SPI_finish();
	tell_longer(longer, leaves);
	PG_RETURN_INT64((int64) leaves);
}

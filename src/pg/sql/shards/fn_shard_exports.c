/*
 * fn_shard_exports.c: what the coordinator of a mesh over several servers asks a shard: which of its
 * vertices other shards need, which places it can answer for, and how many simplices it owns.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/array.h"

#include "abacus/shards.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/shape.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"
#include "pg/sql/shards/exports_row.h"

SQL_FUNCTION(abacus_sql_shard_exports);
SQL_FUNCTION(abacus_sql_shard_settled);
SQL_FUNCTION(abacus_sql_shard_count);

/* Columns of the places */
enum
{
	SETTLED_ID,
	SETTLED_X,
	SETTLED_COLUMNS = SETTLED_X + ABACUS_MAX_DIMENSION
};

/* The elements of an argument that is a plain array of eight-byte values without NULLs. */
static const uint64 *
words_argument(FunctionCallInfo fcinfo, int argument, const char *name, int *count)
{
	ArrayType  *array = PG_GETARG_ARRAYTYPE_P(argument);

	if (ARR_NDIM(array) > 1 || array_contains_nulls(array))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s must be a one-dimensional array without NULLs", name)));
	*count = ARR_NDIM(array) == 0 ? 0 : ARR_DIMS(array)[0];
	return (const uint64 *) ARR_DATA_PTR(array);
}

/* ---- abacus_shard_exports ------------------------------------------------------------------- */

/*
 * The exports of a reader's mesh; they belong to its host. The arguments behind the mesh say between which
 * borders, which shard, and around which points.
 */
abacus_exports *
exports_open(FunctionCallInfo fcinfo, Reader *reader)
{
	Host	   *host = reader->host;
	int			count;
	const uint64 *borders = words_argument(fcinfo, 1, "borders", &count);
	int32		shard = PG_GETARG_INT32(2);
	abacus_box	extent;
	abacus_exports *exports = NULL;

	for (int i = 0; i < count; i++)
		if ((int64) borders[i] < 0 || (i > 0 && borders[i] < borders[i - 1]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("borders must be codes that ascend")));
	if (shard < 0 || shard > count)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("there is no shard %d between %d borders", shard, count)));
	shape_point(&reader->header.facts.form, PG_GETARG_ARRAYTYPE_P(3), "least", extent.lower);
	shape_point(&reader->header.facts.form, PG_GETARG_ARRAYTYPE_P(4), "greatest", extent.upper);
	header_open_vertices(host, &reader->header.facts);
	host_run(host, abacus_exports_open, &host->table, &reader->header.facts, borders, (size_t) count,
			 (uint32) shard, &extent, &exports);
	host_own(host, exports, (void (*) (void *)) abacus_exports_close);
	return exports;
}

/* The row of a vertex; the attributes are allocated. */
void
export_columns(uint32 shard, const abacus_vertex *vertex, const abacus_facts *facts, Datum *values, bool *isnull)
{
	values[EXPORT_SHARD] = Int32GetDatum((int32) shard);
	values[EXPORT_ID] = Int64GetDatum(vertex->id);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[EXPORT_X + i] = i >= facts->form.dimension;
		values[EXPORT_X + i] = Float8GetDatum(vertex->point[i]);
	}
	values[EXPORT_ATTRIBUTES] = attribute_array(vertex->attributes, (int) facts->columns.attributes);
}

/*
 * abacus_shard_exports(mesh regclass, borders bigint[], shard int, least float8[], greatest float8[])
 *     -> shard, id, x, y, z, attributes
 */
Datum
abacus_sql_shard_exports(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	const abacus_facts *facts;
	uint32		shard;
	abacus_vertex vertex;
	abacus_status status;
	Datum		values[EXPORT_COLUMNS];
	bool		isnull[EXPORT_COLUMNS] = {false};

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		(void) exports_open(fcinfo, set_begin(fcinfo, set, result_row_type));
	}
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	facts = &reader->header.facts;
	status = host_run(reader->host, abacus_exports_next, reader->host->handle, &shard, &vertex);
	host_release(reader->host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	export_columns(shard, &vertex, facts, values, isnull);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}

/* ---- abacus_shard_settled ------------------------------------------------------------------- */

/* What the simplices around a place say. */
typedef struct Around
{
	const abacus_form *form;
	int64		first;			/* the codes that the shard owns: from here */
	int64		last;			/* to here */
	bool		any;
	bool		settled;		/* each has a corner of the shard's own */
} Around;

/* Looks at one of them; called by the core. */
static abacus_host_status
look_at_simplex(void *context, const abacus_simplex *simplex)
{
	Around	   *around = context;
	bool		has_own = false;

	for (uint32 i = 0; i <= around->form->dimension; i++)
	{
		uint64		code;
		abacus_error error;

		if (abacus_codes(around->form, simplex->corner[i], 1, &code, &error) != ABACUS_OK)
			return ABACUS_HOST_FAILED;
		has_own |= around->first <= (int64) code && (int64) code <= around->last;
	}
	around->any = true;
	around->settled &= has_own;
	return ABACUS_HOST_OK;
}

/*
 * abacus_shard_settled(mesh regclass, first bigint, last bigint, ids bigint[], places float8[])
 *     -> id, x, y, z
 *
 * A simplex with a corner of the shard's own is one of the mesh of all shards, and so are all others
 * around that corner. So if each simplex around a place has one, the shard has all that are there.
 */
Datum
abacus_sql_shard_settled(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	CachedMesh *cached;
	int			count;
	int			coordinates;
	const uint64 *ids = words_argument(fcinfo, 3, "ids", &count);
	const double *places = (const double *) words_argument(fcinfo, 4, "places", &coordinates);
	Around		around = {.first = PG_GETARG_INT64(1),.last = PG_GETARG_INT64(2)};
	int			dimension;

	InitMaterializedSRF(fcinfo, 0);
	cached = mesh_cache_get(PG_GETARG_OID(0));
	dimension = (int) cached->dimension;
	around.form = &cached->header.facts.form;
	if (coordinates != count * dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("places must have %d coordinates for each id", dimension)));
	for (int i = 0; i < count; i++)
	{
		Datum		values[SETTLED_COLUMNS] = {[SETTLED_ID] = Int64GetDatum((int64) ids[i])};
		bool		isnull[SETTLED_COLUMNS] = {false};

		around.any = false;
		around.settled = true;
		host_run(cached->host, abacus_mesh_star, cached->mesh, places + i * dimension, look_at_simplex, &around);
		if (!around.any || !around.settled)
			continue;
		for (int axis = 0; axis < ABACUS_MAX_DIMENSION; axis++)
		{
			isnull[SETTLED_X + axis] = axis >= dimension;
			values[SETTLED_X + axis] = axis < dimension ? Float8GetDatum(places[i * dimension + axis]) : (Datum) 0;
		}
		tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	}
	host_release(cached->host);
	PG_RETURN_NULL();
}

/* ---- abacus_shard_count --------------------------------------------------------------------- */

/*
 * abacus_shard_count(mesh regclass, borders bigint[], own int, least float8[], greatest float8[])
 *     -> bigint
 */
Datum
abacus_sql_shard_count(PG_FUNCTION_ARGS)
{
	Reader	   *reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	uint64		count;

	(void) exports_open(fcinfo, reader);
	host_run(reader->host, abacus_exports_count, reader->host->handle, &count);
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_INT64((int64) count);
}

/*
 * simplex_row.c: the composite type abacus_simplex, (code, v0, v1, v2, v3).
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/memutils.h"
#include "utils/typcache.h"

#include "pg/sql/rows/result.h"
#include "pg/sql/rows/simplex_row.h"

/* An error unless the type has our columns. */
static void
require_type(TupleDesc row_type)
{
	static const Oid types[SIMPLEX_COLUMNS] = {INT8OID, INT8OID, INT8OID, INT8OID, INT8OID};

	result_require_type(row_type, "abacus_simplex", types, SIMPLEX_COLUMNS,
						"code, v0, v1, v2 and v3, all of type bigint",
						"Save the points, which abacus_vertices() still returns, and make the "
						"extension and its meshes anew.");
}

/*
 * The row type of a function that returns simplices, blessed, in the current memory context. Its
 * columns are those of the type, to which its owner may have added some.
 */
TupleDesc
simplex_row_type(FunctionCallInfo fcinfo)
{
	TupleDesc	row_type = result_row_type(fcinfo);

	require_type(row_type);
	return row_type;
}

/* Code and corner ids as columns. */
void
simplex_columns(const abacus_simplex *simplex, uint32 dimension, Datum *values, bool *isnull)
{
	values[0] = Int64GetDatum((int64) simplex->code);
	isnull[0] = false;
	for (uint32 i = 0; i <= ABACUS_MAX_DIMENSION; i++)
	{
		values[1 + i] = Int64GetDatum(simplex->id[i]);
		isnull[1 + i] = i > dimension;
	}
}

Datum
simplex_row(TupleDesc row_type, const abacus_simplex *simplex, uint32 dimension)
{
	Datum		values[SIMPLEX_COLUMNS];
	bool		isnull[SIMPLEX_COLUMNS];

	simplex_columns(simplex, dimension, values, isnull);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/* The data for a function that is called for many rows; looked up once. */
SimplexRows *
simplex_rows(FunctionCallInfo fcinfo)
{
	FmgrInfo   *function = fcinfo->flinfo;

	if (function->fn_extra == NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(function->fn_mcxt);
		SimplexRows *rows = palloc0(sizeof(SimplexRows));

		rows->memory = function->fn_mcxt;
		rows->row_type = simplex_row_type(fcinfo);
		function->fn_extra = rows;
		MemoryContextSwitchTo(old);
	}
	return function->fn_extra;
}

/*
 * simplex_row() for many rows. Rows of one dimension differ only in their values, which
 * are bigints. So each row is a copy of the first with its own values.
 */
Datum
simplex_row_again(SimplexRows *rows, const abacus_simplex *simplex, uint32 dimension)
{
	HeapTupleHeader model = rows->model[dimension];
	HeapTupleHeader row;
	int64	   *values;
	uint32		size;

	if (unlikely(model == NULL))
	{
		MemoryContext old = MemoryContextSwitchTo(rows->memory);

		model = DatumGetHeapTupleHeader(simplex_row(rows->row_type, simplex, dimension));
		rows->model[dimension] = model;
		MemoryContextSwitchTo(old);
	}
	size = HeapTupleHeaderGetDatumLength(model);
	Assert(size == model->t_hoff + (2 + dimension) * sizeof(int64));
	row = palloc(size);
	memcpy(row, model, model->t_hoff);
	values = (int64 *) ((char *) row + model->t_hoff);
	values[0] = (int64) simplex->code;
	memcpy(values + 1, simplex->id, (1 + dimension) * sizeof(int64));
	return PointerGetDatum(row);
}

/*
 * The code and corner ids of a simplex that SQL passes back. False for a row of NULLs, which a
 * missing simplex becomes in a FROM clause.
 */
bool
simplex_from_row(Datum row, TupleDesc row_type, uint32 dimension, uint64 *code, int64 *ids)
{
	HeapTupleHeader header = DatumGetHeapTupleHeader(row);
	HeapTupleData tuple;
	Datum		values[SIMPLEX_COLUMNS];
	bool		isnull[SIMPLEX_COLUMNS];
	bool		complete;
	bool		empty;

	tuple.t_len = HeapTupleHeaderGetDatumLength(header);
	ItemPointerSetInvalid(&tuple.t_self);
	tuple.t_tableOid = InvalidOid;
	tuple.t_data = header;
	heap_deform_tuple(&tuple, row_type, values, isnull);

	complete = !isnull[0];
	empty = isnull[0];
	for (uint32 i = 0; i <= ABACUS_MAX_DIMENSION; i++)
		empty &= isnull[1 + i];
	for (uint32 i = 0; i <= dimension; i++)
	{
		complete &= !isnull[1 + i];
		ids[i] = DatumGetInt64(values[1 + i]);
	}
	if (empty)
		return false;
	if (!complete)
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("simplex has a NULL where a mesh of dimension %u needs a value", dimension),
				 errhint("Pass a simplex as abacus_locate(), abacus_walk() or abacus_simplices() "
						 "returned it.")));
	for (uint32 i = dimension + 1; i <= ABACUS_MAX_DIMENSION; i++)
		if (!isnull[1 + i])
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("simplex has a vertex v%u, but the mesh has dimension %u", i, dimension),
					 errhint("Pass a simplex of the same mesh.")));
	*code = (uint64) DatumGetInt64(values[0]);
	return true;
}

/* The same in a function that returns another type. */
bool
simplex_from_argument(Datum row, uint32 dimension, uint64 *code, int64 *ids)
{
	HeapTupleHeader header = DatumGetHeapTupleHeader(row);
	TupleDesc	row_type = lookup_rowtype_tupdesc(HeapTupleHeaderGetTypeId(header),
												  HeapTupleHeaderGetTypMod(header));
	bool		is_simplex;

	require_type(row_type);
	is_simplex = simplex_from_row(row, row_type, dimension, code, ids);
	ReleaseTupleDesc(row_type);
	return is_simplex;
}

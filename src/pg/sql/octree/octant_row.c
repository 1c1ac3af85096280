/*
 * octant_row.c: the composite type abacus_octant, (code, level, lower, upper, attributes).
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"

#include "pg/sql/octree/octant_row.h"
#include "pg/sql/rows/result.h"

/* Row type of a function that returns octants, blessed, in the current memory context. */
TupleDesc
octant_row_type(FunctionCallInfo fcinfo)
{
	static const Oid types[OCTANT_COLUMNS] = {
		[OCTANT_CODE] = INT8OID, [OCTANT_LEVEL] = INT4OID, [OCTANT_LOWER] = FLOAT8ARRAYOID,
		[OCTANT_UPPER] = FLOAT8ARRAYOID, [OCTANT_ATTRIBUTES] = FLOAT8ARRAYOID
	};
	TupleDesc	row_type = result_row_type(fcinfo);

	result_require_type(row_type, "abacus_octant", types, OCTANT_COLUMNS,
						"code, a bigint, level, an integer, and lower, upper and attributes, all "
						"of type double precision[]",
						"Save the leaves, which abacus_octree_elements() still returns, and make "
						"the extension and its octrees anew.");
	return row_type;
}

/* The values of the columns, none of which is NULL. */
void
octant_columns(const abacus_octant *octant, const abacus_facts *facts, Datum *values)
{
	values[OCTANT_CODE] = Int64GetDatum((int64) octant->code);
	values[OCTANT_LEVEL] = Int32GetDatum(octant->level);
	values[OCTANT_LOWER] = attribute_array(octant->lower, (int) facts->form.dimension);
	values[OCTANT_UPPER] = attribute_array(octant->upper, (int) facts->form.dimension);
	values[OCTANT_ATTRIBUTES] = attribute_array(octant->values, (int) facts->columns.attributes);
}

Datum
octant_row(TupleDesc row_type, const abacus_octant *octant, const abacus_facts *facts)
{
	Datum		values[OCTANT_COLUMNS];
	bool		isnull[OCTANT_COLUMNS] = {false};

	octant_columns(octant, facts, values);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

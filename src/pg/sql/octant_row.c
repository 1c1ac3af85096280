/*
 * octant_row.c: the composite type abacus_octant, (code, level, lower, upper, attributes).
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "pg/sql/octant_row.h"
#include "pg/sql/result.h"

/* The values of the columns, none of which is NULL. */
void
octant_columns(const abacus_octant *octant, const abacus_header *header, Datum *values)
{
	values[OCTANT_CODE] = Int64GetDatum((int64) octant->code);
	values[OCTANT_LEVEL] = Int32GetDatum(octant->level);
	values[OCTANT_LOWER] = attribute_array(octant->lower, (int) header->dimension);
	values[OCTANT_UPPER] = attribute_array(octant->upper, (int) header->dimension);
	values[OCTANT_ATTRIBUTES] = attribute_array(octant->values, (int) header->attributes);
}

Datum
octant_row(TupleDesc row_type, const abacus_octant *octant, const abacus_header *header)
{
	Datum		values[OCTANT_COLUMNS];
	bool		isnull[OCTANT_COLUMNS] = {false};

	octant_columns(octant, header, values);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

/*
 * vertex_row.c: the rows of abacus_vertices.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "pg/sql/rows/result.h"
#include "pg/sql/rows/vertex_row.h"

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

Datum
vertex_row(TupleDesc row_type, const abacus_vertex *vertex, const abacus_facts *facts)
{
	Datum		values[VERTEX_COLUMNS];
	bool		isnull[VERTEX_COLUMNS] = {false};

	isnull[VERTEX_SEQUENCE] = !vertex->waits;
	values[VERTEX_SEQUENCE] = Int64GetDatum((int64) vertex->sequence);
	values[VERTEX_ID] = Int64GetDatum(vertex->id);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[VERTEX_X + i] = i >= facts->form.dimension;
		values[VERTEX_X + i] = isnull[VERTEX_X + i] ? (Datum) 0 : Float8GetDatum(vertex->point[i]);
	}
	values[VERTEX_ATTRIBUTES] = attribute_array(vertex->attributes, facts->columns.attributes);
	isnull[VERTEX_VERTEX] = vertex->waits;
	values[VERTEX_VERTEX] = Int64GetDatum(vertex->vertex);
	return HeapTupleGetDatum(heap_form_tuple(row_type, values, isnull));
}

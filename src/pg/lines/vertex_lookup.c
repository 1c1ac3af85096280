/*
 * vertex_lookup.c: vertices of a mesh that is being changed, looked up by their places.
 *
 * A place is found in the mesh as it is, by the core. So few places cost little in a mesh of any size.
 */
#include "postgres.h"

#include "executor/spi.h"

#include "pg/base/float_array.h"
#include "pg/lines/line_points.h"
#include "pg/lines/vertex_lookup.h"

#define ROWS_A_FETCH 1024

/*
 * Whether that is possible: a mesh without triangles has no vertices yet, and attributes that are apart
 * are not read between changes.
 */
bool
vertex_lookup_can(const Change *change)
{
	const abacus_facts *facts = &change->writer.header->facts;

	return facts->census.vertices > 0 && !facts->columns.apart;
}

/* Reads the vertex at a place, as its record; false if there is none. */
bool
vertex_lookup(Change *change, const double *place, uint64 *record)
{
	change_open_build(change);
	return host_run(change->writer.host, abacus_build_vertex_at, change->build, place, record) == ABACUS_OK;
}

/* Calls the sink for each row of a query. */
void
vertex_lookup_rows(Change *change, const char *query, LookupSink sink, void *context)
{
	const abacus_facts *facts = &change->writer.header->facts;
	uint64	   *record = palloc((3 + facts->columns.attributes) * sizeof(uint64));
	Portal		portal = SPI_cursor_open_with_args(NULL, query, 0, NULL, NULL, NULL, true, CURSOR_OPT_NO_SCROLL);

	for (;;)
	{
		SPITupleTable *rows;

		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		rows = SPI_tuptable;
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0, count = SPI_processed; i < count; i++)
			sink(context, rows->vals[i], rows->tupdesc, record);
		SPI_freetuptable(rows);
	}
	SPI_cursor_close(portal);
	pfree(record);
}

/* A double of a row, which is not NULL. */
double
vertex_lookup_number(HeapTuple tuple, TupleDesc desc, int column)
{
	bool		isnull;

	return DatumGetFloat8(SPI_getbinval(tuple, desc, column, &isnull));
}

/* Puts a vertex into the rows of points found. */
void
vertex_lookup_put(const Change *change, NamedRows *found, const uint64 *record, bool has_attributes, bool by_id)
{
	const double *numbers = (const double *) (record + 1);
	Datum		values[FOUND_COLUMNS];
	bool		isnull[FOUND_COLUMNS] = {false};

	values[FOUND_ID] = values[FOUND_VERTEX] = Int64GetDatum((int64) record[0]);
	values[FOUND_X] = Float8GetDatum(numbers[0]);
	values[FOUND_Y] = Float8GetDatum(numbers[1]);
	isnull[FOUND_SEQUENCE] = true;
	isnull[FOUND_ATTRIBUTES] = !has_attributes;
	if (has_attributes)
		values[FOUND_ATTRIBUTES] = attribute_array(numbers + 2, (int) change->writer.header->facts.columns.attributes);
	values[FOUND_BY_ID] = BoolGetDatum(by_id);
	named_rows_put(found, values, isnull);
}

/*
 * point_batch.c: points on their way to a server, as text of SQL.
 *
 * Queries go as text. Doubles go as the shortest decimal that gives the same double, so nothing is
 * rounded; an attribute that is missing goes as NULL.
 */
#include "postgres.h"

#include <math.h>

#include "common/shortest_dec.h"

#include "abacus/facts.h"
#include "pg/shards/point_batch.h"

/* A batch of so many bytes is sent. */
#define FULL_BYTES (512 * 1024)

/* The shortest decimal that gives the same double. */
char *
exact_text(double value)
{
	char	   *text = palloc(DOUBLE_SHORTEST_DECIMAL_LEN);

	double_to_shortest_decimal_buf(value, text);
	return text;
}

void
point_batch_init(PointBatch *batch, uint32 dimension, int attributes)
{
	int			columns = 1 + (int) dimension + attributes;

	batch->dimension = dimension;
	batch->attributes = attributes;
	batch->points = 0;
	batch->bytes = 0;
	batch->columns = palloc(columns * sizeof(StringInfoData));
	for (int i = 0; i < columns; i++)
		initStringInfo(&batch->columns[i]);
}

static void
add_text(PointBatch *batch, int column, const char *text, int length)
{
	StringInfo	values = &batch->columns[column];

	appendStringInfoChar(values, values->len == 0 ? '{' : ',');
	appendBinaryStringInfo(values, text, length);
	batch->bytes += (size_t) length + 1;
}

static void
add_double(PointBatch *batch, int column, double value)
{
	char		text[DOUBLE_SHORTEST_DECIMAL_LEN];

	if (isnan(value))
		add_text(batch, column, "NULL", 4);
	else
		add_text(batch, column, text, double_to_shortest_decimal_buf(value, text));
}

void
point_batch_add(PointBatch *batch, int64 id, const double *point, const double *attributes)
{
	char		text[32];
	int			column = 0;

	add_text(batch, column++, text, snprintf(text, sizeof(text), INT64_FORMAT, id));
	for (uint32 i = 0; i < batch->dimension; i++)
		add_double(batch, column++, point[i]);
	for (int i = 0; i < batch->attributes; i++)
		add_double(batch, column++, attributes[i]);
	batch->points++;
}

bool
point_batch_is_full(const PointBatch *batch)
{
	return batch->bytes >= FULL_BYTES;
}

/* What stands after FROM: the points as rows, in their order, with a number `n`. */
char *
point_batch_rows(const PointBatch *batch)
{
	StringInfoData rows;
	int			columns = 1 + (int) batch->dimension + batch->attributes;

	initStringInfo(&rows);
	appendStringInfoString(&rows, "unnest(");
	for (int i = 0; i < columns; i++)
		appendStringInfo(&rows, "%s'%s}'::%s[]", i == 0 ? "" : ", ", batch->columns[i].data,
						 i == 0 ? "bigint" : "double precision");
	appendStringInfo(&rows, ") WITH ORDINALITY AS p (id, %s, n)",
					 point_columns(batch->dimension, batch->attributes, "a%d"));
	return rows.data;
}

void
point_batch_clear(PointBatch *batch)
{
	for (int i = 0; i < 1 + (int) batch->dimension + batch->attributes; i++)
		resetStringInfo(&batch->columns[i]);
	batch->points = 0;
	batch->bytes = 0;
}

/* The names of coordinates and attributes; `attribute` is a format for the number of one, from 1. */
char *
point_columns(uint32 dimension, int attributes, const char *attribute)
{
	StringInfoData names;

	initStringInfo(&names);
	appendStringInfoString(&names, dimension == 2 ? "x, y" : "x, y, z");
	for (int i = 1; i <= attributes; i++)
	{
		appendStringInfoString(&names, ", ");
		appendStringInfo(&names, attribute, i);
	}
	return names.data;
}

/*
 * point_batch.h: points on their way to a server, as text of SQL.
 */
#ifndef ABACUS_POINT_BATCH_H
#define ABACUS_POINT_BATCH_H

#include "postgres.h"

#include "lib/stringinfo.h"

/* Points, column by column: id, coordinates, attributes. */
typedef struct PointBatch
{
	uint32		dimension;
	int			attributes;
	uint64		points;
	size_t		bytes;			/* of their text */
	StringInfoData *columns;
} PointBatch;

extern char *exact_text(double value);
extern void point_batch_init(PointBatch *batch, uint32 dimension, int attributes);
extern void point_batch_add(PointBatch *batch, int64 id, const double *point, const double *attributes);
extern bool point_batch_is_full(const PointBatch *batch);
extern char *point_batch_rows(const PointBatch *batch);
extern void point_batch_clear(PointBatch *batch);
extern char *point_columns(uint32 dimension, int attributes, const char *attribute);

#endif

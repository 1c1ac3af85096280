/*
 * point_bytes.c: points on their way between servers, as bytes: the words of their records
 * (abacus_stage_add), each with its greatest byte first, so that servers need not be alike.
 */
#include "postgres.h"

#include <math.h>

#include "port/pg_bswap.h"

#include "pg/port/port.h"
#include "pg/shards/point_bytes.h"

/* Words of a record: id, coordinates, attributes. */
int
point_words(const abacus_facts *facts)
{
	return 1 + (int) facts->form.dimension + (int) facts->columns.attributes;
}

void
point_bytes_add(StringInfo bytes, const uint64 *record, int words)
{
	uint64	   *to;

	enlargeStringInfo(bytes, words * (int) sizeof(uint64));
	to = (uint64 *) (bytes->data + bytes->len); /* aligned: whole words are in front of it */
	for (int i = 0; i < words; i++)
		to[i] = pg_hton64(record[i]);
	bytes->len += words * (int) sizeof(uint64);
}

/* The records. What another server has sent is not trusted: coordinates must be finite. */
const uint64 *
point_bytes_read(const bytea *bytes, const abacus_facts *facts, size_t *count)
{
	size_t		size = VARSIZE_ANY_EXHDR(bytes);
	size_t		words = (size_t) point_words(facts);
	uint64	   *records = palloc(Max(1, size));

	*count = size / (words * sizeof(uint64));
	if (size != *count * words * sizeof(uint64))
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("points of another server have %zu bytes, which is no multiple of %zu", size,
						words * sizeof(uint64))));
	memcpy(records, VARDATA_ANY(bytes), size);
	for (size_t i = 0; i < *count * words; i++)
		records[i] = pg_ntoh64(records[i]);
	for (size_t i = 0; i < *count; i++)
		for (uint32 axis = 0; axis < facts->form.dimension; axis++)
			if (!isfinite(((const double *) (records + i * words))[1 + axis]))
				ereport(ERROR,
						(errcode(ERRCODE_DATA_CORRUPTED),
						 errmsg("a point of another server has a coordinate that is not a finite number")));
	return records;
}

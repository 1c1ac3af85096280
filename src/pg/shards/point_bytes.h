/*
 * point_bytes.h: points on their way between servers, as bytes.
 */
#ifndef ABACUS_POINT_BYTES_H
#define ABACUS_POINT_BYTES_H

#include "postgres.h"

#include "lib/stringinfo.h"

#include "abacus/facts.h"

/* So many bytes are sent, or stored in a row. */
#define POINT_BYTES_FULL (128 * 1024)

extern int	point_words(const abacus_facts *facts);
extern void point_bytes_add(StringInfo bytes, const uint64 *record, int words);
extern const uint64 *point_bytes_read(const bytea *bytes, const abacus_facts *facts, size_t *count);

#endif

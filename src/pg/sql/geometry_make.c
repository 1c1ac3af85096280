/*
 * geometry_make.c: geometries of PostGIS as results: EWKB (geometry.c), in the byte order of
 * the machine, through the type's receive function.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/sql/geometry_make.h"

#define WITH_Z 0x80000000
#define WITH_M 0x40000000
#define WITH_SRID 0x20000000

void
geometry_put_head(StringInfo bytes, const GeometryHead *head)
{
	uint32		word = head->kind;

	if (head->has_z)
		word |= WITH_Z;
	if (head->has_m)
		word |= WITH_M;
	if (head->srid != 0)
		word |= WITH_SRID;
#ifdef WORDS_BIGENDIAN
	appendStringInfoChar(bytes, 0);
#else
	appendStringInfoChar(bytes, 1);
#endif
	appendBinaryStringInfo(bytes, (const char *) &word, sizeof(word));
	if (head->srid != 0)
		appendBinaryStringInfo(bytes, (const char *) &head->srid, sizeof(head->srid));
}

void
geometry_put_count(StringInfo bytes, size_t count)
{
	uint32		word = (uint32) count;

	appendBinaryStringInfo(bytes, (const char *) &word, sizeof(word));
}

void
geometry_put_numbers(StringInfo bytes, const double *numbers, size_t count)
{
	size_t		size = count * sizeof(double);

	if (size > MaxAllocSize)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("a geometry of %zu numbers is larger than a value can be", count)));
	appendBinaryStringInfo(bytes, (const char *) numbers, (int) size);
}

/* The geometry of these bytes. */
Datum
geometry_made(const GeometryType *type, StringInfo bytes)
{
	return ReceiveFunctionCall(unconstify(FmgrInfo *, &type->receive), bytes, type->type, -1);
}

/*
 * reader.h: one reading of a whole mesh, for the functions that return sets.
 */
#ifndef ABACUS_READER_H
#define ABACUS_READER_H

#include "pg/mesh/header.h"

typedef struct Reader
{
	Host	   *host;
	abacus_header header;
} Reader;

extern Reader *reader_open(Oid mesh, MemoryContext memory);
extern Reader *reader_open_of(Oid mesh, uint32 type, MemoryContext memory);

#endif

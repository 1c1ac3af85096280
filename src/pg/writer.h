/*
 * writer.h: one change of a mesh, from the lock on its header to the new
 * header.
 */
#ifndef ABACUS_WRITER_H
#define ABACUS_WRITER_H

#include "pg/header.h"

typedef struct Writer
{
	Host	   *host;
	abacus_header *header;
	ItemPointerData header_tid;
} Writer;

extern void writer_begin(Writer *writer, Oid mesh, const char *command);
extern void writer_end(Writer *writer);

#endif

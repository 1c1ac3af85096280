/*
 * writer.h: one change of a mesh, from the lock on its header to the new
 * header; or several, each in a transaction of its own:
 *
 *     writer_begin(); change; writer_store(); commit;
 *     writer_continue(); change; writer_store(); commit; ...
 *     writer_continue(); writer_close();
 */
#ifndef ABACUS_WRITER_H
#define ABACUS_WRITER_H

#include "pg/mesh/header.h"

typedef struct Writer
{
	Host	   *host;
	abacus_header *header;
	ItemPointerData header_tid;
	CommandId	began;			/* what commands before this one have done was there when it began */
} Writer;

extern void writer_prevent_read_only(Oid mesh, const char *command);
extern void writer_begin(Writer *writer, Oid mesh, MeshAccess access, const char *command);
extern void writer_begin_of(Writer *writer, Oid mesh, uint32 type, const char *command);
extern void writer_begin_moves(Writer *writer, Oid mesh, const char *command);
extern void writer_begin_in_trigger(Writer *writer, Oid mesh, const char *command);
extern void writer_store(Writer *writer);
extern void writer_release(Writer *writer);
extern void writer_continue(Writer *writer);
extern void writer_close(Writer *writer);
extern void writer_end(Writer *writer);

#endif

/*
 * reader.c: one reading of a whole mesh, for the functions that return sets.
 */
#include "postgres.h"

#include "access/table.h"
#include "utils/memutils.h"

#include "pg/mesh/reader.h"

/*
 * Opens a mesh for reading under the active snapshot. The reader lives in `memory`, and ends with
 * it; the caller releases the host before it returns to SQL.
 */
Reader *
reader_open(Oid mesh, MemoryContext memory)
{
	return reader_open_of(mesh, ABACUS_MESH, memory);
}

/* The same for another type, or for any. */
Reader *
reader_open_of(Oid mesh, uint32 type, MemoryContext memory)
{
	Relation	table = mesh_table_open_to_read(mesh);
	Reader	   *reader = MemoryContextAlloc(memory, sizeof(Reader));

	reader->host = mesh_host_create(memory, mesh, MESH_READ);
	mesh_pages(reader->host)->type = type;
	header_read(reader->host, &reader->header, NULL);
	table_close(table, NoLock);
	return reader;
}

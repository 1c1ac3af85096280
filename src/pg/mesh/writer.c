/*
 * writer.c: one change of a mesh.
 *
 * Writers of a mesh take turns by locking its header row; readers are never blocked.
 * The whole change happens inside one SQL call. When it returns, every page and the new
 * header are in the tables, under the command's own transaction. So savepoints,
 * rollback and crash recovery need no code of ours. A writer that commits in between
 * (abacus_build) makes each of its changes in this way.
 *
 * Waiting for another writer means that the snapshot taken before is too old to see
 * what that writer did. Under READ COMMITTED we then take a new snapshot and start
 * again, as a second statement would. Under the stricter levels it is a serialization
 * failure.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/tableam.h"
#include "access/xact.h"
#include "catalog/namespace.h"
#include "commands/tablecmds.h"
#include "miscadmin.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"

#include "pg/mesh/writer.h"

/* Locks the header row as the active snapshot sees it; false if it has changed since. */
static bool
lock_header(Host *host, ItemPointer tid)
{
	Relation	heap = mesh_pages(host)->simplices.heap;
	const char *name = type_name(mesh_pages(host)->type);
	TupleTableSlot *slot = table_slot_create(heap, NULL);
	TM_FailureData failure;
	TM_Result	result;

	result = table_tuple_lock(heap, tid, GetActiveSnapshot(), slot, GetCurrentCommandId(false),
							  LockTupleExclusive, LockWaitBlock, 0, &failure);
	ExecDropSingleTupleTableSlot(slot);
	switch (result)
	{
		case TM_Ok:
			return true;
		case TM_Updated:
		case TM_Deleted:
			if (IsolationUsesXactSnapshot())
				ereport(ERROR,
						(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
						 errmsg("could not serialize access due to concurrent update"),
						 errdetail("Another transaction has changed %s \"%s\".", name,
								   RelationGetRelationName(heap)),
						 errhint("The transaction might succeed if retried.")));
			return false;
		default:
			elog(ERROR, "unexpected result %d of locking the header of %s \"%s\"", result, name,
				 RelationGetRelationName(heap));
	}
	return false;
}

/*
 * Opens both tables, the second with all checks. While they are open, PostgreSQL does not let this
 * session alter or drop them. So the checks remain true, whatever the source query does.
 */
static void
open_tables(MeshPages *pages)
{
	page_table_open(&pages->simplices);
	mesh_pages_vertex_table(pages);
	page_table_open(&pages->vertices);
}

/*
 * Opens the tables, with all checks, locks the header and pushes an active
 * snapshot that sees it.
 */
static void
open_and_lock(Writer *writer, bool in_trigger)
{
	Host	   *host = writer->host;
	Relation	table = mesh_table_open(mesh_pages(host)->mesh, mesh_pages(host)->access);
	OwnSight	sight;

	/* also refuses a second writer inside the first one's source query */
	CheckTableNotInUse(table, mesh_pages(host)->type == ABACUS_OCTREE ? "change octree" : "change mesh");
	open_tables(mesh_pages(host));
	table_close(table, NoLock);

	/* before we have a snapshot of our own, which would not matter */
	own_sight_take(&sight, in_trigger);
	for (;;)
	{
		CommandCounterIncrement();
		PushCopiedSnapshot(GetTransactionSnapshot());
		header_read(host, writer->header, &writer->header_tid);
		if (lock_header(host, &writer->header_tid))
			break;
		host_release(host);
		PopActiveSnapshot();
		open_tables(mesh_pages(host));
	}
	/* otherwise the snapshot is newer than our lock on the vertex table */
	if (IsolationUsesXactSnapshot())
		header_open_vertices(host, &writer->header->facts);
	if (mesh_pages(host)->simplices.superseded == NULL)
		mesh_pages(host)->simplices.superseded = superseded_of_session(mesh_pages(host)->simplices.heap);
	superseded_reclaim_earlier(mesh_pages(host)->simplices.superseded, mesh_pages(host)->simplices.heap, &sight);
}

/*
 * A temporary mesh may be changed in a read-only transaction, as INSERT may change a
 * temporary table.
 */
void
writer_prevent_read_only(Oid mesh, const char *command)
{
	if (!isTempNamespace(get_rel_namespace(mesh)))
		PreventCommandIfReadOnly(command);
}

static void
begin(Writer *writer, Oid mesh, MeshAccess access, uint32 type, const char *command,
	  bool in_trigger)
{
	writer_prevent_read_only(mesh, command);
	PreventCommandIfParallelMode(command);

	writer->host = mesh_host_create(CurrentMemoryContext, mesh, access);
	mesh_pages(writer->host)->type = type;
	writer->header = MemoryContextAlloc(writer->host->home, sizeof(abacus_header));
	open_and_lock(writer, in_trigger);
	writer->began = GetActiveSnapshot()->curcid;
	progress_begin(&writer->host->progress, mesh);
}

/*
 * Opens a mesh for changing, with its header locked and an active snapshot that sees it.
 * `command` names the function for messages. The writer lives in the current memory context.
 */
void
writer_begin(Writer *writer, Oid mesh, MeshAccess access, const char *command)
{
	begin(writer, mesh, access, ABACUS_MESH, command, false);
}

/* The same for another type, or for any. */
void
writer_begin_of(Writer *writer, Oid mesh, uint32 type, const char *command)
{
	begin(writer, mesh, MESH_WRITE, type, command, false);
}

/* Opens a mesh or an octree for moving its rows. */
void
writer_begin_moves(Writer *writer, Oid mesh, const char *command)
{
	begin(writer, mesh, MESH_MOVE, ANY_TYPE, command, false);
}

/*
 * Opens a mesh for changing in a function that is called as a trigger. There, more is known about
 * snapshots.
 */
void
writer_begin_in_trigger(Writer *writer, Oid mesh, const char *command)
{
	begin(writer, mesh, MESH_WRITE, ABACUS_MESH, command, true);
}

/*
 * Releases the tables and the snapshot, which must happen before a transaction can end. Either
 * nothing has changed, or the header has been written.
 */
void
writer_release(Writer *writer)
{
	host_release(writer->host);
	PopActiveSnapshot();
}

/* Writes the header: the change is complete and may be committed. */
void
writer_store(Writer *writer)
{
	header_update(writer->host, writer->header, &writer->header_tid);
	writer_release(writer);
}

/*
 * After writer_store() or writer_release(), and a commit: opens the mesh for the next change. The
 * core's data about the mesh are still true if a lock of the session (mesh.h) has kept others from
 * changing it meanwhile.
 */
void
writer_continue(Writer *writer)
{
	mesh_pages(writer->host)->vertices.relid = InvalidOid;	/* may be gone: look again */
	open_and_lock(writer, false);
}

static void
destroy(Writer *writer)
{
	progress_end(&writer->host->progress);
	host_destroy(writer->host);
	writer->host = NULL;
}

/* Closes the mesh without a change. */
void
writer_close(Writer *writer)
{
	writer_release(writer);
	destroy(writer);
}

/* Writes the header and closes the mesh. */
void
writer_end(Writer *writer)
{
	writer_store(writer);
	destroy(writer);
}

/*
 * vacuum_moves.c: moves the rows of vacuumed meshes to the beginning of their tables.
 *
 * Rows are moved only if the file will be cut, so not if the table's settings keep VACUUM from
 * cutting it. Users who may vacuum a table may have its rows moved: that neither shows nor changes
 * the rows, and calls no function of a user.
 *
 * The moves never wait: a mesh that someone is changing stays as it is. For a mesh without much
 * empty space, the cost is reading a sample of its heap pages.
 *
 * The moves are transactions of their own. One that fails is rolled back, as in autovacuum, and the
 * failure becomes a warning. A cancel remains an error. We are at the outermost level, so only our
 * own transaction is aborted.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/xact.h"
#include "catalog/pg_am.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "nodes/makefuncs.h"
#include "storage/lmgr.h"
#include "tcop/pquery.h"
#include "utils/acl.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/port/port.h"
#include "pg/space/compact.h"
#include "pg/space/vacuum_moves.h"

/* Whether the user may VACUUM the table; false if it no longer exists. */
static bool
may_vacuum(Oid relid)
{
	return SearchSysCacheExists1(RELOID, ObjectIdGetDatum(relid)) &&
		(port_may_maintain(relid, GetUserId()) ||
		 object_ownercheck(DatabaseRelationId, MyDatabaseId, GetUserId()));
}

/* Whether VACUUM would leave the table's file as it is. */
static bool
is_spared(Relation rel, const VacuumOptions *options)
{
	const StdRdOptions *settings = (const StdRdOptions *) rel->rd_options;

	return rel->rd_rel->relam != HEAP_TABLE_AM_OID || RELATION_IS_OTHER_TEMP(rel) ||
		(!options->truncate && !port_vacuum_truncates(rel)) ||
		(settings != NULL && !options->index_cleanup &&
		 settings->vacuum_index_cleanup == STDRD_OPTION_VACUUM_INDEX_CLEANUP_OFF);
}

/* Whether moving the rows of this table is worth it and allowed. */
static bool
is_wanted(Oid relid, const VacuumOptions *options)
{
	Relation	rel;
	bool		wanted;

	if (!OidIsValid(relid) || !ConditionalLockRelationOid(relid, AccessShareLock))
		return false;
	rel = try_relation_open(relid, NoLock);
	if (rel == NULL)
	{
		UnlockRelationOid(relid, AccessShareLock);
		return false;
	}
	wanted = may_vacuum(relid) && !is_spared(rel, options) && compact_is_worthwhile(rel);
	relation_close(rel, AccessShareLock);
	return wanted;
}

static char *
full_name(Oid relid)
{
	return psprintf("%s.%s", get_namespace_name(get_rel_namespace(relid)), get_rel_name(relid));
}

/* Moves rows, under locks that keep others from the mesh. Returns how many. */
static uint64
move_rows(const VacuumJob *job, MemoryContext memory)
{
	Writer		writer;
	uint64		moved;

	SPI_connect_ext(SPI_OPT_NONATOMIC);
	MemoryContextSwitchTo(memory);
	SPI_commit();				/* the next snapshot sees what was done before the lock */
	writer_begin_moves(&writer, job->mesh, "VACUUM");
	moved = compact(&writer, OidIsValid(job->simplices), OidIsValid(job->vertices));
	writer_close(&writer);
	SPI_commit();
	SPI_finish();
	return moved;
}

/*
 * Moves the rows of one mesh, if that is worth it and no one has it locked. Returns whether the
 * tables are due: even if no row had to move, VACUUM has postponed the work before the cut.
 */
static bool
move_mesh(VacuumJob *job, const VacuumOptions *options, MemoryContext memory)
{
	int			level = options->verbose ? INFO : DEBUG2;
	MeshLocks	locks;
	uint64		moved;

	EnsurePortalSnapshotExists();
	if (!is_wanted(job->simplices, options))
		job->simplices = InvalidOid;
	if (!is_wanted(job->vertices, options))
		job->vertices = InvalidOid;
	/* the header is in the simplex table, and is always written */
	if ((!OidIsValid(job->simplices) && !OidIsValid(job->vertices)) || !may_vacuum(job->mesh))
		return false;
	if (!mesh_try_lock_for_session(job->mesh, OidIsValid(job->vertices), &locks))
	{
		ereport(level,
				(errmsg("pages of mesh \"%s\" are not moved, since the mesh is locked",
						full_name(job->mesh))));
		return false;
	}
	moved = move_rows(job, memory);
	mesh_unlock_for_session(&locks);
	if (moved > 0)
		ereport(level,
				(errmsg_plural("moved %llu page of mesh \"%s\" to the beginning of its table",
							   "moved %llu pages of mesh \"%s\" to the beginning of its table",
							   (unsigned long) moved, (unsigned long long) moved,
							   full_name(job->mesh))));
	return true;
}

/*
 * After an error: rolls the transaction back, which releases all locks, and reports the error as a
 * warning. Cancels are thrown again.
 */
static void
give_up(const VacuumJob *job, MemoryContext memory)
{
	ErrorData  *error;

	MemoryContextSwitchTo(memory);
	error = CopyErrorData();
	if (error->sqlerrcode == ERRCODE_QUERY_CANCELED)
		PG_RE_THROW();
	FlushErrorState();
	AbortCurrentTransaction();
	ActivePortal->portalSnapshot = NULL;	/* gone with the transaction */
	StartTransactionCommand();
	MemoryContextSwitchTo(memory);
	ereport(WARNING,
			(errcode(error->sqlerrcode),
			 errmsg("could not move pages of mesh \"%s\"", full_name(job->mesh)),
			 errdetail_internal("%s", error->message),
			 error->hint != NULL ? errhint("%s", error->hint) : 0));
}

/* Moves the rows of meshes. Returns the tables to vacuum again. */
List *
vacuum_move_meshes(List *jobs, const VacuumOptions *options, MemoryContext home)
{
	MemoryContext memory = AllocSetContextCreate(home, "Abacus moves", ALLOCSET_DEFAULT_SIZES);
	List	   *volatile tables = NIL;
	ListCell   *cell;

	foreach(cell, jobs)
	{
		VacuumJob  *job = lfirst(cell);

		CHECK_FOR_INTERRUPTS();
		MemoryContextSwitchTo(memory);
		PG_TRY();
		{
			bool		again = move_mesh(job, options, memory);

			MemoryContextSwitchTo(home);
			if (again && OidIsValid(job->simplices))
				tables = lappend(tables, makeVacuumRelation(NULL, job->simplices, NIL));
			if (again && OidIsValid(job->vertices))
				tables = lappend(tables, makeVacuumRelation(NULL, job->vertices, NIL));
		}
		PG_CATCH();
		{
			give_up(job, memory);
		}
		PG_END_TRY();
		MemoryContextSwitchTo(home);
		MemoryContextReset(memory);
	}
	return tables;
}

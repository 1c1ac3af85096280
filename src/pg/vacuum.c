/*
 * vacuum.c: VACUUM of a mesh gives its space back.
 *
 * VACUUM cuts a file behind the last row, and a mesh that was changed all over
 * has rows everywhere (compact.c). So in a session that has this module loaded,
 * VACUUM is followed by what abacus_build does at its end, where that is worth
 * it: rows are moved to the beginning of their tables. Then these tables are
 * vacuumed again, which removes what the moves have left from the indexes, and
 * cuts the files. What is still seen by somebody keeps its place until a later one.
 *
 * Not before VACUUM, once, for two reasons. Statements that change few points
 * leave a few hundred dead line pointers on each heap page, so that no row fits,
 * and to remove them is VACUUM's alone. And nothing that happens here can
 * keep VACUUM from its work: what it refuses it has refused.
 *
 * Only where a file will be cut, so not if the statement or the table's settings
 * keep VACUUM from it. Who may vacuum a table may have its rows moved: neither
 * shows or changes anything of them, and no function of a user is called.
 *
 * Nothing is waited for: a mesh that somebody is changing stays as it is. Of one
 * without much empty space no more is seen than a sample of its heap pages. The
 * moves are transactions of their own. One that fails is taken back whole, as
 * autovacuum does it, and the failure becomes a warning; a cancel is an error.
 *
 * VACUUM ends in a fresh transaction, and so do we. The statement may belong to a
 * plan that an aborted transaction lets go; so it is copied.
 *
 * The workers of autovacuum run no statement, so they do not come by here.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/relation.h"
#include "access/table.h"
#include "access/xact.h"
#include "access/xlog.h"
#include "catalog/namespace.h"
#include "catalog/pg_am.h"
#include "catalog/pg_class.h"
#include "commands/defrem.h"
#include "commands/extension.h"
#include "commands/vacuum.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "nodes/makefuncs.h"
#include "parser/parse_node.h"
#include "storage/lmgr.h"
#include "tcop/pquery.h"
#include "tcop/utility.h"
#include "utils/acl.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/compact.h"
#include "pg/settings.h"
#include "pg/vacuum.h"

/* What the statement says about all tables. */
typedef struct Options
{
	bool		verbose;
	bool		truncate;		/* said to be on: the tables' settings do not count */
	bool		index_cleanup;	/* likewise */
} Options;

/* A mesh, and its tables as far as they are vacuumed, else InvalidOid. */
typedef struct Job
{
	Oid			mesh;
	Oid			simplices;
	Oid			vertices;
} Job;

static ProcessUtility_hook_type previous_hook = NULL;

/* ---- What is asked for ---------------------------------------------------- */

/* Reads INDEX_CLEANUP; false if it is off. */
static bool
is_index_cleanup_on(DefElem *option)
{
	return option->arg == NULL || pg_strcasecmp(defGetString(option), "auto") == 0 ||
		defGetBoolean(option);
}

/* Reads the options of a VACUUM that went well; false if it cannot cut files, or has no need to. */
static bool
read_options(const VacuumStmt *statement, Options *options)
{
	ListCell   *cell;
	bool		cuts = true;

	MemSet(options, 0, sizeof(*options));
	foreach(cell, statement->options)
	{
		DefElem    *option = lfirst_node(DefElem, cell);

		if (strcmp(option->defname, "verbose") == 0)
			options->verbose = defGetBoolean(option);
		else if (strcmp(option->defname, "truncate") == 0)
			cuts = options->truncate = defGetBoolean(option);
		else if (strcmp(option->defname, "index_cleanup") == 0)
			cuts = options->index_cleanup = is_index_cleanup_on(option);
		else if (strcmp(option->defname, "full") == 0)
			cuts = !defGetBoolean(option);
		if (!cuts)
			return false;
	}
	return true;
}

/*
 * The statement for the tables that have been moved: without ANALYZE, and with
 * INDEX_CLEANUP, else VACUUM puts off what concerns few heap pages.
 */
static VacuumStmt *
vacuum_again(const VacuumStmt *statement)
{
	VacuumStmt *again = makeNode(VacuumStmt);
	ListCell   *cell;

	again->is_vacuumcmd = true;
	foreach(cell, statement->options)
	{
		DefElem    *option = lfirst_node(DefElem, cell);

		if (strcmp(option->defname, "analyze") != 0 &&
			strcmp(option->defname, "index_cleanup") != 0)
			again->options = lappend(again->options, copyObject(option));
	}
	again->options = lappend(again->options,
							 makeDefElem("index_cleanup", (Node *) makeString("on"), -1));
	return again;
}

/* Adds a table, if it is one of a mesh. */
static List *
add_table(List *jobs, Oid relid)
{
	Oid			mesh = mesh_of_table(relid);
	Job		   *job = NULL;
	ListCell   *cell;

	if (!OidIsValid(mesh))
		return jobs;
	foreach(cell, jobs)
		if (((Job *) lfirst(cell))->mesh == mesh)
			job = lfirst(cell);
	if (job == NULL)
	{
		job = palloc0(sizeof(Job));
		job->mesh = mesh;
		jobs = lappend(jobs, job);
	}
	*(relid == mesh ? &job->simplices : &job->vertices) = relid;
	return jobs;
}

/* All meshes of the database. */
static List *
all_meshes(void)
{
	Relation	classes = table_open(RelationRelationId, AccessShareLock);
	TableScanDesc scan = table_beginscan_catalog(classes, 0, NULL);
	List	   *jobs = NIL;
	HeapTuple	tuple;

	while ((tuple = heap_getnext(scan, ForwardScanDirection)) != NULL)
	{
		Form_pg_class form = (Form_pg_class) GETSTRUCT(tuple);

		if (OidIsValid(form->reloftype) && mesh_of_table(form->oid) == form->oid)
		{
			Job		   *job = palloc(sizeof(Job));

			job->mesh = job->simplices = form->oid;
			job->vertices = mesh_find_vertex_table(form->oid);
			jobs = lappend(jobs, job);
		}
	}
	table_endscan(scan);
	table_close(classes, AccessShareLock);
	return jobs;
}

/* The meshes that a VACUUM was about, in the current memory context. */
static List *
find_jobs(const VacuumStmt *statement)
{
	List	   *jobs = NIL;
	ListCell   *cell;

	if (statement->rels == NIL)
		return all_meshes();
	foreach(cell, statement->rels)
	{
		VacuumRelation *named = lfirst_node(VacuumRelation, cell);

		jobs = add_table(jobs, OidIsValid(named->oid) ? named->oid :
						 RangeVarGetRelid(named->relation, NoLock, true));
	}
	return jobs;
}

/* ---- Whether it is done --------------------------------------------------- */

/* Whether VACUUM has refused the table, or would leave its file as it is. */
static bool
is_spared(Relation rel, const Options *options)
{
	const StdRdOptions *settings = (const StdRdOptions *) rel->rd_options;
	bool		owner = pg_class_ownercheck(RelationGetRelid(rel), GetUserId()) ||
		pg_database_ownercheck(MyDatabaseId, GetUserId());

	return !owner || rel->rd_rel->relam != HEAP_TABLE_AM_OID || RELATION_IS_OTHER_TEMP(rel) ||
		(settings != NULL && !options->truncate && !settings->vacuum_truncate) ||
		(settings != NULL && !options->index_cleanup &&
		 settings->vacuum_index_cleanup == STDRD_OPTION_VACUUM_INDEX_CLEANUP_OFF);
}

/* Whether the rows of this table are worth moving, and may be. */
static bool
is_wanted(Oid relid, const Options *options)
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
	wanted = !is_spared(rel, options) && compact_is_worthwhile(rel);
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
move_rows(const Job *job, MemoryContext memory)
{
	Writer		writer;
	uint64		moved;

	SPI_connect_ext(SPI_OPT_NONATOMIC);
	MemoryContextSwitchTo(memory);
	SPI_commit();				/* the next snapshot sees what was done before the lock */
	writer_begin(&writer, job->mesh, MESH_MOVE, "VACUUM");
	moved = compact(&writer, OidIsValid(job->simplices), OidIsValid(job->vertices));
	writer_close(&writer);
	SPI_commit();
	SPI_finish();
	return moved;
}

/*
 * Moves the rows of one mesh, if that is worth it and nobody is in the way. Returns
 * whether; where none had to be moved, VACUUM has put off what is before the cut.
 */
static bool
move_mesh(Job *job, const Options *options, MemoryContext memory)
{
	int			level = options->verbose ? INFO : DEBUG2;
	MeshLocks	locks;
	uint64		moved;

	EnsurePortalSnapshotExists();
	if (!is_wanted(job->simplices, options))
		job->simplices = InvalidOid;
	if (!is_wanted(job->vertices, options))
		job->vertices = InvalidOid;
	if (!OidIsValid(job->simplices) && !OidIsValid(job->vertices))
		return false;
	if (!mesh_try_lock_for_session(job->mesh, OidIsValid(job->vertices), &locks))
	{
		ereport(level,
				(errmsg("pages of mesh \"%s\" are not moved, since somebody has it locked",
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
 * After an error: takes the transaction back, which gives up all locks, and says
 * what was wrong. Cancels go on.
 */
static void
give_up(const Job *job, MemoryContext memory)
{
	ErrorData  *error;

	MemoryContextSwitchTo(memory);
	error = CopyErrorData();
	if (error->sqlerrcode == ERRCODE_QUERY_CANCELED)
		PG_RE_THROW();
	FlushErrorState();
	AbortCurrentTransaction();
	ActivePortal->portalSnapshot = NULL;	/* went with the transaction */
	StartTransactionCommand();
	MemoryContextSwitchTo(memory);
	ereport(WARNING,
			(errcode(error->sqlerrcode),
			 errmsg("could not move pages of mesh \"%s\"", full_name(job->mesh)),
			 errdetail_internal("%s", error->message),
			 error->hint != NULL ? errhint("%s", error->hint) : 0));
}

/* ---- The hook ------------------------------------------------------------- */

/* Moves the rows of meshes. Returns the tables that are to be vacuumed again. */
static List *
move_meshes(List *jobs, const Options *options, MemoryContext home)
{
	MemoryContext memory = AllocSetContextCreate(home, "Abacus moves", ALLOCSET_DEFAULT_SIZES);
	List	   *volatile tables = NIL;
	ListCell   *cell;

	foreach(cell, jobs)
	{
		Job		   *job = lfirst(cell);

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

/* After a VACUUM that went well. */
static void
after_vacuum(const VacuumStmt *statement, const char *query)
{
	/* goes with the portal */
	MemoryContext home = AllocSetContextCreate(PortalContext, "Abacus vacuum",
											   ALLOCSET_SMALL_SIZES);
	Options		options;
	VacuumStmt *again;
	List	   *jobs;

	MemoryContextSwitchTo(home);
	if (!read_options(statement, &options) || (jobs = find_jobs(statement)) == NIL)
		return;
	again = vacuum_again(statement);
	again->rels = move_meshes(jobs, &options, home);
	if (again->rels != NIL)
	{
		ParseState *state = make_parsestate(NULL);

		state->p_sourcetext = query;
		/* not by the hooks: it is one statement */
		ExecVacuum(state, again, true);
	}
}

/* Whether tables of meshes may be looked at. */
static bool
is_due(void)
{
	return setting_vacuum_moves_rows() && !XactReadOnly && !RecoveryInProgress() &&
		old_snapshot_threshold < 0 &&	/* else VACUUM cuts no file */
		OidIsValid(get_extension_oid("abacus", true));
}

static void
process_utility(PlannedStmt *planned, const char *query, bool read_only_tree,
				ProcessUtilityContext context, ParamListInfo params,
				QueryEnvironment *environment, DestReceiver *destination,
				QueryCompletion *completion)
{
	VacuumStmt *statement = NULL;

	if (context == PROCESS_UTILITY_TOPLEVEL && IsA(planned->utilityStmt, VacuumStmt) &&
		ActivePortal != NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(PortalContext);	/* outlives transactions */

		statement = copyObject(castNode(VacuumStmt, planned->utilityStmt));
		MemoryContextSwitchTo(old);
	}
	(previous_hook != NULL ? previous_hook : standard_ProcessUtility)
		(planned, query, read_only_tree, context, params, environment, destination, completion);
	if (statement != NULL && statement->is_vacuumcmd && is_due())
		after_vacuum(statement, query);
}

void
vacuum_init(void)
{
	previous_hook = ProcessUtility_hook;
	ProcessUtility_hook = process_utility;
}

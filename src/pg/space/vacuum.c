/*
 * vacuum.c: lets VACUUM of a mesh give back its space.
 *
 * VACUUM cuts a file behind the last row, and a mesh that was changed all over has rows everywhere
 * (compact.c). So in a session that has loaded this module, a VACUUM is followed by more work if it
 * pays. Rows are moved to the beginning of their tables (vacuum_moves.c), as at the end of
 * abacus_build. Then these tables are vacuumed again, which removes the old index entries of the
 * moved rows and cuts the files. Rows that a snapshot still sees keep their places until a later
 * VACUUM.
 *
 * Moving rows before a single VACUUM would not do, for two reasons. Statements that change few
 * points leave a hundred or more dead line pointers on each heap page, so that no row fits. Only
 * VACUUM removes them. And a failure here cannot disturb VACUUM, which has already finished.
 *
 * VACUUM ends in a fresh transaction, and so do we. An aborted transaction may release the plan
 * that the statement belongs to, so the statement is copied.
 *
 * Autovacuum workers run no statement, so they do not get here.
 */
#include "postgres.h"

#include "access/heapam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "access/xact.h"
#include "access/xlog.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "commands/defrem.h"
#include "commands/extension.h"
#include "commands/vacuum.h"
#include "miscadmin.h"
#include "nodes/makefuncs.h"
#include "parser/parse_node.h"
#include "tcop/pquery.h"
#include "tcop/utility.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/base/settings.h"
#include "pg/mesh/mesh.h"
#include "pg/port/port.h"
#include "pg/port/shortcuts.h"
#include "pg/space/vacuum.h"
#include "pg/space/vacuum_moves.h"

static ProcessUtility_hook_type previous_hook = NULL;

/* ---- Options and tables ----------------------------------------------------- */

/* Reads INDEX_CLEANUP; false if it is off. */
static bool
is_index_cleanup_on(DefElem *option)
{
	return option->arg == NULL || pg_strcasecmp(defGetString(option), "auto") == 0 ||
		defGetBoolean(option);
}

/* Reads the options of a VACUUM that has succeeded; false if it cannot cut files, or need not. */
static bool
read_options(const VacuumStmt *statement, VacuumOptions *options)
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
 * The statement for the tables whose rows were moved: without ANALYZE, and with INDEX_CLEANUP,
 * since otherwise VACUUM postpones work that concerns few heap pages.
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

/* Adds a table, if it belongs to a mesh. */
static List *
add_table(List *jobs, Oid relid)
{
	Oid			mesh = mesh_of_table(relid);
	VacuumJob  *job = NULL;
	ListCell   *cell;

	if (!OidIsValid(mesh))
		return jobs;
	foreach(cell, jobs)
		if (((VacuumJob *) lfirst(cell))->mesh == mesh)
			job = lfirst(cell);
	if (job == NULL)
	{
		job = palloc0(sizeof(VacuumJob));
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
			VacuumJob  *job = palloc(sizeof(VacuumJob));

			job->mesh = job->simplices = form->oid;
			job->vertices = mesh_find_vertex_table(form->oid);
			jobs = lappend(jobs, job);
		}
	}
	table_endscan(scan);
	table_close(classes, AccessShareLock);
	return jobs;
}

/* The meshes of a VACUUM, in the current memory context. */
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

/* ---- The hook ------------------------------------------------------------- */

/* Runs after a VACUUM that has succeeded. */
static void
after_vacuum(const VacuumStmt *statement, const char *query)
{
	/* freed with the portal */
	MemoryContext home = AllocSetContextCreate(PortalContext, "Abacus vacuum",
											   ALLOCSET_SMALL_SIZES);
	VacuumOptions options;
	VacuumStmt *again;
	List	   *jobs;

	MemoryContextSwitchTo(home);
	if (!read_options(statement, &options) || (jobs = find_jobs(statement)) == NIL)
		return;
	again = vacuum_again(statement);
	again->rels = vacuum_move_meshes(jobs, &options, home);
	if (again->rels != NIL)
	{
		ParseState *state = make_parsestate(NULL);

		state->p_sourcetext = query;
		/* without the hooks: it is one statement */
		ExecVacuum(state, again, true);
	}
}

/* Whether to look at tables of meshes. */
static bool
is_due(void)
{
	return setting_vacuum_moves_rows() && !XactReadOnly && !RecoveryInProgress() &&
		!port_snapshots_may_be_too_old() &&	/* otherwise VACUUM cuts no file */
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
	if (!ABACUS_SHORTCUTS)
		return;
	previous_hook = ProcessUtility_hook;
	ProcessUtility_hook = process_utility;
}

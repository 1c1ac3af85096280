/*
 * pending.c: the changes that meshes which follow at commit still have to make.
 *
 * Statements note the points that they have added and removed in a log, one for each mesh. Before
 * the transaction commits, or is prepared, each mesh is changed once: first all new points are
 * inserted, then those that are gone are deleted, so every deleted point is there, old or new. By
 * then deferred constraints have been checked and deferred triggers have fired, so these may still
 * change tables. An error ends the transaction like an error of theirs. Meshes are changed in the
 * order of their OIDs, and a transaction that has locked one of them no longer waits for rows.
 *
 * A rollback to a savepoint removes all later notes. When a nested transaction first changes the
 * notes of a mesh, it saves the state before; when it commits, it leaves this state to the one
 * around it, unless that has saved its own.
 *
 * After SET CONSTRAINTS ALL IMMEDIATE all meshes catch up. From then on each statement changes the
 * meshes that follow, until the end of the transaction or SET CONSTRAINTS ALL DEFERRED.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "miscadmin.h"
#include "tcop/utility.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/track/in_step.h"
#include "pg/track/pending.h"
#include "pg/track/point_log.h"

/* Points read from the log at once. */
#define POINTS_A_BATCH 1024

/* The part of a log that counts. */
typedef struct Extent
{
	uint64		start;			/* in bytes */
	uint64		end;
	uint64		came;			/* points */
	uint64		went;
} Extent;

/* The state that a nested transaction found. */
typedef struct Saved
{
	SubTransactionId of;
	Extent		extent;
} Saved;

struct Pending
{
	Oid			mesh;
	Oid			user;			/* whose rights are used to change it */
	char	   *table;			/* for messages, like the trigger */
	char	   *trigger;
	ExpectedShape shape;		/* of the mesh */
	uint32		srid;			/* of the mesh, or of the noted geometries; 0: none */
	PointLog   *log;
	Extent		extent;
	List	   *saved;			/* the innermost transaction's first */
	Pending    *next;
};

/* Both in TopTransactionContext. */
static Pending *all = NULL;
static List *immediate_saved = NIL;

/* SET CONSTRAINTS ALL IMMEDIATE holds */
static bool immediate = false;

/* ---- Notes of statements ------------------------------------------------- */

/* The SRID of a mesh as the statement sees it. */
static uint32
srid_of_mesh(Oid mesh)
{
	Host	   *host = mesh_host_create(CurrentMemoryContext, mesh, MESH_WRITE);
	abacus_header *header = palloc(sizeof(abacus_header));
	uint32		srid;

	header_read(host, header, NULL);
	srid = header->facts.form.srid;
	host_release(host);
	host_destroy(host);
	pfree(header);
	return srid;
}

/*
 * Raises an error now, and not at commit, if the mesh cannot be changed with the rights of this
 * user. It stays locked as by any writer. Otherwise DROP TABLE could lock it, and then wait for the
 * table, which we have locked. Returns the SRID of the mesh if it is wanted.
 */
static uint32
check_mesh(Oid mesh, Oid user, bool wants_srid)
{
	Oid			current;
	int			security;
	uint32		srid = 0;

	GetUserIdAndSecContext(&current, &security);
	SetUserIdAndSecContext(user, security | SECURITY_LOCAL_USERID_CHANGE);
	table_close(mesh_table_open(mesh, MESH_WRITE), NoLock);
	if (wants_srid)
		srid = srid_of_mesh(mesh);
	SetUserIdAndSecContext(current, security);
	return srid;
}

/* The notes of a mesh that is changed with the rights of this user. */
Pending *
pending_open(Oid mesh, Oid user, const TriggerData *trigger, const Transition *transition)
{
	Pending    *pending = all;
	uint32		srid = check_mesh(mesh, user, transition->inputs < transition->columns);
	MemoryContext old;

	while (pending != NULL && !(pending->mesh == mesh && pending->user == user &&
								pending->shape.dimension == transition->dimension &&
								pending->shape.columns == transition->columns &&
								pending->shape.dropped == transition->dropped))
		pending = pending->next;
	if (pending != NULL)
	{
		pending_take_srid(pending, (int32) srid);
		return pending;
	}
	old = MemoryContextSwitchTo(TopTransactionContext);
	pending = palloc0(sizeof(Pending));
	pending->mesh = mesh;
	pending->user = user;
	pending->table = pstrdup(RelationGetRelationName(trigger->tg_relation));
	pending->trigger = pstrdup(trigger->tg_trigger->tgname);
	pending->shape = transition_expected(transition);
	pending->srid = srid;
	pending->log = point_log_create(TopTransactionContext);
	pending->next = all;
	all = pending;
	MemoryContextSwitchTo(old);
	return pending;
}

/* The SRID of the mesh or of the noted geometries; 0: none or unknown. */
uint32
pending_srid(const Pending *pending)
{
	return pending->srid;
}

/* A mesh without SRID will take that of the noted geometries; -1: there are none. */
void
pending_take_srid(Pending *pending, int32 srid)
{
	if (srid > 0)
		pending->srid = (uint32) srid;
}

/* To be called before the extent changes. */
static void
save_extent(Pending *pending)
{
	SubTransactionId current = GetCurrentSubTransactionId();
	MemoryContext old;
	Saved	   *saved;

	if (current == TopSubTransactionId ||
		(pending->saved != NIL && ((Saved *) linitial(pending->saved))->of == current))
		return;
	old = MemoryContextSwitchTo(TopTransactionContext);
	saved = palloc(sizeof(Saved));
	saved->of = current;
	saved->extent = pending->extent;
	pending->saved = lcons(saved, pending->saved);
	MemoryContextSwitchTo(old);
}

/* Notes points that are new, or gone. */
void
pending_add(Pending *pending, bool gone, const uint64 *points, size_t count)
{
	size_t		point_bytes = pending->shape.columns * sizeof(uint64);
	uint64		sign = gone;

	save_extent(pending);
	for (size_t i = 0; i < count; i++)
	{
		point_log_write(pending->log, pending->extent.end, &sign, sizeof(sign));
		pending->extent.end += sizeof(sign);
		point_log_write(pending->log, pending->extent.end, points + i * pending->shape.columns, point_bytes);
		pending->extent.end += point_bytes;
	}
	*(gone ? &pending->extent.went : &pending->extent.came) += count;
}

static void
forget(Pending *pending)
{
	save_extent(pending);
	pending->extent.start = pending->extent.end;
	pending->extent.came = pending->extent.went = 0;
}

/* The mesh has been emptied, and so has its table. */
void
pending_forget(Oid mesh)
{
	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (pending->mesh == mesh)
			forget(pending);
}

/* ---- Catching up --------------------------------------------------------- */

/* Stages the points that are new, or those that are gone. */
static void
stage(Pending *pending, bool gone, Change *change)
{
	size_t		words = 1 + pending->shape.columns;
	uint64	   *records = palloc(POINTS_A_BATCH * words * sizeof(uint64));
	uint64	   *points = palloc(POINTS_A_BATCH * pending->shape.columns * sizeof(uint64));
	uint64		at = pending->extent.start;

	change_open_stage(change, &change->writer.header->facts);
	while (at < pending->extent.end)
	{
		size_t		size = Min(POINTS_A_BATCH * words * sizeof(uint64), pending->extent.end - at);
		size_t		count = 0;

		CHECK_FOR_INTERRUPTS();
		point_log_read(pending->log, at, records, size);
		at += size;
		for (const uint64 *record = records; record < records + size / sizeof(uint64); record += words)
			if (record[0] == (uint64) gone)
				memcpy(points + count++ * pending->shape.columns, record + 1,
					   pending->shape.columns * sizeof(uint64));
		if (count > 0)
			change_add(change, points, count);
	}
	pfree(records);
	pfree(points);
}

static void
change_mesh(Pending *pending)
{
	Change	   *change = change_begin(pending->mesh, "abacus_track()");

	in_step_check_shape(change, pending->shape, pending->trigger);
	in_step_check_srid(change, (int32) pending->srid);
	change_hold(change);
	if (pending->extent.came > 0)
	{
		stage(pending, false, change);
		change_insert(change);
	}
	if (pending->extent.went > 0)
	{
		stage(pending, true, change);
		in_step_check_found(change, pending->table, "delete", pending->extent.went,
							change_delete(change, true));
	}
	change_settle(change);
	change_end(change);
}

/* Applies the notes to the mesh. */
static void
catch_up(Pending *pending)
{
	MemoryContext memory = AllocSetContextCreate(TopTransactionContext, "Abacus deferred change",
												 ALLOCSET_DEFAULT_SIZES);
	MemoryContext old = MemoryContextSwitchTo(memory);
	Oid			user;
	int			security;

	GetUserIdAndSecContext(&user, &security);
	SetUserIdAndSecContext(pending->user, security | SECURITY_LOCAL_USERID_CHANGE);
	/* if it was dropped meanwhile, it need not follow */
	if (SearchSysCacheExists1(RELOID, ObjectIdGetDatum(pending->mesh)))
		change_mesh(pending);
	SetUserIdAndSecContext(user, security);
	forget(pending);
	MemoryContextSwitchTo(old);
	MemoryContextDelete(memory);
}

/* The mesh with the least OID that has notes; only `mesh`, if it is valid. */
static Pending *
next_behind(Oid mesh)
{
	Pending    *found = NULL;

	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (pending->extent.came + pending->extent.went > 0 &&
			(!OidIsValid(mesh) || pending->mesh == mesh) &&
			(found == NULL || pending->mesh < found->mesh))
			found = pending;
	return found;
}

/* Lets the mesh catch up with its table now; given InvalidOid, all meshes. */
void
pending_settle(Oid mesh)
{
	Pending    *pending;

	while ((pending = next_behind(mesh)) != NULL)
		catch_up(pending);
}

static void
close_all(void)
{
	for (Pending *pending = all; pending != NULL; pending = pending->next)
		point_log_close(pending->log);
	all = NULL;
}

/* ---- SET CONSTRAINTS ----------------------------------------------------- */

static ProcessUtility_hook_type previous_hook = NULL;

/* Whether each statement changes the meshes, though they follow at commit. */
bool
pending_is_immediate(void)
{
	return immediate;
}

typedef struct SavedMode
{
	SubTransactionId of;
	bool		immediate;
} SavedMode;

static void
set_immediate(bool now)
{
	MemoryContext old = MemoryContextSwitchTo(TopTransactionContext);
	SavedMode  *saved = palloc(sizeof(SavedMode));

	saved->of = GetCurrentSubTransactionId();
	saved->immediate = immediate;
	immediate_saved = lcons(saved, immediate_saved);
	immediate = now;
	MemoryContextSwitchTo(old);
}

static void
process_utility(PlannedStmt *planned, const char *query, bool read_only_tree,
				ProcessUtilityContext context, ParamListInfo params,
				QueryEnvironment *environment, DestReceiver *destination,
				QueryCompletion *completion)
{
	bool		is_about_all = IsA(planned->utilityStmt, ConstraintsSetStmt) &&
		castNode(ConstraintsSetStmt, planned->utilityStmt)->constraints == NIL;
	bool		deferred = is_about_all && castNode(ConstraintsSetStmt, planned->utilityStmt)->deferred;

	(previous_hook != NULL ? previous_hook : standard_ProcessUtility)
		(planned, query, read_only_tree, context, params, environment, destination, completion);
	if (!is_about_all)
		return;
	set_immediate(!deferred);
	if (immediate)
		pending_settle(InvalidOid);
}

/* ---- Ends of transactions ------------------------------------------------- */

static void
at_transaction_event(XactEvent event, void *arg)
{
	switch (event)
	{
		case XACT_EVENT_PRE_COMMIT:
		case XACT_EVENT_PRE_PREPARE:
			pending_settle(InvalidOid);
			close_all();
			break;
		case XACT_EVENT_COMMIT:
		case XACT_EVENT_PREPARE:
		case XACT_EVENT_ABORT:
			/* files and memory go with the transaction */
			all = NULL;
			immediate_saved = NIL;
			immediate = false;
			break;
		default:
			break;
	}
}

static void
at_subtransaction_abort(SubTransactionId id)
{
	for (Pending *pending = all; pending != NULL; pending = pending->next)
		while (pending->saved != NIL && ((Saved *) linitial(pending->saved))->of == id)
		{
			pending->extent = ((Saved *) linitial(pending->saved))->extent;
			pending->saved = list_delete_first(pending->saved);
		}
	while (immediate_saved != NIL && ((SavedMode *) linitial(immediate_saved))->of == id)
	{
		immediate = ((SavedMode *) linitial(immediate_saved))->immediate;
		immediate_saved = list_delete_first(immediate_saved);
	}
}

static void
at_subtransaction_commit(SubTransactionId id, SubTransactionId parent)
{
	ListCell   *cell;

	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (pending->saved != NIL && ((Saved *) linitial(pending->saved))->of == id)
		{
			((Saved *) linitial(pending->saved))->of = parent;
			/* the parent's saved state is older */
			if (parent == TopSubTransactionId || (list_length(pending->saved) > 1 &&
												  ((Saved *) lsecond(pending->saved))->of == parent))
				pending->saved = list_delete_first(pending->saved);
		}
	foreach(cell, immediate_saved)
	{
		SavedMode  *saved = lfirst(cell);

		if (saved->of == id)
			saved->of = parent;
	}
}

static void
at_subtransaction_event(SubXactEvent event, SubTransactionId id, SubTransactionId parent, void *arg)
{
	if (event == SUBXACT_EVENT_ABORT_SUB)
		at_subtransaction_abort(id);
	else if (event == SUBXACT_EVENT_COMMIT_SUB)
		at_subtransaction_commit(id, parent);
}

void
pending_init(void)
{
	previous_hook = ProcessUtility_hook;
	ProcessUtility_hook = process_utility;
	RegisterXactCallback(at_transaction_event, NULL);
	RegisterSubXactCallback(at_subtransaction_event, NULL);
}

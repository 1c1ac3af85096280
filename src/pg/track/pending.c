/*
 * pending.c: the changes that meshes which follow at commit still have to make.
 *
 * Statements note the points that they have added and removed in a log, one for each mesh, and the
 * ids of the lines that they have changed in another one. Before the transaction commits, or is
 * prepared, each mesh is changed once (catch_up.c). By then deferred constraints have been checked and deferred triggers have fired, so these may still
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

#include "pg/track/catch_up.h"
#include "pg/track/pending_parts.h"

/* Points read from the log at once. */
#define POINTS_A_BATCH 1024

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

static bool
is_same(const PendingTable *a, const Pending *b)
{
	return a->mesh == b->mesh && a->user == b->user && a->kind == b->kind &&
		a->shape.dimension == b->shape.dimension && a->shape.columns == b->shape.columns &&
		a->shape.dropped == b->shape.dropped;
}

/* The notes of a mesh that follows a table, and is changed with the rights of a user. */
Pending *
pending_open(const PendingTable *table)
{
	Pending    *pending = all;
	uint32		srid = check_mesh(table->mesh, table->user, table->has_geometries);
	MemoryContext old;

	while (pending != NULL && !is_same(table, pending))
		pending = pending->next;
	if (pending != NULL)
	{
		pending_take_srid(pending, (int32) srid);
		return pending;
	}
	old = MemoryContextSwitchTo(TopTransactionContext);
	pending = palloc0(sizeof(Pending));
	pending->mesh = table->mesh;
	pending->kind = table->kind;
	pending->user = table->user;
	pending->table = pstrdup(table->name);
	pending->trigger = pstrdup(table->trigger);
	pending->shape = table->shape;
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
	pending->extent.all = false;
}

/* The mesh has been emptied, and so has its table. */
void
pending_forget(Oid mesh)
{
	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (pending->mesh == mesh && pending->kind == TRACKED_POINTS)
			forget(pending);
}

/* Notes that the table has been emptied: all its points are gone, or all its lines have changed. */
void
pending_add_all(Pending *pending)
{
	forget(pending);
	pending->extent.all = true;
}

/* Passes on the points that are new, those that are gone, or the lines that have changed. */
void
pending_read(const Pending *pending, bool gone, PendingSink sink, void *context)
{
	size_t		words = 1 + pending->shape.columns;
	uint64	   *records = palloc(POINTS_A_BATCH * words * sizeof(uint64));
	uint64	   *points = palloc(POINTS_A_BATCH * pending->shape.columns * sizeof(uint64));
	uint64		at = pending->extent.start;

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
			sink(context, points, count);
	}
	pfree(records);
	pfree(points);
}

/* ---- Catching up --------------------------------------------------------- */

static bool
is_behind(const Pending *pending)
{
	return pending->extent.came + pending->extent.went > 0 || pending->extent.all;
}

/* The least OID of a mesh that has notes; InvalidOid if there is none. */
static Oid
next_behind(void)
{
	Oid			mesh = InvalidOid;

	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (is_behind(pending) && (!OidIsValid(mesh) || pending->mesh < mesh))
			mesh = pending->mesh;
	return mesh;
}

/* Lets a mesh catch up with its tables. */
static void
settle(Oid mesh)
{
	List	   *behind = NIL;
	ListCell   *cell;

	for (Pending *pending = all; pending != NULL; pending = pending->next)
		if (pending->mesh == mesh && is_behind(pending))
			behind = lappend(behind, pending);
	if (behind == NIL)
		return;
	catch_up(mesh, behind);
	foreach(cell, behind)
		forget(lfirst(cell));
	list_free(behind);
}

/* Lets the mesh catch up with its tables now; given InvalidOid, all meshes. */
void
pending_settle(Oid mesh)
{
	if (OidIsValid(mesh))
		settle(mesh);
	else
		while (OidIsValid(mesh = next_behind()))
			settle(mesh);
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

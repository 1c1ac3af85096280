/*
 * fn_tracked.c: abacus_tracked, the trigger function that keeps a mesh in step
 * with a table.
 *
 * It is called once after each statement. Points that a statement adds are inserted first, then
 * those that it removes are deleted. So a vertex that only gets new attributes is renamed: the new
 * point waits beside the old one and takes over, and the triangulation stays as it is. If a
 * statement changes only attributes, not even that is needed: they are changed in place. A
 * statement that changes no point neither touches the mesh nor waits for its other writers. If a
 * mesh follows at commit, the points are only noted (pending.c).
 *
 * A statement may reach a table through its parent, but fires only the statement triggers of the
 * table that it names. So tables with partitions or children have triggers for each row, which
 * PostgreSQL also adds to partitions that are attached later. These triggers note points.
 *
 * The mesh is written with the rights of the table's owner, as for foreign keys: users who may
 * write the table need no privileges on the mesh, and the owner's are checked. No code of a user
 * runs meanwhile. That holds for triggers bound to their mesh (tracking.c), which the owner has
 * made by abacus_track(). Other triggers may name any mesh. They change it only with the rights of
 * the user, as any function of a trigger does.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "miscadmin.h"

#include "pg/base/sql_function.h"
#include "pg/track/in_step.h"
#include "pg/track/pending.h"
#include "pg/track/tracked_points.h"
#include "pg/track/tracking.h"
#include "pg/track/transition.h"

SQL_FUNCTION(abacus_sql_tracked);

/* Whether a statement trigger has what its event provides: its transition tables. */
static bool
fits_statement(const TriggerData *trigger)
{
	if (TRIGGER_FIRED_BY_TRUNCATE(trigger->tg_event))
		return true;
	if (!TRIGGER_FIRED_AFTER(trigger->tg_event))
		return false;
	return (trigger->tg_newtable != NULL || TRIGGER_FIRED_BY_DELETE(trigger->tg_event)) &&
		(trigger->tg_oldtable != NULL || TRIGGER_FIRED_BY_INSERT(trigger->tg_event));
}

static void
check_protocol(FunctionCallInfo fcinfo)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	bool		fits = CALLED_AS_TRIGGER(fcinfo) &&
		trigger->tg_trigger->tgnargs > TRACKING_ARGUMENT_COLUMNS;

	if (fits && TRIGGER_FIRED_FOR_ROW(trigger->tg_event))
		fits = TRIGGER_FIRED_AFTER(trigger->tg_event) && !OidIsValid(trigger->tg_trigger->tgconstraint);
	else if (fits)
		fits = fits_statement(trigger);
	if (!fits)
		ereport(ERROR,
				(errcode(ERRCODE_E_R_I_E_TRIGGER_PROTOCOL_VIOLATED),
				 errmsg("function \"abacus_tracked\" is not called as a trigger for a "
						"statement with its transition tables"),
				 errhint("Make the triggers with abacus_track().")));
}

/* ---- Now ------------------------------------------------------------------- */

static void
to_stage(void *context, const uint64 *points, size_t count)
{
	change_add(context, points, count);
}

/* Stages the points that are new, or those that are gone; returns how many. */
static uint64
stage(Transition *transition, bool new, Change *change)
{
	change_open_stage(change, &change->writer.header->facts);
	return transition_send(transition, new, to_stage, change);
}

/* Writes new attributes of points that stay into the mesh. */
static void
revise(const TriggerData *trigger, Transition *transition, Change *change)
{
	abacus_facts shape = change->writer.header->facts;
	uint32		count = shape.columns.attributes;
	uint32	   *attributes = palloc(count * sizeof(uint32));
	abacus_named_place missing;
	uint64		rows;

	for (uint32 i = 0; i < count; i++)
		attributes[i] = i;
	shape.columns.attributes = 2 * count;
	change_open_stage(change, &shape);
	rows = transition_send_revisions(transition, to_stage, change);
	change_take_srid(change, transition_srid(transition));
	in_step_check_found(change, RelationGetRelationName(trigger->tg_relation), "change", rows,
						change_update(change, attributes, count, true, &missing));
	pfree(attributes);
}

/* Whether revise() can do it: waiting points are found by id and place only. */
static bool
can_be_revised(Transition *transition, const Change *change)
{
	const abacus_facts *facts = &change->writer.header->facts;

	return facts->census.simplices > 0 && 2 * facts->columns.attributes <= ABACUS_MAX_ATTRIBUTES &&
		transition_revises(transition);
}

/* Applies the added and removed points of the statement to the mesh. */
static void
follow(const TriggerData *trigger, Transition *transition, Change *change)
{
	uint64		gone;

	in_step_check_shape(change, transition_expected(transition), trigger->tg_trigger->tgname);
	transition->srid = change->writer.header->facts.form.srid;
	if (can_be_revised(transition, change))
	{
		revise(trigger, transition, change);
		return;
	}
	if (transition->new.rows != NULL && stage(transition, true, change) > 0)
	{
		change_take_srid(change, transition_srid(transition));
		change_insert(change);
	}
	/* another row's point at the place must not be taken for a missing one */
	if (transition->old.rows != NULL && (gone = stage(transition, false, change)) > 0)
		in_step_check_found(change, RelationGetRelationName(trigger->tg_relation), "delete", gone,
							change_delete(change, true));
}

/*
 * Changes the mesh as the statement has changed the table. If there is no transition, the statement
 * has emptied the table.
 */
static void
change_mesh(const TriggerData *trigger, Transition *transition)
{
	Oid			user;
	int			security;
	Oid			writer;
	Oid			mesh = tracking_mesh(trigger, &writer);
	Change	   *change;

	GetUserIdAndSecContext(&user, &security);
	if (writer != user)
		SetUserIdAndSecContext(writer, security | SECURITY_LOCAL_USERID_CHANGE);
	change = change_begin_in_trigger(mesh, "abacus_track()");
	if (transition == NULL)
		change_clear(change);
	else
		follow(trigger, transition, change);
	change_end(change);
	SetUserIdAndSecContext(user, security);
	if (transition == NULL)
		pending_forget(mesh);
}

/* ---- At commit ------------------------------------------------------------- */

static void
note_new(void *pending, const uint64 *points, size_t count)
{
	pending_add(pending, false, points, count);
}

static void
note_gone(void *pending, const uint64 *points, size_t count)
{
	pending_add(pending, true, points, count);
}

static Pending *
open_pending(const TriggerData *trigger, const Transition *transition)
{
	PendingTable table = {.kind = TRACKED_POINTS,.name = RelationGetRelationName(trigger->tg_relation),
		.trigger = trigger->tg_trigger->tgname,.shape = transition_expected(transition),
		.has_geometries = transition->inputs < transition->columns
	};

	table.mesh = tracking_mesh(trigger, &table.user);
	return pending_open(&table);
}

static void
note_statement(const TriggerData *trigger, Transition *transition)
{
	Pending    *pending = open_pending(trigger, transition);

	transition->srid = pending_srid(pending);
	transition_send(transition, true, note_new, pending);
	transition_send(transition, false, note_gone, pending);
	pending_take_srid(pending, transition_srid(transition));
}

/* State kept from row to row of a statement. */
typedef struct RowNotes
{
	Transition *transition;
	Pending    *pending;
} RowNotes;

static void
note_row(FunctionCallInfo fcinfo)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	RowNotes   *notes = fcinfo->flinfo->fn_extra;

	if (notes == NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(fcinfo->flinfo->fn_mcxt);

		notes = palloc(sizeof(RowNotes));
		notes->transition = transition_open(trigger);
		notes->pending = open_pending(trigger, notes->transition);
		transition_open_rows(notes->transition, pending_srid(notes->pending));
		fcinfo->flinfo->fn_extra = notes;
		MemoryContextSwitchTo(old);
	}
	transition_send_row(notes->transition, trigger, true, note_new, notes->pending);
	transition_send_row(notes->transition, trigger, false, note_gone, notes->pending);
	pending_take_srid(notes->pending, transition_srid(notes->transition));
}

/* Notes that the rows of a partition or child that will be truncated are gone. */
static void
note_all_gone(const TriggerData *trigger, const Transition *transition)
{
	Oid			writer;
	Pending    *pending = open_pending(trigger, transition);
	List	   *columns = NIL;
	Source		source;
	const uint64 *points;
	size_t		count;
	Oid			user;
	int			security;

	for (int i = 0; i < transition->inputs; i++)
		columns = lappend(columns, transition->names[i]);
	(void) tracking_mesh(trigger, &writer);
	GetUserIdAndSecContext(&user, &security);
	/* a user who may truncate it may lack the right to read it */
	SetUserIdAndSecContext(writer, security | SECURITY_LOCAL_USERID_CHANGE);
	source_prepare(&source, tracked_points_of_one_table(trigger->tg_relation, columns,
														transition->dimension));
	source_open(&source, transition_shape(transition), true);
	while ((count = source_fetch(&source, &points)) > 0)
		pending_add(pending, true, points, count);
	source_close(&source);
	source_finish(&source);
	SetUserIdAndSecContext(user, security);
}

/* ---- Either ----------------------------------------------------------------- */

/*
 * Whether the mesh follows lines as well. Then it follows at commit, since a statement may delete a
 * point that a line names, and the next one the line.
 */
static bool
follows_lines(const TriggerData *trigger)
{
	Oid			writer;
	Relation	mesh = table_open(tracking_mesh(trigger, &writer), AccessShareLock);
	bool		follows = tracking_followed(mesh, TRACKED_LINES) != NULL;

	table_close(mesh, NoLock);
	return follows;
}

/* Changes the mesh at commit, or at once if the user wishes. */
static void
settle_soon(const TriggerData *trigger)
{
	Oid			writer;

	if (pending_is_immediate())
		pending_settle(tracking_mesh(trigger, &writer));
}

static void
truncated(const TriggerData *trigger)
{
	if (!TRIGGER_FIRED_AFTER(trigger->tg_event))
	{
		if (tracking_is_followed(trigger))
			note_all_gone(trigger, transition_open(trigger));
	}
	else if (follows_lines(trigger))
	{
		pending_add_all(open_pending(trigger, transition_open(trigger)));
		settle_soon(trigger);
	}
	else
		change_mesh(trigger, NULL);
}

static void
changed(const TriggerData *trigger)
{
	Transition *transition = transition_open(trigger);

	if (transition_changes(transition))
	{
		bool		with_lines = follows_lines(trigger);

		if (with_lines || (transition->deferred && !pending_is_immediate()))
			note_statement(trigger, transition);
		else
			change_mesh(trigger, transition);
		if (with_lines)
			settle_soon(trigger);
	}
	transition_close(transition);
}

/* abacus_tracked() -> trigger; arguments: mesh, dimension, columns of a point */
Datum
abacus_sql_tracked(PG_FUNCTION_ARGS)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;

	check_protocol(fcinfo);
	if (TRIGGER_FIRED_BY_TRUNCATE(trigger->tg_event))
		truncated(trigger);
	else if (TRIGGER_FIRED_FOR_ROW(trigger->tg_event))
		note_row(fcinfo);
	else
		changed(trigger);
	return PointerGetDatum(NULL);
}

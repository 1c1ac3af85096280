/*
 * fn_tracked.c: abacus_tracked, the trigger function that keeps a mesh in step
 * with a table.
 *
 * It is called once after each statement. What a statement adds is inserted
 * first, what it takes away is deleted then: so a vertex whose attributes alone
 * change is renamed (the new point waits beside the old one and takes over),
 * and the triangulation stays as it is. A statement that changes no point does
 * not touch the mesh, nor wait for its other writers.
 *
 * The mesh is written as the owner of the table, as for foreign keys: whoever
 * may write the table need have no privileges on the mesh, and without the
 * owner's nobody reaches it. Nothing that a user has written runs meanwhile.
 * That holds for triggers bound to their mesh (tracking.c), which the owner has
 * made by abacus_track(). Others may name any mesh, and change it with the rights
 * of the user only, as any function of a trigger does.
 */
#include "postgres.h"

#include "miscadmin.h"

#include "pg/sql/sql_function.h"
#include "pg/track/tracking.h"
#include "pg/track/transition.h"

SQL_FUNCTION(abacus_sql_tracked);

static void
check_protocol(FunctionCallInfo fcinfo)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	bool		fits = CALLED_AS_TRIGGER(fcinfo) && TRIGGER_FIRED_AFTER(trigger->tg_event) &&
		TRIGGER_FIRED_FOR_STATEMENT(trigger->tg_event) &&
		trigger->tg_trigger->tgnargs > TRACKING_ARGUMENT_COLUMNS;

	if (fits && (TRIGGER_FIRED_BY_INSERT(trigger->tg_event) ||
				 TRIGGER_FIRED_BY_UPDATE(trigger->tg_event)))
		fits = trigger->tg_newtable != NULL;
	if (fits && (TRIGGER_FIRED_BY_DELETE(trigger->tg_event) ||
				 TRIGGER_FIRED_BY_UPDATE(trigger->tg_event)))
		fits = trigger->tg_oldtable != NULL;
	if (!fits)
		ereport(ERROR,
				(errcode(ERRCODE_E_R_I_E_TRIGGER_PROTOCOL_VIOLATED),
				 errmsg("function \"" TRACKING_FUNCTION "\" is not called as a trigger for a "
						"statement with its transition tables"),
				 errhint("Make the triggers with abacus_track().")));
}

static void
check_shape(const abacus_header *header, const Transition *transition, const char *trigger)
{
	if ((int) header->dimension != transition->dimension ||
		(int) (1 + header->dimension + header->attributes) != transition->columns)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("trigger \"%s\" was made for another mesh", trigger),
				 errdetail("The mesh has dimension %u and %u attributes.", header->dimension,
						   header->attributes),
				 errhint("Drop the trigger, and call abacus_track().")));
}

/* What the statement has added and taken away, into the mesh. */
static void
follow(const TriggerData *trigger, Transition *transition, Change *change)
{
	uint64		gone;
	uint64		deleted;

	check_shape(change->writer.header, transition, trigger->tg_trigger->tgname);
	if (transition->new.rows != NULL && transition_stage(transition, true, change) > 0)
		change_insert(change);
	if (transition->old.rows == NULL || (gone = transition_stage(transition, false, change)) == 0)
		return;
	/* another row's point at the place must not go for one that is missing */
	deleted = change_delete(change, true);
	if (deleted != gone)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" is not in step with table \"%s\"",
						RelationGetRelationName(change->writer.host->store.simplices.heap),
						RelationGetRelationName(trigger->tg_relation)),
				 errdetail("Points to delete: " UINT64_FORMAT "; found: " UINT64_FORMAT ".", gone,
						   deleted),
				 errhint("Bring it in step with abacus_track(mesh, table, synchronize => true). If "
						 "an AFTER trigger changes the rows of its own statement again, make it a "
						 "BEFORE trigger: such changes cannot be followed.")));
}

/* Changes the mesh as the statement has changed the table; no transition: it has emptied it. */
static void
change_mesh(const TriggerData *trigger, Transition *transition)
{
	Oid			user;
	int			security;
	bool		bound;
	Oid			mesh = tracking_mesh(trigger, &bound);
	Change	   *change;

	GetUserIdAndSecContext(&user, &security);
	if (bound)
		SetUserIdAndSecContext(trigger->tg_relation->rd_rel->relowner,
							   security | SECURITY_LOCAL_USERID_CHANGE);
	change = change_begin_in_trigger(mesh, "abacus_track()");
	if (transition == NULL)
		change_clear(change);
	else
		follow(trigger, transition, change);
	change_end(change);
	SetUserIdAndSecContext(user, security);
}

/* abacus_tracked() -> trigger; arguments: mesh, dimension, columns of a point */
Datum
abacus_sql_tracked(PG_FUNCTION_ARGS)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	Transition *transition;

	check_protocol(fcinfo);
	if (TRIGGER_FIRED_BY_TRUNCATE(trigger->tg_event))
	{
		change_mesh(trigger, NULL);
		return PointerGetDatum(NULL);
	}
	transition = transition_open(trigger);
	if (transition_changes(transition))
		change_mesh(trigger, transition);
	transition_close(transition);
	return PointerGetDatum(NULL);
}

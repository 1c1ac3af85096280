/*
 * fn_tracked_lines.c: abacus_tracked_lines, the trigger function that keeps a mesh in step with a
 * table of lines.
 *
 * It notes the ids of the lines that a statement has changed. The mesh catches up at commit, since
 * several statements may change a line, or a line and its points. For everything else it is as
 * abacus_tracked (fn_tracked.c).
 */
#include "postgres.h"

#include "access/table.h"
#include "miscadmin.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/lines/line_rows.h"
#include "pg/lines/line_values.h"
#include "pg/track/pending.h"
#include "pg/track/tracked_lines.h"
#include "pg/track/tracked_points.h"
#include "pg/track/transition_rows.h"

SQL_FUNCTION(abacus_sql_tracked_lines);

/* The lines that a trigger sees. */
typedef struct ChangedLines
{
	TrackedLines tracked;
	int			count;			/* of columns that matter */
	AttrNumber *numbers;		/* of these, the line's first */
	Oid			type;			/* of the line's */
	bool		is_drawn;		/* a row without a geometry is not a line */
	Pending    *pending;		/* NULL before the first note */
	bool		any;
	int64		last;			/* noted */
} ChangedLines;

static void
refuse_call(void)
{
	ereport(ERROR,
			(errcode(ERRCODE_E_R_I_E_TRIGGER_PROTOCOL_VIOLATED),
			 errmsg("function \"abacus_tracked_lines\" is not called as a trigger for a statement with its "
					"transition tables"),
			 errhint("Make the triggers with abacus_track_lines().")));
}

static void
check_protocol(FunctionCallInfo fcinfo)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	TriggerEvent event;

	if (!CALLED_AS_TRIGGER(fcinfo))
		refuse_call();
	event = trigger->tg_event;
	if (TRIGGER_FIRED_FOR_ROW(event)
		? !TRIGGER_FIRED_AFTER(event) || OidIsValid(trigger->tg_trigger->tgconstraint)
		: !TRIGGER_FIRED_BY_TRUNCATE(event) &&
		(!TRIGGER_FIRED_AFTER(event) ||
		 (trigger->tg_newtable == NULL && !TRIGGER_FIRED_BY_DELETE(event)) ||
		 (trigger->tg_oldtable == NULL && !TRIGGER_FIRED_BY_INSERT(event))))
		refuse_call();
}

/* The columns of lines in the table that the trigger is for. */
static ChangedLines *
open_lines(const TriggerData *trigger)
{
	Relation	table = trigger->tg_relation;
	ChangedLines *lines = palloc0(sizeof(ChangedLines));
	List	   *columns;
	ListCell   *cell;

	if (!tracked_lines_read(&lines->tracked, trigger->tg_trigger->tgargs, trigger->tg_trigger->tgnargs))
		ereport(ERROR,
				(errcode(ERRCODE_E_R_I_E_TRIGGER_PROTOCOL_VIOLATED),
				 errmsg("trigger \"%s\" has wrong arguments", trigger->tg_trigger->tgname),
				 errhint("Make it with abacus_track_lines().")));
	columns = tracked_lines_columns(&lines->tracked);
	lines->numbers = palloc(list_length(columns) * sizeof(AttrNumber));
	foreach(cell, columns)
		lines->numbers[lines->count++] = tracked_column(table, lfirst(cell), "abacus_track_lines()");
	tracked_lines_check_types(&lines->tracked, table);
	lines->is_drawn = list_length(lines->tracked.columns) == LINE_ROW_POSITION + 1;
	lines->type = getBaseType(TupleDescAttr(RelationGetDescr(table), lines->numbers[0] - 1)->atttypid);
	return lines;
}

/*
 * A mesh finds the table of its lines by triggers that are bound to it, or whose table has the same
 * owner. Any user could have made others.
 */
static void
check_followed(const TriggerData *trigger, Oid relid)
{
	Relation	mesh = table_open(relid, AccessShareLock);
	TrackedLines *followed = tracked_lines_of(mesh);

	if (followed == NULL || followed->table != tracking_root(RelationGetRelid(trigger->tg_relation)))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("trigger \"%s\" does not belong to mesh \"%s\"", trigger->tg_trigger->tgname,
						RelationGetRelationName(mesh)),
				 errdetail("The mesh and the table have different owners, or the mesh follows another table."),
				 errhint("Call abacus_track_lines(), as a user who owns the table and may write the mesh.")));
	table_close(mesh, NoLock);
}

static void
open_pending(const TriggerData *trigger, ChangedLines *lines)
{
	PendingTable table = {.kind = TRACKED_LINES,.name = RelationGetRelationName(trigger->tg_relation),
		.trigger = trigger->tg_trigger->tgname,.shape = {.dimension = 2,.columns = 1}
	};

	if (lines->pending != NULL)
		return;
	table.mesh = tracking_mesh(trigger, &table.user);
	check_followed(trigger, table.mesh);
	lines->pending = pending_open(&table);
}

/* Whether the row is a line or a point of one. NULL is an error where a line needs a value. */
static bool
is_line(const TriggerData *trigger, const ChangedLines *lines, TupleTableSlot *row)
{
	if (lines->is_drawn && slot_attisnull(row, lines->numbers[1]))
		return false;
	for (int i = 0; i <= (lines->is_drawn ? LINE_ROW_LINE : LINE_ROW_POINT); i++)
		if (slot_attisnull(row, lines->numbers[i]))
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("column \"%s\" of a line in table \"%s\" is NULL",
							(char *) list_nth(lines->tracked.columns, i),
							RelationGetRelationName(trigger->tg_relation)),
					 lines->is_drawn ? errhint("Set the geometry to NULL in rows without a line.")
					 : errhint("Each row is a point of a line.")));
	return true;
}

/* Notes the line of a row, unless that is the last one noted. */
static void
note_row(const TriggerData *trigger, ChangedLines *lines, TupleTableSlot *row)
{
	bool		isnull;
	uint64		id = (uint64) line_value_integer(lines->type, slot_getattr(row, lines->numbers[0], &isnull));

	if (lines->any && lines->last == (int64) id)
		return;
	open_pending(trigger, lines);
	pending_add(lines->pending, false, &id, 1);
	lines->any = true;
	lines->last = (int64) id;
}

/* Notes the lines of an old row and its new one, either of which may be NULL. */
static void
note_rows(const TriggerData *trigger, ChangedLines *lines, TupleTableSlot *old, TupleTableSlot *new)
{
	bool		is = new != NULL && is_line(trigger, lines, new);

	if (old != NULL && new != NULL && transition_rows_agree(old, new, lines->numbers, lines->count))
		return;
	/* an old row had values, unless the triggers were off */
	if (old != NULL && !slot_attisnull(old, lines->numbers[0]))
		note_row(trigger, lines, old);
	if (is)
		note_row(trigger, lines, new);
}

static void
note_statement(const TriggerData *trigger)
{
	ChangedLines *lines = open_lines(trigger);
	TransitionRows old;
	TransitionRows new;
	bool		was;
	bool		is;

	transition_rows_open(&old, trigger->tg_oldtable, RelationGetDescr(trigger->tg_relation));
	transition_rows_open(&new, trigger->tg_newtable, RelationGetDescr(trigger->tg_relation));
	transition_rows_rewind(&old);
	transition_rows_rewind(&new);
	for (;;)
	{
		CHECK_FOR_INTERRUPTS();
		was = transition_rows_fetch(&old);
		is = transition_rows_fetch(&new);
		if (!was && !is)
			break;
		note_rows(trigger, lines, was ? old.slot : NULL, is ? new.slot : NULL);
	}
	transition_rows_close(&old);
	transition_rows_close(&new);
}

/* Notes the row of a trigger for each row; what is known is kept from row to row. */
static void
note_one_row(FunctionCallInfo fcinfo)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	bool		inserts = TRIGGER_FIRED_BY_INSERT(trigger->tg_event);

	if (fcinfo->flinfo->fn_extra == NULL)
	{
		MemoryContext old = MemoryContextSwitchTo(fcinfo->flinfo->fn_mcxt);

		fcinfo->flinfo->fn_extra = open_lines(trigger);
		MemoryContextSwitchTo(old);
	}
	note_rows(trigger, fcinfo->flinfo->fn_extra, inserts ? NULL : trigger->tg_trigslot,
			  inserts ? trigger->tg_trigslot
			  : TRIGGER_FIRED_BY_UPDATE(trigger->tg_event) ? trigger->tg_newslot : NULL);
}

/* Notes the lines of a partition or child that will be truncated. */
static void
note_one_table(const TriggerData *trigger)
{
	ChangedLines *lines = open_lines(trigger);
	Oid			owner;
	Oid			user;
	int			security;

	(void) tracking_mesh(trigger, &owner);
	open_pending(trigger, lines);
	GetUserIdAndSecContext(&user, &security);
	/* a user who may truncate it may lack the right to read it */
	SetUserIdAndSecContext(owner, security | SECURITY_LOCAL_USERID_CHANGE);
	SPI_connect();
	if (SPI_execute(tracked_lines_of_one_table(trigger->tg_relation, &lines->tracked), true, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not read the lines: %s", SPI_result_code_string(SPI_result));
	for (uint64 i = 0; i < SPI_processed; i++)
	{
		bool		isnull;
		uint64		id = (uint64) DatumGetInt64(SPI_getbinval(SPI_tuptable->vals[i], SPI_tuptable->tupdesc, 1,
															  &isnull));

		if (!isnull)
			pending_add(lines->pending, false, &id, 1);
	}
	SPI_finish();
	SetUserIdAndSecContext(user, security);
}

static void
truncated(const TriggerData *trigger)
{
	ChangedLines *lines;

	if (TRIGGER_FIRED_AFTER(trigger->tg_event))
	{
		lines = open_lines(trigger);
		open_pending(trigger, lines);
		pending_add_all(lines->pending);
	}
	else if (tracking_is_followed(trigger))
		note_one_table(trigger);
}

/* abacus_tracked_lines() -> trigger; arguments: tracked_lines.h */
Datum
abacus_sql_tracked_lines(PG_FUNCTION_ARGS)
{
	TriggerData *trigger = (TriggerData *) fcinfo->context;
	Oid			user;

	check_protocol(fcinfo);
	if (TRIGGER_FIRED_FOR_ROW(trigger->tg_event))
	{
		note_one_row(fcinfo);
		return PointerGetDatum(NULL);
	}
	if (TRIGGER_FIRED_BY_TRUNCATE(trigger->tg_event))
		truncated(trigger);
	else
		note_statement(trigger);
	if (pending_is_immediate() && TRIGGER_FIRED_AFTER(trigger->tg_event))
		pending_settle(tracking_mesh(trigger, &user));
	return PointerGetDatum(NULL);
}

/*
 * transition.c: the points in the transition tables of a trigger.
 *
 * An UPDATE has two of them, the old rows and the new rows; rows with the same position belong to
 * the same row of the table. If they give the same point, there is nothing to do. No other rows are
 * compared, and no sort is needed: removing equal rows from two lists, one for one, leaves the same
 * difference whichever pairs are found.
 *
 * Rows with a NULL among the coordinates are not points. They become points when they get
 * coordinates, and stop being points when they lose them.
 *
 * The rows are read directly from the tuplestores. That costs less than planning a query on them,
 * so a statement that changes one row is quick.
 */
#include "postgres.h"

#include "access/tupdesc.h"
#include "executor/executor.h"
#include "executor/tuptable.h"
#include "miscadmin.h"
#include "utils/lsyscache.h"
#include "utils/rel.h"
#include "utils/tuplestore.h"

#include "pg/mesh/numbering.h"
#include "pg/port/port.h"
#include "pg/track/tracked_points.h"
#include "pg/track/transition.h"

#define POINTS_A_BATCH 1024

/* Skips a word if the text begins with it. */
static bool
skip(char **text, const char *word)
{
	if (strncmp(*text, word, strlen(word)) != 0)
		return false;
	*text += strlen(word);
	return true;
}

/*
 * The dimension, how the mesh follows, and how many of its attributes had been dropped; 0 if the
 * argument is not valid, since the creator of the trigger may have written anything.
 */
static int
read_dimension(char *argument, bool *deferred, uint32 *dropped)
{
	char	   *rest;
	long		dimension = strtol(argument, &rest, 10);
	long		count = 0;

	*deferred = skip(&rest, TRACKING_DEFERRED);
	if (skip(&rest, TRACKING_DROPPED))
		count = strtol(rest, &rest, 10);
	*dropped = (uint32) count;
	return *rest == '\0' && count >= 0 && count <= NUMBERING_LIMIT && dimension >= 2 &&
		dimension <= ABACUS_MAX_DIMENSION ? (int) dimension : 0;
}

/* The shape of the mesh that the trigger expects. */
ExpectedShape
transition_expected(const Transition *transition)
{
	return (ExpectedShape) {transition->dimension, transition->columns, transition->dropped};
}

/* The same in the form for points. */
abacus_names
transition_shape(const Transition *transition)
{
	abacus_facts *facts = palloc0(sizeof(abacus_facts));
	char		(*names)[ABACUS_NAME_BYTES];

	facts->form.dimension = transition->dimension;
	facts->form.srid = transition->srid;
	facts->columns.attributes = transition->columns - 1 - transition->dimension;
	names = palloc0(Max(facts->columns.attributes, 1) * sizeof(*names));
	for (uint32 i = 0; i < facts->columns.attributes; i++)
		strlcpy(names[i], transition->names[transition->inputs - facts->columns.attributes + i],
				ABACUS_NAME_BYTES);
	return (abacus_names) {facts, (const char (*)[ABACUS_NAME_BYTES]) names};
}

static void
refuse_arguments(const TriggerData *trigger)
{
	ereport(ERROR,
			(errcode(ERRCODE_E_R_I_E_TRIGGER_PROTOCOL_VIOLATED),
			 errmsg("trigger \"%s\" has wrong arguments", trigger->tg_trigger->tgname),
			 errhint("Make it with abacus_track().")));
}

/* Opens the transition tables of a trigger that tracking_create() has made. */
Transition *
transition_open(const TriggerData *trigger)
{
	Transition *transition = palloc0(sizeof(Transition));
	TupleDesc	desc = RelationGetDescr(trigger->tg_relation);
	char	  **names = trigger->tg_trigger->tgargs + TRACKING_ARGUMENT_COLUMNS;

	transition->inputs = trigger->tg_trigger->tgnargs - TRACKING_ARGUMENT_COLUMNS;
	transition->dimension = read_dimension(trigger->tg_trigger->tgargs[TRACKING_ARGUMENT_DIMENSION],
										   &transition->deferred, &transition->dropped);
	if (transition->dimension == 0 || transition->inputs < 2 ||
		transition->inputs > 1 + transition->dimension + ABACUS_MAX_ATTRIBUTES)
		refuse_arguments(trigger);
	transition->numbers = palloc(transition->inputs * sizeof(AttrNumber));
	transition->points = CreateTemplateTupleDesc(transition->inputs);
	for (int i = 0; i < transition->inputs; i++)
	{
		AttrNumber	number = tracked_column(trigger->tg_relation, names[i], "abacus_track()");

		transition->numbers[i] = number;
		TupleDescCopyEntry(transition->points, i + 1, desc, number);
	}
	TupleDescFinalize(transition->points);
	transition->columns = transition->inputs;
	if (row_packer_takes_geometry(transition->points))
		transition->columns += transition->dimension - 1;
	if (transition->columns < 1 + transition->dimension ||
		transition->columns > 1 + transition->dimension + ABACUS_MAX_ATTRIBUTES)
		refuse_arguments(trigger);
	transition->point = MakeSingleTupleTableSlot(transition->points, &TTSOpsVirtual);
	transition->names = names;
	transition_rows_open(&transition->old, trigger->tg_oldtable, desc);
	transition_rows_open(&transition->new, trigger->tg_newtable, desc);
	return transition;
}

static void
rewind_all(Transition *transition)
{
	transition_rows_rewind(&transition->old);
	transition_rows_rewind(&transition->new);
}

/* Whether the row in the slot is a point. */
static bool
is_point(const Transition *transition, TupleTableSlot *slot)
{
	int			places = transition->dimension - (transition->columns - transition->inputs);

	for (int i = 1; i <= places; i++)
		if (slot_attisnull(slot, transition->numbers[i]))
			return false;
	return true;
}

/* Whether the rows agree in the first columns of a point: in all, or in id and place. */
static bool
agree(const Transition *transition, int columns)
{
	return transition_rows_agree(transition->old.slot, transition->new.slot, transition->numbers, columns);
}

static bool
is_same_point(const Transition *transition)
{
	return agree(transition, transition->inputs);
}

/* Goes to the next rows; false at the end of both tables. */
static bool
advance(Transition *transition)
{
	TransitionRows *old = &transition->old;
	TransitionRows *new = &transition->new;
	bool		was = transition_rows_fetch(old);
	bool		is = transition_rows_fetch(new);

	CHECK_FOR_INTERRUPTS();
	old->counts = was && is_point(transition, old->slot);
	new->counts = is && is_point(transition, new->slot);
	if (old->counts && new->counts && is_same_point(transition))
		old->counts = new->counts = false;
	return was || is;
}

/* Whether the statement has changed points at all. */
bool
transition_changes(Transition *transition)
{
	rewind_all(transition);
	while (advance(transition))
		if (transition->old.counts || transition->new.counts)
			return true;
	return false;
}

/* Whether the statement has changed only attributes: each point stays, with its id. */
bool
transition_revises(Transition *transition)
{
	int			attributes = transition->columns - 1 - transition->dimension;

	if (attributes == 0 || transition->old.rows == NULL || transition->new.rows == NULL)
		return false;
	rewind_all(transition);
	while (advance(transition))
	{
		if (transition->old.counts != transition->new.counts)
			return false;
		if (transition->new.counts && !agree(transition, transition->inputs - attributes))
			return false;
	}
	return true;
}

/* Makes room for this many packed points. */
static void
open_packer(Transition *transition, size_t batch)
{
	if (transition->packer == NULL)
		transition->packer = row_packer_create_tracked(transition->points,
													   transition_shape(transition), batch);
}

/* The SRID of the geometries passed on; -1 if there were none. */
int32
transition_srid(const Transition *transition)
{
	return transition->packer == NULL ? -1 : transition->packer->srid;
}

/* Passes the point of a row to the packer. */
static void
pack(const Transition *transition, TupleTableSlot *row)
{
	TupleTableSlot *point = transition->point;
	RowPacker  *packer = transition->packer;

	ExecClearTuple(point);
	for (int i = 0; i < transition->inputs; i++)
		point->tts_values[i] = slot_getattr(row, transition->numbers[i], &point->tts_isnull[i]);
	ExecStoreVirtualTuple(point);
	packer->receiver.receiveSlot(point, &packer->receiver);
}

/* Passes on the points that are new, or those that are gone; returns how many. */
uint64
transition_send(Transition *transition, bool new, PointSink sink, void *context)
{
	TransitionRows *rows = new ? &transition->new : &transition->old;
	RowPacker  *packer;
	uint64		sent = 0;

	open_packer(transition, POINTS_A_BATCH);
	packer = transition->packer;
	packer->row = 0;
	rewind_all(transition);
	while (advance(transition))
	{
		if (!rows->counts)
			continue;
		pack(transition, rows->slot);
		sent++;
		if (packer->count == POINTS_A_BATCH)
		{
			sink(context, packer->points, packer->count);
			row_packer_reset(packer);
		}
	}
	if (packer->count > 0)
		sink(context, packer->points, packer->count);
	row_packer_reset(packer);
	return sent;
}

/* Merges the pairs of packed points, new and old, into one record each. */
static void
join_pairs(const Transition *transition)
{
	size_t		columns = transition->columns;
	size_t		attributes = columns - 1 - transition->dimension;
	uint64	   *points = transition->packer->points;
	uint64	   *to = points;

	for (size_t i = 0; i + 1 < transition->packer->count; i += 2)
	{
		memmove(to, points + i * columns, columns * sizeof(uint64));
		to += columns;
		memmove(to, points + (i + 2) * columns - attributes, attributes * sizeof(uint64));
		to += attributes;
	}
}

static void
flush_revisions(const Transition *transition, PointSink sink, void *context)
{
	RowPacker  *packer = transition->packer;

	if (packer->count > 0)
	{
		join_pairs(transition);
		sink(context, packer->points, packer->count / 2);
	}
	row_packer_reset(packer);
}

/*
 * Passes on the new points, each with its old attributes after the new ones; returns how many. Only
 * for a statement for which transition_revises() is true.
 */
uint64
transition_send_revisions(Transition *transition, PointSink sink, void *context)
{
	uint64		sent = 0;

	open_packer(transition, POINTS_A_BATCH);
	transition->packer->row = 0;
	rewind_all(transition);
	while (advance(transition))
	{
		if (!transition->new.counts)
			continue;
		pack(transition, transition->new.slot);
		pack(transition, transition->old.slot);
		sent++;
		if (transition->packer->count == POINTS_A_BATCH)
			flush_revisions(transition, sink, context);
	}
	flush_revisions(transition, sink, context);
	return sent;
}

/*
 * Prepares for a trigger that is called for each row. Data needed from row to row are in the
 * current memory context, since the context of the trigger's call is emptied after each row.
 */
void
transition_open_rows(Transition *transition, uint32 srid)
{
	transition->srid = srid;
	open_packer(transition, 1);
}

/*
 * Passes on the point of the row for which a trigger for each row is called, if it counts.
 * transition_open_rows() must have prepared the transition.
 */
void
transition_send_row(Transition *transition, const TriggerData *trigger, bool new, PointSink sink,
					void *context)
{
	bool		is_update = TRIGGER_FIRED_BY_UPDATE(trigger->tg_event);
	TransitionRows *rows = new ? &transition->new : &transition->old;

	transition->new.slot = is_update ? trigger->tg_newslot
		: TRIGGER_FIRED_BY_INSERT(trigger->tg_event) ? trigger->tg_trigslot : NULL;
	transition->old.slot = TRIGGER_FIRED_BY_INSERT(trigger->tg_event) ? NULL : trigger->tg_trigslot;
	if (rows->slot == NULL || !is_point(transition, rows->slot) ||
		(is_update && is_point(transition, transition->old.slot) &&
		 is_point(transition, transition->new.slot) && is_same_point(transition)))
		return;
	pack(transition, rows->slot);
	sink(context, transition->packer->points, 1);
	row_packer_reset(transition->packer);
}

void
transition_close(Transition *transition)
{
	transition_rows_close(&transition->old);
	transition_rows_close(&transition->new);
	ExecDropSingleTupleTableSlot(transition->point);
}

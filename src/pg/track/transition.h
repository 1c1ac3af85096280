/*
 * transition.h: the points in the transition tables of a trigger.
 */
#ifndef ABACUS_TRANSITION_H
#define ABACUS_TRANSITION_H

#include "commands/trigger.h"

#include "pg/mesh/change.h"

/* A transition table while it is read. */
typedef struct TransitionRows
{
	Tuplestorestate *rows;		/* NULL: the event has none */
	int			pointer;
	TupleTableSlot *slot;
	bool		counts;			/* the row in the slot is a point to be added, or taken away */
} TransitionRows;

typedef struct Transition
{
	TransitionRows old;
	TransitionRows new;
	int			columns;
	int			dimension;
	AttrNumber *numbers;		/* of the columns of points, in the table */
	TupleDesc	points;			/* what a point's row looks like */
	TupleTableSlot *point;
} Transition;

/* Arguments of the trigger: name of the mesh, its dimension, columns of a point. */
#define TRACKING_ARGUMENT_DIMENSION 1
#define TRACKING_ARGUMENT_COLUMNS 2

extern Transition *transition_open(const TriggerData *trigger);
extern bool transition_changes(Transition *transition);
extern uint64 transition_stage(Transition *transition, bool new, Change *change);
extern void transition_close(Transition *transition);

#endif

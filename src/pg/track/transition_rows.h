/*
 * transition_rows.h: the rows of a transition table, or a row of a trigger for each row.
 */
#ifndef ABACUS_TRANSITION_ROWS_H
#define ABACUS_TRANSITION_ROWS_H

#include "executor/tuptable.h"
#include "utils/tuplestore.h"

/* A transition table while it is read, or a row. */
typedef struct TransitionRows
{
	Tuplestorestate *rows;		/* NULL: the event has none, or the slot is set */
	int			pointer;
	TupleTableSlot *slot;
	bool		counts;			/* the row in the slot is a point to add or remove */
} TransitionRows;

extern void transition_rows_open(TransitionRows *rows, Tuplestorestate *store, TupleDesc desc);
extern void transition_rows_rewind(TransitionRows *rows);
extern bool transition_rows_fetch(TransitionRows *rows);
extern void transition_rows_close(TransitionRows *rows);
extern bool transition_rows_agree(TupleTableSlot *old, TupleTableSlot *new, const AttrNumber *numbers,
								  int count);

#endif

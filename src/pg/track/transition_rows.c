/*
 * transition_rows.c: the rows of a transition table, or a row of a trigger for each row.
 */
#include "postgres.h"

#include "executor/executor.h"
#include "utils/datum.h"

#include "pg/track/transition_rows.h"

void
transition_rows_open(TransitionRows *rows, Tuplestorestate *store, TupleDesc desc)
{
	rows->rows = store;
	rows->counts = false;
	if (store == NULL)
		return;
	/* a read pointer of our own: other triggers read the same rows */
	rows->pointer = tuplestore_alloc_read_pointer(store, EXEC_FLAG_REWIND);
	rows->slot = MakeSingleTupleTableSlot(desc, &TTSOpsMinimalTuple);
}

void
transition_rows_rewind(TransitionRows *rows)
{
	if (rows->rows == NULL)
		return;
	tuplestore_select_read_pointer(rows->rows, rows->pointer);
	tuplestore_rescan(rows->rows);
}

/* Puts the next row into the slot; false at the end. */
bool
transition_rows_fetch(TransitionRows *rows)
{
	if (rows->rows == NULL)
		return false;
	tuplestore_select_read_pointer(rows->rows, rows->pointer);
	return tuplestore_gettupleslot(rows->rows, true, false, rows->slot);
}

void
transition_rows_close(TransitionRows *rows)
{
	if (rows->rows != NULL)
		ExecDropSingleTupleTableSlot(rows->slot);
}

/* Whether two rows have the same values in some columns. */
bool
transition_rows_agree(TupleTableSlot *old, TupleTableSlot *new, const AttrNumber *numbers, int count)
{
	for (int i = 0; i < count; i++)
	{
		Form_pg_attribute attribute = TupleDescAttr(old->tts_tupleDescriptor, numbers[i] - 1);
		bool		old_null;
		bool		new_null;
		Datum		before = slot_getattr(old, numbers[i], &old_null);
		Datum		after = slot_getattr(new, numbers[i], &new_null);

		if (old_null != new_null ||
			(!old_null && !datum_image_eq(before, after, attribute->attbyval, attribute->attlen)))
			return false;
	}
	return true;
}

/*
 * own_sight.h: which changes of its own transaction a session's snapshots see.
 */
#ifndef ABACUS_OWN_SIGHT_H
#define ABACUS_OWN_SIGHT_H

#include "access/htup_details.h"

#define SIGHT_MOST_SNAPSHOTS 64

typedef struct OwnSight
{
	bool		known;			/* these are all existing snapshots */
	int			count;
	CommandId	from[SIGHT_MOST_SNAPSHOTS]; /* each sees the changes of commands before this one */
	int			level;			/* of nested transactions */
	TransactionId innermost;	/* its transaction; invalid if it has no number yet */
} OwnSight;

extern void own_sight_take(OwnSight *sight, bool in_trigger);
extern bool own_sight_is_past(const OwnSight *sight, HeapTupleHeader row);

#endif

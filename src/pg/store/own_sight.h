/*
 * own_sight.h: what a session's snapshots see of the changes of its own transaction.
 */
#ifndef ABACUS_OWN_SIGHT_H
#define ABACUS_OWN_SIGHT_H

#include "access/htup_details.h"

#define SIGHT_MOST_SNAPSHOTS 64

typedef struct OwnSight
{
	bool		known;			/* these are all snapshots that there are */
	int			count;
	CommandId	from[SIGHT_MOST_SNAPSHOTS]; /* each sees what commands before this one did */
	int			level;			/* of nested transactions */
	TransactionId innermost;	/* its transaction; invalid if it has no number yet */
} OwnSight;

extern void own_sight_take(OwnSight *sight, bool in_trigger);
extern bool own_sight_is_past(const OwnSight *sight, HeapTupleHeader row);

#endif

/*
 * transition.h: the points that a statement has added and removed, from the transition tables of
 * its trigger, or from the rows of a trigger for each row.
 */
#ifndef ABACUS_TRANSITION_H
#define ABACUS_TRANSITION_H

#include "commands/trigger.h"

#include "pg/mesh/change.h"
#include "pg/track/in_step.h"
#include "pg/track/transition_rows.h"

typedef struct Transition
{
	TransitionRows old;
	TransitionRows new;
	int			columns;		/* of a point: id, coordinates, attributes */
	int			inputs;			/* ... in the table: a geometry replaces all coordinates */
	int			dimension;
	uint32		srid;			/* of the mesh, for geometries; 0: none, or not known yet */
	bool		deferred;		/* the mesh follows at commit */
	uint32		dropped;		/* attributes that had been dropped when the trigger was made */
	char	  **names;			/* of the columns of points */
	AttrNumber *numbers;		/* of these columns, in the table */
	TupleDesc	points;			/* the row type of a point */
	TupleTableSlot *point;
	RowPacker  *packer;
} Transition;

/* Receives points. */
typedef void (*PointSink) (void *context, const uint64 *points, size_t count);

/*
 * Arguments of the trigger: name of the mesh, its dimension (followed by how it follows, and how
 * many attributes had been dropped, if any: the columns are those of the others), columns of a
 * point.
 */
#define TRACKING_ARGUMENT_DIMENSION 1
#define TRACKING_DEFERRED " deferred"
#define TRACKING_DROPPED " dropped "
#define TRACKING_ARGUMENT_COLUMNS 2

extern Transition *transition_open(const TriggerData *trigger);
extern void transition_open_rows(Transition *transition, uint32 srid);
extern ExpectedShape transition_expected(const Transition *transition);
extern abacus_names transition_shape(const Transition *transition);
extern int32 transition_srid(const Transition *transition);
extern bool transition_changes(Transition *transition);
extern bool transition_revises(Transition *transition);
extern uint64 transition_send_revisions(Transition *transition, PointSink sink, void *context);
extern uint64 transition_send(Transition *transition, bool new, PointSink sink, void *context);
extern void transition_send_row(Transition *transition, const TriggerData *trigger, bool new,
								PointSink sink, void *context);
extern void transition_close(Transition *transition);

#endif

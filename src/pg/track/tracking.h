/*
 * tracking.h: the triggers by which a mesh follows a table.
 */
#ifndef ABACUS_TRACKING_H
#define ABACUS_TRACKING_H

#include "commands/trigger.h"
#include "nodes/pg_list.h"
#include "utils/rel.h"

/* What the rows of a table are. A mesh follows at most one table of each kind. */
typedef enum TrackedKind
{
	TRACKED_POINTS,
	TRACKED_LINES
} TrackedKind;

#define TRACKED_KINDS 2

/* One of the triggers in the catalogue. */
typedef struct TrackingTrigger
{
	Oid			oid;
	char	   *name;
	Oid			table;
	Oid			mesh;			/* InvalidOid: not found */
	bool		bound;			/* to the mesh; otherwise only its name is known */
	int16		event;			/* TRIGGER_TYPE_..., one or several */
	bool		auxiliary;		/* on a partition or child: reports its truncation */
	char		fires;			/* as pg_trigger.tgenabled says */
	int			count;			/* of arguments */
	char	  **arguments;		/* the first one is the name of the mesh */
} TrackingTrigger;

/* The function and arguments that all triggers of a mesh share. */
typedef struct TriggerCall
{
	Oid			function;
	Oid			mesh;
	List	   *arguments;		/* of the trigger, behind the name of the mesh */
	List	   *former;			/* TrackingTriggers that these replace */
} TriggerCall;

extern Oid	tracking_function(TrackedKind kind, Oid extension_namespace);
extern Oid	tracking_extension(Relation mesh);
extern TrackingTrigger *tracking_followed(Relation mesh, TrackedKind kind);
extern Oid	tracking_mesh(const TriggerData *data, Oid *user);
extern bool tracking_is_followed(const TriggerData *data);
extern Oid	tracking_root(Oid table);
extern void tracking_bind_restored(Relation mesh);
extern List *tracking_triggers(Oid function, Oid mesh, Oid table);
extern void tracking_create(const TriggerCall *call, Relation table);
extern void tracking_drop(const TrackingTrigger *trigger);

#endif

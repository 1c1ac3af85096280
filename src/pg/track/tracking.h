/*
 * tracking.h: the triggers by which a mesh follows a table.
 */
#ifndef ABACUS_TRACKING_H
#define ABACUS_TRACKING_H

#include "commands/trigger.h"
#include "nodes/pg_list.h"
#include "utils/rel.h"

#define TRACKING_FUNCTION "abacus_tracked"

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
} TrackingTrigger;

/* The function and arguments that all triggers of a mesh share. */
typedef struct TriggerCall
{
	Oid			function;
	Oid			mesh;
	int			dimension;
	uint32		dropped;		/* attributes of the mesh that were dropped */
	bool		deferred;
	List	   *columns;
	List	   *former;			/* TrackingTriggers that these replace */
} TriggerCall;

extern Oid	tracking_function(Oid extension_namespace);
extern Oid	tracking_mesh(const TriggerData *data, Oid *user);
extern bool tracking_is_followed(const TriggerData *data);
extern Oid	tracking_root(Oid table);
extern void tracking_bind_restored(Relation mesh);
extern List *tracking_triggers(Oid function, Oid mesh, Oid table);
extern void tracking_create(const TriggerCall *call, Relation table);
extern void tracking_drop(const TrackingTrigger *trigger);

#endif

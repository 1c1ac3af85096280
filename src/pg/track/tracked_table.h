/*
 * tracked_table.h: a table that a mesh will follow: locked, checked, and given its triggers.
 */
#ifndef ABACUS_TRACKED_TABLE_H
#define ABACUS_TRACKED_TABLE_H

#include "pg/track/tracking.h"

extern Relation tracked_table_begin(Oid relid, Oid mesh, const char *command);
extern List *tracked_table_triggers(Oid function, Oid mesh, Relation table);
extern void tracked_table_follow(const TriggerCall *call, Relation table);

#endif

/*
 * pending.h: the changes that meshes which follow at commit still have to make.
 */
#ifndef ABACUS_PENDING_H
#define ABACUS_PENDING_H

#include "pg/track/in_step.h"
#include "pg/track/tracking.h"

typedef struct Pending Pending;

/* A table whose changes are noted. */
typedef struct PendingTable
{
	Oid			mesh;
	Oid			user;			/* whose rights are used to change the mesh */
	TrackedKind kind;
	const char *name;			/* for messages, like the trigger */
	const char *trigger;
	ExpectedShape shape;		/* that the trigger expects of the mesh */
	bool		has_geometries; /* points are geometries */
} PendingTable;

extern Pending *pending_open(const PendingTable *table);
extern uint32 pending_srid(const Pending *pending);
extern void pending_take_srid(Pending *pending, int32 srid);
extern void pending_add(Pending *pending, bool gone, const uint64 *points, size_t count);
extern void pending_add_all(Pending *pending);
extern void pending_forget(Oid mesh);
extern bool pending_is_immediate(void);
extern void pending_settle(Oid mesh);
extern void pending_init(void);

#endif

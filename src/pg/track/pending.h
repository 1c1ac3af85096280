/*
 * pending.h: the changes that meshes which follow at commit still have to make.
 */
#ifndef ABACUS_PENDING_H
#define ABACUS_PENDING_H

#include "pg/track/transition.h"

typedef struct Pending Pending;

extern Pending *pending_open(Oid mesh, Oid user, const TriggerData *trigger,
							  const Transition *transition);
extern uint32 pending_srid(const Pending *pending);
extern void pending_take_srid(Pending *pending, int32 srid);
extern void pending_add(Pending *pending, bool gone, const uint64 *points, size_t count);
extern void pending_forget(Oid mesh);
extern bool pending_is_immediate(void);
extern void pending_settle(Oid mesh);
extern void pending_init(void);

#endif

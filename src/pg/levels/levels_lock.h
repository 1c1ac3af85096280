/*
 * levels_lock.h: the levels of a mesh kept from others while they are made anew or dropped.
 */
#ifndef ABACUS_LEVELS_LOCK_H
#define ABACUS_LEVELS_LOCK_H

#include "pg/levels/levels_table.h"

extern Oid	levels_lock(Oid mesh, Oid **bound, int *bound_count);
extern void levels_lock_each(Oid mesh, const Level *levels, int count, const Oid *bound, int bound_count);

#endif

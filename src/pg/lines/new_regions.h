/*
 * new_regions.h: regions that a mesh gets, and those that it loses.
 */
#ifndef ABACUS_NEW_REGIONS_H
#define ABACUS_NEW_REGIONS_H

#include "pg/input/source.h"
#include "pg/mesh/change.h"

extern uint64 new_regions_add(Change *change, Source *source);
extern void new_regions_remove(Change *change, const char *region);

#endif

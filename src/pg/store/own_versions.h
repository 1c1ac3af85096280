/*
 * own_versions.h: prunes rows that a transaction has both made and replaced, before it ends.
 */
#ifndef ABACUS_OWN_VERSIONS_H
#define ABACUS_OWN_VERSIONS_H

#include "storage/itemptr.h"
#include "utils/rel.h"

#include "pg/store/own_sight.h"

extern bool own_versions_has(Relation heap, ItemPointer tid);
extern bool own_versions_prune(Relation heap, BlockNumber block, const OwnSight *sight, Size *room);

#endif

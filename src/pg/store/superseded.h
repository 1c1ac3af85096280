/*
 * superseded.h: reclaims the space of rows that were replaced, without VACUUM, once no one sees
 * them.
 */
#ifndef ABACUS_SUPERSEDED_H
#define ABACUS_SUPERSEDED_H

#include "storage/block.h"
#include "utils/rel.h"

#include "pg/store/own_sight.h"

typedef struct Superseded Superseded;

extern Superseded *superseded_create(MemoryContext memory);
extern void superseded_forget(Superseded *superseded);
extern void superseded_add(Superseded *superseded, BlockNumber block);
extern void superseded_add_own(Superseded *superseded, BlockNumber block);
extern BlockNumber superseded_take_empty(Superseded *superseded, Relation heap, Size size,
										 Size *room);
extern void superseded_give_back(Superseded *superseded, BlockNumber block, Size room);
extern bool superseded_is_far(Superseded *superseded, BlockNumber block);
extern bool superseded_has_empty_before(Superseded *superseded, BlockNumber block);
extern uint64 superseded_survey(Superseded *superseded, Relation heap, uint64 *block, uint64 end,
								uint64 one_of, uint64 enough);
extern void superseded_reclaim(Superseded *superseded, Relation heap);
extern Superseded *superseded_of_session(Relation heap);
extern void superseded_reclaim_earlier(Superseded *superseded, Relation heap, const OwnSight *sight);

#endif

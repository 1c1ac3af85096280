/*
 * by_hand.h: changes of a mesh that do not come from the table that it follows.
 */
#ifndef ABACUS_BY_HAND_H
#define ABACUS_BY_HAND_H

#include "pg/mesh/change.h"

extern void by_hand_refuse_points(const Change *change);
extern void by_hand_refuse_lines(const Change *change);
extern void by_hand_refuse_attributes(const Change *change);

#endif

/*
 * octree_growth.h: leaves of an octree that are split.
 */
#ifndef ABACUS_OCTREE_GROWTH_H
#define ABACUS_OCTREE_GROWTH_H

#include "pg/mesh/writer.h"

extern void octree_growth_open(Writer *writer);

#endif

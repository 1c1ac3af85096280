/*
 * octree_growth.h: splitting leaves of an octree.
 */
#ifndef ABACUS_OCTREE_GROWTH_H
#define ABACUS_OCTREE_GROWTH_H

#include "pg/mesh/writer.h"

extern void octree_growth_open(Writer *writer);

#endif

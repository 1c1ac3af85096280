/*
 * compact.h: moves the rows of a mesh to the beginning of their tables.
 */
#ifndef ABACUS_COMPACT_H
#define ABACUS_COMPACT_H

#include "pg/mesh/writer.h"

extern bool compact_is_worthwhile(Relation heap);
extern uint64 compact(Writer *writer, bool simplices, bool vertices);

#endif

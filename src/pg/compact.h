/*
 * compact.h: the rows of a mesh moved to the beginning of their table.
 */
#ifndef ABACUS_COMPACT_H
#define ABACUS_COMPACT_H

#include "pg/writer.h"

extern void compact(Writer *writer);

#endif

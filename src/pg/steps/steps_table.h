/*
 * steps_table.h: the table of the steps of a solution on a mesh, found and made.
 */
#ifndef ABACUS_STEPS_TABLE_H
#define ABACUS_STEPS_TABLE_H

#include "pg/mesh/mesh.h"

extern char *steps_table_for(Relation mesh, int64 step);

#endif

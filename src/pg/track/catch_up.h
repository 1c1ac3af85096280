/*
 * catch_up.h: a mesh catches up with the tables that it follows.
 */
#ifndef ABACUS_CATCH_UP_H
#define ABACUS_CATCH_UP_H

#include "nodes/pg_list.h"

extern void catch_up(Oid mesh, List *behind);

#endif

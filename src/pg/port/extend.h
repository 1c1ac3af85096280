/*
 * extend.h: many heap pages added to a table at once.
 */
#ifndef ABACUS_EXTEND_H
#define ABACUS_EXTEND_H

#include "storage/buf.h"
#include "utils/rel.h"

/* The most pages added at once. */
#define EXTEND_MOST_PAGES 32

extern int	port_extend(Relation heap, int pages, void (*taken) (Buffer buffer), BlockNumber *first);

#endif

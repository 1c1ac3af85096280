/*
 * order.h: an order of rows by their distance from a place.
 */
#ifndef ABACUS_ORDER_H
#define ABACUS_ORDER_H

#include "pg/fdw/conditions.h"

extern Expr *order_place(const Shown *shown, RelOptInfo *rel);
extern bool order_read_place(Oid type, Datum value, double *place);

#endif

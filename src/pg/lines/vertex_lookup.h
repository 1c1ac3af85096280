/*
 * vertex_lookup.h: vertices of a mesh that is being changed, looked up by their places.
 */
#ifndef ABACUS_VERTEX_LOOKUP_H
#define ABACUS_VERTEX_LOOKUP_H

#include "access/htup.h"
#include "access/tupdesc.h"

#include "pg/lines/named_rows.h"
#include "pg/mesh/change.h"

/* Receives a row of a query; `record` has room for a vertex. */
typedef void (*LookupSink) (void *context, HeapTuple tuple, TupleDesc desc, uint64 *record);

extern bool vertex_lookup_can(const Change *change);
extern bool vertex_lookup(Change *change, const double *place, uint64 *record);
extern void vertex_lookup_rows(Change *change, const char *query, LookupSink sink, void *context);
extern double vertex_lookup_number(HeapTuple tuple, TupleDesc desc, int column);
extern void vertex_lookup_put(const Change *change, NamedRows *found, const uint64 *record, bool has_attributes,
							  bool by_id);

#endif

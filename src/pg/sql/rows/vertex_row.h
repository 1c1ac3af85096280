/*
 * vertex_row.h: the rows of abacus_vertices.
 */
#ifndef ABACUS_VERTEX_ROW_H
#define ABACUS_VERTEX_ROW_H

#include "access/tupdesc.h"

#include "abacus/simplex.h"

extern Datum vertex_row(TupleDesc row_type, const abacus_vertex *vertex,
						const abacus_facts *facts);

#endif

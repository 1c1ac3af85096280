/*
 * mesh_rows.h: the rows of a published mesh, one by one.
 */
#ifndef ABACUS_MESH_ROWS_H
#define ABACUS_MESH_ROWS_H

#include "nodes/bitmapset.h"

#include "pg/fdw/conditions.h"
#include "pg/fdw/published.h"

typedef struct MeshRows MeshRows;

extern MeshRows *mesh_rows_open(Relation table, const Published *published,
								const Bitmapset *wanted, Oid user, MemoryContext parent);
extern uint32 mesh_rows_dimension(const MeshRows *rows);
extern int32 mesh_rows_srid(const MeshRows *rows);
extern void mesh_rows_begin(MeshRows *rows, const Bounds *bounds);
extern void mesh_rows_begin_nearest(MeshRows *rows, Relation table, Oid user, const double *place,
									uint64 first);
extern bool mesh_rows_next(MeshRows *rows, Datum *values, bool *isnull);
extern uint64 mesh_rows_pages(const MeshRows *rows);
extern void mesh_rows_close(MeshRows *rows);

#endif

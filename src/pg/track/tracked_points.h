/*
 * tracked_points.h: the points of a table that a mesh follows, and those of the mesh.
 */
#ifndef ABACUS_TRACKED_POINTS_H
#define ABACUS_TRACKED_POINTS_H

#include "nodes/pg_list.h"
#include "utils/array.h"
#include "utils/rel.h"

#include "abacus/mesh_header.h"

extern void tracked_check_column(Relation table, AttrNumber number);
extern AttrNumber tracked_column(Relation table, const char *name, const char *function);
extern void tracked_check_places(Relation table, List *columns);
extern List *tracked_columns(ArrayType *given, abacus_names mesh, Relation table);
extern char *tracked_points_of_table(Relation table, List *columns, int dimension, bool packed);
extern char *tracked_points_of_other_srid(Relation table, List *columns,
										  const abacus_form *form);
extern char *tracked_points_of_one_table(Relation table, List *columns, int dimension);
extern char *tracked_places(Relation table, List *columns, const char *ids);
extern char *tracked_least_id(Relation table, List *columns);
extern char *tracked_only_geometry(Relation table);
extern char *tracked_points_of_mesh(Oid mesh, const abacus_facts *facts,
									Oid extension_namespace, const char *lines);

#endif

/*
 * build.h: the steps of making a mesh, shared by the SQL functions.
 */
#ifndef ABACUS_BUILD_H
#define ABACUS_BUILD_H

#include "utils/array.h"

#include "pg/header.h"
#include "pg/source.h"

extern void shape_dimension(abacus_header *header, int32 dimension);
extern void shape_attribute(abacus_header *header, const char *name);
extern void shape_attributes(abacus_header *header, ArrayType *names);
extern void shape_point(const abacus_header *header, ArrayType *point, const char *what,
						double *values);
extern void shape_domain(abacus_header *header, ArrayType *lower, ArrayType *upper);

extern Oid	build_create(text *name, Oid extension_namespace, abacus_header *header);
extern uint64 build_stage(Oid mesh, Source *source);
extern uint64 build_triangulate(Oid mesh);

#endif

/*
 * build.h: the steps of making a mesh, shared by the SQL functions.
 */
#ifndef ABACUS_BUILD_H
#define ABACUS_BUILD_H

#include "utils/array.h"

#include "abacus/change.h"
#include "pg/header.h"
#include "pg/source.h"
#include "pg/writer.h"

extern void shape_dimension(abacus_header *header, int32 dimension);
extern void shape_attribute(abacus_header *header, const char *name);
extern Datum *shape_names(ArrayType *names, const char *what, int *count);
extern void shape_attributes(abacus_header *header, ArrayType *names);
extern void shape_point(const abacus_header *header, ArrayType *point, const char *what,
						double *values);
extern void shape_domain(abacus_header *header, ArrayType *lower, ArrayType *upper);

extern Oid	build_create(text *name, Oid extension_namespace, abacus_header *header,
						 const char *command);

/* A change of a mesh with the points of a query. */
typedef struct Change
{
	Writer		writer;
	abacus_stage *stage;		/* the points */
	abacus_build *build;
	uint64		points;			/* how many it holds */
	abacus_stage *put_aside;	/* another one */
} Change;

extern uint64 edit_insert(Oid mesh, Source *source, const char *command, abacus_header *header);
extern Change *change_begin(Oid mesh, const char *command);
extern void change_open_stage(Change *change, const abacus_header *shape);
extern void change_add(Change *change, const uint64 *points, size_t count);
extern void change_read(Change *change, Source *source, const abacus_header *shape);
extern void change_swap_stages(Change *change);
extern void change_open_build(Change *change);
extern void change_insert(Change *change);
extern uint64 change_delete(Change *change, bool exactly);
extern void change_clear(Change *change);
extern void change_abandon(Change *change);
extern void change_end(Change *change);

#endif

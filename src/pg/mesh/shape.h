/*
 * shape.h: the shape of a new mesh, from the arguments of an SQL function.
 */
#ifndef ABACUS_SHAPE_H
#define ABACUS_SHAPE_H

#include "utils/array.h"

#include "abacus/mesh_header.h"

extern void shape_dimension(abacus_form *form, int32 dimension);
extern void shape_check_name(const char *name);
extern void shape_check_room(const abacus_facts *facts);
extern void shape_check_split(uint32 attributes);
extern void shape_attribute(abacus_header *header, const char *name);
extern Datum *shape_names(ArrayType *names, const char *what, int *count);
extern Datum *shape_numbers(ArrayType *numbers, const char *what, int *count);
extern void shape_attributes(abacus_header *header, ArrayType *names);
extern void shape_label(abacus_header *header, const char *name);
extern void shape_point(const abacus_form *form, ArrayType *point, const char *what,
						double *values);
extern void shape_pair(ArrayType *pair, const char *what, double *values);
extern void shape_range(ArrayType *range, const char *what, double *values);
extern void shape_domain(abacus_form *form, ArrayType *lower, ArrayType *upper);

#endif

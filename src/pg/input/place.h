/*
 * place.h: a place given as x, y and, in space, z after the mesh, and k after them.
 */
#ifndef ABACUS_PLACE_H
#define ABACUS_PLACE_H

#include "fmgr.h"

#include "abacus/facts.h"

extern bool place_arguments(FunctionCallInfo fcinfo, int given, const abacus_form *form,
							double *point);
extern void place_arguments_finite(FunctionCallInfo fcinfo, int given,
								   const abacus_form *form, double *point);
extern void place_require_z(int given, const abacus_form *form);
extern uint64 place_count_argument(FunctionCallInfo fcinfo, int argument, const char *rows);

#endif

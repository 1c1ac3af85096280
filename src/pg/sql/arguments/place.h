/*
 * place.h: a place given as x, y and, in space, z behind the mesh, and k behind it.
 */
#ifndef ABACUS_PLACE_H
#define ABACUS_PLACE_H

#include "fmgr.h"

#include "abacus/mesh_header.h"

extern bool place_arguments(FunctionCallInfo fcinfo, int given, const abacus_header *header,
							double *point);
extern void place_arguments_finite(FunctionCallInfo fcinfo, int given,
								   const abacus_header *header, double *point);
extern void place_require_z(int given, const abacus_header *header);
extern uint64 place_count_argument(FunctionCallInfo fcinfo, int argument, const char *rows);

#endif

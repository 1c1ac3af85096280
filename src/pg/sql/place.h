/*
 * place.h: a place given as x, y and, in space, z behind the mesh.
 */
#ifndef ABACUS_PLACE_H
#define ABACUS_PLACE_H

#include "fmgr.h"

extern bool place_arguments(FunctionCallInfo fcinfo, int given, uint32 dimension, double *point);
extern void place_arguments_finite(FunctionCallInfo fcinfo, int given, uint32 dimension,
								   double *point);
extern void place_require_octree(int given, uint32 dimension);

#endif

/*
 * interpolation.h: the optional arguments of functions that interpolate.
 */
#ifndef ABACUS_INTERPOLATION_H
#define ABACUS_INTERPOLATION_H

#include "fmgr.h"

#include "abacus/mesh_header.h"
#include "abacus/values.h"

extern bool interpolation_of_null(FunctionCallInfo fcinfo, int given);
extern void interpolation_how(FunctionCallInfo fcinfo, int method, abacus_interpolation *how);
extern void interpolation_attribute(FunctionCallInfo fcinfo, int argument,
									abacus_names names, abacus_interpolation *how);
extern void interpolation_attributes(FunctionCallInfo fcinfo, int argument,
									 abacus_names names, abacus_interpolation *how);

#endif

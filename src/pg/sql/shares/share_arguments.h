/*
 * share_arguments.h: how a mesh is cut into parts, as arguments of several functions.
 */
#ifndef ABACUS_SHARE_ARGUMENTS_H
#define ABACUS_SHARE_ARGUMENTS_H

#include "fmgr.h"

#include "abacus/mesh_header.h"
#include "abacus/shares.h"

extern void cut_arguments(FunctionCallInfo fcinfo, int parts, int weight, abacus_names names,
						  abacus_cut *cut);
extern uint32 part_argument(FunctionCallInfo fcinfo, int part, const abacus_cut *cut);

#endif

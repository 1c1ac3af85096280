/*
 * extent_arguments.h: the arguments that say which part of a mesh counts: max_edge and within.
 */
#ifndef ABACUS_EXTENT_ARGUMENTS_H
#define ABACUS_EXTENT_ARGUMENTS_H

#include "abacus/extent.h"
#include "abacus/mesh_header.h"
#include "pg/host/host.h"
#include "fmgr.h"

extern double extent_max_edge(FunctionCallInfo fcinfo, int argument);
extern void extent_within(FunctionCallInfo fcinfo, int argument, Oid mesh, const abacus_facts *facts,
						  uint64 stamp, Host *owner, abacus_extent *extent);
extern const char *extent_region_name(Oid mesh, const abacus_header *header, uint32 number);
extern void extent_arguments(FunctionCallInfo fcinfo, int max_edge, int within, Oid mesh,
							 const abacus_header *header, Host *owner, abacus_extent *extent);

#endif

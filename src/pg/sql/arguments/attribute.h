/*
 * attribute.h: an attribute that a function takes by its name.
 */
#ifndef ABACUS_ATTRIBUTE_H
#define ABACUS_ATTRIBUTE_H

#include "fmgr.h"

#include "abacus/mesh_header.h"

extern uint32 attribute_argument(FunctionCallInfo fcinfo, int argument,
								 abacus_names names);
extern int	attribute_or_none(FunctionCallInfo fcinfo, int argument, abacus_names names);

#endif

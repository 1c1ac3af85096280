/*
 * step_argument.h: the argument step, a step of a solution to be read in place of the attributes.
 */
#ifndef ABACUS_STEP_ARGUMENT_H
#define ABACUS_STEP_ARGUMENT_H

#include "fmgr.h"

#include "pg/mesh/reader.h"

extern void step_argument(FunctionCallInfo fcinfo, int argument, Reader *reader);
extern int	step_or_attribute(FunctionCallInfo fcinfo, int step, int attribute, abacus_names names);

#endif

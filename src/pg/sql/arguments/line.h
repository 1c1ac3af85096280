/*
 * line.h: places given as arrays, for functions that follow lines.
 */
#ifndef ABACUS_LINE_H
#define ABACUS_LINE_H

#include "fmgr.h"

extern double *line_places(FunctionCallInfo fcinfo, int argument, const char *what, size_t *count);
extern void line_place(FunctionCallInfo fcinfo, int argument, const char *what, uint32 dimension,
					   double *place);

#endif

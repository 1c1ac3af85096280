/*
 * drawing.h: the common part of functions that draw.
 */
#ifndef ABACUS_DRAWING_H
#define ABACUS_DRAWING_H

#include "fmgr.h"

#include "abacus/draw.h"
#include "pg/mesh/header.h"

extern int32 drawing_pixels(FunctionCallInfo fcinfo, int argument, int32 otherwise,
							const char *name);
extern double drawing_factor(FunctionCallInfo fcinfo, int argument, const char *name);
extern bool drawing_is_given(FunctionCallInfo fcinfo, int argument, const char *name,
							 const abacus_drawing *drawing);
extern void drawing_range(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing);
extern abacus_ramp drawing_ramp_argument(FunctionCallInfo fcinfo, int argument);
extern void drawing_ramp(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing);
extern double drawing_interval(FunctionCallInfo fcinfo, int argument);
extern void drawing_contours(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing);
extern bool drawing_flag(FunctionCallInfo fcinfo, int argument);
extern void drawing_overlay(FunctionCallInfo fcinfo, int regions, int lines, abacus_drawing *drawing);
extern bytea *drawing_finish_both(Host *host, const abacus_picture *first, const abacus_picture *second);
extern bytea *drawing_finish(Host *host, const abacus_picture *picture);

#endif

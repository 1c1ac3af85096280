/*
 * window.h: the part of a mesh that a call asks for: where it is, and which simplices.
 */
#ifndef ABACUS_WINDOW_H
#define ABACUS_WINDOW_H

#include "abacus/mesh_header.h"
#include "abacus/windows.h"
#include "fmgr.h"
#include "utils/array.h"

/* Two arguments of a call. */
typedef enum WindowForm
{
	WINDOW_BOX,					/* lower, upper: the whole mesh if both are NULL */
	WINDOW_BALL					/* center, radius */
} WindowForm;

extern void window_arguments(FunctionCallInfo fcinfo, int first, WindowForm kind,
							 const abacus_form *form, abacus_window *window);
extern bool window_label(FunctionCallInfo fcinfo, int first, abacus_names names,
						 abacus_range *range);
extern bool window_attribute(FunctionCallInfo fcinfo, int first, abacus_names names,
							 abacus_range *range);

#endif

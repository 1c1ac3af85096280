/*
 * level_argument.h: the level of a mesh that is fine enough for a picture, a tile or lines.
 */
#ifndef ABACUS_LEVEL_ARGUMENT_H
#define ABACUS_LEVEL_ARGUMENT_H

#include "fmgr.h"

/* Where a function has the arguments that matter to the choice; -1 where it has none. */
typedef struct LevelArguments
{
	int			mesh;
	int			attribute;
	int			within;
	int			regions;
	int			step;
	int			max_error;
	int			pixel_error;
} LevelArguments;

extern Oid	level_argument(FunctionCallInfo fcinfo, const LevelArguments *arguments);
extern Oid	level_of_pixel(FunctionCallInfo fcinfo, const LevelArguments *arguments, double pixel);

#endif

/*
 * word.h: an argument that is one of a few words.
 */
#ifndef ABACUS_WORD_H
#define ABACUS_WORD_H

#include "fmgr.h"

extern int	word_argument(FunctionCallInfo fcinfo, int argument, const char *const *words,
						  const char *name, const char *hint);

#endif

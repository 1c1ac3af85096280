/*
 * commits.h: procedures that end transactions.
 */
#ifndef ABACUS_COMMITS_H
#define ABACUS_COMMITS_H

#include "fmgr.h"

extern void require_commits(FunctionCallInfo fcinfo, const char *procedure, const char *step,
							const char *function);

#endif

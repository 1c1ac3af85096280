/*
 * wrapper.h: the callbacks of the foreign-data wrapper.
 */
#ifndef ABACUS_WRAPPER_H
#define ABACUS_WRAPPER_H

#include "foreign/fdwapi.h"

/* What a plan stores for a scan: fdw_private. */
enum
{
	PRIVATE_COLUMNS,			/* numbers of the wanted columns, from 0 */
	PRIVATE_CONDITIONS,			/* as conditions_pack() makes them */
	PRIVATE_NEAREST				/* how many to look for at first, if the nearest rows are wanted */
};

extern void wrapper_set_planner(FdwRoutine *routine);
extern void wrapper_set_executor(FdwRoutine *routine);
extern void wrapper_set_analyze(FdwRoutine *routine);

#endif

/*
 * progress.h: live figures of a running build that other sessions can read.
 */
#ifndef ABACUS_PROGRESS_H
#define ABACUS_PROGRESS_H

#include "abacus/abacus.h"

typedef struct Progress
{
	bool		active;
	abacus_phase phase;
} Progress;

extern void progress_begin(Progress *state, Oid mesh);
extern void progress_report(Progress *state, const abacus_progress *progress);
extern void progress_end(Progress *state);

#endif

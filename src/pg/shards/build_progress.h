/*
 * build_progress.h: what a build over several servers does now, for other sessions to read.
 */
#ifndef ABACUS_BUILD_PROGRESS_H
#define ABACUS_BUILD_PROGRESS_H

#include "postgres.h"

/* Numbers in the view abacus_progress, after those of abacus_phase */
typedef enum BuildPhaseShown
{
	SHOWN_SPREADING = 20,		/* points */
	SHOWN_TRIANGULATING,		/* shards that are done, of all */
	SHOWN_EXCHANGING			/* vertices sent */
} BuildPhaseShown;

extern void build_progress_begin(Oid mesh);
extern void build_progress(BuildPhaseShown phase, int64 done, int64 total, int rounds);
extern void build_progress_add(int64 done);
extern void build_progress_end(void);

#endif

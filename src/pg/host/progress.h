/*
 * progress.h: live figures of running work, for other sessions to read.
 */
#ifndef ABACUS_PROGRESS_H
#define ABACUS_PROGRESS_H

#include "abacus/host_functions.h"

/* What time has passed, and how much of a processor has been used in it; nanoseconds. */
typedef struct ProcessorTime
{
	int64		elapsed;
	int64		all;			/* by all threads of this process */
	int64		session;		/* by the session's */
} ProcessorTime;

typedef struct Progress
{
	bool		active;
	abacus_phase phase;
	uint64		total;			/* of all batches; 0 = not in batches */
	uint64		earlier_done;	/* done in earlier batches */
	uint64		earlier_read;
	uint64		earlier_written;
	bool		had_threads;	/* several have computed so far */
	ProcessorTime began;
} Progress;

extern void progress_begin(Progress *state, Oid mesh);
extern void progress_report(Progress *state, const abacus_progress *progress);
extern void progress_in_batches(Progress *state, uint64 total);
extern void progress_batch_done(Progress *state, uint64 done, uint64 pages_read,
								uint64 pages_written);
extern void progress_end(Progress *state);
extern bool progress_last_with_threads(ProcessorTime *used);

#endif

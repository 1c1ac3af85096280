/*
 * progress.c: live figures of a build, or of other long work, for other sessions to read.
 *
 * Every backend has progress slots in shared memory, but only for core commands. We report as
 * CREATE INDEX, which also builds something ordered from a scan: pg_stat_progress_create_index
 * shows "building index" with tuples done and in total. Figures without a name there go into slots
 * that it does not use. A magic value in the last slot shows the view abacus_progress that the row
 * is ours (sql/install/80-progress.sql, which uses the numbers below). An aborting transaction
 * clears the slots by itself.
 */
#include "postgres.h"

#include <time.h>

#include "commands/progress.h"
#include "utils/backend_progress.h"
#include "utils/backend_status.h"
#include "utils/timestamp.h"

#include "pg/host/progress.h"

/* Slots that CREATE INDEX leaves free; the view's param numbers are one higher. */
#define PROGRESS_ABACUS_PAGES_READ 1
#define PROGRESS_ABACUS_PAGES_WRITTEN 2
#define PROGRESS_ABACUS_THREADS 7
#define PROGRESS_ABACUS_PHASE_START 17	/* microseconds since 2000-01-01 */
#define PROGRESS_ABACUS_START 18
#define PROGRESS_ABACUS_MAGIC 19

#define PROGRESS_MAGIC INT64CONST(0x616261637573)	/* "abacus" */

/*
 * The slot of threads has their number in its lowest bits. Above are two numbers of processors, in
 * thousandths: those that all threads keep busy, and what the session's thread takes of one.
 */
#define THREAD_BITS 16
#define BUSY_BITS 23
#define BUSY_LIMIT ((INT64CONST(1) << BUSY_BITS) - 1)

/* That of the last work in this session with several threads. */
static ProcessorTime last_with_threads;

static int64
read_clock(clockid_t clock)
{
	struct timespec time = {0, 0};

	clock_gettime(clock, &time);
	return time.tv_sec * INT64CONST(1000000000) + time.tv_nsec;
}

static ProcessorTime
processor_time(void)
{
	ProcessorTime now = {read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_PROCESS_CPUTIME_ID),
	read_clock(CLOCK_THREAD_CPUTIME_ID)};

	return now;
}

/* Since the work began. */
static ProcessorTime
time_used(const Progress *state)
{
	ProcessorTime used = processor_time();

	used.elapsed -= state->began.elapsed;
	used.all -= state->began.all;
	used.session -= state->began.session;
	return used;
}

static int64
pack_threads(const Progress *state, uint32 threads)
{
	ProcessorTime used = time_used(state);
	int64		elapsed = Max(used.elapsed, 1);
	int64		all = Min((int64) (used.all * 1000.0 / elapsed), BUSY_LIMIT);
	int64		session = Min((int64) (used.session * 1000.0 / elapsed), BUSY_LIMIT);

	return (session << BUSY_BITS | all) << THREAD_BITS | Min(threads, (1 << THREAD_BITS) - 1);
}

/*
 * Does nothing within a command that reports its own progress: COPY of our rows, COPY into a table
 * that a mesh follows, or a function of ours whose source query this is.
 */
void
progress_begin(Progress *state, Oid mesh)
{
	static const int slots[] = {
		PROGRESS_CREATEIDX_PHASE, PROGRESS_ABACUS_START, PROGRESS_ABACUS_PHASE_START,
		PROGRESS_ABACUS_MAGIC
	};
	int64		now = GetCurrentTimestamp();
	int64		values[] = {PROGRESS_CREATEIDX_PHASE_BUILD, now, now, PROGRESS_MAGIC};

	MemSet(state, 0, sizeof(*state));
	state->began = processor_time();
	if (MyBEEntry == NULL || MyBEEntry->st_progress_command != PROGRESS_COMMAND_INVALID)
		return;
	pgstat_progress_start_command(PROGRESS_COMMAND_CREATE_INDEX, mesh);
	pgstat_progress_update_multi_param(lengthof(slots), slots, values);
	state->active = true;
}

/* From now on, the figures are those of all batches together, of `total` points. */
void
progress_in_batches(Progress *state, uint64 total)
{
	state->total = total;
}

/* Adds the figures of the batch that has ended. */
void
progress_batch_done(Progress *state, uint64 done, uint64 pages_read, uint64 pages_written)
{
	state->earlier_done += done;
	state->earlier_read += pages_read;
	state->earlier_written += pages_written;
}

void
progress_report(Progress *state, const abacus_progress *progress)
{
	static const int slots[] = {
		PROGRESS_CREATEIDX_SUBPHASE, PROGRESS_CREATEIDX_TUPLES_TOTAL,
		PROGRESS_CREATEIDX_TUPLES_DONE, PROGRESS_ABACUS_PAGES_READ, PROGRESS_ABACUS_PAGES_WRITTEN,
		PROGRESS_ABACUS_THREADS
	};
	int64		values[] = {
		progress->phase, (int64) (state->total != 0 ? state->total : progress->total),
		(int64) (state->earlier_done + progress->done),
		(int64) (state->earlier_read + progress->pages_read),
		(int64) (state->earlier_written + progress->pages_written),
		0
	};

	if (!state->active)
		return;
	values[lengthof(values) - 1] = pack_threads(state, progress->threads);
	state->had_threads |= progress->threads > 0;
	if (progress->phase != state->phase)
	{
		/* phases that return with each batch count as one: the rate is that of all batches */
		if (state->total == 0 || state->phase == 0)
			pgstat_progress_update_param(PROGRESS_ABACUS_PHASE_START, GetCurrentTimestamp());
		state->phase = progress->phase;
	}
	pgstat_progress_update_multi_param(lengthof(slots), slots, values);
}

void
progress_end(Progress *state)
{
	if (state->active)
		pgstat_progress_end_command();
	if (state->active && state->had_threads)
		last_with_threads = time_used(state);
	state->active = false;
}

/* False if there was none. */
bool
progress_last_with_threads(ProcessorTime *used)
{
	*used = last_with_threads;
	return used->elapsed > 0;
}

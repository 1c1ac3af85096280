/*
 * build_progress.c: what a build over several servers does now, for other sessions to read. The session
 * has one build at a time. An error ends the display by itself.
 */
#include "postgres.h"

#include "pg/host/progress.h"
#include "pg/shards/build_progress.h"

static Progress shown;
static abacus_progress figures;

void
build_progress_begin(Oid mesh)
{
	progress_begin(&shown, mesh);
}

/* The view shows the number of rounds in place of pages read. */
void
build_progress(BuildPhaseShown phase, int64 done, int64 total, int rounds)
{
	figures = (abacus_progress) {
		.phase = (abacus_phase) phase, .done = (uint64) done, .total = (uint64) total, .pages_read = (uint64) rounds
	};
	progress_report(&shown, &figures);
}

/* More is done in the same phase. */
void
build_progress_add(int64 done)
{
	figures.done += (uint64) done;
	progress_report(&shown, &figures);
}

void
build_progress_end(void)
{
	progress_end(&shown);
}

/*
 * settings.c: the extension's settings.
 */
#include "postgres.h"

#include <limits.h>
#include <sched.h>

#include "access/parallel.h"
#include "miscadmin.h"
#include "postmaster/bgworker_internals.h"
#include "utils/guc.h"

#include "pg/base/settings.h"
#include "pg/port/shortcuts.h"

static int	cache_size_mb = 128;
static int	fail_host_call = 0;
static bool shortcuts = ABACUS_SHORTCUTS != 0;
static int	threads = 0;
static bool tiny_intervals = false;
static bool vacuum_moves_rows = true;

int			setting_calls_to_failure = 0;

static void
assign_fail_host_call(int value, void *extra)
{
	setting_calls_to_failure = value;
}

void
settings_define(void)
{
	DefineCustomIntVariable("abacus.cache_size",
							"Sets the size of the computational cache of a mesh.",
							"A build has one; a session keeps one for each of the last four "
							"meshes it has read.",
							&cache_size_mb, 128, 1, 16 * 1024 * 1024, PGC_USERSET, GUC_UNIT_MB,
							NULL, NULL, NULL);
	DefineCustomIntVariable("abacus.fail_host_call",
							"Makes the core's n-th call of the database fail, once.",
							"Counted from the moment of setting; 0 means none. For tests.",
							&fail_host_call, 0, 0, INT_MAX, PGC_SUSET,
							GUC_NOT_IN_SAMPLE, NULL, assign_fail_host_call, NULL);
	DefineCustomBoolVariable("abacus.shortcuts",
							 "Shows whether Abacus was built to do more than PostgreSQL offers to extensions.",
							 NULL,
							 &shortcuts, ABACUS_SHORTCUTS != 0, PGC_INTERNAL,
							 GUC_NOT_IN_SAMPLE | GUC_DISALLOW_IN_FILE, NULL, NULL, NULL);
	DefineCustomIntVariable("abacus.threads",
							"Sets how many threads compute when many points are inserted or deleted, "
							"a mesh is checked, or many places are asked for.",
							"0 means as many as max_parallel_maintenance_workers allows beside the "
							"session's own, and at most as many as there are processors.",
							&threads, 0, 0, MAX_PARALLEL_WORKER_LIMIT, PGC_USERSET, 0,
							NULL, NULL, NULL);
	DefineCustomBoolVariable("abacus.tiny_intervals",
							 "Makes threads share even little work, in pieces cut at random.",
							 "For tests.",
							 &tiny_intervals, false, PGC_SUSET, GUC_NOT_IN_SAMPLE,
							 NULL, NULL, NULL);
	DefineCustomBoolVariable("abacus.vacuum_moves_rows",
							 "Lets VACUUM move the rows of meshes to the beginning of their tables.",
							 "So it can cut the files.",
							 &vacuum_moves_rows, true, PGC_USERSET, 0, NULL, NULL, NULL);
	MarkGUCPrefixReserved("abacus");
}

/* Bytes that a computational cache may take. */
size_t
setting_cache_bytes(void)
{
	return (size_t) cache_size_mb * 1024 * 1024;
}

/* Bytes that sorting points may take, for a change of a mesh. */
size_t
setting_sort_bytes(void)
{
	return (size_t) maintenance_work_mem * 1024;
}

/* The same for a query. */
size_t
setting_query_sort_bytes(void)
{
	return (size_t) work_mem * 1024;
}

/* How many processors this process may run on. */
static int
processors(void)
{
	cpu_set_t	set;

	return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
}

/* How many threads may compute at once. A parallel worker uses only one, as it is one of many. */
int
setting_threads(void)
{
	if (IsParallelWorker())
		return 1;
	return threads != 0 ? threads : Min(1 + max_parallel_maintenance_workers, processors());
}

bool
setting_tiny_intervals(void)
{
	return tiny_intervals;
}

/* Whether VACUUM moves the rows of meshes before it cuts their files. */
bool
setting_vacuum_moves_rows(void)
{
	return vacuum_moves_rows;
}

/*
 * host_control.c: what the core learns from the session, and what others see of its work:
 * interrupts, progress, and how many threads may compute.
 *
 * The core's threads end before its functions return. A FATAL error ends the session in
 * the middle of one, so the threads are stopped before anything that they use goes away.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "storage/ipc.h"

#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/host/host_parts.h"

static abacus_host_status
host_poll(void *context)
{
	Host	   *host = context;

	GUARD_BEGIN();
	CHECK_FOR_INTERRUPTS();
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_progress(void *context, const abacus_progress *progress)
{
	Host	   *host = context;

	GUARD_BEGIN();
	progress_report(&host->progress, progress);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static void
stop_threads(int code, Datum arg)
{
	abacus_stop_threads();
}

/*
 * Registered when it may be needed, since processes drop callbacks that the postmaster registered.
 */
static void
stop_threads_at_exit(void)
{
	static bool is_registered = false;

	if (!is_registered)
		before_shmem_exit(stop_threads, (Datum) 0);
	is_registered = true;
}

void
host_control_init(Host *host)
{
	host->table.threads = (unsigned) setting_threads();
	host->table.tiny_intervals = setting_tiny_intervals();
	if (host->table.threads > 1)
		stop_threads_at_exit();
	StaticAssertStmt(sizeof(InterruptPending) == sizeof(int), "the core reads the flag as an int");
	host->table.interrupted = (const volatile int *) &InterruptPending;
	host->table.poll = host_poll;
	host->table.progress = host_progress;
}

/*
 * host_control.c: what the core hears from the session, and what others hear of its
 * work: interrupts and progress.
 */
#include "postgres.h"

#include "miscadmin.h"

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

void
host_control_init(Host *host)
{
	StaticAssertStmt(sizeof(InterruptPending) == sizeof(int), "the core reads the flag as an int");
	host->table.interrupted = (const volatile int *) &InterruptPending;
	host->table.poll = host_poll;
	host->table.progress = host_progress;
}

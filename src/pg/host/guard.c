/*
 * guard.c: handles an error between the core's call and its return.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/base/settings.h"
#include "pg/host/guard.h"

/* Whether this is the call that abacus.fail_host_call wants to fail. */
bool
guard_failure_is_due(void)
{
	return setting_calls_to_failure > 0 && --setting_calls_to_failure == 0;
}

void
guard_inject_failure(void)
{
	if (unlikely(guard_failure_is_due()))
		ereport(ERROR,
				(errcode(ERRCODE_IO_ERROR),
				 errmsg("injected failure"),
				 errdetail("The setting abacus.fail_host_call asks for it.")));
}

/* Keeps the error being handled until the core has returned. */
void
guard_keep_error(Host *host)
{
	PG_TRY();
	{
		MemoryContextReset(host->errors);
		MemoryContextSwitchTo(host->errors);
		host->error = CopyErrorData();
	}
	PG_CATCH();
	{
		host->error = NULL;		/* no memory for the copy: see host_leave() */
	}
	PG_END_TRY();
	FlushErrorState();
}

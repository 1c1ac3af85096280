/*
 * guard.h: around the PostgreSQL calls of a function that the core calls.
 *
 *     GUARD_BEGIN();
 *     pages->functions->put(pages->owner, kind, page);
 *     GUARD_END(host);
 *     return ABACUS_HOST_OK;
 *
 * An error between BEGIN and END is kept, and the function returns ABACUS_HOST_FAILED (host.c says
 * why).
 */
#ifndef ABACUS_GUARD_H
#define ABACUS_GUARD_H

#include "pg/host/host.h"

extern bool guard_failure_is_due(void);
extern void guard_inject_failure(void);
extern void guard_keep_error(Host *host);

#define GUARD_BEGIN() \
	do { \
		MemoryContext guard_context = CurrentMemoryContext; \
		PG_TRY(); \
		{ \
			guard_inject_failure();

#define GUARD_END(host) \
		} \
		PG_CATCH(); \
		{ \
			guard_keep_error(host); \
			MemoryContextSwitchTo(guard_context); \
			return ABACUS_HOST_FAILED; \
		} \
		PG_END_TRY(); \
	} while (0)

#endif

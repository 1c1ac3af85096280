/*
 * host_parts.h: the parts of a host, each of which fills in its functions of the table.
 *
 * A part's functions run PostgreSQL under a guard (guard.h). None may be called by
 * a thread other than the session's.
 */
#ifndef ABACUS_HOST_PARTS_H
#define ABACUS_HOST_PARTS_H

#include "pg/host/host.h"

extern void host_memory_init(Host *host);
extern void host_control_init(Host *host);
extern void host_pages_init(Host *host);
extern void host_spools_init(Host *host);

#endif

/*
 * host_parts.h: the parts of a host, each of which fills in its functions of the table.
 *
 * A part's functions run PostgreSQL under a guard (guard.h). Only the session's thread may call
 * them.
 */
#ifndef ABACUS_HOST_PARTS_H
#define ABACUS_HOST_PARTS_H

#include "pg/host/host.h"

extern void host_memory_init(Host *host);
extern void host_control_init(Host *host);
extern void host_pages_init(Host *host);
extern void host_spools_init(Host *host);

#endif

/*
 * host.h: the database as the core sees it, and the way errors go between
 * the two.
 *
 * A Host joins one abacus_host table, the pages of one mesh and one core
 * handle. Every call of the core goes through host_run():
 *
 *     status = host_run(host, abacus_scan_next(scan, &simplex, &host->failure));
 *
 * which returns only ABACUS_OK or ABACUS_END; a failure is raised as an
 * ERROR once the core has returned and no C++ frame is left.
 */
#ifndef ABACUS_HOST_H
#define ABACUS_HOST_H

#include "abacus/host.h"

#include "pg/mesh/mesh.h"
#include "pg/progress.h"
#include "pg/store/page_store.h"

typedef struct Host
{
	abacus_host table;			/* what the core is given; its context is this Host */
	abacus_error failure;		/* the core's own error */
	ErrorData  *error;			/* PostgreSQL's error, kept until the core has returned */
	bool		busy;			/* in a core call, or left in one by an error */
	PageStore	store;
	Progress	progress;
	struct StoredNames *names;	/* of attributes, where they are converted: header.c */
	MemoryContext home;			/* of this struct and the open tables */
	MemoryContext core;			/* of the core's handle */
	MemoryContext errors;		/* of `error` */
	void	   *handle;			/* the core handle, if one is open */
	void		(*close) (void *handle);
} Host;

extern Host *host_create(MemoryContext parent, Oid mesh, MeshAccess access);
extern void host_own(Host *host, void *handle, void (*close) (void *handle));
extern void host_release(Host *host);
extern void host_destroy(Host *host);

extern void host_enter(Host *host);
extern abacus_status host_leave(Host *host, abacus_status status);

#define host_run(host, call) (host_enter(host), host_leave((host), (call)))

#endif

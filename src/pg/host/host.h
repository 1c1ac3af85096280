/*
 * host.h: the database as the core sees it, and how errors pass between the two.
 *
 * A Host joins one abacus_host table and one core handle. Its parts have files
 * of their own: memory (host_memory.c), control (host_control.c: interrupts and
 * progress), pages (host_pages.c) and spools (host_spools.c). Every call of the
 * core goes through host_run(), which gives the place for the core's own error
 * as the last argument:
 *
 *     status = host_run(host, abacus_scan_next, scan, &simplex);
 *
 * It returns only ABACUS_OK or ABACUS_END; a failure is raised as an ERROR once
 * the core has returned and no C++ frame is left.
 *
 * Each page is of a kind. The code that knows how the pages of a kind are stored
 * registers functions for it. A host without such functions has memory, control and
 * spools.
 */
#ifndef ABACUS_HOST_H
#define ABACUS_HOST_H

#include "abacus/host_functions.h"

#include "pg/host/progress.h"

/* How the pages of a kind are found and stored: as in abacus_host, but with PostgreSQL's errors. */
typedef struct HostPageFunctions
{
	bool		(*find) (void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page);
	bool		(*fetch) (void *owner, abacus_page_kind kind, abacus_page *page);
	bool		(*next) (void *owner, abacus_page_kind kind, const abacus_key *key,
						 abacus_page *page);
	void		(*put) (void *owner, abacus_page_kind kind, abacus_page *page);
	void		(*erase) (void *owner, abacus_page_kind kind, const abacus_page *page);
	void		(*doubt) (void *owner); /* pages do not fit: an error if our snapshot is the cause */
	void		(*release) (void *owner);	/* relations, scans, pins; more than once does no harm */
} HostPageFunctions;

/* Of a kind that has no pages: each fails but the last two. For kinds that need only some of them. */
extern const HostPageFunctions host_no_pages;

typedef struct HostPageKind
{
	const HostPageFunctions *functions;
	void	   *owner;
} HostPageKind;

typedef struct Host
{
	abacus_host table;			/* what the core gets; its context is this Host */
	abacus_error failure;		/* the core's own error */
	ErrorData  *error;			/* PostgreSQL's error, kept until the core has returned */
	bool		busy;			/* in a core call, or left in one by an error */
	HostPageKind pages[ABACUS_MAX_PAGE_KINDS];
	Progress	progress;
	struct StoredNames *names;	/* of attributes, if they are converted: header.c */
	MemoryContext home;			/* of this struct and the open tables */
	MemoryContext core;			/* of the core's handle */
	MemoryContext errors;		/* of `error` */
	void	   *handle;			/* the core handle, if one is open */
	void		(*close) (void *handle);
} Host;

extern Host *host_create(MemoryContext parent);
extern void host_register_pages(Host *host, abacus_page_kind kind,
								const HostPageFunctions *functions, void *owner);
extern void host_own(Host *host, void *handle, void (*close) (void *handle));
extern void host_doubt_pages(Host *host);
extern void host_release(Host *host);
extern void host_destroy(Host *host);

extern void host_enter(Host *host);
extern abacus_status host_leave(Host *host, abacus_status status);
extern abacus_status host_leave_both(Host *host, Host *other, abacus_status status);

#define host_run(host, function, ...) \
	host_check((host), function(__VA_ARGS__, &(host)->failure))

/* The same around a call that says itself where its error goes. */
#define host_check(host, call) (host_enter(host), host_leave((host), (call)))

/* The same for a call that uses two hosts, the first of which gets the core's error. */
#define host_check_both(host, other, call) \
	(host_enter(host), host_enter(other), host_leave_both((host), (other), (call)))

#endif

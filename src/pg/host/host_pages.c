/*
 * host_pages.c: pages by kind, for the code that has registered the kind.
 */
#include "postgres.h"

#include "pg/host/guard.h"
#include "pg/host/host_parts.h"
#include "pg/port/port.h"

/* The functions of a kind that is not registered. */

pg_noreturn static void
fail_unregistered(abacus_page_kind kind)
{
	elog(ERROR, "pages of kind %u have no place", (unsigned) kind);
}

static bool
find_nowhere(void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	fail_unregistered(kind);
}

static bool
fetch_nowhere(void *owner, abacus_page_kind kind, abacus_page *page)
{
	fail_unregistered(kind);
}

static bool
next_nowhere(void *owner, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	fail_unregistered(kind);
}

static void
put_nowhere(void *owner, abacus_page_kind kind, abacus_page *page)
{
	fail_unregistered(kind);
}

static void
erase_nowhere(void *owner, abacus_page_kind kind, const abacus_page *page)
{
	fail_unregistered(kind);
}

static void
doubt_nothing(void *owner)
{
}

static void
release_nothing(void *owner)
{
}

const HostPageFunctions host_no_pages = {
	find_nowhere, fetch_nowhere, next_nowhere, put_nowhere, erase_nowhere, doubt_nothing,
	release_nothing
};

static abacus_host_status
host_find(void *context, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	Host	   *host = context;
	const HostPageKind *pages = &host->pages[kind];
	volatile bool found = false;

	GUARD_BEGIN();
	found = pages->functions->find(pages->owner, kind, key, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_fetch(void *context, abacus_page_kind kind, abacus_page *page)
{
	Host	   *host = context;
	const HostPageKind *pages = &host->pages[kind];
	volatile bool found = false;

	GUARD_BEGIN();
	found = pages->functions->fetch(pages->owner, kind, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_next(void *context, abacus_page_kind kind, const abacus_key *key, abacus_page *page)
{
	Host	   *host = context;
	const HostPageKind *pages = &host->pages[kind];
	volatile bool found = false;

	GUARD_BEGIN();
	found = pages->functions->next(pages->owner, kind, key, page);
	GUARD_END(host);
	return found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_put(void *context, abacus_page_kind kind, abacus_page *page)
{
	Host	   *host = context;
	const HostPageKind *pages = &host->pages[kind];

	GUARD_BEGIN();
	pages->functions->put(pages->owner, kind, page);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_erase(void *context, abacus_page_kind kind, const abacus_page *page)
{
	Host	   *host = context;
	const HostPageKind *pages = &host->pages[kind];

	GUARD_BEGIN();
	pages->functions->erase(pages->owner, kind, page);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

void
host_pages_init(Host *host)
{
	for (int kind = 0; kind < ABACUS_MAX_PAGE_KINDS; kind++)
		host_register_pages(host, kind, &host_no_pages, NULL);
	host->table.find = host_find;
	host->table.fetch = host_fetch;
	host->table.next = host_next;
	host->table.put = host_put;
	host->table.erase = host_erase;
}

/* Registers the functions that find and store the pages of a kind. */
void
host_register_pages(Host *host, abacus_page_kind kind, const HostPageFunctions *functions,
					void *owner)
{
	Assert(kind < ABACUS_MAX_PAGE_KINDS);
	host->pages[kind].functions = functions;
	host->pages[kind].owner = owner;
}

/*
 * The core has found pages that do not fit together. If their store knows why, it
 * raises the error.
 */
void
host_doubt_pages(Host *host)
{
	for (int kind = 0; kind < ABACUS_MAX_PAGE_KINDS; kind++)
		host->pages[kind].functions->doubt(host->pages[kind].owner);
}

/* Releases relations, scans and pins, none of which may outlive an SQL call. */
void
host_release(Host *host)
{
	for (int kind = 0; kind < ABACUS_MAX_PAGE_KINDS; kind++)
		host->pages[kind].functions->release(host->pages[kind].owner);
}

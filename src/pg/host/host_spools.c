/*
 * host_spools.c: temporary files for the core.
 */
#include "postgres.h"

#include "pg/host/guard.h"
#include "pg/host/host_parts.h"
#include "pg/host/spool.h"
#include "pg/host/temp_room.h"

static abacus_host_status
host_spool_create(void *context, void **spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	*spool = spool_create(host->home);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_write(void *context, void *spool, const void *bytes, size_t size)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_write(spool, bytes, size);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_rewind(void *context, void *spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_rewind(spool);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_read(void *context, void *spool, void *bytes, size_t size)
{
	Host	   *host = context;
	volatile bool more = false;

	GUARD_BEGIN();
	more = spool_read(spool, bytes, size);
	GUARD_END(host);
	return more ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
host_spool_close(void *context, void *spool)
{
	Host	   *host = context;

	GUARD_BEGIN();
	spool_close(spool);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_expect(void *context, double bytes)
{
	Host	   *host = context;

	GUARD_BEGIN();
	temp_room_require(bytes);
	GUARD_END(host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
host_spool_fits(void *context, double bytes)
{
	Host	   *host = context;
	bool		fits;

	GUARD_BEGIN();
	fits = temp_room_has(bytes);
	GUARD_END(host);
	return fits ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

void
host_spools_init(Host *host)
{
	host->table.spool_create = host_spool_create;
	host->table.spool_write = host_spool_write;
	host->table.spool_rewind = host_spool_rewind;
	host->table.spool_read = host_spool_read;
	host->table.spool_close = host_spool_close;
	host->table.spool_expect = host_spool_expect;
	host->table.spool_fits = host_spool_fits;
}

/*
 * abacus.c: the module.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/connect/connection.h"
#include "pg/fdw/published.h"
#include "pg/levels/levels_table.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/port/port.h"
#include "pg/remote/remote_pages.h"
#include "pg/shards/shard_transaction.h"
#include "pg/space/vacuum.h"
#include "pg/track/pending.h"
#include "pg/track/tracking.h"

PG_MODULE_MAGIC_EXT(.name = "abacus", .version = ABACUS_VERSION);

SQL_FUNCTION(abacus_sql_version);

extern PGDLLEXPORT void _PG_init(void);

/* Binds what belongs to a mesh and comes from a dump. */
static void
bind_restored(Relation mesh)
{
	tracking_bind_restored(mesh);
	published_bind_restored(mesh);
	levels_bind(mesh);
}

void
_PG_init(void)
{
	settings_define();
	mesh_cache_init();
	vacuum_init();
	mesh_tell_of_restored(bind_restored);
	pending_init();
	connection_init();
	remote_pages_init();
	shard_transaction_init();
}

/* The version of the module, which may differ from that of the extension's SQL objects. */
Datum
abacus_sql_version(PG_FUNCTION_ARGS)
{
	PG_RETURN_TEXT_P(cstring_to_text(ABACUS_VERSION));
}

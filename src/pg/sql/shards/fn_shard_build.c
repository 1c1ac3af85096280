/*
 * fn_shard_build.c: abacus_shard_create, abacus_shard_build and abacus_shard_drop: a mesh over several
 * servers is made and removed.
 *
 * The build has phases. Each ends with a commit on the servers, and then one of the coordinator's row,
 * which says how far the build is. So the same call goes on after a failure, and a phase that was
 * committed only in part is done again. A new generation has other meshes on the servers than the one
 * that readers see: they see the former one until the last phase.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/pg_class.h"
#include "common/md5.h"
#include "executor/spi.h"
#include "foreign/foreign.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "tcop/pquery.h"
#include "utils/acl.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/inval.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"

#include "pg/base/commits.h"
#include "pg/base/sql_function.h"
#include "pg/base/utility.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/new_table.h"
#include "pg/mesh/shape.h"
#include "pg/port/port.h"
#include "pg/shards/build_progress.h"
#include "pg/shards/exchange.h"
#include "pg/shards/shard_drop.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_state.h"
#include "pg/shards/spread.h"

SQL_FUNCTION(abacus_sql_shard_create);
SQL_FUNCTION(abacus_sql_shard_build);
SQL_FUNCTION(abacus_sql_shard_build_each);
SQL_FUNCTION(abacus_sql_shard_drop);

#define TOKEN_BYTES 6
#define MD5_DIGEST_HEX 32

/* ---- abacus_shard_create -------------------------------------------------------------------- */

static char **
servers_argument(ArrayType *array, int *count)
{
	Datum	   *names = shape_names(array, "servers", count);
	char	  **servers = palloc(Max(1, *count) * sizeof(char *));

	if (*count == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("servers must not be empty"),
				 errhint("Name a foreign server for each shard.")));
	for (int i = 0; i < *count; i++)
		servers[i] = TextDatumGetCString(names[i]);
	return servers;
}

static char *
new_token(void)
{
	unsigned char bytes[TOKEN_BYTES];
	char	   *token = palloc(2 * TOKEN_BYTES + 1);

	if (!pg_strong_random(bytes, TOKEN_BYTES))
		ereport(ERROR,
				(errcode(ERRCODE_INTERNAL_ERROR),
				 errmsg("could not generate a random token")));
	for (int i = 0; i < TOKEN_BYTES; i++)
		snprintf(token + 2 * i, 3, "%02x", bytes[i]);
	return token;
}

/* Finds out whether all servers can be reached and have this extension. */
static void
no_work(ShardLinks *links, void *context)
{
}

/* The table on the coordinator; the caller's usual rights are needed. */
static Oid
make_table(text *name, Oid extension_namespace)
{
	RangeVar   *range = new_table_name(name);
	Oid			namespace;
	Oid			table;

	namespace = new_table_schema(range);
	new_table_check_name(namespace, range->relname);
	new_table_create(psprintf("CREATE TABLE %s OF %s (PRIMARY KEY (generation)) USING heap",
							  quote_qualified_identifier(get_namespace_name(namespace), range->relname),
							  quote_qualified_identifier(get_namespace_name(extension_namespace), SHARD_GENERATION_TYPE)),
					 range->relname);
	table = new_table_id(namespace, range->relname);
	new_table_describe(table, "a mesh over several servers: see abacus_shards()",
					   get_relname_relid(SHARD_GENERATION_TYPE, extension_namespace), SHARD_GENERATION_COLUMNS);
	CommandCounterIncrement();
	return table;
}

/*
 * abacus_shard_create(mesh text, servers text[], dimension int, attributes text[], lower float8[],
 * upper float8[]) -> regclass
 */
Datum
abacus_sql_shard_create(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Generation	generation = {0};
	ShardLinks	links;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, servers and dimension must not be NULL")));
	generation.servers = servers_argument(PG_GETARG_ARRAYTYPE_P(1), &generation.shards);
	shape_dimension(&header->facts.form, PG_GETARG_INT32(2));
	if (!PG_ARGISNULL(3))
	{
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(3));
		generation.attribute_count = (int) header->facts.columns.attributes;
		generation.attributes = palloc(Max(1, generation.attribute_count) * sizeof(char *));
		for (int i = 0; i < generation.attribute_count; i++)
			generation.attributes[i] = header->names[i];
	}
	shape_domain(&header->facts.form, PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4),
				 PG_ARGISNULL(5) ? NULL : PG_GETARG_ARRAYTYPE_P(5));
	generation.form = header->facts.form;
	generation.names_given = generation.attributes != NULL;
	generation.domain_given = generation.form.has_domain != 0;
	generation.token = new_token();
	PreventCommandIfReadOnly("abacus_shard_create()");
	PreventCommandIfParallelMode("abacus_shard_create()");

	SPI_connect();
	links_prepare(&links, generation.servers, generation.shards);
	links_run(&links, no_work, NULL);
	generation.relid = make_table(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid));
	generation_insert(&generation);
	SPI_finish();
	PG_RETURN_OID(generation.relid);
}

/* ---- Generations that nobody needs ---------------------------------------------------------- */

static void
drop_meshes(ShardLinks *links, void *context)
{
	const Generation *generation = context;

	for (int i = 0; i < generation->shards; i++)
		link_do(links, i, shard_sql_drop(generation, i));
}

/* Drops the meshes of a generation on its servers. */
static void
drop_generation(Generation *generation)
{
	ShardLinks	links;

	links_prepare(&links, generation->servers, generation->shards);
	links_run(&links, drop_meshes, generation);
}

/* ---- abacus_shard_build --------------------------------------------------------------------- */

/* A digest of the queries: the same call goes on, another one begins anew. */
static char *
digest(const ShardSource *source, int count)
{
	StringInfoData all;
	char	   *hash = palloc(MD5_DIGEST_HEX + 1);
	const char *error;

	initStringInfo(&all);
	for (int i = 0; i < count; i++)
		appendStringInfo(&all, "%zu %s;", strlen(source->queries[i]), source->queries[i]);
	appendStringInfoChar(&all, source->is_here ? 'h' : 't');
	if (!pg_md5_hash(all.data, (size_t) all.len, hash, &error))
		elog(ERROR, "could not compute a digest of the queries: %s", error);
	return hash;
}

static void
commit(void)
{
	SPI_commit();
	EnsurePortalSnapshotExists();
}

/* What was not given when the mesh was created comes from the points again. */
static void
begin_anew(Generation *generation, const char *source)
{
	generation->phase = SHARDS_NEW;
	generation->source = pstrdup(source);
	generation->form.has_domain = generation->domain_given;
	generation->form.srid = 0;
	if (!generation->names_given)
		generation->attributes = NULL;
	generation->attribute_count = generation->names_given ? generation->attribute_count : 0;
	generation->points = generation->sent = 0;
	generation->rounds = 0;
	generation->borders = NULL;
	memset(generation->versions, 0, generation->shards * sizeof(int64));
}

/* Drops the meshes of generations before this one, which nobody can begin to read any more. */
static void
drop_before(const Generation *kept)
{
	Generation	old = {.number = -1};

	while (generation_read_after(kept->relid, old.number, &old) && old.number < kept->number)
	{
		drop_generation(&old);
		generation_forget(&old);
		commit();
	}
}

typedef struct BuildPhase
{
	Generation *generation;
	const ShardSource *source;
	int			missing;		/* meshes on servers */
} BuildPhase;

static void
count_missing(ShardLinks *links, void *context)
{
	BuildPhase *phase = context;

	phase->missing = shard_count_missing(phase->generation, links);
}

/* Whether a build can go on: nobody has dropped a mesh of its on a server meanwhile. */
static bool
can_go_on(Generation *generation)
{
	BuildPhase	phase = {.generation = generation};
	ShardLinks	links;

	if (generation->phase == SHARDS_NEW)
		return true;
	links_prepare(&links, generation->servers, generation->shards);
	links_run(&links, count_missing, &phase);
	return phase.missing == 0;
}

/* The generation to be built: the newest one, if this call is to go on with it, else another one. */
static void
choose_generation(Oid relid, const char *source, Generation *generation)
{
	if (!generation_read(relid, false, generation))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("the table of mesh \"%s\" is empty", get_rel_name(relid)),
				 errhint("Drop it, and make the mesh again with abacus_shard_create().")));
	if (generation->phase == SHARDS_PUBLISHED)
	{
		drop_before(generation);
		begin_anew(generation, source);
		generation->number++;
		generation_insert(generation);
		commit();
	}
	else if (generation->source == NULL || strcmp(generation->source, source) != 0 || !can_go_on(generation))
	{
		if (generation->source != NULL)
			drop_generation(generation);
		begin_anew(generation, source);
		generation_update(generation);
		commit();
	}
}

static void
run_phase(ShardLinks *links, void *context)
{
	BuildPhase *phase = context;
	Generation *generation = phase->generation;

	switch (generation->phase)
	{
		case SHARDS_NEW:
			spread_points(generation, links, phase->source);
			break;
		case SHARDS_SPREAD:
			triangulate_shards(generation, links);
			break;
		default:
			exchange_vertices(generation, links);
	}
}

/* All phases that are left. */
static void
build(Oid relid, const ShardSource *source, int queries)
{
	Generation	generation;
	BuildPhase	phase = {.generation = &generation,.source = source};
	ShardLinks	links;

	choose_generation(relid, digest(source, queries), &generation);
	links_prepare(&links, generation.servers, generation.shards);
	while (generation.phase != SHARDS_PUBLISHED)
	{
		links_run(&links, run_phase, &phase);
		generation.phase++;
		generation_update(&generation);
		commit();
	}
}

static void
require_owner(Oid relid)
{
	mesh_require_sharded(relid);
	if (!object_ownercheck(RelationRelationId, relid, GetUserId()))
		aclcheck_error(ACLCHECK_NOT_OWNER, OBJECT_TABLE, get_rel_name(relid));
}

/*
 * Checks the table and keeps other builds away; the caller unlocks, and so does an error. No other lock is
 * held while it waits.
 */
static LockRelId
lock_table(Oid relid)
{
	LockRelId	lock = {.relId = relid,.dbId = MyDatabaseId};

	require_owner(relid);
	LockRelationIdForSession(&lock, ShareUpdateExclusiveLock);
	AcceptInvalidationMessages();
	require_owner(relid);		/* the table may have been dropped meanwhile */
	return lock;
}

static void
build_locked(FunctionCallInfo fcinfo, Oid relid, ShardSource *source, int queries)
{
	LockRelId	lock;

	PreventCommandIfReadOnly("abacus_shard_build()");
	lock = lock_table(relid);
	commit();					/* for a snapshot with what the build before has left */
	build_progress_begin(relid);
	build(relid, source, queries);
	build_progress_end();
	UnlockRelationIdForSession(&lock, ShareUpdateExclusiveLock);
}

static void
require_arguments(FunctionCallInfo fcinfo, const char *second)
{
	require_commits(fcinfo, "abacus_shard_build", "phase", NULL);
	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and %s must not be NULL", second)));
}

/* abacus_shard_build(mesh regclass, query text), a procedure */
Datum
abacus_sql_shard_build(PG_FUNCTION_ARGS)
{
	ShardSource source = {.is_here = true};
	char	   *query;

	require_arguments(fcinfo, "query");
	SPI_connect_ext(SPI_OPT_NONATOMIC); /* its memory outlives transactions */
	query = text_to_cstring(PG_GETARG_TEXT_PP(1));
	source.queries = &query;
	build_locked(fcinfo, PG_GETARG_OID(0), &source, 1);
	SPI_finish();
	PG_RETURN_VOID();
}

/* abacus_shard_build(mesh regclass, queries text[]), a procedure */
Datum
abacus_sql_shard_build_each(PG_FUNCTION_ARGS)
{
	ShardSource source = {.is_here = false};
	Datum	   *queries;
	int			count;
	Generation	generation;

	require_arguments(fcinfo, "queries");
	SPI_connect_ext(SPI_OPT_NONATOMIC);
	queries = shape_names(PG_GETARG_ARRAYTYPE_P(1), "queries", &count);
	source.queries = palloc(Max(1, count) * sizeof(char *));
	for (int i = 0; i < count; i++)
		source.queries[i] = TextDatumGetCString(queries[i]);
	if (mesh_is_sharded(PG_GETARG_OID(0)) && generation_read(PG_GETARG_OID(0), false, &generation) &&
		count != generation.shards)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("there are %d queries for %d servers", count, generation.shards),
				 errhint("Give a query for each server, in the order of abacus_shards(), or one query as text, to be run here.")));
	build_locked(fcinfo, PG_GETARG_OID(0), &source, count);
	SPI_finish();
	PG_RETURN_VOID();
}

/* ---- abacus_shard_drop ---------------------------------------------------------------------- */

/* abacus_shard_drop(mesh regclass) -> void */
Datum
abacus_sql_shard_drop(PG_FUNCTION_ARGS)
{
	Oid			relid = PG_GETARG_OID(0);
	LockRelId	lock;
	Generation	generation = {.number = -1};

	PreventCommandIfReadOnly("abacus_shard_drop()");
	SPI_connect();
	lock = lock_table(relid);
	PushActiveSnapshot(GetLatestSnapshot());	/* with what a build has left that ended after ours was taken */
	while (generation_read_after(relid, generation.number, &generation))
		shard_drop(&generation);
	PopActiveSnapshot();
	utility_run(psprintf("DROP TABLE %s", lines_table_name(relid)));
	UnlockRelationIdForSession(&lock, ShareUpdateExclusiveLock);
	SPI_finish();
	PG_RETURN_VOID();
}

/*
 * fn_build.c: abacus_build, which inserts staged points into the mesh in batches and commits each.
 *
 * A batch is a change like that of abacus_triangulate: all its pages and the new header in one
 * transaction. So whatever stops the build, the mesh has the points up to the last batch, and the
 * header says where to continue.
 *
 * At the end, rows are moved to the beginning of their tables if more than a little of a table is
 * empty (compact.c), so that VACUUM can cut it. The vertex table usually has only dead rows, and is
 * truncated.
 *
 * From one batch to the next the core keeps its cache. Its data about the mesh, including the
 * places of stored pages, stay true: a lock of the session keeps other writers, VACUUM FULL and the
 * like away until the end. That lock does not cover the vertex table, so nothing of that is kept.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "utils/lsyscache.h"

#include "abacus/build.h"
#include "pg/base/commits.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/mesh/notices.h"
#include "pg/mesh/writer.h"
#include "pg/space/compact.h"
#include "pg/space/truncate.h"
#include "pg/track/pending.h"

SQL_FUNCTION(abacus_sql_build);

/* Inserts one batch from where the header says; false if nothing could be inserted. */
static bool
insert_batch(Writer *writer, abacus_build *build, uint64 limit)
{
	Host	   *host = writer->host;
	const abacus_facts *facts = &writer->header->facts;
	uint64		inserted = facts->census.inserted;
	abacus_counters before = writer->header->counters;

	host_run(host, abacus_build_run, build, limit, writer->header);
	if (facts->census.inserted == inserted)
		return false;			/* the points span no simplex yet */
	progress_batch_done(&host->progress, facts->census.inserted - inserted,
						writer->header->counters.loads - before.loads,
						writer->header->counters.stores - before.stores);
	return true;
}

/*
 * A change of its own, if it is due: a mesh whose domain does not fit its points gets new keys.
 * Returns whether there is something to commit.
 */
static bool
rekey(Writer *writer, abacus_build *build)
{
	Host	   *host = writer->host;
	const abacus_facts *facts = &writer->header->facts;
	uint64		outside = facts->census.outside;
	int			done;

	host_run(host, abacus_build_rekey, build, setting_sort_bytes(), writer->header, &done);
	if (done)
		ereport(NOTICE,
				(errmsg("mesh \"%s\" has a new domain", get_rel_name(mesh_pages(host)->mesh)),
				 errdetail("The previous domain did not fit its points; the simplices are the same.")));
	return done || facts->census.outside != outside;
}

/*
 * Also a change of its own: an old mesh with many attributes in its simplex pages gets them apart.
 */
static void
move_attributes_apart(Writer *writer)
{
	Host	   *host = writer->host;
	const abacus_facts *facts = &writer->header->facts;
	uint32	   *same = palloc(facts->columns.attributes * sizeof(uint32));
	abacus_build *build = NULL;

	for (uint32 i = 0; i < facts->columns.attributes; i++)
		same[i] = i;
	host_run(host, abacus_build_open, &host->table, facts, setting_cache_bytes(), &build);
	host_own(host, build, (void (*) (void *)) abacus_build_close);
	host_run(host, abacus_build_change_attributes, build, same, facts->columns.attributes,
			 setting_sort_bytes(), writer->header);
	host_own(host, NULL, NULL);
	pfree(same);
	ereport(NOTICE,
			(errmsg("mesh \"%s\" now has its attributes in pages of their own",
					get_rel_name(mesh_pages(host)->mesh)),
			 facts->columns.labels > 0 || facts->census.marked > 0 ? 0 :
			 errdetail("It now has format 4; versions of Abacus that read only format 3 cannot read it.")));
}

/* Ends a change and begins the next one. */
static void
commit(Writer *writer)
{
	PageTable  *simplices = &mesh_pages(writer->host)->simplices;

	writer_store(writer);
	SPI_commit();
	writer_continue(writer);
	superseded_reclaim(simplices->superseded, simplices->heap);
}

/* What is open in the core while points are inserted. */
typedef struct Handles
{
	abacus_build *build;
	abacus_segments *segments;
} Handles;

static void
close_handles(void *handle)
{
	Handles    *handles = handle;

	abacus_build_close(handles->build);
	abacus_segments_close(handles->segments);
}

/* Inserts all waiting points, and fixes the edges of lines that have waited for them. */
static void
insert_all(Writer *writer, uint64 batch)
{
	Host	   *host = writer->host;
	const abacus_facts *facts = &writer->header->facts;
	uint64		duplicates = facts->census.duplicates;
	Handles    *handles = MemoryContextAllocZero(host->home, sizeof(Handles));

	if (!facts->columns.apart && abacus_are_apart(facts->form.dimension, facts->columns.attributes))
	{
		move_attributes_apart(writer);
		commit(writer);
	}
	host_run(host, abacus_build_open, &host->table, facts, setting_cache_bytes(), &handles->build);
	host_own(host, handles, close_handles);
	if (rekey(writer, handles->build))
		commit(writer);
	while (facts->census.inserted < facts->census.staged && insert_batch(writer, handles->build, batch))
		commit(writer);
	if (facts->census.lines_wait > 0)
	{
		mesh_lines_fix_waiting(writer, handles->build, &handles->segments);
		commit(writer);
	}
	notice_duplicates(writer, duplicates, false);
	notice_waiting(writer);
	host_own(host, NULL, NULL);	/* the core would look for pages in their old places */
}

/* abacus_build(mesh regclass, batch bigint), a procedure */
Datum
abacus_sql_build(PG_FUNCTION_ARGS)
{
	Oid			mesh;
	Oid			vertices;
	int64		batch;
	LockRelId	lock;
	Writer		writer;
	const abacus_facts *facts;
	Host	   *host;
	PageTable  *simplices;

	require_commits(fcinfo, "abacus_build", "batch", "abacus_triangulate");
	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and batch must not be NULL")));
	mesh = PG_GETARG_OID(0);
	batch = PG_GETARG_INT64(1);
	if (batch < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("batch must be at least 1")));
	writer_prevent_read_only(mesh, "abacus_build()");	/* before the lock, which a standby lacks */

	SPI_connect_ext(SPI_OPT_NONATOMIC); /* its memory outlives transactions */
	pending_settle(mesh);		/* not in the middle of the build, by a commit */
	lock = mesh_lock_for_session(mesh);
	writer_begin(&writer, mesh, MESH_WRITE, "abacus_build()");
	host = writer.host;
	facts = &writer.header->facts;
	simplices = &mesh_pages(host)->simplices;
	simplices->superseded = superseded_create(host->home);
	progress_in_batches(&host->progress, facts->census.staged - facts->census.inserted);
	/* a mesh that is not Delaunay has no waiting points, but may still need binding */
	if (abacus_is_editable(facts->standing))
		insert_all(&writer, (uint64) batch);
	compact(&writer, true, true);
	vertices = mesh_pages_vertex_table(mesh_pages(host));
	writer_close(&writer);
	if (truncate_if_empty(vertices))
		SPI_commit();			/* lets readers see it */
	SPI_finish();
	UnlockRelationIdForSession(&lock, ShareRowExclusiveLock);
	PG_RETURN_VOID();
}

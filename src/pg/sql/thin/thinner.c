/*
 * thinner.c: a mesh that is thinned, step by step.
 *
 * The core says which vertices of the source a step adds; they go through a stage into the growing
 * mesh, as those of a query do. The source is opened anew for each step, since a snapshot ends with
 * its transaction. Its stamp shows whether it is still the same.
 */
#include "postgres.h"

#include "access/table.h"
#include "executor/spi.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/sql/thin/thinner.h"
#include "pg/sql/thin/thinning_table.h"

static void
close_handles(void *handle)
{
	Thinner    *thinner = handle;

	abacus_build_close(thinner->build);
	abacus_stage_close(thinner->stage);
	abacus_thin_close(thinner->thinning);
}

/* Opens the mesh that is thinned for a step. */
Reader *
thinner_source(const Thinner *thinner)
{
	Reader	   *source = reader_open(thinner->source, CurrentMemoryContext);

	if (source->header.stamp != thinner->stamp)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has changed since its thinning began", get_rel_name(thinner->source)),
				 thinner->commits
				 ? errhint("Drop mesh \"%s\", and thin anew.", get_rel_name(thinner->mesh))
				 : errhint("Call %s again.", thinner->command)));
	return source;
}

static void
source_close_host(Reader *source)
{
	host_release(source->host);
	host_destroy(source->host);
}

/* Opens the mesh that grows. */
void
thinner_begin(Thinner *thinner)
{
	PageTable  *simplices;
	Host	   *host;

	writer_begin(&thinner->writer, thinner->mesh, MESH_WRITE, thinner->command);
	host = thinner->writer.host;
	thinner->thinning = NULL;
	thinner->stage = NULL;
	thinner->build = NULL;
	host_own(host, thinner, close_handles);
	simplices = &mesh_pages(host)->simplices;
	if (thinner->commits)
		simplices->superseded = superseded_create(host->home);
	host_run(host, abacus_thin_open, &host->table, &thinner->writer.header->facts, &thinner->options,
			 &thinner->thinning);
}

/* Ends a change and begins the next one. */
static void
commit(Thinner *thinner)
{
	PageTable  *simplices = &mesh_pages(thinner->writer.host)->simplices;
	Relation	mesh;

	writer_store(&thinner->writer);
	mesh = mesh_table_open(thinner->mesh, MESH_WRITE);
	thinning_table_reach(mesh, (int64) thinner->writer.header->stamp);
	table_close(mesh, NoLock);
	SPI_commit();
	writer_continue(&thinner->writer);
	superseded_reclaim(simplices->superseded, simplices->heap);
}

static void
insert_stage(Thinner *thinner)
{
	Host	   *host = thinner->writer.host;
	abacus_header *header = thinner->writer.header;

	host_run(host, abacus_stage_end, thinner->stage, &header->facts);
	if (thinner->build == NULL)
	{
		host_run(host, abacus_build_open, &host->table, &header->facts, setting_cache_bytes(),
				 &thinner->build);
		if (header->facts.census.lines > 0)
			mesh_lines_attach(host, thinner->build);
	}
	header->facts.census.knows_ids = 0; /* of those that come */
	host_run(host, abacus_build_insert, thinner->build, thinner->stage, ABACUS_KEEP, header);
}

/* Adds the vertices of a step to the mesh; returns how many. */
uint64
thinner_step(Thinner *thinner, abacus_thin_step step)
{
	Host	   *host = thinner->writer.host;
	abacus_facts *facts = &thinner->writer.header->facts;
	Reader	   *source = thinner_source(thinner);
	uint64		added;

	abacus_stage_close(thinner->stage);
	thinner->stage = NULL;
	host_run(host, abacus_stage_open, &host->table, facts, setting_sort_bytes() / 2, &thinner->stage);
	host_check_both(host, source->host,
					abacus_thin_find(thinner->thinning, step, &source->host->table,
									 &source->header.facts, facts, thinner->stage, &added,
									 &host->failure));
	source_close_host(source);
	if (added > 0)
		insert_stage(thinner);
	host_run(host, abacus_thin_inserted, thinner->thinning, facts);
	if (added > 0 && thinner->commits && !thinner->holds)
		commit(thinner);
	return added;
}

/* The greatest error, and how many vertices have no value. */
double
thinner_greatest(Thinner *thinner, uint64 *without_value)
{
	Host	   *host = thinner->writer.host;
	Reader	   *source = thinner_source(thinner);
	double		greatest;

	host_check_both(host, source->host,
					abacus_thin_greatest(thinner->thinning, &source->host->table,
										 &source->header.facts, &thinner->writer.header->facts,
										 &greatest, without_value, &host->failure));
	source_close_host(source);
	return greatest;
}

/* Writes the header of the mesh and closes it. */
void
thinner_end(Thinner *thinner)
{
	writer_end(&thinner->writer);
}

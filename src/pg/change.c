/*
 * change.c: a change of a mesh with the points of a query.
 *
 * Rows go from the executor in batches of a thousand into the core's stage,
 * which brings them into order within maintenance_work_mem (beyond it in
 * temporary files). From there they go to vertex pages, or into the
 * triangulation, or are taken out of it.
 */
#include "postgres.h"

#include "miscadmin.h"

#include "pg/build.h"
#include "pg/settings.h"

/* Both handles go when the host does. */
static void
close_handles(void *handle)
{
	Change	   *change = handle;

	abacus_build_close(change->build);
	abacus_stage_close(change->stage);
}

/* Opens a mesh for changing; `command` names the function for messages. */
Change *
change_begin(Oid mesh, const char *command)
{
	Change	   *change = palloc0(sizeof(Change));

	writer_begin(&change->writer, mesh, command);
	host_own(change->writer.host, change, close_handles);
	return change;
}

/* Reads the points of a query, of the shape that a header describes, into a stage. */
void
change_read(Change *change, Source *source, const abacus_header *shape)
{
	Host	   *host = change->writer.host;
	const uint64 *points;
	size_t		count;

	source_open(source, shape);
	host_run(host, abacus_stage_open(&host->table, shape, (size_t) maintenance_work_mem * 1024,
									 &change->stage, &host->failure));
	while ((count = source_fetch(source, &points)) > 0)
	{
		host_run(host, abacus_stage_add(change->stage, points, count, &host->failure));
		change->points += count;
	}
	source_close(source);
}

/* Opens the triangulation for changes. */
void
change_open_build(Change *change)
{
	Host	   *host = change->writer.host;

	host_run(host, abacus_build_open(&host->table, change->writer.header, setting_cache_bytes(),
									 &change->build, &host->failure));
}

/* Writes the header and closes the mesh. */
void
change_end(Change *change)
{
	writer_end(&change->writer);
	pfree(change);
}

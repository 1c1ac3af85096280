/*
 * change.c: a change of a mesh with the points of a query.
 *
 * Rows go from the executor in batches of a thousand into the core's stage. It sorts
 * them within maintenance_work_mem, and beyond that in temporary files. From there the
 * points go to vertex pages or into the triangulation, or they are taken out of it.
 */
#include "postgres.h"

#include "access/xact.h"

#include "pg/base/settings.h"
#include "pg/mesh/change.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/mesh/notices.h"

/* The handles are closed with the host. */
static void
close_handles(void *handle)
{
	Change	   *change = handle;

	abacus_build_close(change->build);
	abacus_stage_close(change->stage);
	abacus_stage_close(change->put_aside);
	abacus_load_close(change->load);
	abacus_labelling_close(change->labelling);
	abacus_marking_close(change->marking);
	abacus_segments_close(change->fixed);
	abacus_segments_close(change->freed);
	abacus_segments_close(change->ties);
}

/* Initializes a change whose writer has begun. */
static Change *
begun(Change *change)
{
	change->duplicates = change->writer.header->facts.census.duplicates;
	host_own(change->writer.host, change, close_handles);
	return change;
}

/* Opens a mesh for changing; `command` names the function for messages. */
Change *
change_begin(Oid mesh, const char *command)
{
	Change	   *change = palloc0(sizeof(Change));

	writer_begin(&change->writer, mesh, MESH_WRITE, command);
	return begun(change);
}

/* The same in a function that is called as a trigger. */
Change *
change_begin_in_trigger(Oid mesh, const char *command)
{
	Change	   *change = palloc0(sizeof(Change));

	writer_begin_in_trigger(&change->writer, mesh, command);
	return begun(change);
}

/* Opens an empty stage for points of the shape that these facts describe. */
void
change_open_stage(Change *change, const abacus_facts *shape)
{
	Host	   *host = change->writer.host;

	abacus_stage_close(change->stage);
	change->stage = NULL;
	change->points = 0;
	change->point_words = 1 + shape->form.dimension + shape->columns.attributes;
	change->greatest_id = PG_INT64_MIN;
	host_run(host, abacus_stage_open, &host->table, shape, setting_sort_bytes(), &change->stage);
}

/* Adds points to the stage. */
void
change_add(Change *change, const uint64 *points, size_t count)
{
	Host	   *host = change->writer.host;

	host_run(host, abacus_stage_add, change->stage, points, count);
	for (size_t i = 0; i < count; i++)
		change->greatest_id = Max(change->greatest_id, (int64) points[i * change->point_words]);
	change->points += count;
}

static void
read_query(Change *change, Source *source, abacus_names names, bool takes_srid)
{
	const uint64 *points;
	size_t		count;

	source_open(source, names, takes_srid);
	change_open_stage(change, names.facts);
	while ((count = source_fetch(source, &points)) > 0)
		change_add(change, points, count);
	source_close(source);
}

/* Reads the points of a query that will be added to the mesh into a stage. */
void
change_read(Change *change, Source *source)
{
	read_query(change, source, abacus_names_of(change->writer.header), true);
	change_take_srid(change, source->packer->srid);
}

/* The same for points to be found in the mesh, with the given columns. */
void
change_read_gone(Change *change, Source *source, abacus_names names)
{
	read_query(change, source, names, false);
}

/* A mesh without SRID takes the SRID of the geometries read; -1: there were none. */
void
change_take_srid(Change *change, int32 srid)
{
	if (srid > 0)
		change->writer.header->facts.form.srid = (uint32) srid;
}

/* Swaps the stage with the one put aside before; the first time there is none. */
void
change_swap_stages(Change *change)
{
	abacus_stage *stage = change->stage;
	int64		greatest_id = change->greatest_id;

	change->stage = change->put_aside;
	change->greatest_id = change->greatest_aside;
	change->put_aside = stage;
	change->greatest_aside = greatest_id;
}

/*
 * From here until it is settled, everything is one change for labels and markers, however many steps
 * it takes.
 */
static void
hold(Change *change)
{
	const abacus_census *census = &change->writer.header->facts.census;

	change->holds = census->labelled > 0 || census->marked > 0;
	if (change->holds)
		host_run(change->writer.host, abacus_build_hold, change->build);
}

/* Lets labels and markers follow what has changed; the end of the change does that otherwise. */
void
change_settle(Change *change)
{
	if (change->holds)
		host_run(change->writer.host, abacus_build_settle, change->build, change->writer.header);
	change->holds = false;
}

/*
 * Opens the triangulation for changes, unless it is open. If the coming points choose the domain,
 * the header must already have it.
 */
void
change_open_build(Change *change)
{
	Host	   *host = change->writer.host;

	if (change->build != NULL)
		return;
	host_run(host, abacus_build_open, &host->table, &change->writer.header->facts,
			 setting_cache_bytes(), &change->build);
	hold(change);
	if (change->returns)
		host_run(host, abacus_build_log, change->build, setting_query_sort_bytes());
	if (change->writer.header->facts.census.lines > 0)
		mesh_lines_attach(host, change->build);
}

/*
 * From here on, queries of this session see the mesh as it has become; the change goes on. The core
 * keeps its cache, since the transaction keeps others from changing the mesh. Labels and markers
 * that are held may be those of simplices that have gone; the header that is shown counts no more of
 * them than there are simplices.
 */
void
change_show(Change *change)
{
	abacus_census *census = &change->writer.header->facts.census;
	const uint64 labelled = census->labelled;
	const uint64 marked = census->marked;

	census->labelled = Min(labelled, census->simplices);
	census->marked = Min(marked, census->simplices);
	writer_store(&change->writer);
	CommandCounterIncrement();
	writer_continue(&change->writer);
	census->labelled = labelled;
	census->marked = marked;
}

/* The points of the stage become points of the mesh: what is known of its ids stays true. */
static void
note_ids(Change *change)
{
	abacus_census *census = &change->writer.header->facts.census;

	if (census->knows_ids)
		census->greatest_id = Max(census->greatest_id, change->greatest_id);
}

/* Inserts the points of the stage. */
void
change_insert(Change *change)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;

	host_run(host, abacus_stage_end, change->stage, &header->facts);
	if (change->keeps_domain)
		header->facts.census.outside = 0;
	change_open_build(change);
	note_ids(change);
	host_run(host, abacus_build_insert, change->build, change->stage, change->on_duplicate,
			 header);
	change->inserts = true;
	mesh_lines_fix_waiting(&change->writer, change->build, &change->fixed);
}

/* Stages the points of the stage: they wait, after those that wait already. */
void
change_stage(Change *change)
{
	note_ids(change);
	host_run(change->writer.host, abacus_stage_finish, change->stage,
			 &change->writer.header->facts);
}

/*
 * Inserts points that wait, if lines wait with them, and fixes their edges: what follows deletes
 * points, or changes their attributes.
 */
static void
settle_lines(Change *change)
{
	const abacus_census *census = &change->writer.header->facts.census;

	if (census->lines_wait == 0)
		return;
	host_run(change->writer.host, abacus_build_run, change->build, 0, change->writer.header);
	mesh_lines_fix_waiting(&change->writer, change->build, &change->fixed);
}

/* Without triangles, lines wait. */
static void
let_lines_wait(Change *change)
{
	abacus_census *census = &change->writer.header->facts.census;

	if (census->lines > 0 && census->vertices == 0)
		census->lines_wait = 1;
}

/*
 * Removes the points of the stage; with `exactly`, only points with the same id and attributes.
 * Returns how many there were.
 */
uint64
change_delete(Change *change, bool exactly)
{
	Host	   *host = change->writer.host;
	uint64		deleted;

	change_open_build(change);
	settle_lines(change);
	if (!change->knows_lines)
		mesh_lines_refuse_waiting(&change->writer);
	host_run(host, abacus_build_delete, change->build, change->stage, exactly,
			 change->writer.header, &deleted);
	let_lines_wait(change);
	return deleted;
}

/*
 * Gives points new values of some attributes. The stage's points have only these attributes; with
 * `exactly`, the old values follow them, and only points that have those are changed. Returns how
 * many there were; if some were not found, *missing is one of them.
 */
uint64
change_update(Change *change, const uint32 *attributes, size_t count, bool exactly,
			  abacus_named_place *missing)
{
	Host	   *host = change->writer.host;
	uint64		updated;

	change_open_build(change);
	settle_lines(change);
	host_run(host, abacus_build_update, change->build, change->stage, attributes, count, exactly,
			 change->writer.header, &updated, missing);
	return updated;
}

/*
 * Gives all points other attributes, as abacus_build_change_attributes() does. Only the end of the
 * change may follow.
 */
void
change_attributes(Change *change, const uint32 *source, size_t count)
{
	Host	   *host = change->writer.host;

	change_open_build(change);
	host_run(host, abacus_build_change_attributes, change->build, source, count,
			 setting_sort_bytes(), change->writer.header);
}

/* Removes all points. */
void
change_clear(Change *change)
{
	Host	   *host = change->writer.host;
	uint64		deleted;

	mesh_lines_refuse_clearing(&change->writer);
	change_open_build(change);
	host_run(host, abacus_build_clear, change->build, change->writer.header, &deleted);
}

/*
 * The mesh has so many more lines, or fewer, in its table, and so many more soft ones. To be called
 * before their edges are fixed, and after they are freed.
 */
void
change_lines(Change *change, int64 more, int64 soft)
{
	abacus_facts *facts = &change->writer.header->facts;

	facts->census.lines += (uint64) more;
	facts->census.soft_lines += (uint64) soft;
	facts->standing = facts->census.lines > 0 ? ABACUS_CONSTRAINED : ABACUS_DELAUNAY;
	if (facts->census.lines == 0)
		facts->census.lines_wait = 0;
}

/* Fixes the edges of the segments in `fixed`. */
void
change_fix(Change *change)
{
	change_open_build(change);
	mesh_lines_fix(&change->writer, change->build, change->fixed);
	mesh_lines_close(change->writer.host, &change->fixed);
}

/*
 * Frees the edges of the segments in `freed`, and inserts the points that wait. Then lines that wait are
 * fixed, unless they cross.
 */
void
change_unfix(Change *change)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	abacus_region_fault fault;

	change_open_build(change);
	if (host_run(host, abacus_build_unfix, change->build, change->freed, header, &fault) == ABACUS_END)
		mesh_regions_refuse(&change->writer, &fault);
	mesh_lines_close(host, &change->freed);
	mesh_lines_fix_left(&change->writer, change->build, &change->fixed);
}

/*
 * Flips the edges of a mesh that has been loaded, and whose lines are fixed, that the perturbation decides
 * against; returns how many there were. Closes the load.
 */
uint64
change_restore_ties(Change *change)
{
	Host	   *host = change->writer.host;
	uint64		count;

	mesh_lines_open(&change->writer, &change->ties);
	host_run(host, abacus_load_ties, change->load, change->ties, &count);
	abacus_load_close(change->load);
	change->load = NULL;
	if (count > 0)
	{
		change_open_build(change);
		host_run(host, abacus_build_restore, change->build, change->ties, change->writer.header);
	}
	mesh_lines_close(host, &change->ties);
	return count;
}

/* Reports the simplices that have been created and removed, if the change returns them. */
void
change_report(Change *change, abacus_change_report report, void *context)
{
	Host	   *host = change->writer.host;

	host_run(host, abacus_build_report, change->build, report, context);
}

/* Closes the mesh, which was not changed. */
void
change_abandon(Change *change)
{
	writer_close(&change->writer);
	pfree(change);
}

/* Writes the header and closes the mesh. */
void
change_end(Change *change)
{
	let_lines_wait(change);
	change_settle(change);
	notice_duplicates(&change->writer, change->duplicates, change->may_replace);
	if (change->inserts)
		notice_waiting(&change->writer);
	writer_end(&change->writer);
	pfree(change);
}

/* Inserts the points of a prepared query and returns their number; *header is the new header. */
uint64
change_insert_query(Oid mesh, Source *source, const char *command, abacus_header *header)
{
	Change	   *change = change_begin(mesh, command);
	uint64		points;

	change_read(change, source);
	change_insert(change);
	points = change->points;
	abacus_header_copy(header, change->writer.header);
	change_end(change);
	return points;
}

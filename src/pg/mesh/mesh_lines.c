/*
 * mesh_lines.c: the lines of a mesh that is being changed, for the core.
 *
 * The core knows which edges are fixed, but not by which lines. When it frees edges or deletes a
 * vertex, it asks which segments end at a place. The answer comes from the table of lines, by its
 * index on places, and from there by the primary key to the neighbours in each line. The writer has
 * locked the header, so nobody else changes the lines meanwhile. What this transaction has changed
 * in them is visible.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/mesh/line_crossings.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/port/port.h"

#define ROWS_A_FETCH 1024

/* Questions about the lines of one mesh. */
typedef struct MeshLines
{
	Host	   *host;
	SPIPlanPtr	plan;			/* NULL before the first question */
	abacus_segment_end *ends;	/* the last answer */
	size_t		room;
	MemoryContextCallback on_end;
} MeshLines;

/* A mesh that is being changed. */
typedef struct MeshBuild
{
	Host	   *host;
	abacus_build *build;
} MeshBuild;

static Relation
mesh_of(const Host *host)
{
	return mesh_pages(host)->simplices.heap;
}

/* ---- Segments at a place ------------------------------------------------------ */

/* Plans the question, for all times that it will be asked. */
static void
prepare(MeshLines *lines)
{
	Oid			types[] = {FLOAT8OID, FLOAT8OID};
	char	   *query = lines_table_segments_at(lines_table_require(mesh_of(lines->host), MESH_WRITE));

	lines->plan = SPI_prepare_cursor(query, lengthof(types), types, CURSOR_OPT_GENERIC_PLAN);
	if (lines->plan == NULL || SPI_keepplan(lines->plan) != 0)
		elog(ERROR, "could not prepare the query of lines: %s", SPI_result_code_string(SPI_result));
}

/* Keeps the rows of the answer. */
static void
take_ends(MeshLines *lines, const SPITupleTable *rows, uint64 count)
{
	bool		isnull;

	if (count > lines->room)
	{
		if (lines->ends != NULL)
			pfree(lines->ends);
		lines->ends = MemoryContextAllocHuge(lines->host->home, 2 * count * sizeof(abacus_segment_end));
		lines->room = 2 * count;
	}
	for (uint64 i = 0; i < count; i++)
	{
		abacus_segment_end *end = &lines->ends[i];

		end->line = DatumGetInt64(SPI_getbinval(rows->vals[i], rows->tupdesc, 1, &isnull));
		for (int axis = 0; axis < 2; axis++)
			end->other[axis] = DatumGetFloat8(SPI_getbinval(rows->vals[i], rows->tupdesc, axis + 2,
															&isnull));
		end->is_soft = DatumGetBool(SPI_getbinval(rows->vals[i], rows->tupdesc, 4, &isnull)) ? 0 : 1;
	}
}

static uint64
find_ends(MeshLines *lines, const double place[2])
{
	Datum		arguments[] = {Float8GetDatum(place[0]), Float8GetDatum(place[1])};
	uint64		count;

	SPI_connect();
	if (lines->plan == NULL)
		prepare(lines);
	/* the writer's snapshot, but with our own changes */
	PushCopiedSnapshot(GetActiveSnapshot());
	UpdateActiveSnapshotCommandId();
	if (SPI_execute_plan(lines->plan, arguments, NULL, true, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not read the lines: %s", SPI_result_code_string(SPI_result));
	PopActiveSnapshot();
	count = SPI_processed;
	take_ends(lines, SPI_tuptable, count);
	SPI_finish();
	return count;
}

/* Called by the core. */
static abacus_host_status
segments_at(void *context, const double place[2], const abacus_segment_end **ends, size_t *count)
{
	MeshLines  *lines = context;
	volatile uint64 found = 0;

	GUARD_BEGIN();
	found = find_ends(lines, place);
	GUARD_END(lines->host);
	*ends = lines->ends;
	*count = found;
	return ABACUS_HOST_OK;
}

static void
forget_plan(void *context)
{
	MeshLines  *lines = context;

	if (lines->plan != NULL)
		SPI_freeplan(lines->plan);
}

/* Lets the core ask for the lines of the mesh during a change. */
void
mesh_lines_attach(Host *host, abacus_build *build)
{
	MeshLines  *lines = MemoryContextAllocZero(host->home, sizeof(MeshLines));

	lines->host = host;
	lines->on_end.func = forget_plan;
	lines->on_end.arg = lines;
	MemoryContextRegisterResetCallback(host->home, &lines->on_end);
	host_run(host, abacus_build_lines, build, segments_at, lines);
}

/* ---- All segments --------------------------------------------------------------- */

/* The row before. */
typedef struct LastPoint
{
	bool		is_known;
	int64		line;
	int64		part;
	double		at[2];
} LastPoint;

/* Adds the segments between the rows of one fetch, and the row before it. */
static void
add_fetched(Host *host, abacus_segments *segments, abacus_segment *added, LastPoint *last)
{
	const SPITupleTable *rows = SPI_tuptable;
	size_t		count = 0;
	bool		isnull;

	for (uint64 i = 0; i < SPI_processed; i++)
	{
		LastPoint	point = {.is_known = true};
		Datum		part;

		point.line = DatumGetInt64(SPI_getbinval(rows->vals[i], rows->tupdesc, 1, &isnull));
		part = SPI_getbinval(rows->vals[i], rows->tupdesc, 4, &isnull);
		point.part = isnull ? 0 : DatumGetInt64(part);

		for (int axis = 0; axis < 2; axis++)
			point.at[axis] = DatumGetFloat8(SPI_getbinval(rows->vals[i], rows->tupdesc, axis + 2,
														  &isnull));
		if (last->is_known && point.line == last->line && point.part == last->part)
		{
			memcpy(added[count].ends[0], last->at, sizeof(point.at));
			memcpy(added[count].ends[1], point.at, sizeof(point.at));
			added[count].is_soft =
				DatumGetBool(SPI_getbinval(rows->vals[i], rows->tupdesc, 5, &isnull)) ? 1 : 0;
			count++;
		}
		*last = point;
	}
	host_run(host, abacus_segments_add, segments, added, count);
}

/*
 * Adds the segments of lines: `query` returns line, x, y, part and whether it is soft, in the order of
 * the lines and of the positions in each. SPI is connected.
 */
void
mesh_lines_add(Host *host, abacus_segments *segments, const char *query)
{
	SPIParseOpenOptions options = {.cursorOptions = CURSOR_OPT_NO_SCROLL};
	Portal		portal = SPI_cursor_parse_open(NULL, query, &options);
	abacus_segment *added = palloc(ROWS_A_FETCH * sizeof(abacus_segment));
	LastPoint	last = {false};

	for (;;)
	{
		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		if (SPI_processed == 0)
			break;
		add_fetched(host, segments, added, &last);
		SPI_freetuptable(SPI_tuptable);
	}
	SPI_cursor_close(portal);
	pfree(added);
}

/* Opens an empty collection of segments; *segments must be owned by the host's handle. */
void
mesh_lines_open(Writer *writer, abacus_segments **segments)
{
	Host	   *host = writer->host;

	host_run(host, abacus_segments_open, &host->table, &writer->header->facts, setting_sort_bytes(),
			 segments);
}

/* Closes a collection that has been used. */
void
mesh_lines_close(Host *host, abacus_segments **segments)
{
	host_run(host, abacus_segments_end, *segments);
	abacus_segments_close(*segments);
	*segments = NULL;
}

/* Called when lines cross: asks the build, which has the vertices of this change. */
static bool
is_vertex(void *context, const double *place)
{
	const MeshBuild *changed = context;

	return host_run(changed->host, abacus_build_vertex_at, changed->build, place, NULL) == ABACUS_OK;
}

/*
 * Fixes the edges of segments. All lines are in their table, so if some cross, the error can say
 * which. Only then does anything look for them.
 */
static void
fix(Writer *writer, abacus_build *build, abacus_segments *segments)
{
	Host	   *host = writer->host;
	MeshBuild	changed = {host, build};
	abacus_status status;

	host_enter(host);
	status = abacus_build_fix(build, segments, writer->header, &host->failure);
	if (status == ABACUS_ERROR && host->failure.kind == ABACUS_ERROR_CROSSING)
		line_crossings_refuse(writer, is_vertex, &changed);
	host_leave(host, status);
}

/* The same for lines that come to those that are there. */
void
mesh_lines_fix(Writer *writer, abacus_build *build, abacus_segments *segments)
{
	fix(writer, build, segments);
	mesh_regions_follow(writer, build, segments);
}

/* Whether lines wait that could be fixed. */
static bool
may_fix_waiting(const abacus_census *census)
{
	return census->lines_wait > 0 && census->vertices > 0 && census->inserted >= census->staged;
}

/*
 * Fixes the edges of all lines, if lines wait and no point does any more. *segments is NULL, and
 * owned by the host's handle.
 */
void
mesh_lines_fix_waiting(Writer *writer, abacus_build *build, abacus_segments **segments)
{
	Host	   *host = writer->host;
	abacus_census *census = &writer->header->facts.census;

	if (!may_fix_waiting(census))
		return;
	mesh_lines_open(writer, segments);
	SPI_connect();
	mesh_lines_add(host, *segments,
				   psprintf("SELECT line, x, y, part, kind OPERATOR(pg_catalog.=) 'soft' FROM %s ORDER BY line, position",
							lines_table_name(lines_table_require(mesh_of(host), MESH_WRITE))));
	SPI_finish();
	fix(writer, build, *segments);
	mesh_regions_renew(writer, build);
	mesh_lines_close(host, segments);
	census->lines_wait = 0;
}

/* The same when other lines have gone. If some of those that wait cross, they go on waiting. */
void
mesh_lines_fix_left(Writer *writer, abacus_build *build, abacus_segments **segments)
{
	MeshBuild	changed = {writer->host, build};

	if (may_fix_waiting(&writer->header->facts.census) &&
		!line_crossings_any(writer, is_vertex, &changed))
		mesh_lines_fix_waiting(writer, build, segments);
}

/* Why lines of the mesh wait, if any do. */
void
mesh_lines_notice_waiting(const Writer *writer)
{
	const abacus_census *census = &writer->header->facts.census;
	const char *mesh = RelationGetRelationName(mesh_of(writer->host));

	if (census->lines_wait == 0)
		return;
	if (may_fix_waiting(census))
		ereport(NOTICE,
				(errmsg("lines of mesh \"%s\" wait, since some of them cross", mesh),
				 errhint("Find the crossings with abacus_crossings(). The edges of lines are fixed as soon as "
						 "abacus_unconstrain() has removed those that cross, or vertices are inserted there.")));
	else
		ereport(NOTICE,
				(errmsg("lines of mesh \"%s\" wait for points", mesh),
				 errdetail(census->vertices == 0 ? "The mesh has no triangles yet."
						   : "Some points of the mesh have not been inserted yet."),
				 errhint("Their edges are fixed as soon as abacus_build() or abacus_insert() has inserted all "
						 "points.")));
}

/*
 * An error if points are about to go while lines wait: the core knows which vertices lines name, but
 * not which points that wait.
 */
void
mesh_lines_refuse_waiting(const Writer *writer)
{
	if (writer->header->facts.census.lines_wait == 0)
		return;
	ereport(ERROR,
			(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
			 errmsg("cannot delete points of mesh \"%s\", since its lines wait for points",
					RelationGetRelationName(mesh_of(writer->host))),
			 errdetail("The mesh has no triangles."),
			 errhint("Insert points that span a triangle, or remove the lines first, with "
					 "abacus_unconstrain().")));
}

/* An error if all points are about to go, but lines name some of them. */
void
mesh_lines_refuse_clearing(const Writer *writer)
{
	uint64		lines = writer->header->facts.census.lines;

	if (lines == 0)
		return;
	ereport(ERROR,
			(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
			 errmsg("cannot remove all points of mesh \"%s\", since it has lines",
					RelationGetRelationName(mesh_of(writer->host))),
			 errdetail_plural("It has " UINT64_FORMAT " line.", "It has " UINT64_FORMAT " lines.",
							  (unsigned long) lines, lines),
			 errhint("Remove the lines first, with abacus_unconstrain().")));
}

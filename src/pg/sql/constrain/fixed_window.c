/*
 * fixed_window.c: the fixed edges of a window, and the lines over them.
 *
 * The mesh says which edges of the window are fixed, but not by which lines. A segment is straight, and all
 * of it is fixed. So from an edge this goes back, straight along fixed edges, to the first of them, and
 * then forward. At each vertex the table of lines says which segments begin there. The cost grows
 * with the answer and with the lines in it, not with the table.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/hsearch.h"

#include "abacus/constrain.h"
#include "pg/base/settings.h"
#include "pg/mesh/lines_table.h"
#include "pg/port/port.h"
#include "pg/sql/constrain/fixed_window.h"

/* A fixed edge of the window. */
typedef struct WindowEdge
{
	double		ends[4];		/* the key: x and y of both ends, the lesser place first */
	int64		ids[2];
	bool		is_done;
} WindowEdge;

/* A segment over the edges at which the way along them has arrived. */
typedef struct OpenSegment
{
	int64		line;
	bool		is_hard;
	double		end[2];
} OpenSegment;

typedef struct FixedWindow
{
	CachedMesh *cached;
	HTAB	   *edges;
	SPIPlanPtr	segments_at;
	OpenSegment *open;
	int			open_count;
	int			open_room;
	FixedEdgeReport report;
	void	   *context;
} FixedWindow;

static bool
is_place(const double *a, const double *b)
{
	return a[0] == b[0] && a[1] == b[1];
}

static bool
is_before(const double *a, const double *b)
{
	return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

/* The edge between two places, in the order of places; NULL if it is not one of the window's. */
static WindowEdge *
find_edge(FixedWindow *fixed, const double *a, const double *b, HASHACTION action, bool *found)
{
	double		key[4];

	memcpy(key, is_before(a, b) ? a : b, 2 * sizeof(double));
	memcpy(key + 2, is_before(a, b) ? b : a, 2 * sizeof(double));
	for (int i = 0; i < 4; i++)
		key[i] += 0.0;			/* no negative zero */
	return hash_search(fixed->edges, key, action, found);
}

/* Reads the fixed edges of the window; false if they have no room in work_mem. */
static bool
read_edges(FixedWindow *fixed, Reader *reader, const abacus_window *window, const abacus_extent *extent)
{
	Host	   *host = reader->host;
	abacus_faces *faces = NULL;
	abacus_edge edge;
	double		ends[4];
	bool		fits = true;

	host_run(host, abacus_faces_open, &host->table, &reader->header.facts, window, true, extent,
			 setting_cache_bytes(), &faces);
	host_own(host, faces, (void (*) (void *)) abacus_faces_close);
	while (fits && host_run(host, abacus_faces_next_edge, faces, &edge, ends) != ABACUS_END)
	{
		WindowEdge *entry;
		bool		in_order = is_before(ends, ends + 2);
		bool		found;

		if (!abacus_faces_is_fixed(faces))
			continue;
		entry = find_edge(fixed, ends, ends + 2, HASH_ENTER, &found);
		entry->ids[0] = edge.id[in_order ? 0 : 1];
		entry->ids[1] = edge.id[in_order ? 1 : 0];
		entry->is_done = false;
		/* an entry takes about twice its size */
		fits = hash_get_num_entries(fixed->edges) * 2 * (long) sizeof(WindowEdge) < work_mem * 1024L;
	}
	host_release(host);
	return fits;
}

/* The place to which a fixed edge leads straight on; false if none does. */
static bool
straight_on(FixedWindow *fixed, const double *behind, const double *at, double *next)
{
	CHECK_FOR_INTERRUPTS();
	return host_run(fixed->cached->host, abacus_fixed_straight_on, fixed->cached->mesh, behind, at, next) ==
		ABACUS_OK;
}

static void
open_segment(FixedWindow *fixed, const OpenSegment *segment)
{
	if (fixed->open_count == fixed->open_room)
	{
		fixed->open_room = Max(16, 2 * fixed->open_room);
		fixed->open = fixed->open == NULL ? palloc(fixed->open_room * sizeof(OpenSegment))
			: repalloc_huge(fixed->open, fixed->open_room * sizeof(OpenSegment));
	}
	fixed->open[fixed->open_count++] = *segment;
}

/* Leaves the segments that end at a place, and takes those that begin there and lead on. */
static void
pass(FixedWindow *fixed, const double *at, const double *next)
{
	Datum		place[] = {Float8GetDatum(at[0]), Float8GetDatum(at[1])};
	int			kept = 0;

	for (int i = 0; i < fixed->open_count; i++)
		if (!is_place(fixed->open[i].end, at))
			fixed->open[kept++] = fixed->open[i];
	fixed->open_count = kept;
	if (SPI_execute_plan(fixed->segments_at, place, NULL, true, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not read the lines: %s", SPI_result_code_string(SPI_result));
	for (uint64 i = 0; i < SPI_processed; i++)
	{
		HeapTuple	tuple = SPI_tuptable->vals[i];
		TupleDesc	desc = SPI_tuptable->tupdesc;
		OpenSegment segment;
		bool		isnull;

		segment.line = DatumGetInt64(SPI_getbinval(tuple, desc, 1, &isnull));
		for (int axis = 0; axis < 2; axis++)
			segment.end[axis] = DatumGetFloat8(SPI_getbinval(tuple, desc, 2 + axis, &isnull));
		segment.is_hard = DatumGetBool(SPI_getbinval(tuple, desc, 4, &isnull));
		if (host_run(fixed->cached->host, abacus_is_on_ray, at, next, segment.end) == ABACUS_OK)
			open_segment(fixed, &segment);
	}
	SPI_freetuptable(SPI_tuptable);
}

/* Reports an edge with each line over it. */
static void
put_edge(FixedWindow *fixed, WindowEdge *edge)
{
	if (fixed->open_count == 0)
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("a fixed edge belongs to no line"),
				 errdetail("It is from (%g, %g) to (%g, %g).", edge->ends[0], edge->ends[1], edge->ends[2],
						   edge->ends[3]),
				 errhint("Find all faults with abacus_check().")));
	for (int i = 0; i < fixed->open_count; i++)
		fixed->report(fixed->context, edge->ids, edge->ends, fixed->open[i].line, fixed->open[i].is_hard);
	edge->is_done = true;
}

/*
 * Reports an edge and those of the window that follow it straight on. The window is convex, so if
 * one is not in it, none that follows is, or it gets its own turn.
 */
static void
put_row(FixedWindow *fixed, const WindowEdge *first)
{
	double		at[2];
	double		next[2];
	double		further[2];
	bool		in_window = false;
	WindowEdge *edge;

	memcpy(at, first->ends, sizeof(at));
	memcpy(next, first->ends + 2, sizeof(next));
	while (straight_on(fixed, next, at, further))
	{
		memcpy(next, at, sizeof(next));
		memcpy(at, further, sizeof(at));
	}
	fixed->open_count = 0;
	for (;;)
	{
		edge = find_edge(fixed, at, next, HASH_FIND, NULL);
		if (edge == NULL && in_window)
			break;
		pass(fixed, at, next);
		if (edge != NULL)
		{
			in_window = in_window || edge == first;
			if (!edge->is_done)
				put_edge(fixed, edge);
		}
		if (!straight_on(fixed, at, next, further))
			break;
		memcpy(at, next, sizeof(at));
		memcpy(next, further, sizeof(next));
	}
}

static HTAB *
edge_table(void)
{
	HASHCTL		control = {
		.keysize = 4 * sizeof(double),.entrysize = sizeof(WindowEdge),.hcxt = CurrentMemoryContext
	};

	return hash_create("Abacus fixed edges", 1024, &control, HASH_ELEM | HASH_BLOBS | HASH_CONTEXT);
}

/*
 * Reports the fixed edges of a window, once for each line over them; false, and nothing, if they are too
 * many for work_mem. SPI is connected, and names without a schema are PostgreSQL's own.
 */
bool
fixed_window_read(Reader *reader, CachedMesh *cached, const abacus_window *window, const abacus_extent *extent,
				  Oid table, FixedEdgeReport report, void *context)
{
	FixedWindow fixed = {.cached = cached,.edges = edge_table(),.report = report,.context = context};
	bool		fits = read_edges(&fixed, reader, window, extent);
	Oid			types[] = {FLOAT8OID, FLOAT8OID};
	HASH_SEQ_STATUS scan;
	WindowEdge *edge;

	if (fits)
	{
		fixed.segments_at = SPI_prepare_cursor(lines_table_segments_at(table), lengthof(types), types,
											   CURSOR_OPT_GENERIC_PLAN);
		if (fixed.segments_at == NULL)
			elog(ERROR, "could not prepare the query of lines: %s", SPI_result_code_string(SPI_result));
		hash_seq_init(&scan, fixed.edges);
		while ((edge = hash_seq_search(&scan)) != NULL)
			if (!edge->is_done)
				put_row(&fixed, edge);
		host_release(cached->host);
	}
	hash_destroy(fixed.edges);
	return fits;
}

/*
 * catch_up.c: a mesh catches up with the tables that it follows.
 *
 * It is changed once. Lines that have changed leave, and with them those that have a corner where a
 * point comes or goes, so that no line names a point that goes. All new points are inserted, then
 * those that are gone are deleted, so every deleted point is there, old or new. Then the lines come
 * as the table has them now (followed_lines.c). An error ends the transaction.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/mesh/lines_table.h"
#include "pg/track/catch_up.h"
#include "pg/track/in_step.h"
#include "pg/track/pending_parts.h"
#include "pg/track/tracked_lines.h"

typedef struct CatchUp
{
	Change	   *change;
	List	   *behind;			/* Pendings with notes */
	TrackedLines *tracked;		/* NULL: the mesh follows no table of lines */
	FollowedLines *followed;
	int			security;
} CatchUp;

static void
become(const CatchUp *up, Oid user)
{
	SetUserIdAndSecContext(user, up->security | SECURITY_LOCAL_USERID_CHANGE);
}

/* ---- Points ----------------------------------------------------------------------- */

static void
to_stage(void *context, const uint64 *points, size_t count)
{
	change_add(context, points, count);
}

/* Stages the points that are new, or those that are gone. */
static void
stage(const Pending *pending, bool gone, Change *change)
{
	change_open_stage(change, &change->writer.header->facts);
	pending_read(pending, gone, to_stage, change);
}

static void
change_points(const CatchUp *up)
{
	Change	   *change = up->change;
	ListCell   *cell;

	foreach(cell, up->behind)
	{
		Pending    *pending = lfirst(cell);

		if (pending->kind != TRACKED_POINTS)
			continue;
		become(up, pending->user);
		if (pending->extent.all)
			change_clear(change);
		if (pending->extent.came > 0)
		{
			stage(pending, false, change);
			change_insert(change);
		}
	}
	foreach(cell, up->behind)
	{
		Pending    *pending = lfirst(cell);

		if (pending->kind != TRACKED_POINTS || pending->extent.went == 0)
			continue;
		become(up, pending->user);
		stage(pending, true, change);
		in_step_check_found(change, pending->table, "delete", pending->extent.went,
							change_delete(change, true));
	}
}

/* ---- Lines ------------------------------------------------------------------------ */

static void
to_lines(void *context, const uint64 *ids, size_t count)
{
	for (size_t i = 0; i < count; i++)
		followed_lines_note(context, (int64) ids[i]);
}

/* The places of points of a pending, whose records have so many words. */
typedef struct PlaceSink
{
	FollowedLines *followed;
	int			words;
} PlaceSink;

static void
to_places(void *context, const uint64 *points, size_t count)
{
	const PlaceSink *sink = context;

	for (size_t i = 0; i < count; i++)
		followed_lines_note_place(sink->followed, (const double *) (points + i * sink->words + 1));
}

/* Whether all lines have changed, or must be put anew since all points have gone. */
static bool
all_changed(const CatchUp *up)
{
	ListCell   *cell;

	foreach(cell, up->behind)
		if (((Pending *) lfirst(cell))->extent.all)
			return true;
	return false;
}

/* Lets lines leave that have changed; false if there are none. */
static bool
let_lines_leave(CatchUp *up)
{
	Relation	mesh = mesh_pages(up->change->writer.host)->simplices.heap;
	bool		all = all_changed(up);
	LineQueries queries;
	ListCell   *cell;

	become(up, up->tracked->user);
	new_lines_check_mesh(up->change);
	up->followed = followed_lines_begin(up->change, lines_table_require(mesh, MESH_WRITE), all);
	foreach(cell, all ? NIL : up->behind)
	{
		Pending    *pending = lfirst(cell);
		PlaceSink	sink = {up->followed, pending->shape.columns};

		if (pending->kind == TRACKED_LINES)
			pending_read(pending, false, to_lines, up->followed);
		else if (up->change->writer.header->facts.census.lines > 0)
			for (int gone = 0; gone < 2; gone++)
				pending_read(pending, gone, to_places, &sink);
	}
	tracked_lines_queries(up->tracked, up->change, all, &queries);
	queries.reading.is_quiet = true;
	return followed_lines_leave(up->followed, &queries);
}

static void
change_points_and_lines(CatchUp *up)
{
	bool		any;

	SPI_connect();
	any = let_lines_leave(up);
	change_points(up);
	become(up, up->tracked->user);
	if (any)
		followed_lines_come(up->followed);
	followed_lines_end(up->followed);
	SPI_finish();
}

/* ---- Both ------------------------------------------------------------------------- */

static void
change_mesh(CatchUp *up, Oid mesh)
{
	Change	   *change = up->change = change_begin(mesh, "abacus_track()");
	ListCell   *cell;

	up->tracked = tracked_lines_of(mesh_pages(change->writer.host)->simplices.heap);
	change->knows_lines = up->tracked != NULL;
	foreach(cell, up->behind)
	{
		Pending    *pending = lfirst(cell);

		if (pending->kind != TRACKED_POINTS)
			continue;
		in_step_check_shape(change, pending->shape, pending->trigger);
		in_step_check_srid(change, (int32) pending->srid);
	}
	if (up->tracked != NULL)
		change_points_and_lines(up);
	else
		change_points(up);
	change_end(change);
}

/* Applies the notes about a mesh, a list of Pendings, to it. */
void
catch_up(Oid mesh, List *behind)
{
	MemoryContext memory = AllocSetContextCreate(TopTransactionContext, "Abacus deferred change",
												 ALLOCSET_DEFAULT_SIZES);
	MemoryContext old = MemoryContextSwitchTo(memory);
	CatchUp		up = {.behind = behind};
	Oid			user;

	GetUserIdAndSecContext(&user, &up.security);
	become(&up, ((Pending *) linitial(behind))->user);
	/* if it was dropped meanwhile, it need not follow */
	if (SearchSysCacheExists1(RELOID, ObjectIdGetDatum(mesh)))
		change_mesh(&up, mesh);
	SetUserIdAndSecContext(user, up.security);
	MemoryContextSwitchTo(old);
	MemoryContextDelete(memory);
}

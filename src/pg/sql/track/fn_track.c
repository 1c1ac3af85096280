/*
 * fn_track.c: abacus_track and abacus_untrack, which make a mesh follow a table of points, and end
 * that for any table.
 *
 * An empty mesh gets the points of all rows. A mesh with points must have exactly those. The
 * difference of the two multisets is computed, and corrected if the caller wishes.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/numbering.h"
#include "pg/track/pending.h"
#include "pg/track/tracked_points.h"
#include "pg/track/tracked_table.h"
#include "pg/track/transition.h"

SQL_FUNCTION(abacus_sql_track);
SQL_FUNCTION(abacus_sql_untrack);

/* Reads the points of a query into the stage; returns how many. */
static uint64
read_points(Change *change, const char *query)
{
	Source		source;

	source_prepare(&source, query);
	change_read(change, &source);
	source_finish(&source);
	return change->points;
}

/* A table that a mesh will follow. */
typedef struct Tracked
{
	Oid			mesh;
	Relation	table;
	Oid			extension_namespace;
	List	   *columns;
	uint32		dropped;		/* attributes of the mesh that were dropped */
} Tracked;

/* The points of the table and of the mesh, as queries. */
typedef struct BothPoints
{
	char	   *here;
	char	   *there;
} BothPoints;

static BothPoints
both_points(Change *change, const Tracked *tracked, const char *lines)
{
	const abacus_facts *facts = &change->writer.header->facts;
	char	   *elsewhere = tracked_points_of_other_srid(tracked->table, tracked->columns, &facts->form);

	/* a geometry of another system is an error, unless the mesh has no SRID and takes it */
	if (elsewhere != NULL)
		read_points(change, elsewhere);
	return (BothPoints) {
		tracked_points_of_table(tracked->table, tracked->columns, facts->form.dimension, true),
		tracked_points_of_mesh(tracked->mesh, facts, tracked->extension_namespace, lines)
	};
}

static void
refuse_difference(const Tracked *tracked, uint64 missing, uint64 surplus)
{
	if (missing + surplus > 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" does not hold the points of table \"%s\"", get_rel_name(tracked->mesh),
						RelationGetRelationName(tracked->table)),
				 errdetail("Points missing from the mesh: " UINT64_FORMAT "; surplus points in the mesh: "
						   UINT64_FORMAT ".", missing, surplus),
				 errhint("Use synchronize => true to insert and delete them.")));
}

/* Brings the mesh in step, or reports that it is not; false if it already was. */
static bool
make_equal(Change *change, const Tracked *tracked, bool synchronize)
{
	const abacus_facts *facts = &change->writer.header->facts;
	BothPoints	both = both_points(change, tracked, NULL);
	uint32		srid = facts->form.srid;
	uint64		missing;
	uint64		surplus;

	/* both are read before the mesh changes, since a query would see it half changed */
	missing = read_points(change, psprintf("%s EXCEPT ALL %s", both.here, both.there));
	change_swap_stages(change);
	surplus = read_points(change, psprintf("%s EXCEPT ALL %s", both.there, both.here));
	if (!synchronize)
		refuse_difference(tracked, missing, surplus);
	/* since it is inserted first, a point that differs only in its attributes replaces the other */
	change_swap_stages(change);
	if (missing > 0)
		change_insert(change);
	change_swap_stages(change);
	if (surplus > 0)
		change_delete(change, true);
	return missing + surplus > 0 || srid != facts->form.srid;
}

/* Notes the points of a query; returns how many. */
static uint64
note_points(Change *change, const char *query, bool gone, Pending *pending)
{
	uint64		noted = 0;
	Source		source;
	const uint64 *points;
	size_t		count;

	source_prepare(&source, query);
	source_open(&source, abacus_names_of(change->writer.header), true);
	for (; (count = source_fetch(&source, &points)) > 0; noted += count)
		pending_add(pending, gone, points, count);
	pending_take_srid(pending, source.packer->srid);
	source_close(&source);
	source_finish(&source);
	return noted;
}

/*
 * The same for a mesh that follows lines: notes what must change, so that the lines follow, too. It
 * may have vertices that lines have made.
 */
static void
note_difference(Change *change, const Tracked *tracked, bool synchronize)
{
	Relation	simplices = mesh_pages(change->writer.host)->simplices.heap;
	const abacus_facts *facts = &change->writer.header->facts;
	BothPoints	both = both_points(change, tracked, lines_table_name(lines_table_require(simplices, MESH_WRITE)));
	PendingTable table = {tracked->mesh, tracked->table->rd_rel->relowner, TRACKED_POINTS,
		RelationGetRelationName(tracked->table), "abacus_track",
		{facts->form.dimension, 1 + facts->form.dimension + facts->columns.attributes, tracked->dropped},
		false};
	Pending    *pending = pending_open(&table);
	bool		is_empty = read_points(change, psprintf("%s LIMIT 1", both.there)) == 0;
	uint64		missing = note_points(change, psprintf("%s EXCEPT ALL %s", both.here, both.there), false, pending);
	uint64		surplus = note_points(change, psprintf("%s EXCEPT ALL %s", both.there, both.here), true, pending);

	if (!synchronize && !is_empty)
		refuse_difference(tracked, missing, surplus);
}

/* How many attributes of the mesh have been dropped. */
static uint32
dropped_attributes(const Change *change)
{
	Numbering  *numbering = palloc(sizeof(Numbering));
	uint32		dropped;

	numbering_read(change->writer.host, &change->writer.header->facts.columns, numbering);
	dropped = numbering->dropped;
	pfree(numbering);
	return dropped;
}

/* The arguments of the triggers: the shape of the mesh, in one, and the columns. */
static List *
trigger_arguments(const Tracked *tracked, uint32 dimension, bool deferred)
{
	return lcons(psprintf("%u%s%s", dimension, deferred ? TRACKING_DEFERRED : "",
						  tracked->dropped > 0 ? psprintf(TRACKING_DROPPED "%u", tracked->dropped) : ""),
				 list_copy(tracked->columns));
}

/* Brings the mesh in step with the table, or, if it follows lines, notes what that takes. */
static void
bring_in_step(Change *change, const Tracked *tracked, bool synchronize)
{
	const abacus_facts *facts = &change->writer.header->facts;
	bool		changed = true;

	if (tracking_followed(mesh_pages(change->writer.host)->simplices.heap, TRACKED_LINES) != NULL)
	{
		note_difference(change, tracked, synchronize);
		changed = false;
	}
	else if (facts->census.vertices == 0 && facts->census.inserted == facts->census.staged)
	{
		read_points(change, tracked_points_of_table(tracked->table, tracked->columns, facts->form.dimension, false));
		change_insert(change);
	}
	else
		changed = make_equal(change, tracked, synchronize);
	if (changed)
		change_end(change);
	else
		change_abandon(change);
}

static uint64
count_points(Oid mesh)
{
	Change	   *change = change_begin(mesh, "abacus_track()");
	abacus_census census = change->writer.header->facts.census;

	change_abandon(change);
	return census.vertices + census.duplicates + (census.staged - census.inserted);
}

/*
 * abacus_track(mesh regclass, table regclass, columns text[], synchronize bool, deferred bool)
 * -> bigint
 */
Datum
abacus_sql_track(PG_FUNCTION_ARGS)
{
	Tracked		tracked = {.extension_namespace = get_func_namespace(fcinfo->flinfo->fn_oid)};
	TriggerCall call = {0};
	Change	   *change;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3) || PG_ARGISNULL(4))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, table, synchronize and deferred must not be NULL")));
	tracked.mesh = call.mesh = PG_GETARG_OID(0);
	tracked.table = tracked_table_begin(PG_GETARG_OID(1), tracked.mesh, "abacus_track()");

	pending_settle(tracked.mesh);
	change = change_begin(tracked.mesh, "abacus_track()");
	call.function = tracking_function(TRACKED_POINTS, tracked.extension_namespace);
	call.former = tracked_table_triggers(call.function, tracked.mesh, tracked.table);
	tracked.dropped = dropped_attributes(change);
	tracked.columns = tracked_columns(PG_ARGISNULL(2) ? NULL : PG_GETARG_ARRAYTYPE_P(2),
									  abacus_names_of(change->writer.header), tracked.table);
	call.arguments = trigger_arguments(&tracked, change->writer.header->facts.form.dimension,
									   PG_GETARG_BOOL(4));
	bring_in_step(change, &tracked, PG_GETARG_BOOL(3));
	tracked_table_follow(&call, tracked.table);
	pending_settle(tracked.mesh);
	PG_RETURN_INT64((int64) count_points(tracked.mesh));
}

/* abacus_untrack(mesh regclass, table regclass) */
Datum
abacus_sql_untrack(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	Oid			table = PG_GETARG_OID(1);
	Oid			extension_namespace = get_func_namespace(fcinfo->flinfo->fn_oid);
	List	   *triggers = NIL;
	ListCell   *cell;
	bool		found = false;

	PreventCommandIfReadOnly("abacus_untrack()");
	pending_settle(mesh);
	for (int kind = 0; kind < TRACKED_KINDS; kind++)
		triggers = list_concat(triggers, tracking_triggers(tracking_function(kind, extension_namespace),
														   mesh, table));
	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		/* a partition's auxiliary trigger goes with those of the table that the mesh follows */
		if (tracking_root(trigger->table) != table && (trigger->table != table || trigger->auxiliary))
			continue;
		tracking_drop(trigger);
		found = true;
	}
	if (!found)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("mesh %s does not follow table %s",
						DatumGetCString(DirectFunctionCall1(regclassout, ObjectIdGetDatum(mesh))),
						DatumGetCString(DirectFunctionCall1(regclassout,
															ObjectIdGetDatum(table))))));
	PG_RETURN_VOID();
}

/*
 * fn_track_lines.c: abacus_track_lines, which makes a mesh follow a table of lines.
 *
 * A mesh without lines gets those of the table. Another must have exactly those, or, if the caller
 * wishes, the lines that differ are put in their places.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/lines_table.h"
#include "pg/track/pending.h"
#include "pg/track/tracked_lines.h"
#include "pg/track/tracked_table.h"

SQL_FUNCTION(abacus_sql_track_lines);

/* The table of the mesh's lines, which its owner makes if there is none. */
static Oid
require_lines_table(const Change *change)
{
	Relation	mesh = mesh_pages(change->writer.host)->simplices.heap;
	bool		is_new;
	Oid			table;

	(void) lines_table_of(mesh, change->writer.header->facts.census.lines);
	table = lines_table_make(mesh, &is_new);
	if (is_new)
		lines_table_index(mesh);
	lines_table_index_made(mesh);
	return table;
}

/* An error unless the mesh has the lines of the table, or none. */
static void
refuse_difference(const Change *change, Relation table, uint64 differ)
{
	ereport(ERROR,
			(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
			 errmsg("mesh \"%s\" does not have the lines of table \"%s\"",
					RelationGetRelationName(mesh_pages(change->writer.host)->simplices.heap),
					RelationGetRelationName(table)),
			 errdetail_plural(UINT64_FORMAT " line is missing, surplus or another one.",
							  UINT64_FORMAT " lines are missing, surplus or other ones.",
							  (unsigned long) differ, differ),
			 errhint("Use synchronize => true to put the lines of the table in their places.")));
}

/* Brings the mesh in step with the table, or reports that it is not. */
static void
bring_in_step(Change *change, Relation table, const TrackedLines *tracked, bool synchronize)
{
	bool		is_empty = change->writer.header->facts.census.lines == 0;
	LineQueries queries;
	FollowedLines *lines;

	SPI_connect();
	lines = followed_lines_begin(change, require_lines_table(change), true);
	tracked_lines_queries(tracked, change, true, &queries);
	if (!is_empty)
	{
		uint64		differ = followed_lines_compare(lines, &queries);

		if (differ > 0 && !synchronize)
			refuse_difference(change, table, differ);
		tracked_lines_queries(tracked, change, false, &queries);
	}
	if (followed_lines_leave(lines, &queries))
		followed_lines_come(lines);
	followed_lines_end(lines);
	SPI_finish();
}

/*
 * abacus_track_lines(mesh regclass, table regclass, columns text[], kind text, z text,
 * synchronize bool) -> bigint
 */
Datum
abacus_sql_track_lines(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	TriggerCall call = {.mesh = mesh};
	Relation	table;
	TrackedLines *tracked;
	Change	   *change;
	uint64		lines;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3) || PG_ARGISNULL(5))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, table, kind and synchronize must not be NULL")));
	table = tracked_table_begin(PG_GETARG_OID(1), mesh, "abacus_track_lines()");
	pending_settle(mesh);
	change = change_begin(mesh, "abacus_track_lines()");
	new_lines_check_mesh(change);
	change->knows_lines = true;
	call.function = tracking_function(TRACKED_LINES, get_func_namespace(fcinfo->flinfo->fn_oid));
	call.former = tracked_table_triggers(call.function, mesh, table);
	tracked = tracked_lines_given(table, abacus_names_of(change->writer.header),
								  PG_ARGISNULL(2) ? NULL : PG_GETARG_ARRAYTYPE_P(2),
								  text_to_cstring(PG_GETARG_TEXT_PP(3)),
								  PG_ARGISNULL(4) ? NULL : text_to_cstring(PG_GETARG_TEXT_PP(4)));
	call.arguments = tracked_lines_arguments(tracked);
	bring_in_step(change, table, tracked, PG_GETARG_BOOL(5));
	lines = change->writer.header->facts.census.lines;
	change_end(change);
	tracked_table_follow(&call, table);
	PG_RETURN_INT64((int64) lines);
}

/*
 * by_hand.c: changes of a mesh that do not come from the tables that it follows.
 *
 * A mesh that follows a table has the points of its rows. If it had others, a later change of the
 * table would not find its own, and the writer of the table would get the error. So points and
 * attributes are changed only through the table, and so are lines if they come from one. Data that
 * the tables do not provide, such as labels and markers, may be changed.
 *
 * By then the change has locked the header, as abacus_track() does before it makes its triggers. So
 * either its triggers are visible here, or it sees the changes.
 */
#include "postgres.h"

#include "utils/lsyscache.h"

#include "pg/track/by_hand.h"
#include "pg/track/tracking.h"

static Relation
mesh_of(const Change *change)
{
	return mesh_pages(change->writer.host)->simplices.heap;
}

/* The name of the table of a kind that the mesh follows; NULL if there is none. */
static const char *
followed_table(const Change *change, TrackedKind kind)
{
	TrackingTrigger *trigger = tracking_followed(mesh_of(change), kind);

	return trigger == NULL ? NULL : get_rel_name(tracking_root(trigger->table));
}

/* An error if the mesh follows a table: for functions that add, remove or change points. */
void
by_hand_refuse_points(const Change *change)
{
	const char *table = followed_table(change, TRACKED_POINTS);

	if (table != NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("points of mesh \"%s\" are rows of table \"%s\", which it follows",
						RelationGetRelationName(mesh_of(change)), table),
				 errhint("Change the table, and the mesh follows; or call abacus_untrack() first.")));
}

/* The same for functions that add or remove lines. */
void
by_hand_refuse_lines(const Change *change)
{
	const char *table = followed_table(change, TRACKED_LINES);

	if (table != NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("lines of mesh \"%s\" are rows of table \"%s\", which it follows",
						RelationGetRelationName(mesh_of(change)), table),
				 errhint("Change the table, and the mesh follows; or call abacus_untrack() first.")));
}

/* The same for functions that give points new attributes. */
void
by_hand_refuse_attributes(const Change *change)
{
	const char *table = followed_table(change, TRACKED_POINTS);

	if (table != NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("attributes of mesh \"%s\" are columns of table \"%s\", which it follows",
						RelationGetRelationName(mesh_of(change)), table),
				 errhint("Call abacus_untrack() first, and afterwards abacus_track() with "
						 "synchronize => true.")));
	table = followed_table(change, TRACKED_LINES);
	if (table != NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" keeps its attributes while it follows the lines of table \"%s\"",
						RelationGetRelationName(mesh_of(change)), table),
				 errhint("Call abacus_untrack() first, and afterwards abacus_track_lines().")));
}

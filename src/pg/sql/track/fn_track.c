/*
 * fn_track.c: abacus_track and abacus_untrack, which make a mesh follow a table, and end that.
 *
 * The table is locked against writers first, so no row is missed: rows committed by then are read
 * here, and later ones meet the triggers. Then an empty mesh gets the points of all rows. A mesh
 * with points must have exactly those. The difference of the two multisets is computed, and
 * corrected if the caller wishes.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/pg_class.h"
#include "catalog/pg_inherits.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/rls.h"
#include "utils/syscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/numbering.h"
#include "pg/port/port.h"
#include "pg/track/pending.h"
#include "pg/track/tracked_points.h"
#include "pg/track/tracking.h"

SQL_FUNCTION(abacus_sql_track);
SQL_FUNCTION(abacus_sql_untrack);

/*
 * Users who may not track the table must not block its writers, so this comes before the lock.
 */
static void
check_owner(Oid relid)
{
	if (SearchSysCacheExists1(RELOID, ObjectIdGetDatum(relid)) &&
		!object_ownercheck(RelationRelationId, relid, GetUserId()))
		aclcheck_error(ACLCHECK_NOT_OWNER, OBJECT_TABLE, get_rel_name(relid));
}

/* The table to track, locked. While it is open no one drops it, not even an event trigger. */
static Relation
open_table(Oid relid, LOCKMODE mode)
{
	Relation	table = try_relation_open(relid, mode);

	if (table == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("table with OID %u does not exist", relid)));
	return table;
}

/* A partition or child is followed through its topmost parent; only tables can be followed. */
static void
check_kind(Relation table)
{
	char		kind = table->rd_rel->relkind;
	Oid			root = tracking_root(RelationGetRelid(table));

	if (kind != RELKIND_RELATION && kind != RELKIND_PARTITIONED_TABLE)
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("cannot track \"%s\"", RelationGetRelationName(table)),
				 errdetail("Only tables have triggers that see all changes.")));
	if (root != RelationGetRelid(table))
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("cannot track \"%s\"", RelationGetRelationName(table)),
				 errdetail("It is a partition or child of table \"%s\".", get_rel_name(root)),
				 errhint("Track that table: the mesh follows all of its partitions and children.")));
}

/* Partitions and children must be tables of the same owner. */
static void
check_family(Relation table, List *family)
{
	ListCell   *cell;

	foreach(cell, family)
	{
		Relation	member = table_open(lfirst_oid(cell), NoLock);
		char		kind = member->rd_rel->relkind;

		if (kind != RELKIND_RELATION && kind != RELKIND_PARTITIONED_TABLE)
			ereport(ERROR,
					(errcode(ERRCODE_WRONG_OBJECT_TYPE),
					 errmsg("cannot track \"%s\"", RelationGetRelationName(table)),
					 errdetail("Its partition or child \"%s\" is not a table of this database.",
							   RelationGetRelationName(member))));
		if (member->rd_rel->relowner != table->rd_rel->relowner)
			ereport(ERROR,
					(errcode(ERRCODE_WRONG_OBJECT_TYPE),
					 errmsg("cannot track \"%s\"", RelationGetRelationName(table)),
					 errdetail("Its partition or child \"%s\" has another owner.",
							   RelationGetRelationName(member))));
		table_close(member, NoLock);
	}
}

/* Rejects a table that cannot be tracked. */
static void
check_table(Relation table)
{
	Oid			relid = RelationGetRelid(table);
	const char *name = RelationGetRelationName(table);

	check_kind(table);
	if (!object_ownercheck(RelationRelationId, relid, GetUserId()))	/* it may have changed since */
		aclcheck_error(ACLCHECK_NOT_OWNER, OBJECT_TABLE, name);
	if (check_enable_rls(relid, InvalidOid, true) == RLS_ENABLED)
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("row-level security on table \"%s\" applies to user \"%s\"", name,
						GetUserNameFromId(GetUserId(), false)),
				 errdetail("It may hide rows that belong in the mesh."),
				 errhint("Use ALTER TABLE ... NO FORCE ROW LEVEL SECURITY.")));
}

/* Rejects a pair if one can be emptied or vanish without a trigger that informs the other. */
static void
check_persistence(Relation table, char of_mesh)
{
	char		of_table = table->rd_rel->relpersistence;

	/* a temporary table is gone after a crash, and so are its triggers */
	if (of_table == RELPERSISTENCE_TEMP)
		return;
	if (of_mesh == RELPERSISTENCE_TEMP)
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("a temporary mesh cannot follow a permanent table"),
				 errdetail("Other sessions could no longer write to the table.")));
	if (of_mesh != of_table)
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 of_table == RELPERSISTENCE_UNLOGGED
				 ? errmsg("a logged mesh cannot follow an unlogged table")
				 : errmsg("an unlogged mesh cannot follow a logged table"),
				 errdetail("A crash would empty one of them."),
				 errhint("Use ALTER TABLE ... SET LOGGED or SET UNLOGGED; a mesh has two tables.")));
}

/* Checks the rights of the table's owner, which every session will use to write the mesh. */
static void
check_mesh(Relation table, List *family, Oid mesh)
{
	ListCell   *cell;
	Oid			user;
	int			security;
	Relation	simplices;
	Oid			vertices;

	GetUserIdAndSecContext(&user, &security);
	SetUserIdAndSecContext(table->rd_rel->relowner, security | SECURITY_LOCAL_USERID_CHANGE);
	simplices = mesh_table_open(mesh, MESH_WRITE);
	vertices = mesh_vertex_table(simplices, MESH_WRITE);
	SetUserIdAndSecContext(user, security);
	foreach(cell, family)
	{
		Relation	member = table_open(lfirst_oid(cell), NoLock);

		check_persistence(member, simplices->rd_rel->relpersistence);
		check_persistence(member, get_rel_persistence(vertices));
		table_close(member, NoLock);
	}
	table_close(simplices, NoLock);
}

/* Whether the mesh is bound to the table, so that triggers that only name it do not count. */
static bool
is_bound_to(List *triggers, Oid table)
{
	ListCell   *cell;

	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (trigger->bound && tracking_root(trigger->table) == table)
			return true;
	}
	return false;
}

/* A mesh follows one table; returns its triggers on this table, its partitions and children. */
static List *
present_triggers(Oid function, Oid mesh, Relation table)
{
	List	   *triggers = tracking_triggers(function, mesh, RelationGetRelid(table));
	bool		is_bound = is_bound_to(triggers, RelationGetRelid(table));
	List	   *present = NIL;
	ListCell   *cell;

	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		/* a detached partition still has its auxiliary trigger */
		if (tracking_root(trigger->table) == RelationGetRelid(table) ||
			(trigger->auxiliary && object_ownercheck(RelationRelationId, trigger->table, GetUserId())))
			present = lappend(present, trigger);
		else if (!trigger->auxiliary && (trigger->bound || !is_bound))
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_IN_USE),
					 errmsg("mesh \"%s\" already follows table \"%s\"", get_rel_name(mesh),
							get_rel_name(trigger->table)),
					 errdetail("A mesh follows one table; a table may be followed by many meshes."),
					 errhint("Call abacus_untrack() first, or make another mesh.")));
	}
	return present;
}

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

/* Brings the mesh in step, or reports that it is not; false if it already was. */
static bool
make_equal(Change *change, Oid mesh, Relation table, List *columns, bool synchronize,
		   Oid extension_namespace)
{
	const abacus_facts *facts = &change->writer.header->facts;
	char	   *here = tracked_points_of_table(table, columns, facts->form.dimension, true);
	char	   *there = tracked_points_of_mesh(mesh, facts, extension_namespace);
	char	   *elsewhere = tracked_points_of_other_srid(table, columns, &facts->form);
	uint32		srid = facts->form.srid;
	uint64		missing;
	uint64		surplus;

	/* a geometry of another system is an error, unless the mesh has no SRID and takes it */
	if (elsewhere != NULL)
		read_points(change, elsewhere);
	/* both are read before the mesh changes, since a query would see it half changed */
	missing = read_points(change, psprintf("%s EXCEPT ALL %s", here, there));
	change_swap_stages(change);
	surplus = read_points(change, psprintf("%s EXCEPT ALL %s", there, here));
	if (!synchronize && missing + surplus > 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" does not hold the points of table \"%s\"", get_rel_name(mesh),
						RelationGetRelationName(table)),
				 errdetail("Points missing from the mesh: " UINT64_FORMAT "; surplus points in the mesh: "
						   UINT64_FORMAT ".", missing, surplus),
				 errhint("Use synchronize => true to insert and delete them.")));
	/* since it is inserted first, a point that differs only in its attributes replaces the other */
	change_hold(change);
	change_swap_stages(change);
	if (missing > 0)
		change_insert(change);
	change_swap_stages(change);
	if (surplus > 0)
		change_delete(change, true);
	change_settle(change);
	return missing + surplus > 0 || srid != facts->form.srid;
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

/*
 * abacus_track(mesh regclass, table regclass, columns text[], synchronize bool, deferred bool)
 * -> bigint
 */
Datum
abacus_sql_track(PG_FUNCTION_ARGS)
{
	Oid			extension_namespace = get_func_namespace(fcinfo->flinfo->fn_oid);
	Oid			mesh;
	Relation	simplices;
	Relation	table;
	List	   *family;
	TriggerCall call = {0};
	ListCell   *cell;
	Change	   *change;
	abacus_facts facts;
	uint64		points;
	bool		changed = true;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(3) || PG_ARGISNULL(4))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, table, synchronize and deferred must not be NULL")));
	PreventCommandIfReadOnly("abacus_track()");	/* before the lock, which a standby does not have */
	if (IsolationUsesXactSnapshot())
		ereport(ERROR,
				(errcode(ERRCODE_ACTIVE_SQL_TRANSACTION),
				 errmsg("abacus_track() needs the isolation level READ COMMITTED"),
				 errdetail("The snapshot of this transaction may be older than rows of the table.")));
	mesh = PG_GETARG_OID(0);
	check_owner(PG_GETARG_OID(1));
	table = open_table(PG_GETARG_OID(1), ShareRowExclusiveLock);
	check_table(table);
	family = find_all_inheritors(RelationGetRelid(table), ShareRowExclusiveLock, NULL);
	check_family(table, family);
	check_mesh(table, family, mesh);

	pending_settle(mesh);
	change = change_begin(mesh, "abacus_track()");
	facts = change->writer.header->facts;
	call.function = tracking_function(extension_namespace);
	call.mesh = mesh;
	call.former = present_triggers(call.function, mesh, table);
	call.dimension = facts.form.dimension;
	call.dropped = dropped_attributes(change);
	call.deferred = PG_GETARG_BOOL(4);
	call.columns = tracked_columns(PG_ARGISNULL(2) ? NULL : PG_GETARG_ARRAYTYPE_P(2),
								   abacus_names_of(change->writer.header), table);
	if (facts.census.vertices == 0 && facts.census.inserted == facts.census.staged)
	{
		read_points(change, tracked_points_of_table(table, call.columns, facts.form.dimension, false));
		change_insert(change);
	}
	else
		changed = make_equal(change, mesh, table, call.columns, PG_GETARG_BOOL(3), extension_namespace);
	facts = change->writer.header->facts;
	points = facts.census.vertices + facts.census.duplicates + (facts.census.staged - facts.census.inserted);
	if (changed)
		change_end(change);
	else
		change_abandon(change);

	/* the change has locked it, and it must not be dropped before its triggers are bound */
	simplices = table_open(mesh, NoLock);
	if (call.former != NIL)
	{
		table_close(table, NoLock); /* DROP TRIGGER refuses a table in use */
		foreach(cell, call.former)
			tracking_drop(lfirst(cell));
		table = open_table(PG_GETARG_OID(1), NoLock);
	}
	tracking_create(&call, table);
	table_close(table, NoLock);
	table_close(simplices, NoLock);
	PG_RETURN_INT64((int64) points);
}

/* abacus_untrack(mesh regclass, table regclass) */
Datum
abacus_sql_untrack(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	Oid			table = PG_GETARG_OID(1);
	Oid			function = tracking_function(get_func_namespace(fcinfo->flinfo->fn_oid));
	List	   *triggers = tracking_triggers(function, mesh, table);
	ListCell   *cell;
	bool		found = false;

	PreventCommandIfReadOnly("abacus_untrack()");
	pending_settle(mesh);
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

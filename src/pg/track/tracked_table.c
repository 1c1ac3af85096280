/*
 * tracked_table.c: a table that a mesh will follow: locked, checked, and given its triggers.
 *
 * It is locked against writers first, so no row is missed: rows committed by then are read by the
 * caller, and later ones meet the triggers.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/pg_class.h"
#include "catalog/pg_inherits.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/lsyscache.h"
#include "utils/rls.h"
#include "utils/syscache.h"

#include "pg/mesh/mesh.h"
#include "pg/port/port.h"
#include "pg/track/tracked_table.h"

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
				 errdetail("Only tables have triggers that see all changes."),
				 kind != RELKIND_VIEW && kind != RELKIND_MATVIEW ? 0
				 : errhint("Track the table below the view. Name its columns with the argument columns; "
						   "what the view computes can be a column of the table that is GENERATED "
						   "ALWAYS AS (...) STORED, NULL where the view has no row.")));
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

/*
 * A mesh follows one table of points, and one of lines; returns the triggers for this function on this
 * table, its partitions and children.
 */
List *
tracked_table_triggers(Oid function, Oid mesh, Relation table)
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
					 errdetail("A mesh follows one table of points and one of lines; a table may be "
							   "followed by many meshes."),
					 errhint("Call abacus_untrack() first, or make another mesh.")));
	}
	return present;
}

/*
 * Opens a table that a mesh will follow, locked against writers, and checks both. `command` names the
 * function for messages.
 */
Relation
tracked_table_begin(Oid relid, Oid mesh, const char *command)
{
	Relation	table;
	List	   *family;

	PreventCommandIfReadOnly(command);	/* before the lock, which a standby does not have */
	if (IsolationUsesXactSnapshot())
		ereport(ERROR,
				(errcode(ERRCODE_ACTIVE_SQL_TRANSACTION),
				 errmsg("%s needs the isolation level READ COMMITTED", command),
				 errdetail("The snapshot of this transaction may be older than rows of the table.")));
	check_owner(relid);
	table = open_table(relid, ShareRowExclusiveLock);
	check_table(table);
	family = find_all_inheritors(RelationGetRelid(table), ShareRowExclusiveLock, NULL);
	check_family(table, family);
	check_mesh(table, family, mesh);
	return table;
}

/*
 * Makes the triggers in place of the former ones, and closes the table. The mesh is in step and
 * locked.
 */
void
tracked_table_follow(const TriggerCall *call, Relation table)
{
	/* the change has locked it, and it must not be dropped before its triggers are bound */
	Relation	simplices = table_open(call->mesh, NoLock);
	Oid			relid = RelationGetRelid(table);
	ListCell   *cell;

	if (call->former != NIL)
	{
		table_close(table, NoLock); /* DROP TRIGGER refuses a table in use */
		foreach(cell, call->former)
			tracking_drop(lfirst(cell));
		table = open_table(relid, NoLock);
	}
	tracking_create(call, table);
	table_close(table, NoLock);
	table_close(simplices, NoLock);
}

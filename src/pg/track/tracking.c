/*
 * tracking.c: the triggers by which a mesh follows a table.
 *
 * They are ordinary triggers of the table, four of them, one for each event, since a trigger with
 * transition tables can have only one event. A table with partitions has two: one for each row, and
 * one for TRUNCATE. Each of its partitions has an auxiliary trigger for TRUNCATE of that partition
 * only. PostgreSQL itself makes a clone of the row trigger for each partition, and drops it when
 * the partition is detached. A table with children, and each of its children, has one for each row
 * and an auxiliary one. The arguments of the triggers are the name of the mesh, its dimension, with
 * a word if it follows at commit, and the names of the columns. The name does not count, only an
 * automatic dependency of the trigger on the mesh. So the mesh may be renamed and moved, and
 * dropping it drops the triggers.
 *
 * Only bound triggers run with the rights of the table's owner, since everyone who may make a
 * trigger can name any mesh.
 *
 * A dump carries the triggers and their arguments, but not the dependency. In a restored database
 * the mesh is found by its name, with the rights of the user. All its triggers are bound again when
 * someone with the rights of both owners first writes the table, or changes the mesh so that its
 * vertex table is bound. The name has no schema if mesh and table are in the same one, so that both
 * can be restored into another schema.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "catalog/pg_depend.h"
#include "catalog/pg_inherits.h"
#include "catalog/pg_proc.h"
#include "catalog/pg_trigger.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"
#include "utils/varlena.h"

#include "pg/mesh/mesh.h"
#include "pg/port/port.h"
#include "pg/track/tracking.h"

/* In the order of TrackedKind. */
static const char *const function_names[TRACKED_KINDS] = {"abacus_tracked", "abacus_tracked_lines"};

/* The function of triggers for a kind of tables; InvalidOid if it is missing. */
Oid
tracking_function(TrackedKind kind, Oid extension_namespace)
{
	return GetSysCacheOid3(PROCNAMEARGSNSP, Anum_pg_proc_oid,
						   CStringGetDatum(function_names[kind]),
						   PointerGetDatum(buildoidvector(NULL, 0)),
						   ObjectIdGetDatum(extension_namespace));
}

/*
 * The mesh of this name; without a schema, the one in `namespace`. Another user than the caller may
 * have written the name. So nothing is an error, and no privilege is needed.
 */
static Oid
mesh_by_name(const char *name, Oid namespace)
{
	List	   *names;

	if (!SplitIdentifierString(pstrdup(name), '.', &names))
		return InvalidOid;
	if (list_length(names) == 2)
		namespace = get_namespace_oid(linitial(names), true);
	else if (list_length(names) != 1)
		return InvalidOid;
	return OidIsValid(namespace) ? get_relname_relid(llast(names), namespace) : InvalidOid;
}

/*
 * The mesh that a trigger of the table is bound to; InvalidOid if none. `from` is the table
 * that a constraint trigger names after FROM, or InvalidOid.
 */
static Oid
bound_mesh(Oid trigger, Oid table, Oid from)
{
	/*
	 * Every trigger depends on its own table, which may be a mesh's, and a trigger with FROM also
	 * depends on that table. Users with the privilege TRIGGER on a mesh can make such triggers.
	 * abacus_track() does not.
	 */
	Oid			mesh = OidIsValid(from) ? InvalidOid : mesh_of_trigger(trigger);

	return mesh == table ? InvalidOid : mesh;
}

/* The parent of a table, the first if there are several; InvalidOid if there is none. */
static Oid
parent_of(Oid table)
{
	Relation	inherits = table_open(InheritsRelationId, AccessShareLock);
	Oid			parent = InvalidOid;
	ScanKeyData key;
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&key, Anum_pg_inherits_inhrelid, BTEqualStrategyNumber, F_OIDEQ, ObjectIdGetDatum(table));
	scan = systable_beginscan(inherits, InheritsRelidSeqnoIndexId, true, NULL, 1, &key);
	tuple = systable_getnext(scan);
	if (HeapTupleIsValid(tuple))
		parent = ((Form_pg_inherits) GETSTRUCT(tuple))->inhparent;
	systable_endscan(scan);
	table_close(inherits, AccessShareLock);
	return parent;
}

/* The table that a mesh follows if it follows this one: its topmost parent, or itself. */
Oid
tracking_root(Oid table)
{
	Oid			parent = parent_of(table);

	return OidIsValid(parent) ? tracking_root(parent) : table;
}

/* The arguments of a trigger, from the catalogue: each ends with a zero byte. */
static void
read_arguments(HeapTuple tuple, Relation triggers, TrackingTrigger *trigger)
{
	bool		isnull;
	Datum		arguments = heap_getattr(tuple, Anum_pg_trigger_tgargs,
										 RelationGetDescr(triggers), &isnull);
	char	   *next = VARDATA_ANY(DatumGetByteaPP(arguments));

	trigger->count = ((Form_pg_trigger) GETSTRUCT(tuple))->tgnargs;
	trigger->arguments = palloc(trigger->count * sizeof(char *));
	for (int i = 0; i < trigger->count; i++)
	{
		trigger->arguments[i] = pstrdup(next);
		next += strlen(next) + 1;
	}
}

/* A trigger from the catalogue; NULL if it no longer exists, or is a clone. */
static TrackingTrigger *
read_trigger(Oid oid)
{
	Relation	triggers = table_open(TriggerRelationId, AccessShareLock);
	TrackingTrigger *trigger = NULL;
	ScanKeyData key;
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&key, Anum_pg_trigger_oid, BTEqualStrategyNumber, F_OIDEQ, ObjectIdGetDatum(oid));
	scan = systable_beginscan(triggers, TriggerOidIndexId, true, NULL, 1, &key);
	tuple = systable_getnext(scan);
	/* a clone comes and goes with its original */
	if (HeapTupleIsValid(tuple) && !OidIsValid(((Form_pg_trigger) GETSTRUCT(tuple))->tgparentid))
	{
		Form_pg_trigger form = (Form_pg_trigger) GETSTRUCT(tuple);

		trigger = palloc(sizeof(TrackingTrigger));
		trigger->oid = oid;
		trigger->name = pstrdup(NameStr(form->tgname));
		trigger->table = form->tgrelid;
		trigger->mesh = bound_mesh(oid, form->tgrelid, form->tgconstrrelid);
		trigger->bound = OidIsValid(trigger->mesh);
		trigger->event = form->tgtype & TRIGGER_TYPE_EVENT_MASK;
		trigger->auxiliary = TRIGGER_FOR_BEFORE(form->tgtype);
		trigger->fires = form->tgenabled;
		read_arguments(tuple, triggers, trigger);
		if (!trigger->bound && trigger->count > 0)
			trigger->mesh = mesh_by_name(trigger->arguments[0], get_rel_namespace(form->tgrelid));
	}
	systable_endscan(scan);
	table_close(triggers, AccessShareLock);
	return trigger;
}

/* Whether the trigger belongs to the mesh; `table` is that of tracking_triggers(). */
static bool
belongs(const TrackingTrigger *trigger, Oid mesh, Oid table)
{
	if (trigger == NULL || trigger->mesh != mesh)
		return false;
	/* triggers that others make on their own tables must not disturb anyone */
	return trigger->bound || trigger->table == table ||
		(OidIsValid(table) && tracking_root(trigger->table) == table) ||
		mesh_table_owner(trigger->table) == mesh_table_owner(mesh);
}

/*
 * The triggers that call the function, one of abacus_track(), for this mesh: those bound to it, and
 * some that only name it. Of the latter only these count: the triggers of `table` (which may be
 * InvalidOid), of its partitions and children, and of tables that the mesh's owner owns.
 */
List *
tracking_triggers(Oid function, Oid mesh, Oid table)
{
	Relation	depend = table_open(DependRelationId, AccessShareLock);
	List	   *found = NIL;
	ScanKeyData keys[2];
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&keys[0], Anum_pg_depend_refclassid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(ProcedureRelationId));
	ScanKeyInit(&keys[1], Anum_pg_depend_refobjid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(function));
	scan = systable_beginscan(depend, DependReferenceIndexId, true, NULL, 2, keys);
	while (HeapTupleIsValid(tuple = systable_getnext(scan)))
	{
		Form_pg_depend entry = (Form_pg_depend) GETSTRUCT(tuple);
		TrackingTrigger *trigger = entry->classid == TriggerRelationId
			? read_trigger(entry->objid) : NULL;

		if (belongs(trigger, mesh, table))
			found = lappend(found, trigger);
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	return found;
}

/* The schema of the extension, from a mesh. */
Oid
tracking_extension(Relation mesh)
{
	return get_rel_namespace(get_typ_typrelid(mesh->rd_rel->reloftype));
}

/* A trigger of the table of this kind that the mesh follows; NULL if there is none. */
TrackingTrigger *
tracking_followed(Relation mesh, TrackedKind kind)
{
	List	   *triggers = tracking_triggers(tracking_function(kind, tracking_extension(mesh)),
											 RelationGetRelid(mesh), InvalidOid);
	TrackingTrigger *found = NULL;
	ListCell   *cell;

	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		/* a detached partition keeps its auxiliary trigger */
		if (!trigger->auxiliary && (found == NULL || !found->bound))
			found = trigger;
	}
	return found;
}

/* The table of all these triggers, with its children; InvalidOid if there is none, or several. */
static Oid
only_table(List *triggers)
{
	Oid			table = InvalidOid;
	ListCell   *cell;

	foreach(cell, triggers)
	{
		Oid			root = tracking_root(((TrackingTrigger *) lfirst(cell))->table);

		if (OidIsValid(table) && root != table)
			return InvalidOid;
		table = root;
	}
	return table;
}

/*
 * Binds all triggers of the table and its children that name the mesh, if the user may; returns
 * whether he may.
 */
static bool
bind_triggers(Oid function, Oid mesh, Oid table)
{
	List	   *triggers;
	ListCell   *cell;

	table = tracking_root(table);
	if (mesh_of_table(mesh) != mesh || !object_ownercheck(RelationRelationId, mesh, GetUserId()) ||
		!object_ownercheck(RelationRelationId, table, GetUserId()))
		return false;
	triggers = tracking_triggers(function, mesh, table);
	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (trigger->bound && !trigger->auxiliary && tracking_root(trigger->table) != table)
			return false;		/* a mesh follows one table of each kind */
	}
	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (!trigger->bound && tracking_root(trigger->table) == table)
			mesh_bind_trigger(mesh, trigger->oid);
	}
	CommandCounterIncrement();	/* a second look in this command must see it */
	return true;
}

/*
 * After a restore: binds the triggers of the mesh, if there is no doubt which tables it follows. It
 * never waits. Triggers that are not bound here are bound by the first write of the table.
 */
void
tracking_bind_restored(Relation mesh)
{
	Oid			relid = RelationGetRelid(mesh);

	for (int kind = 0; kind < TRACKED_KINDS; kind++)
	{
		Oid			function = tracking_function(kind, tracking_extension(mesh));
		Oid			table = only_table(tracking_triggers(function, relid, InvalidOid));

		/* the lock keeps the triggers from being dropped meanwhile */
		if (OidIsValid(table) && ConditionalLockRelationOid(table, AccessShareLock) &&
			OidIsValid(mesh_table_owner(table)))
			bind_triggers(function, relid, table);
	}
}

/*
 * A user who may not use the schema of a mesh cannot reach it through a trigger that is not bound.
 */
static void
check_schema(Oid mesh, Oid table)
{
	Oid			namespace = get_rel_namespace(mesh);
	AclResult	result;

	if (namespace == get_rel_namespace(table))
		return;
	result = object_aclcheck(NamespaceRelationId, namespace, GetUserId(), ACL_USAGE);
	if (result != ACLCHECK_OK)
		aclcheck_error(result, OBJECT_SCHEMA, get_namespace_name(namespace));
}

/* A trigger that fires, or its original if it is a clone. */
typedef struct FiringTrigger
{
	Oid			oid;
	Oid			table;
	Oid			from;			/* as bound_mesh() takes it */
} FiringTrigger;

/*
 * Reads a trigger from the catalogue; returns its original if it is a clone, otherwise InvalidOid.
 */
static Oid
read_firing(Oid oid, FiringTrigger *trigger)
{
	Relation	triggers = table_open(TriggerRelationId, AccessShareLock);
	Oid			original = InvalidOid;
	ScanKeyData key;
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&key, Anum_pg_trigger_oid, BTEqualStrategyNumber, F_OIDEQ, ObjectIdGetDatum(oid));
	scan = systable_beginscan(triggers, TriggerOidIndexId, true, NULL, 1, &key);
	tuple = systable_getnext(scan);
	if (HeapTupleIsValid(tuple))
	{
		Form_pg_trigger form = (Form_pg_trigger) GETSTRUCT(tuple);

		trigger->oid = oid;
		trigger->table = form->tgrelid;
		trigger->from = form->tgconstrrelid;
		original = form->tgparentid;
	}
	systable_endscan(scan);
	table_close(triggers, AccessShareLock);
	return original;
}

/* The trigger that counts for a table's trigger: itself, or its original if it is a clone. */
static FiringTrigger
original_trigger(const Trigger *trigger, Oid table)
{
	FiringTrigger original = {trigger->tgoid, table, trigger->tgconstrrelid};
	Oid			next = trigger->tgisclone ? trigger->tgoid : InvalidOid;

	while (OidIsValid(next))
		next = read_firing(next, &original);
	return original;
}

/*
 * The mesh that a trigger, now firing, keeps in step with its table, and the user with whose rights
 * it is changed. For the mesh of a trigger made by abacus_track(), this is the table's owner.
 * Otherwise a user has named the mesh, and has only his own rights.
 */
Oid
tracking_mesh(const TriggerData *data, Oid *user)
{
	const Trigger *trigger = data->tg_trigger;
	FiringTrigger original = original_trigger(trigger, RelationGetRelid(data->tg_relation));
	Oid			mesh = bound_mesh(original.oid, original.table, original.from);

	*user = mesh_table_owner(original.table);
	if (OidIsValid(mesh))
		return mesh;
	mesh = mesh_by_name(trigger->tgargs[0], get_rel_namespace(original.table));
	if (!OidIsValid(mesh))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\", which follows table \"%s\", does not exist",
						trigger->tgargs[0], get_rel_name(original.table)),
				 errhint("Restore the mesh under that name, or drop the trigger \"%s\" and the "
						 "others like it.", trigger->tgname)));
	check_schema(mesh, original.table);
	if (!bind_triggers(trigger->tgfoid, mesh, original.table) ||
		bound_mesh(original.oid, original.table, original.from) != mesh)
		*user = GetUserId();
	return mesh;
}

/*
 * Whether the table of an auxiliary trigger, now firing, still belongs to one that the mesh
 * follows: then it has a trigger for each row that leads to the same mesh.
 */
bool
tracking_is_followed(const TriggerData *data)
{
	Oid			table = RelationGetRelid(data->tg_relation);
	FiringTrigger original = original_trigger(data->tg_trigger, table);
	Oid			mesh = bound_mesh(original.oid, original.table, original.from);
	const TriggerDesc *triggers = data->tg_relation->trigdesc;

	for (int i = 0; triggers != NULL && i < triggers->numtriggers; i++)
	{
		const Trigger *trigger = &triggers->triggers[i];

		if (!TRIGGER_FOR_ROW(trigger->tgtype) || trigger->tgfoid != data->tg_trigger->tgfoid)
			continue;
		original = original_trigger(trigger, table);
		if (bound_mesh(original.oid, original.table, original.from) == mesh &&
			(OidIsValid(mesh) || strcmp(trigger->tgargs[0], data->tg_trigger->tgargs[0]) == 0))
			return true;
	}
	return false;
}

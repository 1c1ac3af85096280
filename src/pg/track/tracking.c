/*
 * tracking.c: the triggers by which a mesh follows a table.
 *
 * They are ordinary triggers of the table, four of them, one an event, since a
 * trigger with transition tables has only one. Their arguments are the name of
 * the mesh, its dimension and the names of the columns. What counts is not the name, though,
 * but an automatic dependency of the trigger on the mesh: so the mesh may be
 * renamed and moved, and dropping it drops the triggers.
 *
 * Only bound triggers run with the rights of the table's owner, for anybody who
 * may make a trigger can name any mesh.
 *
 * A dump carries the triggers and their arguments, but not the dependency. In a
 * restored database the mesh is found by its name, with the rights of the user.
 * All its triggers are bound again when somebody with the rights of both owners
 * first writes the table, or changes the mesh so that its vertex table is bound.
 * The name has no schema if the mesh lies in that of the table, so that both can
 * be restored into another.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "catalog/pg_depend.h"
#include "catalog/pg_proc.h"
#include "catalog/pg_trigger.h"
#include "commands/defrem.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"
#include "utils/varlena.h"

#include "pg/mesh/mesh.h"
#include "pg/track/tracking.h"
#include "pg/utility.h"

/* The function TRACKING_FUNCTION of the extension; InvalidOid if it has none. */
Oid
tracking_function(Oid extension_namespace)
{
	return GetSysCacheOid3(PROCNAMEARGSNSP, Anum_pg_proc_oid,
						   CStringGetDatum(TRACKING_FUNCTION),
						   PointerGetDatum(buildoidvector(NULL, 0)),
						   ObjectIdGetDatum(extension_namespace));
}

/*
 * The mesh of this name, which without a schema is one of `namespace`. Names are
 * what somebody has written who need not be the one who asks: so nothing is an
 * error, and no privilege is asked for.
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
	 * Every trigger depends on its own table, which may be a mesh's, and one with FROM on that
	 * table, too: whoever has the privilege TRIGGER on a mesh can make such. abacus_track() does not.
	 */
	Oid			mesh = OidIsValid(from) ? InvalidOid : mesh_of_trigger(trigger);

	return mesh == table ? InvalidOid : mesh;
}

/* The first argument of a trigger, as it stands in the catalogue. */
static const char *
first_argument(HeapTuple tuple, Relation triggers)
{
	bool		isnull;
	Datum		arguments = heap_getattr(tuple, Anum_pg_trigger_tgargs,
										 RelationGetDescr(triggers), &isnull);

	return VARDATA_ANY(DatumGetByteaPP(arguments));
}

/* A trigger from the catalogue; NULL if it has gone. */
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
	if (HeapTupleIsValid(tuple))
	{
		Form_pg_trigger form = (Form_pg_trigger) GETSTRUCT(tuple);

		trigger = palloc(sizeof(TrackingTrigger));
		trigger->oid = oid;
		trigger->name = pstrdup(NameStr(form->tgname));
		trigger->table = form->tgrelid;
		trigger->mesh = bound_mesh(oid, form->tgrelid, form->tgconstrrelid);
		trigger->bound = OidIsValid(trigger->mesh);
		trigger->event = form->tgtype & TRIGGER_TYPE_EVENT_MASK;
		trigger->fires = form->tgenabled;
		if (!trigger->bound && form->tgnargs > 0)
			trigger->mesh = mesh_by_name(first_argument(tuple, triggers),
										 get_rel_namespace(form->tgrelid));
	}
	systable_endscan(scan);
	table_close(triggers, AccessShareLock);
	return trigger;
}

static Oid
owner_of_table(Oid relid)
{
	HeapTuple	tuple = SearchSysCache1(RELOID, ObjectIdGetDatum(relid));
	Oid			owner = InvalidOid;

	if (HeapTupleIsValid(tuple))
	{
		owner = ((Form_pg_class) GETSTRUCT(tuple))->relowner;
		ReleaseSysCache(tuple);
	}
	return owner;
}

/* Whether the trigger counts as one of the mesh; `table` is that of tracking_triggers(). */
static bool
belongs(const TrackingTrigger *trigger, Oid mesh, Oid table)
{
	if (trigger == NULL || trigger->mesh != mesh)
		return false;
	/* what others write into triggers of their tables must be in nobody's way */
	return trigger->bound || trigger->table == table ||
		owner_of_table(trigger->table) == owner_of_table(mesh);
}

/*
 * The triggers that call the function, TRACKING_FUNCTION, for this mesh: those
 * bound to it, and of those that only name it the ones of `table` (which may be
 * InvalidOid) and of tables that the mesh's owner has.
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

/* The table of all these triggers; InvalidOid if there is none, or several. */
static Oid
only_table(List *triggers)
{
	Oid			table = InvalidOid;
	ListCell   *cell;

	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (OidIsValid(table) && trigger->table != table)
			return InvalidOid;
		table = trigger->table;
	}
	return table;
}

/* Binds all triggers of the table that name the mesh, if the user may; returns whether he may. */
static bool
bind_triggers(Oid function, Oid mesh, Oid table)
{
	List	   *triggers;
	ListCell   *cell;

	if (mesh_of_table(mesh) != mesh || !pg_class_ownercheck(mesh, GetUserId()) ||
		!pg_class_ownercheck(table, GetUserId()))
		return false;
	triggers = tracking_triggers(function, mesh, table);
	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (trigger->bound && trigger->table != table)
			return false;		/* a mesh follows one table */
	}
	foreach(cell, triggers)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (!trigger->bound && trigger->table == table)
			mesh_bind_trigger(mesh, trigger->oid);
	}
	CommandCounterIncrement();	/* who looks again in this command must see it */
	return true;
}

/*
 * After a restore: binds the triggers of the mesh, if there is no doubt which
 * table it follows. Waits for nobody; what is not bound here the first write of
 * the table binds.
 */
void
tracking_bind_restored(Relation mesh)
{
	Oid			relid = RelationGetRelid(mesh);
	Oid			pages = get_typ_typrelid(mesh->rd_rel->reloftype);
	Oid			function = tracking_function(get_rel_namespace(pages));
	Oid			table = only_table(tracking_triggers(function, relid, InvalidOid));

	/* the lock keeps the triggers from being dropped meanwhile */
	if (OidIsValid(table) && ConditionalLockRelationOid(table, AccessShareLock) &&
		OidIsValid(owner_of_table(table)))
		bind_triggers(function, relid, table);
}

/* Who may not use the schema of a mesh does not reach it through a trigger that is not bound. */
static void
check_schema(Oid mesh, Oid table)
{
	Oid			namespace = get_rel_namespace(mesh);
	AclResult	result;

	if (namespace == get_rel_namespace(table))
		return;
	result = pg_namespace_aclcheck(namespace, GetUserId(), ACL_USAGE);
	if (result != ACLCHECK_OK)
		aclcheck_error(result, OBJECT_SCHEMA, get_namespace_name(namespace));
}

/*
 * The mesh that a trigger, now firing, keeps in step with its table. *bound: it
 * is the one of abacus_track(), to be changed with the rights of the table's
 * owner; otherwise a user has named it, and has no rights but his own.
 */
Oid
tracking_mesh(const TriggerData *data, bool *bound)
{
	const Trigger *trigger = data->tg_trigger;
	Oid			table = RelationGetRelid(data->tg_relation);
	Oid			mesh = bound_mesh(trigger->tgoid, table, trigger->tgconstrrelid);

	*bound = OidIsValid(mesh);
	if (*bound)
		return mesh;
	mesh = mesh_by_name(trigger->tgargs[0], get_rel_namespace(table));
	if (!OidIsValid(mesh))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\", which follows table \"%s\", does not exist",
						trigger->tgargs[0], RelationGetRelationName(data->tg_relation)),
				 errhint("Restore the mesh under that name, or drop the trigger \"%s\" and those "
						 "like it.", trigger->tgname)));
	check_schema(mesh, table);
	*bound = bind_triggers(trigger->tgfoid, mesh, table);
	return mesh;
}

/*
 * A name for a trigger of the table that none of its triggers has. Triggers fire in the
 * order of their names: that of the meshes which follow a table must be the same for all
 * events, or an INSERT could wait for a DELETE that waits for it. So the mesh comes last.
 */
static char *
choose_name(Oid mesh, Oid table, const char *event)
{
	char	   *stem = psprintf("abacus_track_%s", event);
	char	   *name = makeObjectName(stem, get_rel_name(mesh), NULL);

	for (int i = 1; OidIsValid(get_trigger_oid(table, name, true)); i++)
		name = makeObjectName(stem, get_rel_name(mesh), psprintf("%d", i));
	return name;
}

/* The arguments: 'mesh', '2', 'id', 'x', 'y', ... */
static char *
arguments(Oid mesh, int dimension, Relation table, List *columns)
{
	Oid			namespace = get_rel_namespace(mesh);
	const char *schema = namespace == RelationGetNamespace(table) ? NULL
		: get_namespace_name(namespace);
	StringInfoData list;
	ListCell   *cell;

	initStringInfo(&list);
	appendStringInfoString(&list, quote_literal_cstr(
							   quote_qualified_identifier(schema, get_rel_name(mesh))));
	appendStringInfo(&list, ", '%d'", dimension);
	foreach(cell, columns)
		appendStringInfo(&list, ", %s", quote_literal_cstr(lfirst(cell)));
	return list.data;
}

/*
 * Makes a trigger fire where its table is written as a replica, always or there only, if the
 * former one of its event did.
 */
static void
fire_as_before(Relation table, const char *name, int16 event, List *former)
{
	ListCell   *cell;

	foreach(cell, former)
	{
		TrackingTrigger *trigger = lfirst(cell);

		if (trigger->event != event || (trigger->fires != TRIGGER_FIRES_ALWAYS &&
										trigger->fires != TRIGGER_FIRES_ON_REPLICA))
			continue;
		EnableDisableTrigger(table, name, trigger->fires, false, ShareRowExclusiveLock);
		CommandCounterIncrement();
	}
}

/*
 * Makes the triggers, as the caller, through CREATE TRIGGER with all its checks.
 * They fire as the former ones did; where those were disabled, these are not.
 */
void
tracking_create(Oid function, Oid mesh, int dimension, Relation table, List *columns, List *former)
{
	static const struct
	{
		const char *name;
		int16		type;
		const char *referencing;
	}			events[] = {
		{"insert", TRIGGER_TYPE_INSERT, "REFERENCING NEW TABLE AS abacus_new"},
		{"update", TRIGGER_TYPE_UPDATE, "REFERENCING OLD TABLE AS abacus_old NEW TABLE AS abacus_new"},
		{"delete", TRIGGER_TYPE_DELETE, "REFERENCING OLD TABLE AS abacus_old"},
		{"truncate", TRIGGER_TYPE_TRUNCATE, ""}
	};
	char	   *table_schema = get_namespace_name(RelationGetNamespace(table));
	char	   *table_name = quote_qualified_identifier(table_schema,
														RelationGetRelationName(table));
	char	   *function_schema = get_namespace_name(get_func_namespace(function));
	char	   *function_name = quote_qualified_identifier(function_schema,
														   get_func_name(function));

	for (int i = 0; i < lengthof(events); i++)
	{
		char	   *name = choose_name(mesh, RelationGetRelid(table), events[i].name);

		utility_run(psprintf("CREATE TRIGGER %s AFTER %s ON %s %s FOR EACH STATEMENT "
							 "EXECUTE FUNCTION %s(%s)",
							 quote_identifier(name), events[i].name, table_name,
							 events[i].referencing, function_name,
							 arguments(mesh, dimension, table, columns)));
		mesh_bind_trigger(mesh, get_trigger_oid(RelationGetRelid(table), name, false));
		fire_as_before(table, name, events[i].type, former);
	}
}

/* Who has not locked the table may find it gone, and the trigger with it. */
void
tracking_drop(const TrackingTrigger *trigger)
{
	char	   *schema = get_namespace_name(get_rel_namespace(trigger->table));
	char	   *table = get_rel_name(trigger->table);

	if (schema != NULL && table != NULL)
		utility_run(psprintf("DROP TRIGGER %s ON %s", quote_identifier(trigger->name),
							 quote_qualified_identifier(schema, table)));
}

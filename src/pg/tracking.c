/*
 * tracking.c: the triggers by which a mesh follows a table.
 *
 * They are ordinary triggers of the table, four of them, one an event, since a
 * trigger with transition tables has only one. Their arguments are the name of
 * the mesh, its dimension and the names of the columns. What counts is not the name, though,
 * but an automatic dependency of the trigger on the mesh: so the mesh may be
 * renamed and moved, and dropping it drops the triggers.
 *
 * A dump carries the triggers and their arguments, but not the dependency. In a
 * restored database the mesh is found by its name, and bound again when its
 * owner, who also owns the table, first writes. The name has no schema if the
 * mesh lies in that of the table, so that both can be restored into another.
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
#include "executor/spi.h"
#include "miscadmin.h"
#include "nodes/makefuncs.h"
#include "parser/parse_func.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/lsyscache.h"
#include "utils/regproc.h"
#include "utils/varlena.h"

#include "pg/mesh.h"
#include "pg/tracking.h"

/* The table of this name, which without a schema is one of `namespace`. */
static Oid
table_by_name(const char *name, Oid namespace)
{
	RangeVar   *range = makeRangeVarFromNameList(stringToQualifiedNameList(name));

	if (range->schemaname == NULL)
		return get_relname_relid(range->relname, namespace);
	return RangeVarGetRelid(range, NoLock, true);
}

/* The mesh that a trigger, now firing, keeps in step with its table. */
Oid
tracking_mesh(const Trigger *trigger, Relation table)
{
	Oid			mesh = mesh_of_trigger(trigger->tgoid);

	if (OidIsValid(mesh))
		return mesh;
	mesh = table_by_name(trigger->tgargs[0], RelationGetNamespace(table));
	if (!OidIsValid(mesh))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\", which follows table \"%s\", does not exist",
						trigger->tgargs[0], RelationGetRelationName(table)),
				 errhint("Restore the mesh under that name, or drop the trigger \"%s\" and those "
						 "like it.", trigger->tgname)));
	if (pg_class_ownercheck(mesh, GetUserId()) &&
		pg_class_ownercheck(RelationGetRelid(table), GetUserId()))
		mesh_bind_trigger(mesh, trigger->tgoid);
	return mesh;
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
		trigger->mesh = mesh_of_trigger(oid);
		if (!OidIsValid(trigger->mesh) && form->tgnargs > 0)
			trigger->mesh = table_by_name(first_argument(tuple, triggers),
										  get_rel_namespace(form->tgrelid));
	}
	systable_endscan(scan);
	table_close(triggers, AccessShareLock);
	return trigger;
}

/* The triggers that call the function, TRACKING_FUNCTION, for this mesh. */
List *
tracking_triggers(Oid function, Oid mesh)
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

		if (trigger != NULL && trigger->mesh == mesh)
			found = lappend(found, trigger);
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	return found;
}

/* A name for a trigger of the table that none of its triggers has. */
static char *
choose_name(Oid mesh, Oid table, const char *event)
{
	char	   *stem = psprintf("abacus_track_%s", get_rel_name(mesh));
	char	   *name = makeObjectName(stem, event, NULL);

	for (int i = 1; OidIsValid(get_trigger_oid(table, name, true)); i++)
		name = makeObjectName(stem, event, psprintf("%d", i));
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

static void
run(const char *command)
{
	int			result;

	SPI_connect();
	result = SPI_execute(command, false, 0);
	if (result != SPI_OK_UTILITY)
		elog(ERROR, "could not run \"%s\": %s", command, SPI_result_code_string(result));
	SPI_finish();
	CommandCounterIncrement();
}

/* Makes the triggers, as the caller, through CREATE TRIGGER with all its checks. */
void
tracking_create(Oid function, Oid mesh, int dimension, Relation table, List *columns)
{
	static const struct
	{
		const char *name;
		const char *referencing;
	}			events[] = {
		{"insert", "REFERENCING NEW TABLE AS abacus_new"},
		{"update", "REFERENCING OLD TABLE AS abacus_old NEW TABLE AS abacus_new"},
		{"delete", "REFERENCING OLD TABLE AS abacus_old"},
		{"truncate", ""}
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

		run(psprintf("CREATE TRIGGER %s AFTER %s ON %s %s FOR EACH STATEMENT EXECUTE FUNCTION %s(%s)",
					 quote_identifier(name), events[i].name, table_name, events[i].referencing,
					 function_name, arguments(mesh, dimension, table, columns)));
		mesh_bind_trigger(mesh, get_trigger_oid(RelationGetRelid(table), name, false));
	}
}

void
tracking_drop(const TrackingTrigger *trigger)
{
	char	   *schema = get_namespace_name(get_rel_namespace(trigger->table));

	run(psprintf("DROP TRIGGER %s ON %s", quote_identifier(trigger->name),
				 quote_qualified_identifier(schema, get_rel_name(trigger->table))));
}

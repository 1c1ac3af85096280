/*
 * tracking_create.c: makes and drops the triggers by which a mesh follows a table.
 *
 * It uses CREATE TRIGGER and DROP TRIGGER, as the caller, with all their checks. The essay in
 * tracking.c describes the triggers.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "catalog/pg_class.h"
#include "catalog/pg_inherits.h"
#include "catalog/pg_trigger.h"
#include "commands/defrem.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/utility.h"
#include "pg/mesh/mesh.h"
#include "pg/port/port.h"
#include "pg/track/tracking.h"

/*
 * A name for a trigger that no other trigger of the table has. Triggers fire in the order of their
 * names. The meshes that follow a table must come in the same order for all events, or an INSERT
 * and a DELETE could wait for each other. So the mesh comes last in the name.
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

/* The arguments: 'mesh' and those of the call. */
static char *
arguments(const TriggerCall *call, Relation table)
{
	Oid			namespace = get_rel_namespace(call->mesh);
	const char *schema = namespace == RelationGetNamespace(table) ? NULL
		: get_namespace_name(namespace);
	StringInfoData list;
	ListCell   *cell;

	initStringInfo(&list);
	appendStringInfoString(&list, quote_literal_cstr(
							   quote_qualified_identifier(schema, get_rel_name(call->mesh))));
	foreach(cell, call->arguments)
		appendStringInfo(&list, ", %s", quote_literal_cstr(lfirst(cell)));
	return list.data;
}

/*
 * Makes a trigger fire where its table is written as a replica, always or only there, if the former
 * trigger for its event did.
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
		port_set_trigger_firing(table, name, trigger->fires, ShareRowExclusiveLock);
		CommandCounterIncrement();
	}
}

/* The properties of a trigger. */
typedef struct TriggerKind
{
	const char *name;
	int16		type;
	const char *when;
	const char *then;
} TriggerKind;

#define EACH_STATEMENT " FOR EACH STATEMENT"
#define EACH_ROW " FOR EACH ROW"

static const TriggerKind of_plain_table[] = {
	{"insert", TRIGGER_TYPE_INSERT, "AFTER INSERT", "REFERENCING NEW TABLE AS abacus_new" EACH_STATEMENT},
	{"update", TRIGGER_TYPE_UPDATE, "AFTER UPDATE",
		"REFERENCING OLD TABLE AS abacus_old NEW TABLE AS abacus_new" EACH_STATEMENT},
	{"delete", TRIGGER_TYPE_DELETE, "AFTER DELETE", "REFERENCING OLD TABLE AS abacus_old" EACH_STATEMENT},
	{"truncate", TRIGGER_TYPE_TRUNCATE, "AFTER TRUNCATE", EACH_STATEMENT}
};

/* PostgreSQL adds the first one to present and future partitions. */
static const TriggerKind of_partitioned_table[] = {
	{"rows", TRIGGER_TYPE_INSERT | TRIGGER_TYPE_UPDATE | TRIGGER_TYPE_DELETE,
		"AFTER INSERT OR UPDATE OR DELETE", EACH_ROW},
	{"truncate", TRIGGER_TYPE_TRUNCATE, "AFTER TRUNCATE", EACH_STATEMENT}
};

static const TriggerKind of_partition[] = {
	{"part", TRIGGER_TYPE_TRUNCATE, "BEFORE TRUNCATE", EACH_STATEMENT}
};

static const TriggerKind of_parent_or_child[] = {
	{"rows", TRIGGER_TYPE_INSERT | TRIGGER_TYPE_UPDATE | TRIGGER_TYPE_DELETE,
		"AFTER INSERT OR UPDATE OR DELETE", EACH_ROW},
	{"part", TRIGGER_TYPE_TRUNCATE, "BEFORE TRUNCATE", EACH_STATEMENT}
};

static void
create_triggers(const TriggerCall *call, Relation table, const TriggerKind *kinds, int count)
{
	Oid			relid = RelationGetRelid(table);
	char	   *table_name = quote_qualified_identifier(get_namespace_name(RelationGetNamespace(table)),
														RelationGetRelationName(table));
	char	   *function_name = quote_qualified_identifier(get_namespace_name(get_func_namespace(call->function)),
														   get_func_name(call->function));

	for (int i = 0; i < count; i++)
	{
		char	   *name = choose_name(call->mesh, relid, kinds[i].name);

		utility_run(psprintf("CREATE TRIGGER %s %s ON %s %s EXECUTE FUNCTION %s(%s)",
							 quote_identifier(name), kinds[i].when, table_name, kinds[i].then,
							 function_name, arguments(call, table)));
		mesh_bind_trigger(call->mesh, get_trigger_oid(relid, name, false));
		fire_as_before(table, name, kinds[i].type, call->former);
	}
}

/* Makes the triggers of a table with partitions or children, and of these. */
static void
create_in_family(const TriggerCall *call, Relation root, List *family)
{
	bool		is_partitioned = root->rd_rel->relkind == RELKIND_PARTITIONED_TABLE;
	ListCell   *cell;

	if (is_partitioned)
		create_triggers(call, root, of_partitioned_table, lengthof(of_partitioned_table));
	foreach(cell, family)
	{
		Relation	member = table_open(lfirst_oid(cell), NoLock);

		if (!is_partitioned)
			create_triggers(call, member, of_parent_or_child, lengthof(of_parent_or_child));
		else if (member->rd_rel->relkind == RELKIND_RELATION)
			create_triggers(call, member, of_partition, lengthof(of_partition));
		table_close(member, NoLock);
	}
}

/*
 * Makes the triggers, as the caller, through CREATE TRIGGER with all its checks. They fire as the
 * former ones did, but if the former ones were disabled, these are enabled. Partitions and children
 * are locked like the table.
 */
void
tracking_create(const TriggerCall *call, Relation table)
{
	List	   *family = find_all_inheritors(RelationGetRelid(table), NoLock, NULL);

	if (list_length(family) > 1 || table->rd_rel->relkind == RELKIND_PARTITIONED_TABLE)
		create_in_family(call, table, family);
	else
		create_triggers(call, table, of_plain_table, lengthof(of_plain_table));
}

/*
 * If the caller has not locked the table, it may be gone, and the trigger with it. The owner of the
 * mesh may drop a bound trigger of another owner's table, as happens when he drops the mesh.
 */
void
tracking_drop(const TrackingTrigger *trigger)
{
	char	   *schema = get_namespace_name(get_rel_namespace(trigger->table));
	char	   *table = get_rel_name(trigger->table);
	Oid			user;
	int			security;

	if (schema == NULL || table == NULL)
		return;
	GetUserIdAndSecContext(&user, &security);
	if (trigger->bound && object_ownercheck(RelationRelationId, trigger->mesh, user) &&
		!object_ownercheck(RelationRelationId, trigger->table, user))
		SetUserIdAndSecContext(mesh_table_owner(trigger->table), security | SECURITY_LOCAL_USERID_CHANGE);
	utility_run(psprintf("DROP TRIGGER %s ON %s", quote_identifier(trigger->name),
						 quote_qualified_identifier(schema, table)));
	SetUserIdAndSecContext(user, security);
}

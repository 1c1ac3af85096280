/*
 * shard_change.c: a mesh over several servers is changed (docs/design/servers.md).
 *
 *   1. Points go to the shards that own their places, which insert, delete or update them.
 *   2. After deletions, replacements and updates each shard tells the others how its vertices at these places
 *      are now: they do the same with their guests.
 *   3. Vertices around which simplices are new send what others need, as in a build, and again, until no guest
 *      is new.
 *
 * All of it is in the local transaction, with the version of each shard that has changed.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "utils/lsyscache.h"

#include "pg/mesh/header.h"
#include "pg/mesh/notices.h"
#include "pg/mesh/shape.h"
#include "pg/shards/change/shard_change.h"
#include "pg/shards/change/shard_steps.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_transaction.h"

/* The mesh that is being changed: its source query must not change it. */
static Oid	being_changed = InvalidOid;

/* ---- A whole change ------------------------------------------------------------------------- */

static void
begin_change(ShardChange *change, Oid mesh, ReturnSetInfo *set)
{
	if (being_changed == mesh)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_IN_USE),
				 errmsg("mesh \"%s\" is being changed by a query that this command runs for it", get_rel_name(mesh)),
				 errhint("Change it before or afterwards.")));
	change->generation = generation_change_links(mesh, &change->links);
	if (!change->generation->form.has_domain)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has no domain: it was built without points", get_rel_name(mesh)),
				 errhint("Build it from a query with points, or make it with a domain (abacus_shard_create).")));
	change->parts = palloc0(change->links.count * sizeof(Part));
	change->was_changed = palloc(change->links.count * sizeof(bool));
	for (int i = 0; i < change->links.count; i++)
		change->was_changed[i] = shard_transaction_has_changed(change->links.connections[i]);
	change->header = palloc0(sizeof(abacus_header));
	change->header->facts.form = change->generation->form;
	if (set != NULL)
		change->net = shard_net_begin(set);
	being_changed = mesh;
}

/* If points come where none have been, regions that were empty there are not: then all must be sent again. */
static void
note_wider_reach(ShardChange *change, const abacus_box *before)
{
	abacus_box	reach;

	generation_reach(change->generation, &reach);
	for (uint32 i = 0; i < change->generation->form.dimension; i++)
		if (reach.lower[i] != before->lower[i] || reach.upper[i] != before->upper[i])
			for (int shard = 0; shard < change->links.count; shard++)
				change->parts[shard].is_active = change->parts[shard].is_all_new = true;
}

/* Gives changed shards another version, here and there. */
static void
end_change(ShardChange *change)
{
	Generation *generation = change->generation;
	ShardLinks *links = &change->links;

	for (int i = 0; i < links->count; i++)
	{
		link_finish(links, i);
		if (change->parts[i].is_touched)
			link_do(links, i, shard_sql_clear(generation, i));
		if (!change->parts[i].is_changed)
		{
			/* what has come has gone: nothing need be prepared */
			if (!change->was_changed[i])
				shard_transaction_unchange(links->connections[i]);
			continue;
		}
		generation->versions[i]++;
		link_send(links, i, shard_sql_set_version(generation, i));
		shard_transaction_set_version(links->connections[i], generation->number, generation->versions[i]);
	}
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
	generation_update(generation);
	CommandCounterIncrement();
	if (change->net != NULL)
		shard_net_end(change->net);
}

/* Attributes of the mesh are those of the rows. */
static void
take_mesh_attributes(ShardChange *change)
{
	for (int i = 0; i < change->generation->attribute_count; i++)
		shape_attribute(change->header, change->generation->attributes[i]);
}

static void
insert_points(ShardChange *change, Source *source, const char *on_duplicate, uint64 *count)
{
	Generation *generation = change->generation;
	bool	   *owners = palloc(change->links.count * sizeof(bool));
	abacus_box	before;
	int64		duplicates;

	take_mesh_attributes(change);
	change->tells = strcmp(on_duplicate, "replace") == 0;
	generation_reach(generation, &before);
	*count = step_read_points(change, source, true, owners);
	(void) step_run(change, owners, ARRIVES_POINT, on_duplicate);
	duplicates = change->duplicates;
	generation->points += change->more;
	if (change->tells)
		step_follow_owners(change);
	note_wider_reach(change, &before);
	step_exchange(change);
	end_change(change);
	notice_equal_points(get_rel_name(generation->relid), (uint64) Max(duplicates, 0), true);
	if (generation->simplices == 0)
		notice_waiting_points(get_rel_name(generation->relid), generation->form.dimension, (uint64) generation->points);
}

uint64
shard_insert(Oid mesh, Source *source, const char *on_duplicate, ReturnSetInfo *set, const char *command)
{
	ShardChange change = {0};
	uint64		count = 0;

	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	begin_change(&change, mesh, set);
	PG_TRY();
	{
		insert_points(&change, source, on_duplicate, &count);
	}
	PG_FINALLY();
	{
		being_changed = InvalidOid;
	}
	PG_END_TRY();
	return count;
}

static void
delete_points(ShardChange *change, Source *source, uint64 *deleted)
{
	Generation *generation = change->generation;
	bool	   *owners = palloc(change->links.count * sizeof(bool));

	/* attributes may follow the coordinates, as in abacus_insert() */
	if (source_columns(source) != source_first_attribute(source, generation->form.dimension))
		take_mesh_attributes(change);
	change->tells = true;
	(void) step_read_points(change, source, false, owners);
	*deleted = (uint64) step_run(change, owners, ARRIVES_POINT, "delete");
	generation->points += change->more;
	step_follow_owners(change);
	step_exchange(change);
	end_change(change);
}

uint64
shard_delete(Oid mesh, Source *source, ReturnSetInfo *set, const char *command)
{
	ShardChange change = {0};
	uint64		deleted = 0;

	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	begin_change(&change, mesh, set);
	PG_TRY();
	{
		delete_points(&change, source, &deleted);
	}
	PG_FINALLY();
	{
		being_changed = InvalidOid;
	}
	PG_END_TRY();
	return deleted;
}

/* The columns after the coordinates are attributes by name. */
static char **
take_named_attributes(ShardChange *change, Source *source, int *count)
{
	Generation *generation = change->generation;
	int			first = source_first_attribute(source, generation->form.dimension);
	abacus_header *mesh = palloc0(sizeof(abacus_header));
	char	  **names;

	*count = source_columns(source) - first;
	source_require_attributes(source, generation->form.dimension);
	mesh->facts.form = generation->form;
	for (int i = 0; i < generation->attribute_count; i++)
		shape_attribute(mesh, generation->attributes[i]);
	names = palloc(*count * sizeof(char *));
	for (int i = 0; i < *count; i++)
	{
		const char *name = source_column_name(source, first + i);

		names[i] = pstrdup(generation->attributes[header_find_attribute(abacus_names_of(mesh), name)]);
		shape_attribute(change->header, name);
	}
	return names;
}

static void
update_points(ShardChange *change, Source *source, uint64 *count)
{
	bool	   *owners = palloc(change->links.count * sizeof(bool));
	int			attributes;
	char	  **names = take_named_attributes(change, source, &attributes);

	change->tells = true;
	*count = step_read_points(change, source, false, owners);
	for (int i = 0; i < change->links.count; i++)
		if (owners[i])
		{
			link_finish(&change->links, i);
			link_send(&change->links, i, shard_sql_update(change->generation, i, ARRIVES_POINT, names, attributes));
			change->parts[i].is_changed = true;
		}
	for (int i = 0; i < change->links.count; i++)
		link_finish(&change->links, i);
	step_follow_owners(change);
	step_exchange(change);
	end_change(change);
}

uint64
shard_update(Oid mesh, Source *source, const char *command)
{
	ShardChange change = {0};
	uint64		count = 0;

	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	begin_change(&change, mesh, NULL);
	PG_TRY();
	{
		update_points(&change, source, &count);
	}
	PG_FINALLY();
	{
		being_changed = InvalidOid;
	}
	PG_END_TRY();
	return count;
}

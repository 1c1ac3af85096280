/*
 * steps_table.c: the table of the steps of a solution on a mesh, found and made.
 *
 * A row has the values of a vertex at a step, as one part of the mesh has stored them. Another row of
 * each part, without id, says that the part is there, and how the mesh was cut (fn_store.c). Each step is a
 * partition. The first step makes the table.
 *
 * All ranks of a program store at the same time. Those that find no table, or no partition, take turns
 * by a lock that hinders neither readers nor writers; all but the first then find it. A partition is made
 * beside the table and attached, which does not disturb readers.
 */
#include "postgres.h"

#include "catalog/partition.h"
#include "storage/lmgr.h"
#include "utils/builtins.h"
#include "utils/inval.h"
#include "utils/lsyscache.h"

#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_table.h"
#include "pg/steps/steps_table.h"

static Oid
make_table(Relation mesh)
{
	static const NewSideTable steps = {
		.suffix = STEPS_TABLE_SUFFIX,.type = STEP_VALUES_TYPE,.columns = STEP_VALUES_COLUMNS,
		/* rows of one id are searched for; the one without is a part's last */
		.options = "step WITH OPTIONS NOT NULL, part WITH OPTIONS NOT NULL, "
		"\"values\" WITH OPTIONS NOT NULL, UNIQUE (id, step)",
		.partitioning = "PARTITION BY LIST (step)",
		.contents = "steps",.maker = "abacus_store()",.reader = "abacus_steps()"
	};
	Oid			table;

	LockRelationOid(RelationGetRelid(mesh), ShareUpdateExclusiveLock);
	table = mesh_rows_table(mesh, MESH_STEPS, MESH_WRITE);
	return OidIsValid(table) ? table : side_table_make(mesh, &steps);
}

static bool
has_partition(Oid table, const char *name)
{
	Oid			relid = get_relname_relid(name, get_rel_namespace(table));

	return OidIsValid(relid) && get_rel_relispartition(relid) && get_partition_parent(relid, false) == table;
}

/* The name of a partition is too long. A table that this call has made goes with the error. */
static void
refuse_name(Relation mesh, Oid table, bool is_new, const char *name, int64 step)
{
	ereport(ERROR,
			(errcode(ERRCODE_NAME_TOO_LONG),
			 errmsg("name of %s \"%s\" is too long for step " INT64_FORMAT, is_new ? "mesh" : "table",
					is_new ? RelationGetRelationName(mesh) : get_rel_name(table), step),
			 errdetail("The partition of the step would be \"%s\"; names have at most %d bytes.", name, NAMEDATALEN - 1),
			 is_new ? errhint("Rename the mesh.") : errhint("Rename the table, which stays that of the mesh.")));
}

static void
make_partition(Relation mesh, Oid table, bool is_new, const char *name, int64 step)
{
	char	   *parent = lines_table_name(table);
	char	   *partition = quote_qualified_identifier(get_namespace_name(get_rel_namespace(table)), name);

	LockRelationOid(table, ShareUpdateExclusiveLock);
	AcceptInvalidationMessages();
	if (has_partition(table, name))
		return;
	if (strlen(name) >= NAMEDATALEN)
		refuse_name(mesh, table, is_new, name, step);
	new_table_check_name(get_rel_namespace(table), name);
	side_table_create(mesh, psprintf("CREATE %sTABLE %s (LIKE %s) USING heap",
									 mesh->rd_rel->relpersistence == RELPERSISTENCE_UNLOGGED ? "UNLOGGED " : "",
									 partition, parent), name);
	side_table_create(mesh, psprintf("ALTER TABLE %s ATTACH PARTITION %s FOR VALUES IN ('" INT64_FORMAT "')",
									 parent, partition, step), name);
}

/* The table of the steps, as a name in SQL. It has a partition for the step, and is made if need be. */
char *
steps_table_for(Relation mesh, int64 step)
{
	Oid			table = mesh_rows_table(mesh, MESH_STEPS, MESH_WRITE);
	bool		is_new = !OidIsValid(table);
	char	   *partition;

	if (is_new)
		table = make_table(mesh);
	partition = psprintf("%s_" INT64_FORMAT, get_rel_name(table), step);
	if (!has_partition(table, partition))
		make_partition(mesh, table, is_new, partition, step);
	return lines_table_name(table);
}

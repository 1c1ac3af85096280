/*
 * levels_lock.c: the levels of a mesh kept from others while they are made anew or dropped.
 *
 * Which meshes are levels is decided by the catalogues, not by the table of levels, which its owner may change.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "storage/lmgr.h"
#include "utils/lsyscache.h"

#include "pg/levels/levels_lock.h"
#include "pg/mesh/notices.h"

/*
 * The table of a mesh's levels, and the levels that are bound to the mesh, kept from others who make them
 * anew; InvalidOid if there is no table. Those of a restored mesh are bound first.
 */
Oid
levels_lock(Oid mesh, Oid **bound, int *bound_count)
{
	Oid			table = mesh_find_rows_table(mesh, MESH_LEVELS);
	Relation	rel;

	/* at once in the strongest mode, so that two sessions do not wait for each other */
	if (OidIsValid(table))
		LockRelationOid(table, ShareRowExclusiveLock);
	rel = mesh_table_open(mesh, MESH_READ);
	(void) mesh_vertex_table(rel, MESH_WRITE);
	table = mesh_rows_table(rel, MESH_LEVELS, MESH_WRITE);
	table_close(rel, NoLock);
	CommandCounterIncrement();
	*bound_count = levels_bound(mesh, MESH_WRITE, bound);
	if (!OidIsValid(table))
		(void) notice_namesake(mesh, MESH_LEVELS);
	if (!OidIsValid(table) && *bound_count == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has no levels", get_rel_name(mesh)),
				 errhint("Make them with abacus_levels().")));
	return table;
}

#define ANEW_HINT "Drop the levels with abacus_levels_drop(), and make them anew with abacus_levels()."

static bool
is_among(Oid wanted, const Oid *meshes, int count)
{
	for (int i = 0; i < count; i++)
		if (meshes[i] == wanted)
			return true;
	return false;
}

/* Keeps all levels, which must be there, from being changed by hand: a DELETE would not see new rows. */
void
levels_lock_each(Oid mesh, const Level *levels, int count, const Oid *bound, int bound_count)
{
	Oid			unnamed;

	for (int i = 0; i < count; i++)
	{
		LockRelationOid(levels[i].mesh, ShareRowExclusiveLock);
		if (mesh_of_table(levels[i].mesh) != levels[i].mesh)
			ereport(ERROR,
					(errcode(ERRCODE_UNDEFINED_TABLE),
					 errmsg("level %d of mesh \"%s\" no longer exists", levels[i].number, get_rel_name(mesh)),
					 errhint(ANEW_HINT)));
		if (mesh_table_owner(levels[i].mesh) != mesh_table_owner(mesh))
			ereport(ERROR,
					(errcode(ERRCODE_INSUFFICIENT_PRIVILEGE),
					 errmsg("level %d of mesh \"%s\" has another owner", levels[i].number, get_rel_name(mesh)),
					 errhint("Give \"%s\" and its tables the owner of the mesh.", get_rel_name(levels[i].mesh))));
		if (!is_among(levels[i].mesh, bound, bound_count))
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
					 errmsg("mesh \"%s\" is not a level of mesh \"%s\"", get_rel_name(levels[i].mesh),
							get_rel_name(mesh)),
					 errdetail("The table of levels names it as level %d.", levels[i].number),
					 errhint(ANEW_HINT)));
	}
	if (levels_count_unnamed(mesh, MESH_WRITE, levels, count, &unnamed) > 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("the table of levels of mesh \"%s\" does not name its level \"%s\"",
						get_rel_name(mesh), get_rel_name(unnamed)),
				 errhint(ANEW_HINT)));
}

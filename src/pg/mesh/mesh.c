/*
 * mesh.c: the representation of a mesh in the database.
 *
 * A mesh is an ordinary table of the type abacus_simplex_page together with one of the type
 * abacus_vertex_page. No catalogue of ours lists them: the row type in pg_class says what a table is. An
 * automatic dependency in pg_depend ties the vertex table to its mesh. So either table may be renamed or
 * moved to another schema, and DROP TABLE of the mesh drops both. A dump lacks that entry.
 * A restored vertex table is found by its name (<mesh>_vertices) until a change by the owner restores it.
 *
 * A mesh that has had lines has a third table, of the type abacus_line_point, which is bound and found
 * in the same way. Its name ends in _lines. One that has had regions has a fourth, of the type
 * abacus_region_part, whose name ends in _regions; one made by thinning, one of the type
 * abacus_thinning, whose name ends in _thinning. One into which steps of a solution have been stored has
 * a partitioned table of the type abacus_step_values, whose name ends in _steps. One with levels has one of the
 * type abacus_level, which names the meshes that are its levels.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "access/relation.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/objectaddress.h"
#include "catalog/pg_class.h"
#include "catalog/pg_trigger.h"
#include "catalog/pg_type.h"
#include "commands/extension.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/inval.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"

#include "pg/base/dependency.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/mesh_access.h"
#include "pg/mesh/notices.h"
#include "pg/port/port.h"

/* Whether `type` is this extension's row type with that name; remembers the last yes. */
static bool
is_row_type(Oid type, const char *name, Oid *known)
{
	HeapTuple	tuple;
	bool		same;

	if (!OidIsValid(type))
		return false;
	if (type == *known)
		return true;
	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(type));
	if (!HeapTupleIsValid(tuple))
		return false;
	same = strcmp(NameStr(((Form_pg_type) GETSTRUCT(tuple))->typname), name) == 0;
	ReleaseSysCache(tuple);
	if (!same || getExtensionOfObject(TypeRelationId, type) != get_extension_oid("abacus", true))
		return false;
	*known = type;
	return true;
}

/* Called when the owner of a restored mesh writes to it for the first time. */
static void (*on_restored) (Relation mesh) = NULL;

static Oid	simplex_row_type = InvalidOid;

static bool
is_relation_of(Oid relid, char kind, const char *name, Oid *known)
{
	HeapTuple	tuple = SearchSysCache1(RELOID, ObjectIdGetDatum(relid));
	Form_pg_class form;
	bool		is;

	if (!HeapTupleIsValid(tuple))
		return false;
	form = (Form_pg_class) GETSTRUCT(tuple);
	is = form->relkind == kind && is_row_type(form->reloftype, name, known);
	ReleaseSysCache(tuple);
	return is;
}

static bool
is_simplex_table(Oid relid)
{
	return is_relation_of(relid, RELKIND_RELATION, SIMPLEX_PAGE_TYPE, &simplex_row_type);
}

/* Defines a function that says whether a relation is of this kind and type. */
#define TABLE_TEST(name, kind, type) \
	static bool name(Oid relid) \
	{ \
		static Oid	known = InvalidOid; return is_relation_of(relid, kind, type, &known); \
	}
TABLE_TEST(is_vertex_table, RELKIND_RELATION, VERTEX_PAGE_TYPE)
TABLE_TEST(is_lines_table, RELKIND_RELATION, LINE_POINT_TYPE)
TABLE_TEST(is_regions_table, RELKIND_RELATION, REGION_PART_TYPE)
TABLE_TEST(is_thinning_table, RELKIND_RELATION, THINNING_TYPE)
TABLE_TEST(is_steps_table, RELKIND_PARTITIONED_TABLE, STEP_VALUES_TYPE)
TABLE_TEST(is_levels_table, RELKIND_RELATION, LEVEL_TYPE)
TABLE_TEST(is_generations_table, RELKIND_RELATION, SHARD_GENERATION_TYPE)

/* Whether this is the coordinator's table of a mesh over several servers. */
bool
mesh_is_sharded(Oid relid)
{
	return is_generations_table(relid);
}

/* Raises an error unless it is one. */
void
mesh_require_sharded(Oid relid)
{
	char	   *name = get_rel_name(relid);

	if (name == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh with OID %u does not exist", relid)));
	if (!mesh_is_sharded(relid))
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("\"%s\" is not a mesh over several servers", name),
				 errhint("Make one with abacus_shard_create().")));
}

/* The table is not one of simplices. */
static void
refuse_table(Relation rel)
{
	if (mesh_is_sharded(RelationGetRelid(rel)))
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("this function does not work on mesh \"%s\", which lies on several servers",
						RelationGetRelationName(rel)),
				 errhint("docs/distributed.md lists the functions that do. The others work on the mesh of each "
						 "server, see abacus_shards().")));
	ereport(ERROR,
			(errcode(ERRCODE_WRONG_OBJECT_TYPE),
			 errmsg("\"%s\" is not a mesh", RelationGetRelationName(rel)),
			 errhint("Make a mesh with abacus_create() or abacus_triangulate().")));
}

/* Opens the table of a mesh under the given lock, or says why it cannot be used. */
static Relation
open_mesh_table(Oid relid, MeshAccess access, LOCKMODE lock)
{
	Relation	rel = try_relation_open(relid, lock);

	if (rel == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh with OID %u does not exist", relid)));
	if (rel->rd_rel->relkind != RELKIND_RELATION ||
		!is_row_type(rel->rd_rel->reloftype, SIMPLEX_PAGE_TYPE, &simplex_row_type))
		refuse_table(rel);
	mesh_check_access(rel, access, NULL);
	return rel;
}

/* Opens and locks the table of a mesh, or says why it cannot be used. */
Relation
mesh_table_open(Oid relid, MeshAccess access)
{
	return open_mesh_table(relid, access, access == MESH_READ ? AccessShareLock : RowExclusiveLock);
}

/*
 * The same to read the mesh, also one over several servers. Its table is read by SQL, so PostgreSQL checks
 * privileges.
 */
Relation
mesh_table_open_to_read(Oid relid)
{
	if (mesh_is_sharded(relid))
		return table_open(relid, AccessShareLock);
	return mesh_table_open(relid, MESH_READ);
}

/*
 * Keeps all others from changing the mesh and its definition, over several transactions. Only
 * readers continue; VACUUM stays away. The caller unlocks; an error unlocks by itself.
 *
 * The first lock, only for the checks, is ACCESS SHARE, which blocks no one. Two sessions that
 * began with a writer's lock would wait for each other.
 */
LockRelId
mesh_lock_for_session(Oid relid)
{
	Relation	rel = open_mesh_table(relid, MESH_WRITE, AccessShareLock);
	LockRelId	id = rel->rd_lockInfo.lockRelId;

	LockRelationIdForSession(&id, ShareRowExclusiveLock);
	relation_close(rel, NoLock);
	return id;
}

/* A table beside that of the simplices. */
typedef struct SideTable
{
	const char *suffix;
	bool		(*is) (Oid);
	const char *what;			/* for messages */
} SideTable;

static const SideTable vertex_side = {VERTEX_TABLE_SUFFIX, is_vertex_table, "vertex table"};
static const SideTable row_sides[] = {
	[MESH_LINES] = {LINES_TABLE_SUFFIX, is_lines_table, "table of lines"},
	[MESH_REGIONS] = {REGIONS_TABLE_SUFFIX, is_regions_table, "table of regions"},
	[MESH_LEVELS] = {LEVELS_TABLE_SUFFIX, is_levels_table, "table of levels"},
	[MESH_THINNING] = {THINNING_TABLE_SUFFIX, is_thinning_table, "table of its thinning"},
	[MESH_STEPS] = {STEPS_TABLE_SUFFIX, is_steps_table, "table of steps"}
};

/* Such a table of a mesh, found by its name alone; InvalidOid if there is none. */
static Oid
find_named_table(Oid mesh, const SideTable *side)
{
	char	   *name = get_rel_name(mesh);
	Oid			relid;

	if (name == NULL)
		return InvalidOid;
	relid = get_relname_relid(psprintf("%s%s", name, side->suffix), get_rel_namespace(mesh));
	if (OidIsValid(relid) &&
		(!side->is(relid) ||
		 OidIsValid(dependency_find(RelationRelationId, relid, true, is_simplex_table))))
		relid = InvalidOid;
	return relid;
}

/*
 * The same that may be the mesh's. A table of another owner is not: its triggers would run as the one who
 * changes the mesh.
 */
static Oid
find_own_table(Oid mesh, const SideTable *side)
{
	Oid			relid = find_named_table(mesh, side);

	return OidIsValid(relid) && mesh_table_owner(relid) == mesh_table_owner(mesh) ? relid : InvalidOid;
}

/*
 * The vertex table of a mesh, unlocked and unchecked, and whether it is bound; InvalidOid if there is
 * none.
 */
static Oid
find_vertex_table(Oid mesh, bool *bound)
{
	Oid			relid = dependency_find(RelationRelationId, mesh, false, is_vertex_table);

	*bound = OidIsValid(relid);
	return *bound ? relid : find_own_table(mesh, &vertex_side);
}

/*
 * The same for a table of rows. Only that of a restored mesh is found by its name, and all tables of a
 * mesh are bound at once: so once the vertex table is bound, a table of that name belongs to something
 * else, unless the owner says otherwise (mesh_adopt).
 */
static Oid
find_rows_table(Oid mesh, const SideTable *side, bool *bound)
{
	Oid			relid = dependency_find(RelationRelationId, mesh, false, side->is);

	*bound = OidIsValid(relid);
	if (*bound || OidIsValid(dependency_find(RelationRelationId, mesh, false, is_vertex_table)))
		return relid;
	return find_own_table(mesh, side);
}

/*
 * A table of rows that has the name and the type, but is not part of the mesh: it has another owner, or was
 * restored alone, or left by an earlier mesh. InvalidOid if there is none.
 */
Oid
mesh_find_namesake(Oid mesh, SideRows rows)
{
	return OidIsValid(mesh_find_rows_table(mesh, rows)) ? InvalidOid : find_named_table(mesh, &row_sides[rows]);
}

/* The vertex table of a mesh, unlocked and unchecked; InvalidOid if there is none. */
Oid
mesh_find_vertex_table(Oid mesh)
{
	return find_vertex_table(mesh, &(bool) {false});
}

/* The same for a table of rows. */
Oid
mesh_find_rows_table(Oid mesh, SideRows rows)
{
	return find_rows_table(mesh, &row_sides[rows], &(bool) {false});
}

/* The mesh whose simplex table or vertex table this is; InvalidOid if none. */
Oid
mesh_of_table(Oid relid)
{
	const size_t suffix = strlen(VERTEX_TABLE_SUFFIX);
	Oid			mesh;
	char	   *name;

	if (is_simplex_table(relid))
		return relid;
	if (!is_vertex_table(relid))
		return InvalidOid;
	mesh = dependency_find(RelationRelationId, relid, true, is_simplex_table);
	if (OidIsValid(mesh))
		return mesh;
	name = get_rel_name(relid);
	if (name == NULL || strlen(name) <= suffix)
		return InvalidOid;
	name[strlen(name) - suffix] = '\0';
	mesh = get_relname_relid(name, get_rel_namespace(relid));
	return is_simplex_table(mesh) && mesh_find_vertex_table(mesh) == relid ? mesh : InvalidOid;
}

/* Opens such a table under the lock that the access needs; NULL if there is none. */
static Relation
open_side_table(Oid relid, MeshAccess access)
{
	/* it may be dropped while we wait for the lock */
	return OidIsValid(relid) ? try_relation_open(relid, access == MESH_READ ? AccessShareLock : RowExclusiveLock) : NULL;
}

/* Whether a writer should bind a table that is not bound: he must own both. */
static bool
may_bind(Relation mesh, Oid relid, MeshAccess access)
{
	return access == MESH_WRITE && object_ownercheck(RelationRelationId, relid, GetUserId()) &&
		object_ownercheck(RelationRelationId, RelationGetRelid(mesh), GetUserId());
}

/*
 * A table of rows, not pages, that the mesh may have, locked and checked; InvalidOid if there is none. A
 * writer binds it if it is not bound.
 */
Oid
mesh_rows_table(Relation mesh, SideRows rows, MeshAccess access)
{
	const SideTable *side = &row_sides[rows];
	bool		bound;
	Relation	rel = open_side_table(find_rows_table(RelationGetRelid(mesh), side, &bound), access);
	Oid			relid;

	if (rel == NULL)
		return InvalidOid;
	mesh_check_rows_access(rel, access, mesh, side->what);
	relid = RelationGetRelid(rel);
	if (!bound && may_bind(mesh, relid, access))
		mesh_bind_table(RelationGetRelid(mesh), relid);
	relation_close(rel, NoLock);
	return relid;
}

/* The same for the table of its vertex pages, which must be there. */
Oid
mesh_vertex_table(Relation mesh, MeshAccess access)
{
	bool		bound;
	Relation	rel = open_side_table(find_vertex_table(RelationGetRelid(mesh), &bound), access);
	Oid			relid;

	if (rel == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\" has no vertex table", RelationGetRelationName(mesh)),
				 errdetail("There is no table \"%s" VERTEX_TABLE_SUFFIX "\" of type %s beside it that has its owner.",
						   RelationGetRelationName(mesh), VERTEX_PAGE_TYPE),
				 errhint("After a restore, give the vertex table that name and the owner of the mesh; if it is lost, "
						 "restore it from a backup.")));
	mesh_check_access(rel, access, mesh);
	relid = RelationGetRelid(rel);
	if (!bound && may_bind(mesh, relid, access))
	{
		bool		is_whole = true;

		/* these first: see find_rows_table(); while one has another owner, names still count */
		for (int i = 0; i < lengthof(row_sides); i++)
		{
			(void) mesh_rows_table(mesh, (SideRows) i, access);
			is_whole = notice_namesake(RelationGetRelid(mesh), (SideRows) i) && is_whole;
		}
		if (is_whole)
		{
			mesh_bind_table(RelationGetRelid(mesh), relid);
			CommandCounterIncrement();	/* lets others see what is bound */
			if (on_restored != NULL)
				on_restored(mesh);
		}
	}
	relation_close(rel, NoLock);
	return relid;
}

/*
 * Binds tables of rows that were restored alone, if the user owns them and the mesh. `lines`, `regions`: the mesh has some. It
 * cannot be known whether it had steps or levels.
 */
void
mesh_adopt(Relation mesh, bool lines, bool regions)
{
	if (!object_ownercheck(RelationRelationId, RelationGetRelid(mesh), GetUserId()))
		return;
	for (int i = 0; i < lengthof(row_sides); i++)
	{
		bool		wanted = i == MESH_LINES ? lines : i == MESH_REGIONS ? regions : true;
		Relation	rel = wanted ? open_side_table(mesh_find_namesake(RelationGetRelid(mesh), (SideRows) i), MESH_WRITE) : NULL;

		if (rel == NULL)
			continue;
		if (rel->rd_rel->relowner == mesh->rd_rel->relowner && may_bind(mesh, RelationGetRelid(rel), MESH_WRITE))
			mesh_bind_table(RelationGetRelid(mesh), RelationGetRelid(rel));
		relation_close(rel, NoLock);
	}
	CommandCounterIncrement();
	if (on_restored != NULL)
		on_restored(mesh);
}

/* The mesh that a trigger is bound to; InvalidOid if none. */
Oid
mesh_of_trigger(Oid trigger)
{
	return dependency_find(TriggerRelationId, trigger, true, is_simplex_table);
}

void
mesh_bind_trigger(Oid mesh, Oid trigger)
{
	mesh_bind_object(TriggerRelationId, trigger, mesh);
}

/*
 * Registers a function of a higher layer that binds its own objects to meshes; it is called for
 * restored meshes.
 */
void
mesh_tell_of_restored(void (*tell) (Relation mesh))
{
	on_restored = tell;
}

/*
 * mesh_access.c: who may use a table of a mesh, whether it can be used, and whether a session gets it for
 * itself.
 *
 * The store reads and writes pages without planner and executor. So it has to check here what these
 * would check: privileges, row-level security, temporary tables of other sessions, unlogged tables
 * on a standby, publications.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "access/parallel.h"
#include "access/xlog.h"
#include "catalog/pg_am.h"
#include "catalog/pg_class.h"
#include "catalog/pg_type.h"
#include "executor/executor.h"
#include "lib/stringinfo.h"
#include "miscadmin.h"
#include "storage/lmgr.h"
#include "storage/lock.h"
#include "utils/acl.h"
#include "utils/inval.h"
#include "utils/rls.h"
#include "utils/syscache.h"

#include "pg/mesh/mesh_access.h"
#include "pg/store/page_index.h"

/*
 * The detail of an error about a missing privilege: which mesh this table belongs to, unless it is
 * that of the simplices, and which user lacks the privilege. If the mesh follows a table, that user
 * may not be the caller.
 */
static const char *
describe_denied(Relation mesh, const char *side)
{
	StringInfoData detail;

	initStringInfo(&detail);
	if (mesh != NULL)
		appendStringInfo(&detail, "It is the %s of mesh \"%s\".", side,
						 RelationGetRelationName(mesh));
	if (GetUserId() != GetOuterUserId())
		appendStringInfo(&detail, "%sIt is accessed as user \"%s\".", mesh != NULL ? " " : "",
						 GetUserNameFromId(GetUserId(), false));
	return detail.data;
}

/* Raises the executor's errors; `mesh` is the one whose table this is, besides the first, or NULL. */
static void
check_privileges(Relation rel, MeshAccess access, Relation mesh, const char *side, const char *hint)
{
	Oid			relid = RelationGetRelid(rel);
	AclMode		needed = access == MESH_READ ? ACL_SELECT
		: ACL_SELECT | ACL_INSERT | ACL_UPDATE | ACL_DELETE;

	if (pg_class_aclmask(relid, GetUserId(), needed, ACLMASK_ALL) != needed)
	{
		const char *detail = describe_denied(mesh, side);

		ereport(ERROR,
				(errcode(ERRCODE_INSUFFICIENT_PRIVILEGE),
				 errmsg("permission denied for table %s", RelationGetRelationName(rel)),
				 detail[0] == '\0' ? 0 : errdetail_internal("%s", detail),
				 mesh == NULL ? 0 : errhint("%s", hint)));
	}
	if (check_enable_rls(relid, InvalidOid, false) == RLS_ENABLED)
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("row-level security on mesh table \"%s\" applies to user \"%s\"",
						RelationGetRelationName(rel), GetUserNameFromId(GetUserId(), false)),
				 errdetail("A page holds many simplices, so policies on rows have no meaning."),
				 errhint("Disable row-level security on the table and use GRANT.")));
}

/*
 * Checks that a publication can tell its subscribers which rows are updated and deleted.
 * Otherwise the changes would not arrive there, or only in part.
 */
static void
check_publications(Relation rel)
{
	CheckCmdReplicaIdentity(rel, CMD_UPDATE);
	CheckCmdReplicaIdentity(rel, CMD_DELETE);
}

/*
 * The row type of a table says which columns it has, but not where they are: a column that was
 * dropped before ALTER TABLE ... OF keeps its place. Rows are read and written without names, so
 * the columns must be exactly those of the type.
 */
static void
check_columns(Relation rel)
{
	TupleDesc	row = RelationGetDescr(rel);
	bool		are = row->natts == PAGE_TABLE_KEYS + 1;

	if (row->natts < PAGE_TABLE_KEYS + 1)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh table \"%s\" has a type of another version of Abacus",
						RelationGetRelationName(rel)),
				 errhint("Read the mesh's points with the version that wrote it "
						 "(abacus_vertices), and build it anew.")));
	for (int i = 0; are && i < PAGE_TABLE_KEYS; i++)
		are = TupleDescAttr(row, i)->atttypid == INT8OID;
	if (!are || TupleDescAttr(row, PAGE_TABLE_KEYS)->attlen != -1)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh table \"%s\" has had columns other than those of its type",
						RelationGetRelationName(rel)),
				 errhint("Copy its rows into a table made with CREATE TABLE ... OF.")));
}

/*
 * Raises an error if the user may not use a table of a mesh in this way, or if it is impossible.
 * `mesh` is the one whose vertex table this is, or NULL.
 */
void
mesh_check_access(Relation rel, MeshAccess access, Relation mesh)
{
	/* moving rows does not show them: as with VACUUM FULL, the owner's rights are enough */
	if (access != MESH_MOVE)
		check_privileges(rel, access, mesh, "vertex table",
						 "Grant privileges on both tables of a mesh, and give both the same owner.");
	if (rel->rd_rel->relam != HEAP_TABLE_AM_OID)
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("mesh table \"%s\" is not stored as heap", RelationGetRelationName(rel)),
				 errhint("Use ALTER TABLE ... SET ACCESS METHOD heap.")));
	check_columns(rel);
	if (RELATION_IS_OTHER_TEMP(rel))
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("cannot access temporary meshes of other sessions")));
	if (RecoveryInProgress() && !RelationIsPermanent(rel))
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("cannot access unlogged mesh table \"%s\" during recovery",
						RelationGetRelationName(rel)),
				 errdetail("Unlogged tables do not reach standbys.")));
	if (IsParallelWorker() && RelationUsesLocalBuffers(rel))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TRANSACTION_STATE),
				 errmsg("cannot access a temporary mesh in a parallel worker"),
				 errhint("SET max_parallel_workers_per_gather = 0 for this query.")));
	if (access != MESH_READ)
		check_publications(rel);
}

/*
 * The same for a table of lines or regions, `side` in words. Its rows are read and written by SQL, so
 * PostgreSQL checks all else.
 */
void
mesh_check_rows_access(Relation rel, MeshAccess access, Relation mesh, const char *side)
{
	if (access != MESH_MOVE)
		check_privileges(rel, access, mesh, side,
						 "Grant privileges on all tables of a mesh, and give them the same owner.");
	if (RELATION_IS_OTHER_TEMP(rel))
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("cannot access temporary meshes of other sessions")));
}

/* ---- Locks of a session ----------------------------------------------------------------- */

static bool
try_lock_for_session(Oid relid, LOCKMODE mode, LockRelId *lock)
{
	LOCKTAG		tag;

	lock->relId = relid;
	lock->dbId = MyDatabaseId;
	SET_LOCKTAG_RELATION(tag, lock->dbId, lock->relId);
	return LockAcquire(&tag, mode, true, true) != LOCKACQUIRE_NOT_AVAIL;
}

/*
 * Does the same as mesh_lock_for_session() if no one has the mesh locked for more than reading;
 * otherwise returns false. The lock is EXCLUSIVE, so that no one holds a row lock for which a
 * writer would wait. The vertex table is locked as a writer does, or in EXCLUSIVE mode too if its
 * rows will be written. The caller unlocks; an error unlocks by itself.
 */
bool
mesh_try_lock_for_session(Oid relid, bool vertices, MeshLocks *locks)
{
	Oid			vertex_table = mesh_find_vertex_table(relid);

	locks->vertices_mode = vertices ? ExclusiveLock : RowExclusiveLock;
	if (!OidIsValid(vertex_table) ||
		!try_lock_for_session(relid, ExclusiveLock, &locks->simplices))
		return false;
	if (!try_lock_for_session(vertex_table, locks->vertices_mode, &locks->vertices))
	{
		UnlockRelationIdForSession(&locks->simplices, ExclusiveLock);
		return false;
	}
	/* the tables may have been dropped or renamed meanwhile */
	AcceptInvalidationMessages();
	if (mesh_of_table(relid) == relid && mesh_find_vertex_table(relid) == vertex_table)
		return true;
	mesh_unlock_for_session(locks);
	return false;
}

void
mesh_unlock_for_session(MeshLocks *locks)
{
	UnlockRelationIdForSession(&locks->vertices, locks->vertices_mode);
	UnlockRelationIdForSession(&locks->simplices, ExclusiveLock);
}

/* The owner of any table; InvalidOid if it no longer exists. */
Oid
mesh_table_owner(Oid relid)
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

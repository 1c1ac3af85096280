/*
 * mesh.h: the representation of a mesh in the database: two typed tables, and others if it has had lines
 * or regions, has levels, or was thinned; found, locked and checked for privileges.
 */
#ifndef ABACUS_MESH_H
#define ABACUS_MESH_H

#include "storage/lockdefs.h"
#include "utils/rel.h"

#define SIMPLEX_PAGE_TYPE "abacus_simplex_page"
#define VERTEX_PAGE_TYPE "abacus_vertex_page"
#define VERTEX_TABLE_SUFFIX "_vertices"
#define LINE_POINT_TYPE "abacus_line_point"
#define LINE_POINT_COLUMNS 8
#define LINES_TABLE_SUFFIX "_lines"
#define REGION_PART_TYPE "abacus_region_part"
#define REGION_PART_COLUMNS 8
#define REGIONS_TABLE_SUFFIX "_regions"
#define THINNING_TYPE "abacus_thinning"
#define THINNING_COLUMNS 8
#define THINNING_TABLE_SUFFIX "_thinning"
#define STEP_VALUES_TYPE "abacus_step_values"
#define STEP_VALUES_COLUMNS 4
#define STEPS_TABLE_SUFFIX "_steps"
#define LEVEL_TYPE "abacus_level"
#define LEVEL_COLUMNS 6
#define LEVELS_TABLE_SUFFIX "_levels"
#define SHARD_GENERATION_TYPE "abacus_shard_generation"
#define SHARD_GENERATION_COLUMNS 20

/* What a caller intends to do, which decides the lock and the privileges it needs. */
typedef enum MeshAccess
{
	MESH_READ,
	MESH_WRITE,
	MESH_MOVE					/* move the same rows, for a user who may VACUUM */
} MeshAccess;

/* Tables of rows, not pages, that a mesh may have. */
typedef enum SideRows
{
	MESH_LINES,
	MESH_REGIONS,
	MESH_LEVELS,
	MESH_THINNING,
	MESH_STEPS
} SideRows;

/* Locks of the session on both tables. */
typedef struct MeshLocks
{
	LockRelId	simplices;
	LockRelId	vertices;
	LOCKMODE	vertices_mode;
} MeshLocks;

extern Relation mesh_table_open(Oid relid, MeshAccess access);
extern Relation mesh_table_open_to_read(Oid relid);
extern LockRelId mesh_lock_for_session(Oid relid);
extern bool mesh_try_lock_for_session(Oid relid, bool vertices, MeshLocks *locks);
extern void mesh_unlock_for_session(MeshLocks *locks);
extern Oid	mesh_of_table(Oid relid);
extern bool mesh_is_sharded(Oid relid);
extern void mesh_require_sharded(Oid relid);
extern Oid	mesh_table_owner(Oid relid);
extern Oid	mesh_find_vertex_table(Oid mesh);
extern Oid	mesh_find_rows_table(Oid mesh, SideRows rows);
extern Oid	mesh_find_namesake(Oid mesh, SideRows rows);
extern void mesh_adopt(Relation mesh, bool lines, bool regions);
extern Oid	mesh_vertex_table(Relation mesh, MeshAccess access);
extern void mesh_bind_object(Oid class, Oid object, Oid mesh);
extern void mesh_bind_table(Oid mesh, Oid table);
extern Oid	mesh_rows_table(Relation mesh, SideRows rows, MeshAccess access);
extern Oid	mesh_of_trigger(Oid trigger);
extern void mesh_bind_trigger(Oid mesh, Oid trigger);
extern void mesh_tell_of_restored(void (*tell) (Relation mesh));

#endif

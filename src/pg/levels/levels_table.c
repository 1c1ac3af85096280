/*
 * levels_table.c: the table of a mesh's levels, made and read, and the level that is fine enough.
 *
 * A level is a mesh of its own, which depends on the full one as a table beside it does. The table names
 * it by a regclass, which follows it when it is renamed, and which a dump writes as a name.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "common/hashfn.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/rls.h"

#include "pg/levels/levels_table.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_table.h"
#include "pg/mesh/notices.h"
#include "pg/port/port.h"

/* Columns of a query for levels, from 1 as SPI counts. */
enum
{
	LEVEL_NUMBER = 1,
	LEVEL_MESH,
	LEVEL_ATTRIBUTE,
	LEVEL_MAX_ERROR,
	LEVEL_GREATEST,
	LEVEL_STAMP
};

/* Makes the table of a mesh that has none. */
Oid
levels_table_make(Relation mesh)
{
	static const NewSideTable levels = {
		.suffix = LEVELS_TABLE_SUFFIX,.type = LEVEL_TYPE,.columns = LEVEL_COLUMNS,
		.options = "mesh WITH OPTIONS NOT NULL, attribute WITH OPTIONS NOT NULL, max_error WITH OPTIONS NOT NULL, "
		"greatest WITH OPTIONS NOT NULL, stamp WITH OPTIONS NOT NULL, PRIMARY KEY (level)",
		.contents = "levels",.maker = "abacus_levels()",.reader = "abacus_levels()"
	};

	return side_table_make(mesh, &levels);
}

static Datum
value_at(uint64 row, int column)
{
	bool		isnull;

	return SPI_getbinval(SPI_tuptable->vals[row], SPI_tuptable->tupdesc, column, &isnull);
}

/* All levels in the current memory context, the finest first; returns how many. A writer sees what it has changed. */
int
levels_read(Oid table, MeshAccess access, Level **levels)
{
	MemoryContext caller = CurrentMemoryContext;
	MemoryContext spi;
	int			count;

	SPI_connect();
	if (SPI_execute(psprintf("SELECT level, mesh, attribute, max_error, greatest, stamp FROM %s ORDER BY level",
							 lines_table_name(table)), access == MESH_READ, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not read the levels: %s", SPI_result_code_string(SPI_result));
	count = (int) SPI_processed;
	spi = MemoryContextSwitchTo(caller);
	*levels = palloc0((count + 1) * sizeof(Level));
	for (int i = 0; i < count; i++)
	{
		Level	   *level = &(*levels)[i];

		level->number = DatumGetInt32(value_at(i, LEVEL_NUMBER));
		level->mesh = DatumGetObjectId(value_at(i, LEVEL_MESH));
		level->attribute = SPI_getvalue(SPI_tuptable->vals[i], SPI_tuptable->tupdesc, LEVEL_ATTRIBUTE);
		level->max_error = DatumGetFloat8(value_at(i, LEVEL_MAX_ERROR));
		level->greatest = DatumGetFloat8(value_at(i, LEVEL_GREATEST));
		level->stamp = DatumGetInt64(value_at(i, LEVEL_STAMP));
	}
	MemoryContextSwitchTo(spi);
	SPI_finish();
	return count;
}

/* Whether the user may read the table of a mesh's levels, if there is one. */
bool
levels_may_read(Oid mesh)
{
	Oid			table = mesh_find_rows_table(mesh, MESH_LEVELS);

	return !OidIsValid(table) || (pg_class_aclcheck(table, GetUserId(), ACL_SELECT) == ACLCHECK_OK &&
								  check_enable_rls(table, GetUserId(), true) != RLS_ENABLED);
}

/* The same for a mesh; 0 if it has none, or if the user may not read them. */
int
levels_read_if_allowed(Oid mesh, Level **levels)
{
	Oid			table = mesh_find_rows_table(mesh, MESH_LEVELS);
	Relation	rel;
	int			count;

	if (!OidIsValid(table) || !levels_may_read(mesh))
		return 0;
	rel = mesh_table_open(mesh, MESH_READ);
	table = mesh_rows_table(rel, MESH_LEVELS, MESH_READ);
	count = OidIsValid(table) ? levels_read(table, MESH_READ, levels) : 0;
	table_close(rel, NoLock);
	return count;
}

/*
 * The levels that are bound to a mesh, in the current memory context, in the order of their numbers in the catalogues;
 * returns how many. A mesh that is bound to another one is a level of it, whatever its table of levels says.
 */
int
levels_bound(Oid mesh, MeshAccess access, Oid **levels)
{
	MemoryContext caller = CurrentMemoryContext;
	int			count = 0;

	SPI_connect();
	if (SPI_execute(psprintf("SELECT objid FROM pg_catalog.pg_depend WHERE classid OPERATOR(pg_catalog.=) %u "
							 "AND refclassid OPERATOR(pg_catalog.=) %u AND refobjid OPERATOR(pg_catalog.=) %u "
							 "AND deptype OPERATOR(pg_catalog.=) 'a' AND objsubid OPERATOR(pg_catalog.=) 0 ORDER BY objid",
							 RelationRelationId, RelationRelationId, mesh), access == MESH_READ, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not read the dependencies of a mesh: %s", SPI_result_code_string(SPI_result));
	*levels = MemoryContextAlloc(caller, (SPI_processed + 1) * sizeof(Oid));
	for (uint64 row = 0; row < SPI_processed; row++)
	{
		Oid			relid = DatumGetObjectId(value_at(row, 1));

		if (mesh_of_table(relid) == relid)
			(*levels)[count++] = relid;
	}
	SPI_finish();
	return count;
}

static bool
names_level(const Level *levels, int count, Oid mesh)
{
	for (int i = 0; i < count; i++)
		if (levels[i].mesh == mesh)
			return true;
	return false;
}

/* How many levels of a mesh are not named by its table of levels, whose rows are given; the first one is in *level. */
int
levels_count_unnamed(Oid mesh, MeshAccess access, const Level *levels, int count, Oid *level)
{
	Oid		   *bound;
	int			bound_count = levels_bound(mesh, access, &bound);
	int			unnamed = 0;

	for (int i = 0; i < bound_count; i++)
		if (!names_level(levels, count, bound[i]) && unnamed++ == 0)
			*level = bound[i];
	return unnamed;
}

/* How many levels of a mesh were dropped, or are not named by its table of levels. */
int
levels_count_lost(Oid mesh, const Level *levels, int count)
{
	int			lost = levels_count_unnamed(mesh, MESH_READ, levels, count, &(Oid) {InvalidOid});

	for (int i = 0; i < count; i++)
		if (mesh_of_table(levels[i].mesh) != levels[i].mesh)
			lost++;
	return lost;
}

/* A hash that changes when a level is made or made anew. */
uint32
levels_hash(const Level *levels, int count)
{
	uint32		hash = (uint32) count;

	for (int i = 0; i < count; i++)
	{
		const uint64 row[] = {
			(uint64) levels[i].number, levels[i].mesh, (uint64) levels[i].stamp,
			DatumGetUInt64(Float8GetDatum(levels[i].max_error))
		};

		hash = hash_combine(hash, DatumGetUInt32(hash_any((const unsigned char *) row, sizeof(row))));
	}
	return hash;
}

/* How many levels are of a mesh that had another stamp. */
int
levels_count_old(const Level *levels, int count, uint64 stamp)
{
	int			old = 0;

	for (int i = 0; i < count; i++)
		if ((uint64) levels[i].stamp != stamp)
			old++;
	return old;
}

/* Binds the levels of a restored mesh to it, and their table: those that the user owns. */
void
levels_bind(Relation mesh)
{
	Oid			table = mesh_rows_table(mesh, MESH_LEVELS, MESH_WRITE);
	Level	   *levels;
	int			count = OidIsValid(table) ? levels_read(table, MESH_WRITE, &levels) : 0;

	for (int i = 0; i < count; i++)
		if (levels[i].mesh != RelationGetRelid(mesh) && mesh_of_table(levels[i].mesh) == levels[i].mesh &&
			object_ownercheck(RelationRelationId, levels[i].mesh, GetUserId()))
			mesh_bind_table(RelationGetRelid(mesh), levels[i].mesh);
}

static void
check_max_error(double max_error)
{
	if (isnan(max_error) || max_error < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("max_error must be a number, at least 0"),
				 errhint("Give the greatest error of the level to read, in units of the attribute.")));
}

/* For the table of levels, or for one of them; InvalidOid needs no right. */
static void
require_select(Oid table, Oid mesh)
{
	if (OidIsValid(table) && pg_class_aclcheck(table, GetUserId(), ACL_SELECT) != ACLCHECK_OK)
		ereport(ERROR,
				(errcode(ERRCODE_INSUFFICIENT_PRIVILEGE),
				 errmsg("permission denied for table %s", get_rel_name(table)),
				 errdetail("Levels of mesh \"%s\" are needed where an error is allowed.", get_rel_name(mesh)),
				 errhint("Its owner can grant SELECT on the levels and on their table. Without max_error and pixel_error the "
						 "full mesh is read.")));
}

/*
 * The mesh to read where an error is allowed: the coarsest level whose error is not greater, or else the full
 * mesh. Errors of levels are those of one attribute; NULL stands for any.
 */
Oid
levels_choose(Oid mesh, double max_error, const char *attribute)
{
	Relation	rel = mesh_table_open(mesh, MESH_READ);
	Oid			table = mesh_find_rows_table(mesh, MESH_LEVELS);
	const Level *chosen = NULL;
	Level	   *levels;
	int			count;

	check_max_error(max_error);
	require_select(table, mesh);
	table = mesh_rows_table(rel, MESH_LEVELS, MESH_READ);
	count = OidIsValid(table) ? levels_read(table, MESH_READ, &levels) : 0;
	table_close(rel, NoLock);
	if (count == 0)
	{
		(void) notice_namesake(mesh, MESH_LEVELS);
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has no levels", get_rel_name(mesh)),
				 errhint("Make them with abacus_levels(), or leave out the error that is allowed.")));
	}
	for (int i = 0; i < count; i++)
		if (levels[i].greatest <= max_error)
			chosen = &levels[i];
	if (attribute != NULL && strcmp(attribute, levels[0].attribute) != 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the levels of mesh \"%s\" are not levels of \"%s\"", get_rel_name(mesh), attribute),
				 errdetail("Their errors are those of attribute \"%s\".", levels[0].attribute),
				 errhint("Leave out the error that is allowed, to read the full mesh.")));
	if (chosen == NULL)
		return mesh;
	if (get_rel_name(chosen->mesh) == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("level %d of mesh \"%s\" no longer exists", chosen->number, get_rel_name(mesh)),
				 errhint("Drop the other levels with abacus_levels_drop(), and make them anew with abacus_levels().")));
	require_select(chosen->mesh, mesh);
	return chosen->mesh;
}

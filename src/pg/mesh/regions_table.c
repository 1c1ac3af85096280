/*
 * regions_table.c: the table of a mesh's regions, found, made and read.
 *
 * A row is an outline or a seed of a region: the name of the region, its number in the pages of the
 * mesh, a number of its own, and the line that is the outline, or the place of the seed.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/acl.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/hsearch.h"
#include "utils/lsyscache.h"
#include "utils/rls.h"

#include "pg/base/text_begin.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/regions_table.h"
#include "pg/mesh/new_table.h"

/* The table of the regions of a mesh that gets regions. */
Oid
regions_table_make(Relation mesh)
{
	static const NewSideTable regions = {
		.suffix = REGIONS_TABLE_SUFFIX,.type = REGION_PART_TYPE,.columns = REGION_PART_COLUMNS,
		.options = "number WITH OPTIONS NOT NULL, PRIMARY KEY (region, part)",
		.contents = "regions",.maker = "abacus_region()",.reader = "abacus_regions()"
	};
	Oid			table = mesh_rows_table(mesh, MESH_REGIONS, MESH_WRITE);

	return OidIsValid(table) ? table : side_table_make(mesh, &regions);
}

/* The table of the regions of a mesh that has some, as a name in SQL. */
char *
regions_table_require(Relation mesh, MeshAccess access)
{
	Oid			table = mesh_rows_table(mesh, MESH_REGIONS, access);

	if (!OidIsValid(table))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\" has regions, but no table of regions", RelationGetRelationName(mesh)),
				 errdetail("There is no table \"%s" REGIONS_TABLE_SUFFIX "\" of type %s beside it that has its owner.",
						   RelationGetRelationName(mesh), REGION_PART_TYPE),
				 errhint("After a restore, give the table of regions that name and the owner of the mesh, and call "
						 "abacus_set_srid() with the SRID that the mesh has; if it is lost, restore it from a backup.")));
	return lines_table_name(table);
}

/*
 * The first column of the first row of a query with one argument; false if there is none. A writer sees
 * what it has changed.
 */
static bool
find(const char *query, MeshAccess access, Oid type, Datum argument, Datum *value)
{
	bool		isnull;

	if (SPI_execute_with_args(query, 1, &type, &argument, NULL, access == MESH_READ, 1) != SPI_OK_SELECT)
		elog(ERROR, "could not read the regions: %s", SPI_result_code_string(SPI_result));
	if (SPI_processed == 0)
		return false;
	*value = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull);
	return true;
}

/* The name of a region with a number, which is in the caller's memory; NULL if there is none. */
static char *
find_region(Relation mesh, MeshAccess access, uint32 number)
{
	char	   *table = regions_table_require(mesh, access);
	char	   *name = NULL;
	Datum		region;
	MemoryContext caller = CurrentMemoryContext;

	SPI_connect();
	if (find(psprintf("SELECT region FROM %s WHERE number OPERATOR(pg_catalog.=) $1 LIMIT 1", table),
			 access, INT4OID, Int32GetDatum((int32) number), &region))
		name = MemoryContextStrdup(caller, TextDatumGetCString(region));
	SPI_finish();
	return name;
}

/* The same for messages. */
char *
regions_table_region(Relation mesh, MeshAccess access, uint32 number)
{
	char	   *name = find_region(mesh, access, number);

	return name != NULL ? name : psprintf("number %u", number);
}

static void
complain_of_no_name(Oid mesh, uint32 number)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATA_CORRUPTED),
			 errmsg("mesh \"%s\" has triangles of region number %u, which has no name",
					get_rel_name(mesh), number),
			 errhint("Find all faults with abacus_check().")));
}

/* The name of the region that triangles with a number are in. */
char *
regions_table_name(Relation mesh, MeshAccess access, uint32 number)
{
	char	   *name = find_region(mesh, access, number);

	if (name == NULL)
		complain_of_no_name(RelationGetRelid(mesh), number);
	return name;
}

/* Takes a corner of a region's box; false if it has none, or none that can be. */
static bool
take_corner(HeapTuple tuple, TupleDesc desc, int column, double *corner)
{
	bool		isnull;
	Datum		array = SPI_getbinval(tuple, desc, column, &isnull);
	Datum	   *values;
	bool	   *nulls;
	int			count = 0;

	if (!isnull)
		deconstruct_array(DatumGetArrayTypeP(array), FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE,
						  &values, &nulls, &count);
	if (count != 2 || nulls[0] || nulls[1])
		return false;
	for (int i = 0; i < 2; i++)
		corner[i] = DatumGetFloat8(values[i]);
	return isfinite(corner[0]) && isfinite(corner[1]);
}

/* The number of the region with a name and, if it is known, its box; an error if there is none. */
void
regions_table_find(Relation mesh, MeshAccess access, const char *region, abacus_extent *extent)
{
	char	   *table = regions_table_require(mesh, access);
	Datum		number;
	bool		isnull;
	bool		found;

	SPI_connect();
	found = find(psprintf("SELECT number, lower, upper FROM %s WHERE region OPERATOR(pg_catalog.=) $1 LIMIT 1", table),
				 access, TEXTOID, CStringGetTextDatum(region), &number);
	if (found)
	{
		HeapTuple	tuple = SPI_tuptable->vals[0];
		TupleDesc	desc = SPI_tuptable->tupdesc;

		extent->region = (uint32) DatumGetInt32(SPI_getbinval(tuple, desc, 1, &isnull));
		extent->has_box = take_corner(tuple, desc, 2, extent->lower) && take_corner(tuple, desc, 3, extent->upper) &&
			extent->lower[0] <= extent->upper[0] && extent->lower[1] <= extent->upper[1];
	}
	SPI_finish();
	if (!found)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("mesh \"%s\" has no region \"%s\"", RelationGetRelationName(mesh), text_begin(region)),
				 errhint("abacus_regions() lists the regions of a mesh.")));
}

/* Refuses to take lines away, the ids of a query, if a region uses one. SPI is connected. */
void
regions_table_refuse_lines(Relation mesh, const char *ids)
{
	char	   *table = regions_table_require(mesh, MESH_WRITE);
	bool		isnull;

	if (SPI_execute(psprintf("SELECT r.region, r.line FROM %s AS r WHERE r.line IN (%s) "
							 "ORDER BY r.line, r.region LIMIT 1", table, ids), false, 1) != SPI_OK_SELECT)
		elog(ERROR, "could not read the regions: %s", SPI_result_code_string(SPI_result));
	if (SPI_processed > 0)
		ereport(ERROR,
				(errcode(ERRCODE_DEPENDENT_OBJECTS_STILL_EXIST),
				 errmsg("region \"%s\" of mesh \"%s\" uses line " INT64_FORMAT,
						SPI_getvalue(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1),
						RelationGetRelationName(mesh),
						DatumGetInt64(SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 2, &isnull))),
				 errhint("Remove the region first, with abacus_unregion().")));
}

/* ---- Names of all regions ---------------------------------------------------------- */

#define ROWS_A_FETCH 1024

typedef struct RegionName
{
	uint32		number;			/* the key */
	char	   *name;
} RegionName;

struct RegionNames
{
	Oid			mesh;
	HTAB	   *names;
};

/* Whether a user may read the names; nothing is locked. */
bool
region_names_may_read(Oid mesh, Oid user)
{
	Oid			table = mesh_find_rows_table(mesh, MESH_REGIONS);

	return OidIsValid(table) && pg_class_aclcheck(table, user, ACL_SELECT) == ACLCHECK_OK &&
		check_enable_rls(table, user, true) != RLS_ENABLED;
}

static void
add_rows(HTAB *names, MemoryContext memory)
{
	for (uint64 i = 0; i < SPI_processed; i++)
	{
		bool		isnull;
		bool		found;
		uint32		number = (uint32) DatumGetInt32(SPI_getbinval(SPI_tuptable->vals[i],
																  SPI_tuptable->tupdesc, 1, &isnull));
		RegionName *name = hash_search(names, &number, HASH_ENTER, &found);

		name->name = MemoryContextStrdup(memory, SPI_getvalue(SPI_tuptable->vals[i],
															  SPI_tuptable->tupdesc, 2));
	}
}

/*
 * Reads the names once, into the current memory context, under the active snapshot, as the pages are. The mesh
 * is locked. A mesh without regions has none, and needs no privilege.
 */
RegionNames *
region_names_read(Oid mesh, const abacus_facts *facts)
{
	RegionNames *names = palloc0(sizeof(RegionNames));
	HASHCTL		control = {
		.keysize = sizeof(uint32),.entrysize = sizeof(RegionName),.hcxt = CurrentMemoryContext
	};
	SPIParseOpenOptions options = {.cursorOptions = CURSOR_OPT_NO_SCROLL,.read_only = true};
	Relation	heap;
	Portal		portal;
	char	   *table;

	names->mesh = mesh;
	if (facts->census.regions == 0)
		return names;
	heap = table_open(mesh, NoLock);
	table = regions_table_require(heap, MESH_READ);
	table_close(heap, NoLock);
	names->names = hash_create("Abacus names of regions", 64, &control,
							   HASH_ELEM | HASH_BLOBS | HASH_CONTEXT);
	SPI_connect();
	portal = SPI_cursor_parse_open(NULL, psprintf("SELECT DISTINCT number, region FROM %s", table), &options);
	do
	{
		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		add_rows(names->names, control.hcxt);
		SPI_freetuptable(SPI_tuptable);
	} while (SPI_processed > 0);
	SPI_cursor_close(portal);
	SPI_finish();
	return names;
}

/* The name of the region with a number; NULL for 0, which is none. */
const char *
region_names_find(const RegionNames *names, uint32 number)
{
	const RegionName *name;

	if (number == 0)
		return NULL;
	name = names->names == NULL ? NULL : hash_search(names->names, &number, HASH_FIND, NULL);
	if (name == NULL)
		complain_of_no_name(names->mesh, number);
	return name->name;
}

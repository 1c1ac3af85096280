/*
 * extent_arguments.c: the arguments that say which part of a mesh counts: max_edge and within.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/base/text_begin.h"
#include "pg/mesh/regions_table.h"
#include "pg/sql/arguments/area_argument.h"
#include "pg/geos/area_text.h"
#include "pg/sql/arguments/extent_arguments.h"

/* The longest edge to return, or that simplices may have; 0 if any length is allowed. */
double
extent_max_edge(FunctionCallInfo fcinfo, int argument)
{
	double		value = PG_ARGISNULL(argument) ? 0 : PG_GETARG_FLOAT8(argument);

	if (!isfinite(value) || value < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("max_edge must be a finite number, at least 0"),
				 errhint("Leave it out, or give 0, for edges of any length.")));
	return value;
}

/* ---- within ---------------------------------------------------------------------------- */

/* The region that was found last. A stamp stands for one state of one mesh, and never repeats. */
typedef struct LastRegion
{
	Oid			user;			/* who may read the table of regions */
	Oid			mesh;
	uint64		stamp;			/* 0: there is none */
	char	   *name;
	abacus_extent extent;		/* its number and its box */
} LastRegion;

/* ... by its name, and by its number, then without a box. */
static LastRegion last;
static LastRegion last_named;

static abacus_extent
find_region(Oid mesh, const char *name)
{
	Relation	heap = table_open(mesh, NoLock);	/* locked since the mesh was got */
	abacus_extent found = {0};

	regions_table_find(heap, MESH_READ, name, &found);
	table_close(heap, NoLock);
	return found;
}

static void
remember(LastRegion *region, Oid mesh, uint64 stamp, const char *name, abacus_extent extent)
{
	char	   *copy = MemoryContextStrdup(TopMemoryContext, name);

	if (region->name != NULL)
		pfree(region->name);
	*region = (LastRegion) {GetUserId(), mesh, stamp, copy, extent};
}

/* The region, which is remembered for the next call if the stamp of the mesh is given. */
static abacus_extent
region_of(const char *name, Oid mesh, const abacus_facts *facts, uint64 stamp)
{
	abacus_extent found;

	if (facts->census.regions == 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("mesh \"%s\" has no region \"%s\"", get_rel_name(mesh), text_begin(name)),
				 errdetail("It has no regions."),
				 errhint("Make regions with abacus_region(), or give a polygon as WKT.")));
	if (stamp != 0 && last.stamp == stamp && last.mesh == mesh && last.user == GetUserId() &&
		strcmp(last.name, name) == 0)
		return last.extent;
	found = find_region(mesh, name);
	if (stamp != 0)
		remember(&last, mesh, stamp, name, found);
	return found;
}

/*
 * Sets the region or the polygon of an extent. A polygon lives as long as its owner, a host; without one it
 * is remembered, and lives until the next one.
 */
void
extent_within(FunctionCallInfo fcinfo, int argument, Oid mesh, const abacus_facts *facts, uint64 stamp,
			  Host *owner, abacus_extent *extent)
{
	double		max_edge = extent->max_edge;
	char	   *given;

	*extent = (abacus_extent) {.max_edge = max_edge};
	if (PG_ARGISNULL(argument))
		return;
	given = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	if (!area_text_is(given))
	{
		*extent = region_of(given, mesh, facts, stamp);
		extent->max_edge = max_edge;
	}
	else if (owner != NULL)
		extent->area = area_open(given, &facts->form, get_rel_name(mesh), owner->home);
	else
		extent->area = area_remembered(given, &facts->form, get_rel_name(mesh));
}

/*
 * The name of the region with a number, valid until the next call; it is remembered as well.
 */
const char *
extent_region_name(Oid mesh, const abacus_header *header, uint32 number)
{
	Relation	heap;
	char	   *name;

	if (last_named.stamp == header->stamp && last_named.mesh == mesh && last_named.user == GetUserId() &&
		last_named.extent.region == number)
		return last_named.name;
	heap = table_open(mesh, NoLock);	/* locked since the mesh was got */
	name = regions_table_name(heap, MESH_READ, number);
	table_close(heap, NoLock);
	remember(&last_named, mesh, header->stamp, name, (abacus_extent) {.region = number});
	return last_named.name;
}

/* Both arguments. */
void
extent_arguments(FunctionCallInfo fcinfo, int max_edge, int within, Oid mesh, const abacus_header *header,
				 Host *owner, abacus_extent *extent)
{
	extent->max_edge = extent_max_edge(fcinfo, max_edge);
	extent_within(fcinfo, within, mesh, &header->facts, header->stamp, owner, extent);
}

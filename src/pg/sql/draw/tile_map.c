/*
 * tile_map.c: arguments of tiles: the map that they are of, and the attribute that they show.
 */
#include "postgres.h"

#include "utils/array.h"

#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/draw/tile_map.h"

/* A map with its own world: a square in the mesh's coordinates. */
static void
own_world(ArrayType *array, abacus_tile *tile)
{
	int			count;
	Datum	   *world = shape_numbers(array, "world", &count);

	if (count != 3)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("world must have 3 elements, not %d", count),
				 errhint("Give x and y of its lower left corner, and its side.")));
	for (int i = 0; i < 2; i++)
		tile->lower[i] = DatumGetFloat8(world[i]);
	tile->side = DatumGetFloat8(world[2]);
	if (!(tile->side > 0))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the side of world must be above 0")));
}

/* The SRID of the mesh: from its header or, if it has none there, from the argument. */
static int32
tile_srid(FunctionCallInfo fcinfo, int argument, const abacus_form *form)
{
	int32		srid = PG_ARGISNULL(argument) ? (int32) form->srid : PG_GETARG_INT32(argument);

	header_require_srid(form, srid);
	if (srid == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("the mesh has no SRID, so its place on the map is not known"),
				 errhint("Say with abacus_set_srid(mesh, 4326) that its coordinates are longitude "
						 "and latitude, or with abacus_set_srid(mesh, 3857) that they are in Web "
						 "Mercator; or give srid, or world for a map of their own.")));
	if (srid != 4326 && srid != 3857)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("srid must be 4326 or 3857, not %d", srid),
				 errhint("Tiles need a mesh in longitude and latitude (4326) or in Web Mercator "
						 "(3857). Transform other points before they are triangulated, for "
						 "instance with ST_Transform of PostGIS, or give world for a map of their "
						 "own.")));
	return srid;
}

/* The map of the tiles: Web Mercator, or one of its own. */
void
tile_map(FunctionCallInfo fcinfo, int srid, int world, const abacus_form *form, abacus_tile *tile)
{
	if (!PG_ARGISNULL(world))
	{
		own_world(PG_GETARG_ARRAYTYPE_P(world), tile);
		return;
	}
	tile->is_geographic = tile_srid(fcinfo, srid, form) == 4326;
	tile->lower[0] = tile->lower[1] = -HALF_WORLD;
	tile->side = 2 * HALF_WORLD;
}

/* An attribute by its name; if not given, the only one, or -1 if the mesh has none. */
int
tile_attribute(FunctionCallInfo fcinfo, int argument, abacus_names names)
{
	if (PG_ARGISNULL(argument))
		return names.facts->columns.attributes == 0 ? -1 : header_only_attribute(names);
	return attribute_or_none(fcinfo, argument, names);
}

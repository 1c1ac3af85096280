/*
 * fn_tile_mesh.c: abacus_tile_mesh, a tile of terrain as triangles.
 */
#include "postgres.h"

#include "abacus/tile.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/sql/arguments/level_argument.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/sql/arguments/word.h"
#include "pg/sql/draw/drawing.h"
#include "pg/sql/draw/tile_map.h"

SQL_FUNCTION(abacus_sql_tile_mesh);

enum
{
	MESH_MESH,
	MESH_ZOOM,
	MESH_X,
	MESH_Y,
	MESH_ATTRIBUTE,
	MESH_SRID,
	MESH_WORLD,
	MESH_FORMAT,
	MESH_SCHEME,
	MESH_MAX_ERROR,
	MESH_STEP
};

static const LevelArguments mesh_level = {
	.mesh = MESH_MESH,.attribute = MESH_ATTRIBUTE,.within = -1,.regions = -1,
	.step = MESH_STEP,.max_error = MESH_MAX_ERROR,.pixel_error = -1
};

/* In the order of abacus_tile_mesh_format */
static const char *const formats[] = {"quantized-mesh", "glb", NULL};

/* Whether y counts from the north */
static const char *const schemes[] = {"tms", "xyz", NULL};

static Reader *
open_surface(FunctionCallInfo fcinfo, Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);

	header_require_dimension(&reader->header.facts.form, 2, "Use a mesh in the plane.");
	step_argument(fcinfo, MESH_STEP, reader);
	header_require_attributes(&reader->header.facts);
	return reader;
}

/*
 * Opens the mesh, or a level of it, and says where the tile is: by the SRID of the mesh itself, which its levels need not
 * have. An error in pixels is no argument: it would be another level for the next row of tiles, and tiles of two
 * levels have a gap between them.
 */
static Reader *
open_mesh(FunctionCallInfo fcinfo, abacus_tile *tile)
{
	Oid			level = level_argument(fcinfo, &mesh_level);
	Reader	   *reader = open_surface(fcinfo, PG_GETARG_OID(MESH_MESH));

	tile_map(fcinfo, MESH_SRID, MESH_WORLD, &reader->header.facts.form, tile);
	if (level == PG_GETARG_OID(MESH_MESH))
		return reader;
	host_release(reader->host);
	host_destroy(reader->host);
	return open_surface(fcinfo, level);
}

/* What the coordinates are. */
static abacus_tile_plane
plane_of(FunctionCallInfo fcinfo, const abacus_tile *tile, abacus_tile_mesh_format format)
{
	if (PG_ARGISNULL(MESH_WORLD))
		return tile->is_geographic ? ABACUS_TILE_DEGREES : ABACUS_TILE_MERCATOR;
	if (format == ABACUS_TILE_QUANTIZED)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("a map of its own has no place on the globe, which quantized-mesh needs"),
				 errhint("Use format => 'glb' with world; or leave out world, if the coordinates of the mesh are "
						 "longitude and latitude (srid => 4326) or Web Mercator (srid => 3857).")));
	return ABACUS_TILE_OWN;
}

/*
 * abacus_tile_mesh(mesh regclass, z int, x int, y int, attribute text, srid int, world float8[],
 * format text, scheme text, max_error float8, step int8) -> bytea
 */
Datum
abacus_sql_tile_mesh(PG_FUNCTION_ARGS)
{
	abacus_tile tile = {0};
	abacus_tile_memory memory = {setting_query_sort_bytes(), setting_cache_bytes()};
	abacus_tile_mesh_kind kind = {0};
	abacus_picture bytes = {0};
	Reader	   *reader;
	bytea	   *result;

	for (int i = 0; i < MESH_ATTRIBUTE; i++)
		if (PG_ARGISNULL(i))
			PG_RETURN_NULL();
	reader = open_mesh(fcinfo, &tile);
	kind.format = word_argument(fcinfo, MESH_FORMAT, formats, "format", "Use quantized-mesh or glb.");
	kind.from_south = word_argument(fcinfo, MESH_SCHEME, schemes, "scheme",
									"Use tms, where y counts from the south, or xyz, where it counts from the north.") == 0;
	kind.attribute = (uint32) tile_attribute(fcinfo, MESH_ATTRIBUTE, abacus_names_of(&reader->header));
	kind.plane = plane_of(fcinfo, &tile, kind.format);
	tile.zoom = PG_GETARG_INT32(MESH_ZOOM);
	tile.x = PG_GETARG_INT32(MESH_X);
	tile.y = PG_GETARG_INT32(MESH_Y);
	host_run(reader->host, abacus_tile_mesh, &reader->host->table, &reader->header.facts, &tile, &kind,
			 &memory, &bytes);
	result = drawing_finish(reader->host, &bytes);
	if (bytes.is_blank)
		PG_RETURN_NULL();
	PG_RETURN_BYTEA_P(result);
}

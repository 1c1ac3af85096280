/*
 * fn_tile.c: abacus_tile_picture, abacus_tile_vector and abacus_tile_terrain, a tile of a web map,
 * and abacus_tile_etag, which shows whether it may have changed.
 */
#include "postgres.h"

#include <math.h>

#include "mb/pg_wchar.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "abacus/tile.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/levels/levels_table.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/regions_table.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/level_argument.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/sql/draw/drawing.h"
#include "pg/sql/draw/tile_lines.h"
#include "pg/sql/draw/tile_map.h"
#include "pg/steps/step.h"

SQL_FUNCTION(abacus_sql_tile_picture);
SQL_FUNCTION(abacus_sql_tile_vector);
SQL_FUNCTION(abacus_sql_tile_terrain);
SQL_FUNCTION(abacus_sql_tile_etag);

/* Arguments of all three */
enum
{
	TILE_MESH,
	TILE_ZOOM,
	TILE_X,
	TILE_Y,
	TILE_SRID,
	TILE_WORLD,
	TILE_ARGUMENTS
};

/* Further arguments of abacus_tile_picture */
enum
{
	PICTURE_SIZE = TILE_ARGUMENTS,
	PICTURE_ATTRIBUTE,
	PICTURE_RANGE,
	PICTURE_EDGES,
	PICTURE_EXAGGERATION,
	PICTURE_MAX_EDGE,
	PICTURE_RAMP,
	PICTURE_CONTOURS,
	PICTURE_WITHIN,
	PICTURE_REGIONS,
	PICTURE_LINES,
	PICTURE_MAX_ERROR,
	PICTURE_PIXEL_ERROR,
	PICTURE_STEP
};

/* ... of abacus_tile_vector */
enum
{
	VECTOR_ATTRIBUTE = TILE_ARGUMENTS,
	VECTOR_CONTOURS,
	VECTOR_MAX_EDGE,
	VECTOR_WITHIN,
	VECTOR_MAX_ERROR,
	VECTOR_PIXEL_ERROR,
	VECTOR_STEP
};

/* ... of abacus_tile_terrain */
enum
{
	TERRAIN_SIZE = TILE_ARGUMENTS,
	TERRAIN_ATTRIBUTE,
	TERRAIN_MAX_EDGE,
	TERRAIN_FILL,
	TERRAIN_WITHIN,
	TERRAIN_MAX_ERROR,
	TERRAIN_PIXEL_ERROR,
	TERRAIN_STEP
};

static const LevelArguments picture_level = {
	.mesh = TILE_MESH,.attribute = PICTURE_ATTRIBUTE,.within = PICTURE_WITHIN,.regions = PICTURE_REGIONS,
	.step = PICTURE_STEP,.max_error = PICTURE_MAX_ERROR,.pixel_error = PICTURE_PIXEL_ERROR
};
static const LevelArguments vector_level = {
	.mesh = TILE_MESH,.attribute = VECTOR_ATTRIBUTE,.within = VECTOR_WITHIN,.regions = -1,
	.step = VECTOR_STEP,.max_error = VECTOR_MAX_ERROR,.pixel_error = VECTOR_PIXEL_ERROR
};
static const LevelArguments terrain_level = {
	.mesh = TILE_MESH,.attribute = TERRAIN_ATTRIBUTE,.within = TERRAIN_WITHIN,.regions = -1,
	.step = TERRAIN_STEP,.max_error = TERRAIN_MAX_ERROR,.pixel_error = TERRAIN_PIXEL_ERROR
};

/* Pixels of a tile of which no size is given, as those of vectors */
#define TILE_SIZE 256

/* More pixels do not make a tile. */
#define MAX_TILE_SIZE 1024

/*
 * The length on the ground of a pixel at the centre of a tile, of so many a side. On a map of its own that is
 * its length there; Web Mercator shows lengths enlarged by the secant of the latitude.
 */
static double
ground_pixel(FunctionCallInfo fcinfo, const abacus_tile *tile, int32 size)
{
	double		side = ldexp(tile->side, -tile->zoom);
	double		north = HALF_WORLD - (tile->y + 0.5) * side;

	if (!PG_ARGISNULL(TILE_WORLD))
		return side / size;
	return side / size / cosh(north / (HALF_WORLD / M_PI));
}

static Reader *
open_plane(Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);

	header_require_dimension(&reader->header.facts.form, 2, "Use a mesh in the plane.");
	return reader;
}

/* Opens the level of the mesh that is fine enough for the tile. */
static Reader *
open_level(FunctionCallInfo fcinfo, Reader *full, const abacus_tile *tile, const LevelArguments *arguments, int32 size)
{
	Oid			level = level_of_pixel(fcinfo, arguments, ground_pixel(fcinfo, tile, size));

	if (level == mesh_pages(full->host)->mesh)
		return full;
	host_release(full->host);
	host_destroy(full->host);
	return open_plane(level);
}

static int32
tile_size(FunctionCallInfo fcinfo, int argument)
{
	int32		size = PG_ARGISNULL(argument) ? TILE_SIZE : PG_GETARG_INT32(argument);

	if (size < 1 || size > MAX_TILE_SIZE)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("size must be between 1 and %d pixels, not %d", MAX_TILE_SIZE, size)));
	return size;
}

/* Opens the mesh of a tile, whose size is an argument or -1; NULL if it, or the tile, is NULL. */
static Reader *
tile_begin(FunctionCallInfo fcinfo, const LevelArguments *level, int size, abacus_tile *tile, abacus_tile_memory *memory)
{
	Reader	   *reader;

	for (int i = 0; i < TILE_SRID; i++)
		if (PG_ARGISNULL(i))
			return NULL;
	memset(tile, 0, sizeof(*tile));
	reader = open_plane(PG_GETARG_OID(TILE_MESH));
	tile_map(fcinfo, TILE_SRID, TILE_WORLD, &reader->header.facts.form, tile);
	tile->zoom = PG_GETARG_INT32(TILE_ZOOM);
	tile->x = PG_GETARG_INT32(TILE_X);
	tile->y = PG_GETARG_INT32(TILE_Y);
	memory->sort = setting_query_sort_bytes();
	memory->cache = setting_cache_bytes();
	reader = open_level(fcinfo, reader, tile, level, size < 0 ? TILE_SIZE : tile_size(fcinfo, size));
	step_argument(fcinfo, level->step, reader);
	return reader;
}

/*
 * abacus_tile_picture(mesh regclass, z int, x int, y int, srid int,
 * world float8[], size int,
 * attribute text, range float8[], edges boolean, exaggeration float8,
 * max_edge float8, ramp text, contours float8, within text, regions boolean, lines boolean,
 * max_error float8, pixel_error float8, step int8) -> bytea
 */
Datum
abacus_sql_tile_picture(PG_FUNCTION_ARGS)
{
	abacus_tile tile;
	abacus_tile_memory memory;
	abacus_drawing drawing = {0};
	abacus_picture picture = {0};
	Reader	   *reader = tile_begin(fcinfo, &picture_level, PICTURE_SIZE, &tile, &memory);
	Host	   *host;

	if (reader == NULL)
		PG_RETURN_NULL();
	host = reader->host;
	drawing.width = tile_size(fcinfo, PICTURE_SIZE);
	drawing.attribute = step_or_attribute(fcinfo, PICTURE_STEP, PICTURE_ATTRIBUTE, abacus_names_of(&reader->header));
	drawing_range(fcinfo, PICTURE_RANGE, &drawing);
	drawing.edges = PG_ARGISNULL(PICTURE_EDGES) || PG_GETARG_BOOL(PICTURE_EDGES);
	drawing.exaggeration = drawing_factor(fcinfo, PICTURE_EXAGGERATION, "exaggeration");
	extent_arguments(fcinfo, PICTURE_MAX_EDGE, PICTURE_WITHIN, mesh_pages(reader->host)->mesh, &reader->header, reader->host,
					 &drawing.extent);
	drawing_ramp(fcinfo, PICTURE_RAMP, &drawing);
	drawing_contours(fcinfo, PICTURE_CONTOURS, &drawing);
	drawing_overlay(fcinfo, PICTURE_REGIONS, PICTURE_LINES, &drawing);
	drawing.transparent = true;
	host_run(host, abacus_tile_picture, &host->table, &reader->header.facts, &tile, &drawing, &memory,
			 &picture);
	PG_RETURN_BYTEA_P(drawing_finish(host, &picture));
}

/* The names of regions for the core. */
typedef struct TileNames
{
	Host	   *host;
	RegionNames *regions;
} TileNames;

/*
 * Reads them; NULL if there are none. Who may read the mesh gets its tiles, but without names that he may
 * not read.
 */
static RegionNames *
read_names(Oid mesh, const abacus_facts *facts)
{
	if (facts->census.regions == 0)
		return NULL;
	if (region_names_may_read(mesh, GetUserId()))
		return region_names_read(mesh, facts);
	ereport(NOTICE,
			(errmsg("triangles have no names of regions, which user \"%s\" may not read",
					GetUserNameFromId(GetUserId(), false)),
			 errhint("Grant SELECT on the table of regions of mesh \"%s\".", get_rel_name(mesh))));
	return NULL;
}

/* Called by the core. */
static abacus_host_status
find_name(void *context, uint32_t region, const char **name)
{
	TileNames  *names = context;
	const char *found;

	GUARD_BEGIN();
	found = region_names_find(names->regions, region);
	*name = pg_server_to_any(found, (int) strlen(found), PG_UTF8);
	GUARD_END(names->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_tile_vector(mesh regclass, z int, x int, y int, srid int,
 * world float8[], attribute text,
 * contours float8, max_edge float8, within text, max_error float8, pixel_error float8, step int8) -> bytea
 */
Datum
abacus_sql_tile_vector(PG_FUNCTION_ARGS)
{
	abacus_tile tile;
	abacus_tile_memory memory;
	abacus_tile_vector_kind kind = {0};
	TileNames	names;
	abacus_tile_words words = {.context = &names};
	abacus_picture bytes = {0};
	abacus_picture lines = {0};
	int32		has_triangles;
	Reader	   *reader = tile_begin(fcinfo, &vector_level, -1, &tile, &memory);
	Host	   *host;

	if (reader == NULL)
		PG_RETURN_NULL();
	host = reader->host;
	kind.attribute = tile_attribute(fcinfo, VECTOR_ATTRIBUTE, abacus_names_of(&reader->header));
	kind.contour_interval = drawing_interval(fcinfo, VECTOR_CONTOURS);
	extent_arguments(fcinfo, VECTOR_MAX_EDGE, VECTOR_WITHIN, mesh_pages(reader->host)->mesh, &reader->header, reader->host,
					 &kind.extent);
	names.host = host;
	names.regions = read_names(mesh_pages(reader->host)->mesh, &reader->header.facts);
	words.region_name = names.regions == NULL ? NULL : find_name;
	words.lines_apart = tile_lines_may_read(mesh_pages(reader->host)->mesh, &reader->header.facts.census);
	host_run(host, abacus_tile_vector, &host->table, &reader->header.facts, &tile, &kind, &words, &memory,
			 &bytes, &has_triangles);
	if (has_triangles && words.lines_apart && !tile_lines_layer(reader, &tile, &kind.extent, &lines))
	{
		words.lines_apart = false;
		host->table.resize(host, bytes.png, 0);
		host_run(host, abacus_tile_vector, &host->table, &reader->header.facts, &tile, &kind, &words, &memory,
				 &bytes, &has_triangles);
	}
	PG_RETURN_BYTEA_P(drawing_finish_both(host, &bytes, &lines));
}

/*
 * abacus_tile_terrain(mesh regclass, z int, x int, y int, srid int,
 * world float8[], size int,
 * attribute text, max_edge float8, fill float8, within text, max_error float8,
 * pixel_error float8, step int8) -> bytea
 */
Datum
abacus_sql_tile_terrain(PG_FUNCTION_ARGS)
{
	abacus_tile tile;
	abacus_tile_memory memory;
	abacus_tile_terrain_kind kind = {0};
	abacus_picture picture = {0};
	uint64		beyond;
	Reader	   *reader = tile_begin(fcinfo, &terrain_level, TERRAIN_SIZE, &tile, &memory);
	Host	   *host;

	if (reader == NULL)
		PG_RETURN_NULL();
	host = reader->host;
	header_require_attributes(&reader->header.facts);
	kind.width = tile_size(fcinfo, TERRAIN_SIZE);
	kind.attribute = (uint32) tile_attribute(fcinfo, TERRAIN_ATTRIBUTE, abacus_names_of(&reader->header));
	extent_arguments(fcinfo, TERRAIN_MAX_EDGE, TERRAIN_WITHIN, mesh_pages(reader->host)->mesh, &reader->header, reader->host,
					 &kind.extent);
	kind.fill = PG_ARGISNULL(TERRAIN_FILL) ? 0 : PG_GETARG_FLOAT8(TERRAIN_FILL);
	if (!isfinite(kind.fill))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("fill must be a finite number"),
				 errhint("Give the height where there is no mesh.")));
	host_run(host, abacus_tile_terrain, &host->table, &reader->header.facts, &tile, &kind, &memory,
			 &picture, &beyond);
	if (beyond > 0)
		ereport(NOTICE,
				(errmsg_plural(UINT64_FORMAT " height of the tile is beyond the range of its encoding",
							   UINT64_FORMAT " heights of the tile are beyond the range of its encoding",
							   (unsigned long) beyond, beyond),
				 errdetail("Heights below -32768 are -32768, and those above 32767.996 are 32767.996."),
				 errhint("Give an attribute whose unit is larger, for instance metres.")));
	PG_RETURN_BYTEA_P(drawing_finish(host, &picture));
}

/* abacus_tile_etag(mesh regclass, step int8) -> text */
Datum
abacus_sql_tile_etag(PG_FUNCTION_ARGS)
{
	Reader	   *reader;
	char	   *stamp;
	Level	   *levels;
	int			count;

	if (PG_ARGISNULL(0))
		PG_RETURN_NULL();
	reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	stamp = psprintf("%016llx", (unsigned long long) reader->header.stamp);
	host_release(reader->host);
	host_destroy(reader->host);
	count = levels_read_if_allowed(PG_GETARG_OID(0), &levels);
	if (count > 0)
		stamp = psprintf("%s-%08x", stamp, levels_hash(levels, count));
	if (!PG_ARGISNULL(1))
		stamp = psprintf("%s-%s", stamp, step_tag(PG_GETARG_OID(0), PG_GETARG_INT64(1)));
	PG_RETURN_TEXT_P(cstring_to_text(stamp));
}

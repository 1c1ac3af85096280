/*
 * tile.h: a mesh of dimension 2 as tiles of web maps.
 *
 * Tiles of zoom z are a grid of 2^z by 2^z squares over the map of the world, a square; x counts
 * from the west, y from the north.
 */
#ifndef ABACUS_ABACUS_TILE_H
#define ABACUS_ABACUS_TILE_H

#include "abacus/extent.h"
#include "abacus/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abacus_tile
{
	int32_t zoom, x, y;
	int32_t is_geographic; /* 1: the mesh has longitude and latitude in degrees, and the map is of Web
							  Mercator; 0: the map is of the mesh's coordinates */
	double lower[2];       /* if not: the map's lower left corner */
	double side;           /* ... and its side */
} abacus_tile;

/* Memory for sorting places, and for a cache of simplices. */
typedef struct abacus_tile_memory
{
	size_t sort, cache;
} abacus_tile_memory;

/*
 * A picture, as by abacus_draw; the drawing's width is that of the tile in pixels, its window and
 * height are not read. With an attribute the drawing must have a range. Where a pixel has several
 * triangles it shows the one at its centre.
 */
ABACUS_API abacus_status abacus_tile_picture(const abacus_host *host, const abacus_facts *facts,
											 const abacus_tile *tile, const abacus_drawing *drawing,
											 const abacus_tile_memory *memory,
											 abacus_picture *picture, abacus_error *error);

typedef struct abacus_tile_terrain_kind
{
	int32_t width;      /* pixels */
	uint32_t attribute; /* heights in metres */
	abacus_extent extent; /* leave out triangles outside of it */
	double fill;        /* height where there is no mesh */
} abacus_tile_terrain_kind;

/* Heights as colours of a PNG: 256 red + green + blue / 256 - 32768 ("terrarium"). */
ABACUS_API abacus_status abacus_tile_terrain(const abacus_host *host, const abacus_facts *facts,
											 const abacus_tile *tile,
											 const abacus_tile_terrain_kind *kind,
											 const abacus_tile_memory *memory,
											 abacus_picture *picture, abacus_error *error);

typedef struct abacus_tile_vector_kind
{
	int32_t attribute;       /* the value of triangles, vertices and contours; -1 = none */
	double contour_interval; /* 0 = no contours */
	abacus_extent extent;    /* leave out triangles outside of it */
} abacus_tile_vector_kind;

/* Gets the name of a region in UTF-8, which the caller keeps until the tile is made. */
typedef struct abacus_region_names
{
	abacus_host_status (*name)(void *context, uint32_t region, const char **name);
	void *context;
} abacus_region_names;

/*
 * A Mapbox vector tile; `picture` gets its bytes. Its layers are triangles, vertices, contours, fixed and
 * hull. For a tile with many triangles it has no triangles and vertices, and contours between
 * samples. Triangles in a region have its name, unless `names` is NULL.
 */
ABACUS_API abacus_status abacus_tile_vector(const abacus_host *host, const abacus_facts *facts,
											const abacus_tile *tile,
											const abacus_tile_vector_kind *kind,
											const abacus_region_names *names,
											const abacus_tile_memory *memory,
											abacus_picture *picture, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

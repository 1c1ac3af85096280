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

/*
 * Heights as colours of a PNG: 256 red + green + blue / 256 - 32768 ("terrarium"). *beyond is set to
 * how many heights that does not hold; they are the least or the greatest that it does.
 */
ABACUS_API abacus_status abacus_tile_terrain(const abacus_host *host, const abacus_facts *facts,
											 const abacus_tile *tile,
											 const abacus_tile_terrain_kind *kind,
											 const abacus_tile_memory *memory,
											 abacus_picture *picture, uint64_t *beyond,
											 abacus_error *error);

/* What the coordinates of a mesh are. */
typedef enum abacus_tile_plane
{
	ABACUS_TILE_OWN = 0,   /* metres on a map of their own, which is the tile's */
	ABACUS_TILE_DEGREES,   /* longitude and latitude */
	ABACUS_TILE_MERCATOR   /* metres of Web Mercator */
} abacus_tile_plane;

typedef enum abacus_tile_mesh_format
{
	ABACUS_TILE_QUANTIZED = 0, /* quantized-mesh 1.0 with normals; on the globe only */
	ABACUS_TILE_GLB            /* glTF 2.0 as one file */
} abacus_tile_mesh_format;

typedef struct abacus_tile_mesh_kind
{
	abacus_tile_plane plane;
	abacus_tile_mesh_format format;
	uint32_t attribute;     /* heights in metres */
	int32_t from_south;     /* 1: y of the tile counts from the south */
} abacus_tile_mesh_kind;

/*
 * Terrain as triangles; `picture` gets the bytes, none if there is no triangle in the tile. For
 * degrees there are 2^(z+1) by 2^z tiles, each a square of 180 / 2^z degrees; lower and side of the
 * tile are then not read.
 */
ABACUS_API abacus_status abacus_tile_mesh(const abacus_host *host, const abacus_facts *facts,
										  const abacus_tile *tile,
										  const abacus_tile_mesh_kind *kind,
										  const abacus_tile_memory *memory,
										  abacus_picture *picture, abacus_error *error);

typedef struct abacus_tile_vector_kind
{
	int32_t attribute;       /* the value of triangles, vertices and contours; -1 = none */
	double contour_interval; /* 0 = no contours */
	abacus_extent extent;    /* leave out triangles outside of it */
} abacus_tile_vector_kind;

/* What the host knows of regions and lines. */
typedef struct abacus_tile_words
{
	/* Gets the name of a region in UTF-8, which the host keeps until the tile is made; may be NULL. */
	abacus_host_status (*region_name)(void *context, uint32_t region, const char **name);
	void *context;
	int32_t lines_apart; /* 1: a tile with triangles gets its fixed edges by abacus_tile_fixed() */
} abacus_tile_words;

/*
 * A Mapbox vector tile; `picture` gets its bytes. Its layers are triangles, vertices, contours, fixed and
 * hull. For a tile with many triangles it has no triangles and vertices, and contours between
 * samples. Triangles in a region have its name. *has_triangles is set to 0 for a tile with too many.
 */
ABACUS_API abacus_status abacus_tile_vector(const abacus_host *host, const abacus_facts *facts,
											const abacus_tile *tile,
											const abacus_tile_vector_kind *kind,
											const abacus_tile_words *words,
											const abacus_tile_memory *memory,
											abacus_picture *picture, int32_t *has_triangles,
											abacus_error *error);

/* The part of a mesh that a vector tile shows, in its coordinates. */
ABACUS_API abacus_status abacus_tile_window(const abacus_facts *facts, const abacus_tile *tile,
											double lower[2], double upper[2],
											abacus_error *error);

/* A fixed edge and a line over it; x and y of both ends. */
typedef struct abacus_tile_edge
{
	double ends[4];
	int64_t line;
	int32_t is_hard;
} abacus_tile_edge;

#define ABACUS_MOST_TILE_EDGES 16000

/* The layer fixed of a vector tile, to be appended to it: of edges, whose order does not matter. */
ABACUS_API abacus_status abacus_tile_fixed(const abacus_host *host, const abacus_facts *facts,
										   const abacus_tile *tile,
										   const abacus_extent *extent,
										   const abacus_tile_edge *edges, uint64_t count,
										   abacus_picture *layer, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif

-- Tiles of web maps.

CREATE FUNCTION abacus_tile_picture(
    mesh regclass,
    z integer,
    x integer,
    y integer,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    size integer DEFAULT 256,
    attribute text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    edges boolean DEFAULT true,
    exaggeration double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL,
    ramp text DEFAULT NULL,
    contours double precision DEFAULT NULL,
    within text DEFAULT NULL,
    regions boolean DEFAULT false,
    lines boolean DEFAULT false,
    max_error double precision DEFAULT NULL,
    pixel_error double precision DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_picture'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_picture(regclass, integer, integer, integer, integer, double precision[], integer, text, double precision[], boolean, double precision, double precision, text, double precision, text, boolean, boolean, double precision, double precision, bigint) IS
    'a tile of a web map as a PNG, drawn as by abacus_draw, with nothing behind the mesh. The coordinates of the mesh are longitude and latitude (SRID 4326), Web Mercator (3857), or lie in a square with this lower left corner and side (world). within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. regions and lines are those of abacus_draw. max_error reads the coarsest level of abacus_levels whose error is not greater; pixel_error says the same in pixels on the ground at the centre of the tile. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: world is {x, y, side}; range is {first, last}. Units: size in pixels; world and max_edge in those of the coordinates; range, contours and max_error in those of the attribute; heights in metres with SRID 4326. Errors: 22023 no such tile, another SRID, a size out of range, an attribute without range, a mesh of dimension 3, both errors; 55000 neither srid nor world for a mesh without SRID, an error without levels; 2202E world of another length; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_tile_vector(
    mesh regclass,
    z integer,
    x integer,
    y integer,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    attribute text DEFAULT NULL,
    contours double precision DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    max_error double precision DEFAULT NULL,
    pixel_error double precision DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_vector'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_vector(regclass, integer, integer, integer, integer, double precision[], text, double precision, double precision, text, double precision, double precision, bigint) IS
    'a tile of a web map as a Mapbox vector tile, with the layers triangles, vertices, contours, fixed and hull. Triangles have the name of their region, if the caller may read it; fixed has the fixed edges, in a tile with triangles those of each line, if the caller may read the lines. A tile with many triangles has only contours, fixed and hull. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. max_error reads the coarsest level of abacus_levels whose error is not greater; pixel_error says the same in pixels on the ground at the centre of the tile. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: world is {x, y, side}. Units: world and max_edge in those of the coordinates; contours and max_error in those of the attribute. A pixel is 1/256 of the side. Errors: those of abacus_tile_picture; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_tile_terrain(
    mesh regclass,
    z integer,
    x integer,
    y integer,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    size integer DEFAULT 256,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    fill double precision DEFAULT 0,
    within text DEFAULT NULL,
    max_error double precision DEFAULT NULL,
    pixel_error double precision DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_terrain'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_terrain(regclass, integer, integer, integer, integer, double precision[], integer, text, double precision, double precision, text, double precision, double precision, bigint) IS
    'a tile of a web map as a PNG whose colours are heights. The encoding is terrarium: 256 red + green + blue / 256 - 32768. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. max_error reads the coarsest level of abacus_levels whose error is not greater; pixel_error says the same in pixels on the ground at the centre of the tile. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: world is {x, y, side}. Units: size in pixels; world and max_edge in those of the coordinates; fill and max_error in those of the attribute. Errors: those of abacus_tile_picture; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_tile_mesh(
    mesh regclass,
    z integer,
    x integer,
    y integer,
    attribute text DEFAULT NULL,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    format text DEFAULT 'quantized-mesh',
    scheme text DEFAULT 'tms',
    max_error double precision DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_mesh'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_mesh(regclass, integer, integer, integer, text, integer, double precision[], text, text, double precision, bigint) IS
    'a tile of terrain as triangles: quantized-mesh, which Cesium reads, or glb, which is glTF 2.0. NULL if the tile has no triangle. A mesh in longitude and latitude has 2^(z+1) by 2^z tiles, each a square in degrees; others have 2^z by 2^z. max_error reads the coarsest level of abacus_levels whose error is not greater; tiles that are to fit need the same. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: format is quantized-mesh or glb; scheme is tms, where y counts from the south, or xyz, where it counts from the north; world is {x, y, side}. Units: the attribute and max_error in metres, with SRID 4326 or 3857 above the ellipsoid; world in the unit of the coordinates, for glb metres. Errors: 22023 no such tile, another SRID, another word, quantized-mesh of a map of its own, a mesh of dimension 3; 42703 no such attribute; 42702 several, and none named; 55000 neither srid nor world for a mesh without SRID, or no attribute; 2202E world of another length; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_tile_etag(mesh regclass, step bigint DEFAULT NULL)
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_tile_etag'
LANGUAGE C STABLE PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_tile_etag(regclass, bigint) IS
    'a text that changes with each change of the mesh, and of its levels, for ETags of its tiles; with step, also when a part of the step is stored again. Errors: 42809 not a mesh, 42501 no privilege on the table of steps';

CREATE FUNCTION abacus_tiles(
    mesh regclass,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    attribute text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    contours double precision DEFAULT NULL,
    ramp text DEFAULT NULL,
    exaggeration double precision DEFAULT 0,
    edges boolean DEFAULT true,
    max_edge double precision DEFAULT NULL,
    size integer DEFAULT 256,
    within text DEFAULT NULL,
    regions boolean DEFAULT false,
    lines boolean DEFAULT false,
    pixel_error double precision DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS SETOF regprocedure
AS 'MODULE_PATHNAME', 'abacus_sql_tiles'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 100000 ROWS 4;
COMMENT ON FUNCTION abacus_tiles(regclass, integer, double precision[], text, double precision[], double precision, text, double precision, boolean, double precision, integer, text, boolean, boolean, double precision, bigint) IS
    'makes functions that tile servers call: <mesh>_picture, <mesh>_vector and <mesh>_terrain for Martin, <mesh>_mvt for pg_tileserv. Returns them. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. regions, lines and pixel_error are those of abacus_tile_picture. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: world is {x, y, side}; range is {first, last}. Units: size in pixels; world and max_edge in those of the coordinates; range and contours in those of the attribute. Errors: those of abacus_tile_picture; 42622 too long a name, 42501 no right to make functions; 42704 no such region; 42704 no such step, 55000 one that is not whole';

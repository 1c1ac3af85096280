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
    contours double precision DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_picture'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_picture(regclass, integer, integer, integer, integer, double precision[], integer, text, double precision[], boolean, double precision, double precision, text, double precision) IS
    'a tile of a web map as a PNG: a mesh whose coordinates are longitude and latitude (SRID 4326) or of Web Mercator (3857), or lie in a square with this lower left corner and side (world), as abacus_draw shows it; nothing is behind it';

CREATE FUNCTION abacus_tile_vector(
    mesh regclass,
    z integer,
    x integer,
    y integer,
    srid integer DEFAULT NULL,
    world double precision[] DEFAULT NULL,
    attribute text DEFAULT NULL,
    contours double precision DEFAULT NULL,
    max_edge double precision DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_vector'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_vector(regclass, integer, integer, integer, integer, double precision[], text, double precision, double precision) IS
    'a tile of a web map as a Mapbox vector tile, with the layers triangles, vertices, contours and hull; of a tile with many triangles only contours and hull';

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
    fill double precision DEFAULT 0)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_tile_terrain'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_tile_terrain(regclass, integer, integer, integer, integer, double precision[], integer, text, double precision, double precision) IS
    'a tile of a web map as a PNG whose colours are an attribute, in the encoding terrarium: 256 red + green + blue / 256 - 32768';

CREATE FUNCTION abacus_tile_etag(mesh regclass)
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_tile_etag'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_tile_etag(regclass) IS
    'a text that is another one after each change of the mesh, as an ETag of its tiles';

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
    size integer DEFAULT 256)
RETURNS SETOF regprocedure
AS 'MODULE_PATHNAME', 'abacus_sql_tiles'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 100000 ROWS 4;
COMMENT ON FUNCTION abacus_tiles(regclass, integer, double precision[], text, double precision[], double precision, text, double precision, boolean, double precision, integer) IS
    'makes functions <mesh>_picture, <mesh>_vector and <mesh>_terrain as the tile server Martin calls them, and <mesh>_mvt for pg_tileserv';

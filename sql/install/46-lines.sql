-- A mesh along lines, and as a raster.

CREATE FUNCTION abacus_line_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_line_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_line_rows(internal) IS 'planner support of functions that follow a line';

CREATE FUNCTION abacus_raster_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_raster_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_raster_rows(internal) IS 'planner support of abacus_raster';

CREATE FUNCTION abacus_profile(
    mesh regclass,
    path double precision[],
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT distance double precision,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT value double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_profile'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_line_rows;
COMMENT ON FUNCTION abacus_profile(regclass, double precision[], text, double precision, text) IS
    'an attribute along a path of straight lines. A row stands at each corner of the path and wherever it crosses an edge, in space a facet; value is NULL where the path leaves or enters the mesh. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: path is {x, y, x, y} or {{x, y}, {x, y}}, with z in space. Units: path, distance and max_edge in those of the coordinates, value in those of the attribute. Errors: 2202E fewer than two places, half a place or a NULL, 22023 a coordinate that is not finite or a bad max_edge; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION abacus_ray(
    mesh regclass,
    origin double precision[],
    direction double precision[],
    OUT enters double precision,
    OUT leaves double precision,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_ray'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_line_rows;
COMMENT ON FUNCTION abacus_ray(regclass, double precision[], double precision[]) IS
    'the simplices that a ray meets, in order, with where it enters and leaves them and their labels. Shapes: origin and direction are {x, y}, in space {x, y, z}. Units: origin and direction in those of the coordinates, enters and leaves in lengths of direction. Errors: 22023 a direction of length 0, a coordinate that is not finite; 2202E other lengths or a NULL';

CREATE FUNCTION abacus_visible(
    mesh regclass,
    observer double precision[],
    target double precision[],
    attribute text DEFAULT NULL,
    observer_height double precision DEFAULT 0,
    target_height double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT visible boolean,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_visible'
LANGUAGE C STABLE PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_visible(regclass, double precision[], double precision[], text, double precision, double precision, double precision, text) IS
    'whether a target is seen from an observer over a terrain. If not, x, y and z are the first place that blocks the sight. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: observer and target are {x, y} on the ground, or {x, y, z}. Units: places and max_edge in those of the coordinates, heights in those of the attribute. Errors: 22023 a mesh of dimension 3, a number that is not finite, a height for an end with z; 2202E other lengths; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION abacus_raster(
    mesh regclass,
    lower double precision[],
    upper double precision[],
    width integer,
    height integer,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT "row" integer,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_raster'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_raster_rows;
COMMENT ON FUNCTION abacus_raster(regclass, double precision[], double precision[], integer, integer, text, text, text, double precision, text) IS
    'an attribute as a raster, row by row from the top. A value is that of abacus_interpolate at the centre of a pixel. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}; "values" has width elements, row 0 is the one with the greatest y. Units: lower, upper and max_edge in those of the coordinates, width and height in pixels, "values" in those of the attribute. Errors: 22023 a size below 1 or a bad window, 54000 a row that is too long; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

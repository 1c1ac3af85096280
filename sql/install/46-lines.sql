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
    OUT distance double precision,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT value double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_profile'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_line_rows;
COMMENT ON FUNCTION abacus_profile(regclass, double precision[], text, double precision) IS
    'an attribute along a path of straight lines: at its corners and wherever it crosses an edge, in space a facet; with NULL where it leaves and enters the mesh';

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
    'the simplices that a ray meets, in order, where it enters and leaves them, counted in directions, and their labels';

CREATE FUNCTION abacus_visible(
    mesh regclass,
    observer double precision[],
    target double precision[],
    attribute text DEFAULT NULL,
    observer_height double precision DEFAULT 0,
    target_height double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL,
    OUT visible boolean,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_visible'
LANGUAGE C STABLE PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_visible(regclass, double precision[], double precision[], text, double precision, double precision, double precision) IS
    'whether a target is seen from an observer over a terrain, and where the line of sight is blocked first if not';

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
    OUT "row" integer,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_raster'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_raster_rows;
COMMENT ON FUNCTION abacus_raster(regclass, double precision[], double precision[], integer, integer, text, text, text, double precision) IS
    'an attribute at the centres of the pixels of a raster, row by row from the top, as abacus_interpolate finds it';

-- Lines of equal value, and the bands between them.

CREATE FUNCTION abacus_contours_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_contours_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_contours_rows(internal) IS 'planner support of abacus_contours';

CREATE FUNCTION abacus_contours(
    mesh regclass,
    level_interval double precision DEFAULT 100,
    level_base double precision DEFAULT 0,
    fixed_levels double precision[] DEFAULT '{}',
    polygonize boolean DEFAULT false,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    max_error double precision DEFAULT NULL,
    OUT id bigint,
    OUT value double precision,
    OUT closed boolean,
    OUT path double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_contours'
LANGUAGE C STABLE PARALLEL SAFE COST 100000 ROWS 1000 SUPPORT abacus_contours_rows;
COMMENT ON FUNCTION abacus_contours(regclass, double precision, double precision, double precision[], boolean, text, double precision[], double precision[], double precision, text, double precision) IS
    'the contours of an attribute in a mesh in the plane, or in a window, as whole lines. With polygonize, the rings around the bands between levels. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. max_error reads the coarsest level of abacus_levels whose error is not greater. Shapes: fixed_levels is an array of levels; lower and upper are {x, y}, in space {x, y, z}; path is {x, y, x, y, ...}. Units: levels and max_error in those of the attribute; lower, upper, max_edge and path in those of the coordinates. Errors: 22023 a bad interval, level or window, or a mesh of dimension 3; 53400 no room for temporary files; 54000 too long a line; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region; 55000 max_error without levels';

-- Surfaces through a mesh in space.

CREATE FUNCTION abacus_surface_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_surface_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_surface_rows(internal) IS 'planner support of functions that return a surface through a mesh';

CREATE FUNCTION abacus_isosurface(
    mesh regclass,
    value double precision,
    attribute text DEFAULT NULL,
    carry text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT corners double precision[],
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_isosurface'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000 ROWS 10000 SUPPORT abacus_surface_rows;
COMMENT ON FUNCTION abacus_isosurface(regclass, double precision, text, text, double precision[], double precision[], double precision) IS
    'the surface in a mesh in space on which an attribute has a value, as triangles. It is watertight; corners are numbered, and carry another attribute. Shapes: lower and upper are {x, y}, in space {x, y, z}; corners[i][axis], "values"[i] of corner i, from 1. Units: value in those of the attribute; lower, upper, max_edge and corners in those of the coordinates. Errors: 22023 a value that is not finite, a mesh of dimension 2, a bad window; 53400 no room for temporary files; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all';

CREATE FUNCTION abacus_section(
    mesh regclass,
    through double precision[],
    normal double precision[],
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT code bigint,
    OUT polygon double precision[],
    OUT "values" double precision[],
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_section'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 10000 SUPPORT abacus_surface_rows;
COMMENT ON FUNCTION abacus_section(regclass, double precision[], double precision[], text, double precision) IS
    'the polygons in which a plane cuts the tetrahedra of a mesh. The plane goes through a point and has a normal. values has an attribute at the corners. Shapes: through and normal are {x, y, z}; polygon is {x, y, z, x, y, z, ...}. Units: through, max_edge and polygon in those of the coordinates, normal of any length, "values" in those of the attribute. Errors: 22023 a mesh of dimension 2, a normal of zero, a number that is not finite; 2202E arrays of another length than 3; 42703 no such attribute, 42702 none named of several';

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
    'triangles of the surface in a mesh of dimension 3 on which an attribute has a value, watertight, with numbered corners and what another attribute is there';

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
    'what the plane through a point with a normal has of each tetrahedron of a mesh of dimension 3, with an attribute at its corners, and its labels';

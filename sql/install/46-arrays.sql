-- A mesh as arrays, for programs outside the database.

CREATE FUNCTION abacus_numbered_vertices(
    mesh regclass,
    OUT number bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_numbered_vertices'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_vertices_rows;
COMMENT ON FUNCTION abacus_numbered_vertices(regclass) IS
    'the vertices of a mesh, numbered from 0 along the curve: an array of points';

CREATE FUNCTION abacus_numbered_simplices(
    mesh regclass,
    OUT code bigint,
    OUT n0 bigint,
    OUT n1 bigint,
    OUT n2 bigint,
    OUT n3 bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_numbered_simplices'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_simplices_rows;
COMMENT ON FUNCTION abacus_numbered_simplices(regclass) IS
    'the simplices of a mesh in positive orientation, by the numbers that abacus_numbered_vertices gives its vertices';

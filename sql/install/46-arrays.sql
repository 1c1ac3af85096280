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
    'the vertices of a mesh as an array of points, numbered from 0 along the curve. Shapes: attributes in the order of the mesh. Units: places in those of the coordinates. Errors: 42809 not a mesh, 53400 no room for temporary files';

CREATE FUNCTION abacus_numbered_simplices(
    mesh regclass,
    OUT code bigint,
    OUT n0 bigint,
    OUT n1 bigint,
    OUT n2 bigint,
    OUT n3 bigint,
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_numbered_simplices'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_simplices_rows;
COMMENT ON FUNCTION abacus_numbered_simplices(regclass) IS
    'the simplices of a mesh, by the numbers of abacus_numbered_vertices, and their labels. Their orientation is positive. Shapes: labels in the order of abacus_labels, NULL in a mesh without any. Errors: 42809 not a mesh, 53400 no room for temporary files';

-- Asking a mesh.

CREATE FUNCTION abacus_locate(mesh regclass, x double precision, y double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision) IS
    'the triangle of a mesh of dimension 2 that contains the point; NULL outside the mesh';

CREATE FUNCTION abacus_locate(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision, double precision) IS
    'the tetrahedron of a mesh of dimension 3 that contains the point; NULL outside the mesh';

CREATE FUNCTION abacus_locate(
    mesh regclass,
    query text,
    OUT id bigint,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_locate_places'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_locate(regclass, text) IS
    'the simplices of a mesh that contain the places of a query (id, x, y[, z]); NULL outside the mesh';

CREATE FUNCTION abacus_walk(mesh regclass, simplex abacus_simplex, facet integer)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_walk'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_walk(regclass, abacus_simplex, integer) IS
    'the neighbour of a simplex across its facet opposite vertex i; NULL at the boundary of the mesh';

CREATE FUNCTION abacus_simplices_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_simplices_rows(internal) IS 'planner support of abacus_simplices';

CREATE FUNCTION abacus_simplices(mesh regclass)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices'
LANGUAGE C STABLE STRICT PARALLEL SAFE ROWS 100000 SUPPORT abacus_simplices_rows;
COMMENT ON FUNCTION abacus_simplices(regclass) IS
    'all simplices, page by page along the curve';

CREATE FUNCTION abacus_vertices_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_vertices_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_vertices_rows(internal) IS 'planner support of abacus_vertices';

CREATE FUNCTION abacus_attributes(
    mesh regclass,
    OUT "position" integer,
    OUT name text,
    OUT "least" double precision,
    OUT "greatest" double precision,
    OUT nulls bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_attributes'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100000 ROWS 4;
COMMENT ON FUNCTION abacus_attributes(regclass) IS
    'the attributes of a mesh: position in abacus_vertices().attributes, name, least and greatest value of all points, and how many have none';

CREATE FUNCTION abacus_add_attribute(mesh regclass, attribute text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_add_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_add_attribute(regclass, text) IS
    'gives a mesh one more attribute, the last one, which is NULL for all points; abacus_update gives it values';

CREATE FUNCTION abacus_drop_attribute(mesh regclass, attribute text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_drop_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_drop_attribute(regclass, text) IS
    'takes an attribute away from a mesh, unless its owner or the caller has published it; those after it move up';

CREATE FUNCTION abacus_rename_attribute(mesh regclass, attribute text, name text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_rename_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_rename_attribute(regclass, text, text) IS
    'gives an attribute of a mesh another name';

CREATE FUNCTION abacus_srid(mesh regclass)
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_srid'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_srid(regclass) IS
    'the spatial reference system of the coordinates of a mesh or an octree, as PostGIS numbers it; 0 if it has none';

CREATE FUNCTION abacus_set_srid(mesh regclass, srid integer)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_set_srid'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_set_srid(regclass, integer) IS
    'says in which spatial reference system the coordinates of a mesh or an octree are; they stay as they are';

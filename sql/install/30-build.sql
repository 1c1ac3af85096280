-- Making a mesh.

CREATE FUNCTION abacus_create(
    mesh text,
    dimension integer,
    attributes text[] DEFAULT '{}',
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_create'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_create(text, integer, text[], double precision[], double precision[]) IS
    'makes an empty mesh: the table of this name and <name>_vertices; without lower and upper the domain comes from the first points';

CREATE FUNCTION abacus_stage(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_stage'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_stage(regclass, text) IS
    'stages the points of a query (id, x, y[, z][, attribute...]) for triangulation; returns how many';

CREATE FUNCTION abacus_triangulate(mesh regclass)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(regclass) IS
    'inserts all staged points into the Delaunay triangulation; returns the number of simplices';

CREATE FUNCTION abacus_triangulate(
    mesh text,
    query text,
    attributes text[] DEFAULT NULL,
    dimension integer DEFAULT 2,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate_query'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(text, text, text[], integer, double precision[], double precision[]) IS
    'makes a mesh and triangulates the points of the query; attributes are named after the query''s columns unless given';

CREATE FUNCTION abacus_insert(mesh regclass, query text, on_duplicate text DEFAULT 'keep')
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_insert'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_insert(regclass, text, text) IS
    'inserts the points of a query (id, x, y[, z][, attribute...]) into the Delaunay triangulation, after those that wait; returns how many; on_duplicate: keep, replace or error, what becomes of one at the place of another';

CREATE FUNCTION abacus_delete(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_delete'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_delete(regclass, text) IS
    'takes points away from the Delaunay triangulation: for each row (id, x, y[, z][, attribute...]) one with these coordinates, of several the one with this id or else the first; returns how many there were';

CREATE FUNCTION abacus_insert_returning(
    mesh regclass,
    query text,
    on_duplicate text DEFAULT 'keep',
    OUT created boolean,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_insert_returning'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000;
COMMENT ON FUNCTION abacus_insert_returning(regclass, text, text) IS
    'abacus_insert, but returns the simplices that it has created and removed, with their corners, in order of their codes';

CREATE FUNCTION abacus_delete_returning(
    mesh regclass,
    query text,
    OUT created boolean,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_delete_returning'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000;
COMMENT ON FUNCTION abacus_delete_returning(regclass, text) IS
    'abacus_delete, but returns the simplices that it has created and removed, with their corners, in order of their codes';

CREATE FUNCTION abacus_update(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_update'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_update(regclass, text) IS
    'gives points other attributes: for each row (id, x, y[, z], columns named after attributes) the point with these coordinates, of several the one with this id or else the first; returns how many rows there were';

CREATE PROCEDURE abacus_build(mesh regclass, batch bigint DEFAULT 1000000)
AS 'MODULE_PATHNAME', 'abacus_sql_build'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_build(regclass, bigint) IS
    'inserts all staged points into the Delaunay triangulation and commits after each batch of that many; called again after a failure, it goes on from the last batch; then, if much of a table is empty, moves pages to its beginning, so that VACUUM can cut it';

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
    'makes an empty mesh: the table of this name and <name>_vertices. Without lower and upper the domain comes from the first points. Shapes: attributes has up to 1,000 names; lower and upper are {x, y}, in space {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 42P07 the name is taken, 42622 too long, 3F000 no schema, 42501 no privilege, 22023 dimension neither 2 nor 3 or a bad domain, 42701 an attribute named twice, 42602 a bad name, 54000 too many, 2202E arrays of another length';

CREATE FUNCTION abacus_stage(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_stage'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_stage(regclass, text) IS
    'stores the points of a query for a later triangulation. Returns how many. Shapes: the query returns id, x, y[, z] and the attributes, by position; a point of PostGIS may stand for the coordinates. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite, 42601 no query, 42809 not a mesh';

CREATE FUNCTION abacus_triangulate(mesh regclass)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(regclass) IS
    'inserts all staged points into a mesh. Returns the number of simplices. Errors: 42809 not a mesh, 42501 no privilege, 54000 a cache beyond what can be addressed, XX001 a damaged page';

CREATE FUNCTION abacus_triangulate(
    mesh text,
    query text,
    attributes text[] DEFAULT NULL,
    dimension integer DEFAULT 2,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    lines text DEFAULT NULL)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate_query'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(text, text, text[], integer, double precision[], double precision[], text) IS
    'makes a mesh and triangulates the points of a query. Attributes are named after the columns of the query unless names are given. lines is another query, of lines as abacus_constrain takes them, whose segments become fixed edges. Returns the number of simplices. Shapes: the query returns id, x, y[, z] and the attributes; lower and upper are {x, y}, in space {x, y, z}. Units: lower and upper in those of the coordinates. Errors: those of abacus_create, abacus_insert and abacus_constrain';

CREATE FUNCTION abacus_insert(mesh regclass, query text, on_duplicate text DEFAULT 'keep')
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_insert'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_insert(regclass, text, text) IS
    'inserts the points of a query into a mesh, after those that wait. on_duplicate says what becomes of a point at the place of another: keep, replace or error. Returns how many points the query gave. Shapes: the query returns id, x, y[, z] and the attributes, by position. Errors: those of abacus_stage and abacus_triangulate; 23505 a point at the place of another with on_duplicate error; 55000 the mesh follows a table or is not Delaunay';

CREATE FUNCTION abacus_delete(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_delete'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_delete(regclass, text) IS
    'deletes points from a mesh. Each row deletes one point with exactly its coordinates: of several the one with its id, or else the first. Returns how many points were deleted. Shapes: the query returns id, x, y[, z]. Errors: those of abacus_stage and abacus_triangulate; 55000 the mesh follows a table or is not Delaunay';

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
    'inserts points as abacus_insert does, and returns the simplices that this has created and removed. Rows come in the order of the codes. Shapes: the query as of abacus_insert; corners[i][axis] of corner i, from 1. Units: corners in those of the coordinates. Errors: those of abacus_insert';

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
    'deletes points as abacus_delete does, and returns the simplices that this has created and removed. Rows come in the order of the codes. Shapes: the query as of abacus_delete; corners[i][axis] of corner i, from 1. Units: corners in those of the coordinates. Errors: those of abacus_delete';

CREATE FUNCTION abacus_update(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_update'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_update(regclass, text) IS
    'gives points of a mesh other attributes. Each row is for the point with exactly its coordinates: of several the one with its id, or else the first. Returns how many rows there were. Shapes: the query returns id, x, y[, z] and columns named after attributes. Errors: those of abacus_delete; 22023 no point at the place of a row, 42703 no such attribute, 42701 a column twice, 42804 none';

CREATE PROCEDURE abacus_build(mesh regclass, batch bigint DEFAULT 1000000)
AS 'MODULE_PATHNAME', 'abacus_sql_build'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_build(regclass, bigint) IS
    'inserts all staged points in batches and commits after each batch. Called again after a failure, it goes on from the last batch. Then, if much of a table is empty, it moves pages to the beginning, so that VACUUM can shorten the file. Errors: those of abacus_triangulate; 2D000 where it cannot commit, 22023 a batch below 1';

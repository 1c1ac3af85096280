-- A mesh cut into parts, for the ranks of a parallel program.

CREATE FUNCTION abacus_partition(
    mesh regclass,
    parts integer,
    weight text DEFAULT NULL,
    OUT part integer,
    OUT vertices bigint,
    OUT simplices bigint,
    OUT cut_facets bigint,
    OUT halo bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_partition'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 10;
COMMENT ON FUNCTION abacus_partition(regclass, integer, text) IS
    'cuts a mesh into parts, stretches of the curve with equal numbers of simplices, and shows their sizes. Nothing is moved or stored. Shapes: parts from 0 to parts - 1; vertices and simplices of the part''s own, facets between its own simplices and those of others, others'' simplices that share a vertex with its own. Units: weight names an attribute, of which a simplex has the mean of its corners, or a label; parts then have equal sums, and NULL counts as 0. Errors: 22023 parts below 1, a negative weight, 42703 no such attribute or label, 42809 not a mesh, 53400 no room for temporary files, 54000 more parts than work_mem has room for';

CREATE FUNCTION abacus_share_vertices(
    mesh regclass,
    parts integer,
    part integer,
    halo integer DEFAULT 1,
    weight text DEFAULT NULL,
    OUT local bigint,
    OUT id bigint,
    OUT owner integer,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_share_vertices'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 10000;
COMMENT ON FUNCTION abacus_share_vertices(regclass, integer, integer, integer, text) IS
    'the vertices of one part of a mesh and of layers of simplices around it, in the order of their local numbers. Shapes: local from 0, the part''s own first, then by owner, along the curve; the owner of a vertex is the least part that has a simplex at it; attributes in the order of the mesh. Units: halo in layers, each of all simplices that share a vertex with what is there. Errors: 22023 parts, part or halo out of range, a negative weight, 42703 no such attribute or label, 42809 not a mesh, 53400 no room for temporary files, 54000 more parts than work_mem has room for';

CREATE FUNCTION abacus_share_simplices(
    mesh regclass,
    parts integer,
    part integer,
    halo integer DEFAULT 1,
    weight text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT owner integer,
    OUT labels double precision[],
    OUT markers double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_share_simplices'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 10000;
COMMENT ON FUNCTION abacus_share_simplices(regclass, integer, integer, integer, text) IS
    'the simplices of one part of a mesh and of layers around it, by the local numbers of abacus_share_vertices. Their orientation is positive. Shapes: owner is the part of the simplex; labels in the order of abacus_labels, NULL in a mesh without any; markers of the facet opposite each corner, NULL in a mesh without any. Units: halo in layers. Errors: as for abacus_share_vertices';

CREATE TYPE abacus_step_values AS (step bigint, part integer, id bigint, "values" double precision[]);
COMMENT ON TYPE abacus_step_values IS 'row of the table of steps of a mesh: the values of a vertex';
COMMENT ON COLUMN abacus_step_values.step IS 'number of the step; each has a partition';
COMMENT ON COLUMN abacus_step_values.part IS 'part that has stored the row';
COMMENT ON COLUMN abacus_step_values.id IS 'id of the vertex; NULL in one row of each part, which says that the part is there';
COMMENT ON COLUMN abacus_step_values."values" IS 'values in the order of the columns of the query; in the row without id the number of parts, that of the part''s vertices, and the state of the mesh';

CREATE FUNCTION abacus_store(
    mesh regclass,
    step bigint,
    parts integer,
    part integer,
    query text,
    weight text DEFAULT NULL)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_store'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_store(regclass, bigint, integer, integer, text, text) IS
    'stores the values of one part''s vertices at one step, in place of those that it has stored before. They go into the table <mesh>_steps, which the first step makes. Returns the number of vertices. Shapes: the query returns id and numbers, a row for each vertex whose owner is the part. Errors: 22004 a NULL argument or id, 22023 parts or part out of range, an id that is not the part''s or is missing, 23505 an id twice, 42804 other columns, 55006 a statement that changes the mesh, 42501 the first step by another than the owner, 42809 not a mesh';

CREATE FUNCTION abacus_steps(
    mesh regclass,
    OUT step bigint,
    OUT parts integer,
    OUT stored integer,
    OUT vertices bigint,
    OUT whole boolean)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_steps'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 100;
COMMENT ON FUNCTION abacus_steps(regclass) IS
    'the steps of a solution that are stored, and which are whole: all parts are there, cut in the same way from the same state of the mesh. Shapes: parts of the step, how many of them are stored, and their vertices. Errors: 42809 not a mesh, 42501 no privilege on the table of steps';

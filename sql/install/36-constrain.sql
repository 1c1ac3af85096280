-- Lines, whose edges are fixed.

CREATE TYPE abacus_line_point AS (
    line bigint, position bigint, point bigint, x double precision, y double precision, kind text,
    part bigint, made boolean);
COMMENT ON TYPE abacus_line_point IS 'row of the table of lines of a mesh: a point of a line';
COMMENT ON COLUMN abacus_line_point.line IS 'id of the line';
COMMENT ON COLUMN abacus_line_point.position IS 'place in the order of the line''s points';
COMMENT ON COLUMN abacus_line_point.point IS 'id of the point, as it was given or chosen';
COMMENT ON COLUMN abacus_line_point.x IS 'where the point is; what counts for the mesh';
COMMENT ON COLUMN abacus_line_point.y IS 'the same';
COMMENT ON COLUMN abacus_line_point.kind IS 'hard or soft, the same for all points of a line';
COMMENT ON COLUMN abacus_line_point.part IS 'part of the line: neighbours are joined if theirs is the same; NULL in a line of one part';
COMMENT ON COLUMN abacus_line_point.made IS 'true if a line of a table that the mesh follows has made the vertex, which goes with the last line that names it';

CREATE FUNCTION abacus_constrain(
    mesh regclass,
    query text,
    kind text DEFAULT 'hard',
    existing text DEFAULT 'error',
    z text DEFAULT NULL)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_constrain'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_constrain(regclass, text, text, text, text) IS
    'adds lines to a mesh in the plane, whose segments become fixed edges. Points that the mesh lacks are inserted. kind is hard or soft; existing says what happens to lines that are there: error or replace. While points wait, the lines wait too. Returns the number of lines. Shapes: the query returns line, position, point id[, x, y[, attributes by name]][, part], in any order, or line and a geometry of PostGIS, whose Z becomes the attribute z; a ring repeats its first point. Units: x and y in those of the coordinates. Errors: those of abacus_insert; 42804 other columns, 22004 a NULL line, position or coordinate, 23505 a position twice or a line that is there, 22023 an unknown point, a point at two places, a segment of length zero or a line of one point, a geometry of another kind or SRID, 42703 no such attribute, 55000 a mesh in space or that cannot be changed, 42501 the first lines given by another than the owner';

CREATE FUNCTION abacus_unconstrain(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_unconstrain'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_unconstrain(regclass, text) IS
    'removes lines from a mesh and frees their edges. Points stay. Ids without a line are counted in a NOTICE. Returns how many lines were removed. Shapes: the query returns ids of lines. Errors: 42804 other columns, 22004 a NULL id, 55000 a mesh in space or that cannot be changed';

CREATE FUNCTION abacus_lines(
    mesh regclass,
    OUT line bigint,
    OUT "position" bigint,
    OUT point bigint,
    OUT x double precision,
    OUT y double precision,
    OUT kind text,
    OUT part bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_lines'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1000;
COMMENT ON FUNCTION abacus_lines(regclass) IS
    'the lines of a mesh as they were given, in the order of line and position. Neighbouring points are joined if their part is the same. A mesh that never had lines has none. Units: x and y in those of the coordinates. Errors: 42809 not a mesh, 42501 no privilege on the table of lines';

CREATE FUNCTION _abacus_fixed_edges(
    mesh regclass,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT lines bigint[],
    OUT kind text,
    OUT path double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_fixed_edges'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000;
COMMENT ON FUNCTION _abacus_fixed_edges(regclass) IS
    'inside abacus_publish: fixed edges with the places of their ends';

-- Where lines cross.

CREATE FUNCTION abacus_crossings(
    mesh regclass,
    query text,
    OUT line_a bigint,
    OUT position_a bigint,
    OUT line_b bigint,
    OUT position_b bigint,
    OUT x double precision,
    OUT y double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_crossings'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 1000;
COMMENT ON FUNCTION abacus_crossings(regclass, text) IS
    'where segments of lines cross: two segments have one point in common, which is neither a vertex of the mesh nor a corner of a line. The lines are those of the query and those of the mesh; if both have a line with one id, that of the query counts. A segment is named by its line and the position where it begins. Shapes: the query returns line, position, x, y, or line, position, point id, or line, position, point id, x, y, in any order. Units: x and y in those of the coordinates. Errors: 42804 other columns, 22004 a NULL, 22023 a position twice in a line, coordinates that are not finite, an unknown point, or a mesh in space, 42501 no privilege on the table of lines, 53400 no room for temporary files';

-- Where lines cross: elsewhere than in a vertex of the mesh, and in the interior of both segments.
SELECT abacus_triangulate('land', $$ SELECT n, n % 11, n / 11 FROM generate_series(0, 120) n $$);
-- Lines that cross, through a vertex of the mesh or elsewhere, and one that crosses itself.
CREATE TABLE line (line int, position int, point bigint, x numeric, y float8);
INSERT INTO line VALUES
    (1, 1, NULL, 0, 0.5), (1, 2, NULL, 9, 0.5),
    (2, 10, NULL, 0.25, 0), (2, 20, NULL, 0.25, 3), (2, 30, NULL, 3.25, 3),
    (3, 1, NULL, 4, 1), (3, 2, NULL, 6, 3), (4, 1, NULL, 6, 1), (4, 2, NULL, 4, 3),
    (5, -7, NULL, 0, 5), (5, 0, NULL, 2, 7), (5, 1, NULL, 2, 5), (5, 4, NULL, 0, 6),
    (6, 1, NULL, 3.25, 3), (6, 2, NULL, 3.25, 9),      -- touches
    (7, 1, NULL, 0.25, 2), (7, 2, NULL, 0.25, 8),      -- overlaps
    (8, 1, NULL, 1, 0.5), (8, 2, NULL, 1, 2);          -- ends on another
SELECT * FROM abacus_crossings('land', 'SELECT line, position, point, x, y FROM line');
SELECT * FROM abacus_crossings('land', 'SELECT line::bigint, position::smallint, x, y::real FROM line ORDER BY y, x');
-- (5, 2) is a vertex of that mesh, but not of this one.
SELECT abacus_triangulate('small', $$ VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1) $$);
SELECT line_a, line_b, x, y FROM abacus_crossings('small', 'SELECT line, position, x, y FROM line');
-- ... and no crossing where a third line has a corner.
SELECT line_a, line_b, x, y FROM abacus_crossings('small', 'SELECT line, position, x, y FROM line UNION ALL VALUES (9, 1, 5, 2), (9, 2, 5, 9)');
-- An inexact place is never a vertex.
SELECT * FROM abacus_crossings('small', $$ VALUES (1, 1, 0, 0), (1, 2, 1, 1.1), (2, 1, 0, 0.1), (2, 2, 1, 0.3) $$);
-- The memory does not change what is found, nor does the order.
CREATE TABLE roads AS
SELECT l AS line, p AS position, l * 7919 % 1009 / 10.0 + p * (l % 7 - 3) / 2.0 AS x, l * 104729 % 997 / 10.0 + p * (l % 5 - 2) / 3.0 AS y
FROM generate_series(1, 2000) l, generate_series(1, 20) p;
CREATE TABLE found AS SELECT row_number() OVER () AS n, c.* FROM abacus_crossings('land', 'SELECT line, position, x, y FROM roads ORDER BY line, position') c;
SELECT count(*) > 10000 AS many, bool_and(n = r) AS in_order
FROM (SELECT n, row_number() OVER (ORDER BY line_a, position_a, line_b, position_b) AS r FROM found) f;
SET work_mem = '64kB';
SELECT count(*) AS differences
FROM found f FULL JOIN (SELECT row_number() OVER () AS n, c.* FROM abacus_crossings('land', 'SELECT line, position, x, y FROM roads ORDER BY x, y, line DESC') c) g USING (n)
WHERE ROW(f.line_a, f.position_a, f.line_b, f.position_b, f.x, f.y) IS DISTINCT FROM ROW(g.line_a, g.position_a, g.line_b, g.position_b, g.x, g.y);
RESET work_mem;
-- None.
SELECT * FROM abacus_crossings('land', 'SELECT 1, 1, 0, 0 WHERE false');
SELECT * FROM abacus_crossings('land', 'VALUES (1, 1, 0, 0)');
SELECT * FROM abacus_crossings(NULL, 'VALUES (1, 1, 0, 0)');
-- Rows of point ids; lines of the mesh, unless the query has one with the same id.
SELECT * FROM abacus_crossings('land', 'VALUES (1, 1, 0), (1, 2, 23), (2, 1, 2), (2, 2, 11), (3, 1, 22), (3, 2, 2)');
SELECT abacus_constrain('land', 'VALUES (1, 1, 0), (1, 2, 23), (5, 1, 22), (5, 2, 24)');
SELECT * FROM abacus_crossings('land', 'VALUES (2, 1, 2), (2, 2, 11)');
SELECT * FROM abacus_crossings('land', 'VALUES (2, 1, 2, 0), (2, 2, 0, 1), (5, 1, 9, 9), (5, 2, 9, 10)');
SELECT * FROM abacus_crossings('land', 'VALUES (2, 1, 2), (2, 2, 11), (1, 1, 0), (1, 2, 12)');
SELECT * FROM abacus_crossings('land', 'SELECT 1, 1, 1 WHERE false');
SELECT * FROM abacus_crossings('land', 'VALUES (2, 1, 2), (2, 2, 1000)');
SELECT * FROM abacus_crossings('land', 'VALUES (2, 1, 2), (2, 2, NULL)');
-- Errors.
SELECT * FROM abacus_crossings('land', 'VALUES (1, 1)');
SELECT * FROM abacus_crossings('land', $$ VALUES ('a', 1, 0, 0) $$);
SELECT * FROM abacus_crossings('land', $$ VALUES (1, 1.5, 0, 0) $$);
SELECT * FROM abacus_crossings('land', $$ VALUES (1, 1, 0, 'b') $$);
SELECT * FROM abacus_crossings('land', 'VALUES (1, 1, 0, 0), (1, NULL, 0, 0)');
SELECT * FROM abacus_crossings('land', 'VALUES (1, 1, 0, 0), (1, 2, NULL, 0)');
SELECT * FROM abacus_crossings('land', $$ VALUES (1, 1, 0, 0::float8), (1, 2, 0, 'NaN') $$);
SELECT * FROM abacus_crossings('land', 'VALUES (4, 1, 0, 0), (4, 2, 2, 3), (4, 1, 1, 1)');
SELECT * FROM abacus_crossings('land', 'DELETE FROM line');
SELECT abacus_triangulate('solid', $$ VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 0, 0, 1) $$, dimension => 3);
SELECT * FROM abacus_crossings('solid', 'VALUES (1, 1, 0, 0)');
SELECT * FROM abacus_crossings('line', 'VALUES (1, 1, 0, 0)');
DROP TABLE land, land_vertices, small, small_vertices, solid, solid_vertices, line, roads, found;

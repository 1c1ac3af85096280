-- Lines of a mesh in the plane, and the edges on them, which are fixed.
CREATE SCHEMA regress_constrain;
SET search_path = regress_constrain, public;

-- Ids say where a point is: 10 * x + y.
CREATE TABLE point AS SELECT 10 * x + y AS id, x, y, x * 0.5 AS height FROM generate_series(0, 3) AS x, generate_series(0, 2) AS y
    WHERE NOT (x = 1 AND y = 1);
SELECT abacus_triangulate('field', 'TABLE point');

-- Before there are lines.
SELECT * FROM abacus_lines('field');
SELECT * FROM abacus_edges('field', fixed => true);
SELECT abacus_constrain('field', 'SELECT 1, 1, id FROM point WHERE false');
SELECT to_regclass('field_lines') IS NULL AS no_table;
SELECT abacus_unconstrain('field', 'VALUES (1)');

-- Points of the mesh, in any order, of any integer type.
SELECT abacus_constrain('field', 'VALUES (7, 30::bigint, 30), (7, -5, 0), (7, 10, 21)');
SELECT * FROM abacus_lines('field');
SELECT v0, v1, round(length::numeric, 3) AS length, lines, kind FROM abacus_edges('field', fixed => true);
SELECT count(*) AS edges, count(lines) AS with_lines FROM abacus_edges('field');
SELECT * FROM abacus_check('field');
\d field_lines

-- A soft line on a part of it; hard beats soft. A ring repeats its first point.
SELECT abacus_constrain('field', 'VALUES (8, 1, 0), (8, 2, 21), (8, 3, 2), (8, 4, 0)', kind => 'soft');
SELECT v0, v1, lines, kind FROM abacus_edges('field', fixed => true);
SELECT v0, v1, lines, kind FROM abacus_edges('field', '{2.5,0}', '{3,1}', fixed => true);
SELECT v0, v1, lines, kind FROM abacus_edges('field', '{0,2}', 0.5, fixed => true);
SELECT v0, v1, lines, kind FROM abacus_edges('field', max_edge => 2, fixed => true);
SELECT count(*) FROM abacus_edges('field', fixed => NULL);

-- Places: points that are there, new ones with an id and without, and attributes by name.
SELECT abacus_constrain('field', $$
    VALUES (20, 1, NULL, 4.0, 2::float8), (20, 2, 52, 5, 2), (20, 3, NULL, 5, 0), (20, 4, NULL, 3, 0), (20, 5, NULL, 4, 2),
           (9, 1, 31, 3, 1), (9, 2, NULL, 3, 4) $$);
SELECT * FROM abacus_lines('field') WHERE line IN (9, 20);
SELECT abacus_constrain('field', 'SELECT 30, i, NULL, i, 5, i * 2 AS height FROM generate_series(0, 2) AS i');
SELECT id, x, y, attributes[1] AS height FROM abacus_vertices('field') WHERE id > 32 ORDER BY id;
SELECT * FROM abacus_check('field');

-- Lines that are there.
SELECT abacus_constrain('field', 'VALUES (30, 1, 0), (30, 2, 20)');
SELECT abacus_constrain('field', 'VALUES (30, 1, 0), (30, 2, 20), (31, 1, 0), (31, 2, 20)', existing => 'replace', kind => 'soft');
SELECT * FROM abacus_lines('field') WHERE line >= 30;

-- Lines do not cross; what is in the way is shown, and nothing has changed.
SELECT abacus_constrain('field', 'VALUES (40, 1, 0), (40, 2, 22), (41, 1, 2), (41, 2, 21)');
SELECT count(*) FROM abacus_lines('field') WHERE line >= 40;
-- A point on an edge splits it, and both halves are fixed; without the point they are one again.
SELECT abacus_insert('field', 'VALUES (1000, 1, 0.5, 1)');
SELECT v0, v1, lines, kind FROM abacus_edges('field', fixed => true) WHERE lines = '{7,8}';
SELECT abacus_delete('field', 'VALUES (1000, 1, 0.5)');
SELECT v0, v1, lines, kind FROM abacus_edges('field', fixed => true) WHERE lines = '{7,8}';
-- A vertex that a line names stays.
SELECT abacus_delete('field', 'VALUES (30, 3, 0)');
SELECT * FROM abacus_check('field');

-- Lines go, points stay.
SELECT abacus_unconstrain('field', 'VALUES (20), (9), (9), (100), (101)');
SELECT count(*) FROM abacus_vertices('field');
SELECT line, count(*) FROM abacus_lines('field') GROUP BY line ORDER BY line;
SELECT abacus_unconstrain('field', 'SELECT DISTINCT line FROM abacus_lines(''field'')');
SELECT * FROM abacus_lines('field');
SELECT count(*) FROM abacus_edges('field', fixed => true);
SELECT * FROM abacus_check('field');
-- the mesh is that of its points alone
SELECT abacus_triangulate('anew', 'SELECT id, x, y, attributes[1] AS height FROM abacus_vertices(''field'')') > 0 AS made;
(SELECT v0, v1 FROM abacus_edges('field') EXCEPT SELECT v0, v1 FROM abacus_edges('anew'))
    UNION ALL (SELECT v0, v1 FROM abacus_edges('anew') EXCEPT SELECT v0, v1 FROM abacus_edges('field'));
DROP TABLE anew;

-- Lines wait for points.
SELECT abacus_create('later', 2);
SELECT abacus_constrain('later', 'VALUES (1, 1, NULL, 0, 0), (1, 2, NULL, 1, 0)');
SELECT * FROM abacus_edges('later', fixed => true);
SELECT abacus_insert('later', 'VALUES (10, 0, 1)');
SELECT v0, v1, lines FROM abacus_edges('later', fixed => true);
SELECT abacus_stage('later', 'VALUES (11, 1, 1), (20, 5, 5)');
SELECT abacus_constrain('later', 'VALUES (2, 1, 11), (2, 2, 10)');
SELECT abacus_constrain('later', 'VALUES (3, 1, 20, 5, 5), (3, 2, NULL, 6, 5)');
SELECT v0, v1, lines FROM abacus_edges('later', fixed => true);
CALL abacus_build('later');
SELECT id, x, y, vertex FROM abacus_vertices('later') ORDER BY id;
SELECT v0, v1, lines FROM abacus_edges('later', fixed => true);
SELECT abacus_stage('later', 'VALUES (30, 7, 7)');
SELECT abacus_constrain('later', 'VALUES (4, 1, 30), (4, 2, 20)');
SELECT abacus_unconstrain('later', 'VALUES (3)');
SELECT v0, v1, lines FROM abacus_edges('later', fixed => true);
SELECT * FROM abacus_check('later');

-- A mesh that loses its triangles keeps its lines.
SELECT abacus_triangulate('small', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT abacus_constrain('small', 'VALUES (1, 1, 1), (1, 2, 2)');
SELECT abacus_delete('small', 'VALUES (3, 0, 1), (1, 0, 0)');
SELECT abacus_delete('small', 'VALUES (3, 0, 1)');
SELECT abacus_delete('small', 'VALUES (1, 0, 0)');
SELECT id, vertex FROM abacus_vertices('small');
SELECT abacus_insert('small', 'VALUES (3, 0, 1)');
SELECT v0, v1, lines FROM abacus_edges('small', fixed => true);
SELECT abacus_insert('small', 'VALUES (9, 0, 0)', on_duplicate => 'replace');
SELECT v0, v1, lines FROM abacus_edges('small', fixed => true);
SELECT point, x, y FROM abacus_lines('small');
SELECT * FROM abacus_check('small');

-- A mesh that follows a table gets lines between its points, and only these.
CREATE TABLE tracked (id int, x float8, y float8);
INSERT INTO tracked SELECT id, x, y FROM point;
SELECT abacus_create('follows', 2);
SELECT abacus_track('follows', 'tracked');
SELECT abacus_constrain('follows', 'VALUES (1, 1, 0), (1, 2, 21)');
SELECT abacus_constrain('follows', 'VALUES (2, 1, 0, 0, 0), (2, 2, NULL, 9, 9)');
TRUNCATE tracked;
INSERT INTO tracked VALUES (11, 1, 1.25);
SELECT abacus_unconstrain('follows', 'VALUES (1)');
TRUNCATE tracked;

-- The table of lines goes with the mesh, whatever its name is.
ALTER TABLE field_lines RENAME TO any_name;
SELECT abacus_constrain('field', 'VALUES (1, 1, 0), (1, 2, 20)');
SELECT line, point FROM any_name ORDER BY position;
DROP TABLE field;
SELECT to_regclass('any_name') IS NULL AS gone;

SET client_min_messages = warning;
DROP SCHEMA regress_constrain CASCADE;

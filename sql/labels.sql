-- Labels of simplices, markers of facets: given with a load or later, returned, kept as long as the simplex is there.
CREATE SCHEMA regress_labels;
SET search_path = regress_labels, public;

-- A load takes them behind the vertices; the mesh is not convex.
CREATE TABLE corner (id int, x float8, y float8);
INSERT INTO corner VALUES (1, 0, 0), (2, 2, 0), (3, 2, 1), (4, 1, 1), (5, 1, 2), (6, 0, 2);
CREATE TABLE part (v0 int, v1 int, v2 int, soil int, depth numeric);
INSERT INTO part VALUES (1, 2, 3, 7, 1.5), (1, 3, 4, NULL, NULL), (1, 4, 6, 8, NULL), (4, 5, 6, 8, -2);
SELECT abacus_load('notch', 'TABLE corner', 'TABLE part', labels => '{soil,depth}');
SELECT abacus_labels('notch');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
SELECT v0, v1, v2, labels FROM abacus_cells('notch', ARRAY[1.5, 0], 0.1);
SELECT id, v0, v1, v2, labels FROM abacus_locate('notch', 'VALUES (1, 1.5, 0.25), (2, 0.5, 1.75), (3, 1.75, 1.75), (4, 1, 0.75)') ORDER BY id;
SELECT * FROM abacus_check('notch');
SELECT abacus_labels('notch', abacus_locate('notch', 0.5, 1.75)), abacus_labels('notch', abacus_locate('notch', 1.75, 1.75)) IS NULL AS outside;
-- it cannot be changed, but it can be labelled
SELECT abacus_label('notch', 'SELECT code, v0, v1, v2, NULL AS depth, v0 + v1 AS "a sum" FROM abacus_simplices(''notch'') WHERE v0 = 1');
SELECT abacus_labels('notch');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
SELECT * FROM abacus_check('notch');

-- In a mesh that changes they stay with their simplices.
CREATE TABLE points AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y FROM generate_series(1, 4000) i;
SELECT abacus_triangulate('field', 'TABLE points');
SELECT count(*), count(labels[1]) FROM abacus_cells('field');
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, v0 * 1000003 + v1 * 1009 + v2 AS n, code % 5 AS fifth FROM abacus_simplices(''field'')')
    = (SELECT count(*) FROM abacus_simplices('field')) AS all_of_them;
CREATE VIEW wrong AS SELECT v0, v1, v2, labels FROM abacus_cells('field')
    WHERE labels <> ARRAY[v0 * 1000003 + v1 * 1009 + v2, code % 5]::float8[];
CREATE TABLE before AS SELECT v0, v1, v2 FROM abacus_cells('field');
CREATE VIEW lost AS SELECT v0, v1, v2 FROM abacus_cells('field') JOIN before USING (v0, v1, v2) WHERE labels[1] IS NULL;
CREATE VIEW found AS SELECT v0, v1, v2 FROM abacus_cells('field') LEFT JOIN before b USING (v0, v1, v2) WHERE b IS NULL AND labels <> '{NULL,NULL}';
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT abacus_insert('field', 'SELECT 10000 + id, x + 0.5, y + 0.25 FROM points WHERE id % 40 = 0');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT count(labels[1]) BETWEEN 6000 AND 7800 AS some_are_left FROM abacus_cells('field');
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 50 = 1');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT * FROM abacus_check('field');
SELECT count(*) FROM abacus_cells('field') WHERE labels IS DISTINCT FROM abacus_labels('field', (code, v0, v1, v2, v3));
-- another domain
SELECT abacus_insert('field', 'SELECT 20000 + id, x * 50 + 3000, y * 70 + 3000 FROM points');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT count(labels[1]) > 5000 AS many_are_left FROM abacus_cells('field');
SELECT * FROM abacus_check('field');
-- rolled back
BEGIN;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points');
SELECT count(labels[1]) FROM abacus_cells('field');
ROLLBACK;
SELECT count(labels[1]) > 5000 AS there_again FROM abacus_cells('field');

-- In space, with attributes, of which there are many.
CREATE TABLE solid AS SELECT i AS id, (i * 7919) % 109 AS x, (i * 104729) % 97 AS y, (i * 31337) % 101 AS z, i AS a, i AS b, i AS c FROM generate_series(1, 600) i;
SELECT abacus_triangulate('solid_mesh', 'TABLE solid', dimension => 3);
SELECT abacus_label('solid_mesh', 'SELECT code, v0, v1, v2, v3, v0 - v3 AS material FROM abacus_simplices(''solid_mesh'') WHERE v0 % 2 = 0') > 0 AS some;
SELECT count(*) FROM abacus_cells('solid_mesh') WHERE labels[1] IS DISTINCT FROM CASE v0 % 2 WHEN 0 THEN v0 - v3 END;
SELECT * FROM abacus_check('solid_mesh');

-- Markers of facets: the boundary of a mesh, then all edges of some triangles.
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, f, 7 FROM abacus_simplices(''notch'') s, generate_series(0, 2) f WHERE abacus_walk(''notch'', s, f) IS NULL');
SELECT marker, v0, v1, v2, corners FROM abacus_facets('notch') ORDER BY v0, v1;
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, f, CASE v2 WHEN 4 THEN -3 END FROM abacus_simplices(''notch'') s, generate_series(0, 2) f WHERE (v0, v1) IN ((1, 3), (4, 5))');
SELECT marker, v0, v1 FROM abacus_facets('notch') ORDER BY marker, v0, v1;
SELECT count(*) FROM abacus_facets('notch', -3);
SELECT * FROM abacus_check('notch');
CREATE VIEW edges AS SELECT least(a, b) AS a, greatest(a, b) AS b FROM abacus_simplices('field'), LATERAL (VALUES (v0, v1), (v1, v2), (v2, v0)) e (a, b) GROUP BY 1, 2;
SELECT abacus_mark('field', 'SELECT code, v0, v1, v2, 2, (v0 + v1) % 1000 FROM abacus_simplices(''field'') WHERE v2 % 3 = 0') > 1000 AS many;
CREATE TABLE marked AS SELECT marker, least(v0, v1) AS a, greatest(v0, v1) AS b FROM abacus_facets('field');
SELECT count(*) - count(DISTINCT (a, b)) AS twice, count(*) FILTER (WHERE marker <> (a + b) % 1000) AS wrong FROM marked;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 50 = 2');
SELECT abacus_insert('field', 'SELECT 40000 + id, x + 0.25, y + 0.5 FROM points WHERE id % 40 = 3');
CREATE VIEW kept AS SELECT marker, least(v0, v1) AS a, greatest(v0, v1) AS b FROM abacus_facets('field');
(SELECT * FROM marked WHERE (a, b) IN (TABLE edges) EXCEPT TABLE kept) UNION ALL (TABLE kept EXCEPT SELECT * FROM marked WHERE (a, b) IN (TABLE edges));
SELECT (SELECT count(*) FROM kept) < (SELECT count(*) FROM marked) AS some_have_gone;
SELECT * FROM abacus_check('field');
SELECT abacus_mark('notch', 'SELECT 1, 2, 3, 4, 0, 1');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 3, 1 FROM abacus_simplices(''notch'')');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 0, 1.5 FROM abacus_simplices(''notch'')');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 0 FROM abacus_simplices(''notch'')');

-- Markers given with a load.
SELECT abacus_load('marked_notch', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1, 5), (3, 1, 6), (1, 3, 6), (5, 6, NULL)');
SELECT marker, v0, v1 FROM abacus_facets('marked_notch');
SELECT * FROM abacus_check('marked_notch');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1, 5), (3, 6, 6), (1, 3, 6), (3, 1, 7)');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 2, 5), (1, 2, 2.5)');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1)');

-- Errors change nothing.
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4');
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4, 5 AS soil, 6 AS soil');
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4, 5 AS soil');
SELECT abacus_label('notch', 'SELECT code, v0, v1, v2, ''clay'' AS soil FROM abacus_simplices(''notch'')');
SELECT abacus_label('notch', 'SELECT code, v0, v1, NULL::int, 1 AS soil FROM abacus_simplices(''notch'')');
SELECT abacus_label('solid_mesh', 'SELECT code, v0, v1, v2, v3, 1 AS b FROM abacus_simplices(''solid_mesh'')');
SELECT abacus_labels('notch', (1, 2, 3, 4, NULL)::abacus_simplex);
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil}');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil,soil}');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil,NULL}');
SELECT abacus_load('bad', 'SELECT *, 1 AS soil FROM corner', 'TABLE part', labels => '{soil,depth}');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
-- a mesh triangulated anew has other simplices
SELECT abacus_load('anew', 'TABLE corner', 'TABLE part', labels => '{soil,depth}', retriangulate => true);
SELECT count(*), count(labels[1]), count(labels[2]) FROM abacus_cells('anew');
SELECT * FROM abacus_check('anew');

SET client_min_messages = warning;
DROP SCHEMA regress_labels CASCADE;

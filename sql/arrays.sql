-- A mesh as two arrays: vertices numbered from 0, simplices by the numbers of their corners.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10, 1), (2, 4, 0, 20, 2), (3, 4, 4, 30, 3), (4, 0, 4, NULL, 4), (5, 2, 1, 50, 5)', '{height,depth}');
SELECT * FROM abacus_numbered_vertices('field');
SELECT n0, n1, n2, n3 FROM abacus_numbered_simplices('field') ORDER BY 1, 2;
-- points equal to a vertex, and those that wait, have no number
SELECT abacus_insert('field', 'VALUES (6, 2, 1, 60, 6)'), abacus_stage('field', 'VALUES (7, 2, 0.5, 70, 7)');
SELECT count(*), max(number) FROM abacus_numbered_vertices('field');
-- the same simplices as by ids, in the same order and orientation; with little memory too
CREATE TABLE points AS SELECT i AS id, i * 0.7548776662466927 % 1 AS x, i * 0.5698402909980532 % 1 AS y, i * 0.4301597090019468 % 1 AS z FROM generate_series(1, 20000) AS i;
SELECT abacus_triangulate('plane', 'SELECT id, x, y, z FROM points', '{z}'), abacus_triangulate('space', 'SELECT id, x, y, z FROM points', dimension => 3);
CREATE FUNCTION differ(mesh regclass, OUT vertices bigint, OUT simplices bigint, OUT most bigint) LANGUAGE sql AS $$
	WITH v AS MATERIALIZED (SELECT * FROM abacus_numbered_vertices(mesh)), s AS (SELECT * FROM abacus_numbered_simplices(mesh))
	SELECT (SELECT count(*) FROM v FULL JOIN abacus_vertices(mesh) AS w USING (id) WHERE (v.x, v.y, v.z, v.attributes) IS DISTINCT FROM (w.x, w.y, w.z, w.attributes)),
		(SELECT count(*) FROM ((SELECT code, a.id, b.id, c.id, d.id FROM s JOIN v AS a ON a.number = n0 JOIN v AS b ON b.number = n1 JOIN v AS c ON c.number = n2 LEFT JOIN v AS d ON d.number = n3)
			EXCEPT ALL SELECT * FROM abacus_simplices(mesh)) AS other),
		(SELECT max(number) FROM v) $$;
SELECT * FROM differ('plane');
SELECT * FROM differ('space');
CREATE TABLE here AS SELECT * FROM abacus_numbered_simplices('space');
SET work_mem = '64kB';
SELECT * FROM differ('plane');
SELECT * FROM differ('space');
SELECT count(*) FROM (SELECT * FROM here EXCEPT ALL SELECT * FROM abacus_numbered_simplices('space')) AS other;
RESET work_mem;
-- the same of a mesh that came about in steps
SELECT abacus_create('steps', 3);
SELECT abacus_insert('steps', 'SELECT * FROM points WHERE id % 2 = 0'), abacus_insert('steps', 'SELECT * FROM points WHERE id % 2 = 1');
SELECT count(*) FROM (SELECT id, x, y, z FROM abacus_numbered_vertices('space') EXCEPT ALL SELECT id, x, y, z FROM abacus_numbered_vertices('steps')) AS other;
-- labels of simplices, in the order of abacus_labels; NULL where a simplex has none
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, v0 AS soil, CASE WHEN v0 = 1 THEN 0.5 END AS wet FROM abacus_simplices(''field'') WHERE v1 <> 3');
SELECT count(*) AS labelled FROM abacus_numbered_simplices('field') WHERE labels[1] IS NOT NULL;
SELECT count(*) FROM (SELECT s.code, a.id, b.id, c.id, s.labels FROM abacus_numbered_simplices('field') AS s JOIN abacus_numbered_vertices('field') AS a ON a.number = n0
	JOIN abacus_numbered_vertices('field') AS b ON b.number = n1 JOIN abacus_numbered_vertices('field') AS c ON c.number = n2
	EXCEPT ALL SELECT code, v0, v1, v2, labels FROM abacus_cells('field')) AS other;
-- nothing of an empty mesh, nor of none
SELECT abacus_create('empty', 2);
SELECT count(*) FROM abacus_numbered_vertices('empty');
SELECT count(*) FROM abacus_numbered_simplices('empty');
SELECT count(*) FROM abacus_numbered_simplices(NULL);
SELECT * FROM abacus_numbered_vertices('points');
DROP TABLE field, plane, space, steps, empty, points, here CASCADE;
DROP FUNCTION differ;

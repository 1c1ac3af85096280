-- Points come and go: abacus_insert and abacus_delete.
CREATE TABLE points (id bigint, x float8, y float8, z float8, height float8);
-- the triangles as sets of ids
CREATE FUNCTION triangles(mesh regclass) RETURNS TABLE (corners bigint[]) LANGUAGE sql AS
    $$ SELECT (SELECT array_agg(v ORDER BY v) FROM unnest(ARRAY[v0, v1, v2, v3]) v) FROM abacus_simplices(mesh) $$;
CREATE FUNCTION counts(mesh regclass) RETURNS text LANGUAGE sql AS
    $$ SELECT string_agg(name || ' ' || value, ', ' ORDER BY name) FROM abacus_stats(mesh)
       WHERE name IN ('waiting', 'vertices', 'duplicates', 'simplices', 'hull_facets') $$;
-- whether the mesh is that of the points, ids included, in either dimension, and sound
CREATE FUNCTION is_mesh_of_points(mesh regclass, dimension int) RETURNS boolean LANGUAGE plpgsql AS $$
DECLARE same boolean;
BEGIN
    PERFORM abacus_triangulate('fresh', CASE dimension WHEN 2 THEN 'SELECT id, x, y, height FROM points ORDER BY id' ELSE 'SELECT id, x, y, z, height FROM points ORDER BY id' END, dimension => dimension);
    SELECT NOT EXISTS (SELECT FROM triangles(mesh) EXCEPT SELECT FROM triangles('fresh')) AND
           NOT EXISTS ((SELECT corners FROM triangles(mesh) EXCEPT SELECT corners FROM triangles('fresh')) UNION ALL
                       (SELECT corners FROM triangles('fresh') EXCEPT SELECT corners FROM triangles(mesh))) AND
           NOT EXISTS (SELECT id, x, y, z, attributes, vertex FROM abacus_vertices(mesh) EXCEPT ALL SELECT id, x, y, z, attributes, vertex FROM abacus_vertices('fresh')) AND
           NOT EXISTS (SELECT FROM abacus_check(mesh)) INTO same;
    DROP TABLE fresh;
    RETURN same;
END $$;

SELECT setseed(0.5);
INSERT INTO points SELECT i, random(), random(), random(), i FROM generate_series(1, 2000) i;
SELECT abacus_create('m', 2, '{height}'), abacus_create('s', 3, '{height}');
SELECT abacus_insert('m', 'SELECT id, x, y, height FROM points'), abacus_insert('s', 'SELECT id, x, y, z, height FROM points');
SELECT is_mesh_of_points('m', 2), is_mesh_of_points('s', 3);
SELECT count(*) FROM m_vertices;

-- with attributes and without; points that are not there do not count
SELECT abacus_delete('m', 'SELECT id, x, y FROM points WHERE id % 2 = 0 UNION ALL VALUES (1, -1, -1)');
SELECT abacus_delete('s', 'SELECT id, x, y, z, height FROM points WHERE id % 2 = 0');
DELETE FROM points WHERE id % 2 = 0;
SELECT is_mesh_of_points('m', 2), is_mesh_of_points('s', 3);
SELECT abacus_delete('m', 'SELECT id, x, y FROM points WHERE false');

-- far outside, one at a time, and away again
INSERT INTO points VALUES (5001, 50, 0.5, 7, 1), (5002, -3, -4, -5, NULL), (5003, 1e10, 1e10, 0, 'NaN');
SELECT abacus_insert('m', format('VALUES (%s, %s::float8, %s::float8, %L::float8)', id, x, y, height)), abacus_insert('s', format('VALUES (%s, %s::float8, %s::float8, %s::float8, %L::float8)', id, x, y, z, height)) FROM points WHERE id > 5000;
SELECT is_mesh_of_points('m', 2), is_mesh_of_points('s', 3);
SELECT abacus_delete('m', 'SELECT id, x, y FROM points WHERE id > 5000 OR id < 100'), abacus_delete('s', 'SELECT id, x, y, z FROM points WHERE id > 5000 OR id < 100');
DELETE FROM points WHERE id > 5000 OR id < 100;
SELECT is_mesh_of_points('m', 2), is_mesh_of_points('s', 3);

-- equal points: the one with the id goes, or else the first; the next takes over
SELECT abacus_create('q', 2, '{height}');
SELECT abacus_insert('q', 'VALUES (1, 0, 0, 10), (2, 4, 0, 20), (3, 0, 4, 30), (4, 1, 1, 40), (5, 1, 1, 50), (6, 1, 1, 60), (7, 1, 1, 70)');
SELECT counts('q');
SELECT abacus_delete('q', 'VALUES (5, 1, 1)');
SELECT id, attributes, vertex FROM abacus_vertices('q') WHERE x = 1 ORDER BY id;
SELECT abacus_delete('q', 'VALUES (4, 1, 1)');
SELECT id, attributes, vertex FROM abacus_vertices('q') WHERE x = 1 ORDER BY id;
SELECT corners FROM triangles('q') ORDER BY 1;
SELECT abacus_delete('q', 'VALUES (99, 1, 1)');
SELECT id, attributes, vertex FROM abacus_vertices('q') WHERE x = 1 ORDER BY id;
SELECT abacus_delete('q', 'VALUES (7, 1, 1), (7, 1, 1)');
SELECT counts('q');

-- down to what spans no triangle, to nothing, and up again
SELECT abacus_insert('q', 'VALUES (8, 8, 0, 80), (9, 2, 0, 90)');
SELECT abacus_delete('q', 'VALUES (3, 0, 4)'), counts('q');
SELECT sequence, id, x, y, attributes, vertex FROM abacus_vertices('q') ORDER BY id;
SELECT * FROM abacus_check('q');
SELECT abacus_delete('q', 'VALUES (2, 4, 0), (3, 0, 4), (9, 2, -0.0)'), counts('q');
SELECT abacus_insert('q', 'VALUES (10, 4, 4, NULL::float8)'), counts('q');
SELECT corners FROM triangles('q') ORDER BY 1;
SELECT abacus_delete('q', 'SELECT id, x, y FROM abacus_vertices(''q'')'), counts('q');
SELECT abacus_delete('q', 'VALUES (1, 0, 0)');
SELECT count(*) FROM abacus_vertices('q');
SELECT count(*) FROM q;

-- what waits is inserted first
SELECT abacus_stage('q', 'VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 1, 1, 0)');
SELECT abacus_delete('q', 'VALUES (2, 1, 0)'), counts('q');

-- one transaction, and savepoints
BEGIN;
SELECT abacus_insert('q', 'VALUES (5, 5, 5, 5)'), counts('q');
SAVEPOINT s;
SELECT abacus_delete('q', 'VALUES (1, 0, 0), (5, 5, 5)'), counts('q');
ROLLBACK TO s;
SELECT counts('q');
ROLLBACK;
SELECT counts('q');
SELECT * FROM abacus_check('q');

-- bad input changes nothing
SELECT abacus_insert('q', 'VALUES (1, 2)');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('q', 'VALUES (1, 2, ''NaN''::float8, 4)');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('q', 'VALUES (1, 2)');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('q', 'VALUES (1, NULL::float8, 2)');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('q', 'DELETE FROM points RETURNING id, x, y');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('q', 'SELECT 1, 0.0, 0.0 FROM abacus_insert(''q'', ''VALUES (1, 2, 3, 4)'')');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('points', 'VALUES (1, 2, 3)');
\echo :LAST_ERROR_SQLSTATE
SELECT counts('q');

-- vertices of high degree, whose removals cost more than a triangulation of the rest: still the same mesh
TRUNCATE points;
INSERT INTO points SELECT i, cos(i * 6.283185307179586 / 3000), sin(i * 6.283185307179586 / 3000), i % 3, i FROM generate_series(1, 3000) i;
INSERT INTO points SELECT 3000 + i, x, y, z, -i FROM points, generate_series(1, 2) i WHERE id = 77;
INSERT INTO points SELECT -i, cos(i) * 3, sin(i) * 3, i % 7, i FROM generate_series(100, 250) i;
SELECT abacus_triangulate('hubs', 'SELECT id, x, y, height FROM points ORDER BY id');
SELECT abacus_delete('hubs', 'SELECT id, x, y FROM points WHERE id < 0 OR id = 77');
SELECT value < 151 AS some_at_once FROM abacus_stats('hubs') WHERE name = 'removals';
DELETE FROM points WHERE id < 0 OR id = 77;
SELECT is_mesh_of_points('hubs', 2), counts('hubs');
-- a grid beside a line full of points; half of a moment curve
TRUNCATE points;
INSERT INTO points SELECT i, i % 9, i / 9 % 9, i / 81 % 9 FROM generate_series(0, 728) i;
INSERT INTO points SELECT 100000 + i, i * 0.001, i * 0.002, i * 0.003 FROM generate_series(1, 1200) i;
SELECT abacus_triangulate('lined', 'SELECT id, x, y, z, height FROM points ORDER BY id', dimension => 3);
SELECT abacus_delete('lined', 'SELECT id, x, y, z FROM points WHERE id < 500');
DELETE FROM points WHERE id < 500;
SELECT is_mesh_of_points('lined', 3);
TRUNCATE points;
INSERT INTO points SELECT i, i, i * i, i::float8 * i * i FROM generate_series(0, 199) i;
SELECT abacus_triangulate('moment', 'SELECT id, x, y, z, height FROM points ORDER BY id', dimension => 3);
BEGIN;
SELECT abacus_delete('moment', 'SELECT id, x, y, z FROM points WHERE id % 2 = 0');
ROLLBACK;
SELECT is_mesh_of_points('moment', 3);
SELECT abacus_delete('moment', 'SELECT id, x, y, z FROM points WHERE id % 2 = 0');
DELETE FROM points WHERE id % 2 = 0;
SELECT is_mesh_of_points('moment', 3);
DROP TABLE hubs, lined, moment;

DROP TABLE points, m, s, q;
DROP FUNCTION triangles, counts, is_mesh_of_points;

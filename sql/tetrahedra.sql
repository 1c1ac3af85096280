-- Meshes of dimension 3: making them, and what comes out.
CREATE FUNCTION tetrahedra(mesh regclass) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT format('%s %s %s %s', v0, v1, v2, v3) FROM abacus_simplices(mesh) ORDER BY v0, v1, v2, v3
$$;

-- a cube, all corners on one sphere, and a point inside
SELECT abacus_triangulate('cube', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 0, 4, 0), (4, 4, 4, 0),
    (5, 0, 0, 4), (6, 4, 0, 4), (7, 0, 4, 4), (8, 4, 4, 4), (9, 2, 2, 1)', dimension => 3);
SELECT tetrahedra('cube');
SELECT * FROM abacus_check('cube');
SELECT name, value FROM abacus_stats('cube')
WHERE name IN ('dimension', 'points', 'inserted', 'vertices', 'duplicates', 'simplices', 'hull_facets', 'insertions') ORDER BY name;
SELECT id, x, y, z, vertex FROM abacus_vertices('cube') ORDER BY id;

-- Figure 4.4 of the dissertation: the fingers of the right hand curl along the first three
-- vertices, the thumb points to the fourth; det(v1 - v0, v2 - v0, v3 - v0) > 0
SELECT abacus_triangulate('corner', 'VALUES (10, 0, 0, 0), (11, 1, 0, 0), (12, 0, 1, 0), (13, 0, 0, 1)', dimension => 3);
SELECT tetrahedra('corner');
SELECT abacus_triangulate('mirrored', 'VALUES (10, 0, 0, 0), (11, 1, 0, 0), (12, 0, 1, 0), (13, 0, 0, -1)', dimension => 3);
SELECT tetrahedra('mirrored');

-- a grid: every cell is cospherical, yet the result depends neither on the order of the rows,
-- nor on the steps, the domain or the cache
CREATE TABLE grid_points AS
SELECT i AS id, i % 8 AS x, i / 8 % 8 AS y, i / 64 AS z FROM generate_series(0, 511) i;
SELECT abacus_triangulate('grid', 'TABLE grid_points', dimension => 3);
SELECT abacus_triangulate('grid_back', 'SELECT * FROM grid_points ORDER BY id DESC', dimension => 3);
SELECT abacus_triangulate('grid_mixed', 'SELECT * FROM grid_points ORDER BY md5(id::text)', dimension => 3);
SELECT abacus_triangulate('grid_small', 'TABLE grid_points', dimension => 3, lower => '{3,3,3}', upper => '{4,4,4}');
SELECT abacus_triangulate('grid_large', 'TABLE grid_points', dimension => 3, lower => '{-1e300,-1e300,-1e300}', upper => '{1e300,1e300,1e300}');
SET abacus.cache_size = '1MB';
SELECT abacus_create('grid_steps', 3, lower => '{0,0,0}', upper => '{7,7,7}');
SELECT abacus_stage('grid_steps', 'SELECT * FROM grid_points WHERE id % 3 = 0');
SELECT abacus_triangulate('grid_steps') > 0 AS third;
SELECT abacus_stage('grid_steps', 'SELECT * FROM grid_points WHERE id % 3 = 1');
SELECT abacus_stage('grid_steps', 'SELECT * FROM grid_points WHERE id % 3 = 2');
SELECT abacus_triangulate('grid_steps');
SELECT abacus_triangulate('grid_steps') AS nothing_to_do;
RESET abacus.cache_size;
SELECT mesh, (SELECT array_agg(t) FROM tetrahedra(mesh) t) = (SELECT array_agg(t) FROM tetrahedra('grid') t) AS same,
       (SELECT count(*) FROM abacus_check(mesh)) AS faults
FROM (VALUES ('grid_back'::regclass), ('grid_mixed'), ('grid_small'), ('grid_large'), ('grid_steps')) AS t (mesh);

-- Euler: vertices - edges + facets - tetrahedra is 1; every facet has one or two sides, those
-- with one are the hull; the volumes add up to that of the box, and none is flat
CREATE TEMP TABLE facets AS
SELECT ARRAY(SELECT v FROM unnest(ARRAY[a, b, c]) AS v ORDER BY v) AS facet, count(*) AS sides
FROM abacus_simplices('grid') AS s,
     LATERAL (VALUES (v1, v2, v3), (v0, v2, v3), (v0, v1, v3), (v0, v1, v2)) AS f (a, b, c)
GROUP BY 1;
CREATE TEMP TABLE edges AS
SELECT DISTINCT least(a, b) AS a, greatest(a, b) AS b
FROM abacus_simplices('grid') AS s,
     LATERAL (VALUES (v0, v1), (v0, v2), (v0, v3), (v1, v2), (v1, v3), (v2, v3)) AS e (a, b);
SELECT (SELECT count(*) FROM grid_points) - (SELECT count(*) FROM edges) + (SELECT count(*) FROM facets) -
       (SELECT count(*) FROM abacus_simplices('grid')) AS euler;
SELECT sides, count(*) FROM facets GROUP BY sides ORDER BY sides;
SELECT value AS hull_facets FROM abacus_stats('grid') WHERE name = 'hull_facets';
SELECT sum(six_volumes) / 6 AS volume, min(six_volumes) > 0 AS positive
FROM abacus_simplices('grid') AS s
     JOIN grid_points AS a ON a.id = v0 JOIN grid_points AS b ON b.id = v1
     JOIN grid_points AS c ON c.id = v2 JOIN grid_points AS d ON d.id = v3,
     LATERAL (SELECT (b.x - a.x) * ((c.y - a.y) * (d.z - a.z) - (c.z - a.z) * (d.y - a.y)) -
                      (b.y - a.y) * ((c.x - a.x) * (d.z - a.z) - (c.z - a.z) * (d.x - a.x)) +
                      (b.z - a.z) * ((c.x - a.x) * (d.y - a.y) - (c.y - a.y) * (d.x - a.x))) AS t (six_volumes);

-- attributes, named after the columns or given; without the dimension the third coordinate is an attribute
SELECT abacus_triangulate('named', 'SELECT i AS a, i % 2 AS b, i / 2 % 2 AS c, i / 4 AS d, i * 10 AS vs, NULL::real AS vp FROM generate_series(0, 7) i', dimension => 3);
SELECT id, x, y, z, attributes FROM abacus_vertices('named') ORDER BY id LIMIT 3;
SELECT abacus_triangulate('given', 'SELECT i, i % 2, i / 2 % 2, i / 4, i * 10, -i FROM generate_series(0, 7) i', '{vs,vp}', 3);
SELECT abacus_triangulate('flat', 'SELECT i AS id, i % 2 AS x, i / 2 % 2 AS y, i / 4 AS z FROM generate_series(0, 7) i');
SELECT id, x, y, z, attributes FROM abacus_vertices('flat') ORDER BY id LIMIT 2;

-- beyond maintenance_work_mem: the same order
SELECT abacus_create('sorted', 3), abacus_create('spilled', 3);
SELECT abacus_stage('sorted', 'SELECT i, i % 40, i / 40 % 40, i / 1600 FROM generate_series(0, 63999) i');
SET maintenance_work_mem = '1MB';
SELECT abacus_stage('spilled', 'SELECT i, i % 40, i / 40 % 40, i / 1600 FROM generate_series(0, 63999) i');
RESET maintenance_work_mem;
SELECT count(*) AS differences
FROM abacus_vertices('sorted') a FULL JOIN abacus_vertices('spilled') b USING (sequence)
WHERE a.id IS DISTINCT FROM b.id;

-- what cannot be a mesh, and what cannot be a point
SELECT abacus_create('bad', 3, lower => '{0,0}', upper => '{1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 3, lower => '{0,0,0}', upper => '{1,1,1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 3, lower => '{0,0,0}', upper => '{1,1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 3, lower => '{0,0,-Infinity}', upper => '{1,1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, lower => '{0,0,0}', upper => '{1,1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('bad', 'SELECT 1, 2, 3', dimension => 3);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('bad', 'SELECT 1, 2, 3, 4, 5', '{}', 3);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('cube', 'SELECT 1, 2, 3, ''7''::text');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('cube', 'SELECT 10, 2, 3, NULL::int');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('cube', 'SELECT 10, 2, 3, ''NaN''::float8');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('cube', 'SELECT 10, 2, 3, ''Infinity''::real');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('cube', 'SELECT 10, 2, 3, -1e309::numeric');
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM abacus_vertices('cube');

DROP TABLE cube, corner, mirrored, grid, grid_back, grid_mixed, grid_small, grid_large, grid_steps,
    named, given, flat, sorted, spilled, grid_points, facets, edges;
DROP FUNCTION tetrahedra;

-- Less than a triangle, and points that are equal.
SELECT abacus_triangulate('one', 'SELECT 1, 5, 5');
SELECT abacus_triangulate('two', 'VALUES (1, 5, 5), (2, 6, 6)');
SELECT abacus_triangulate('equal', 'SELECT i, 5, 5 FROM generate_series(1, 50) i');
SELECT abacus_triangulate('line', 'SELECT i, i, 2 * i FROM generate_series(1, 50) i');
SELECT * FROM abacus_check('one') UNION ALL SELECT * FROM abacus_check('two')
UNION ALL SELECT * FROM abacus_check('equal') UNION ALL SELECT * FROM abacus_check('line');
SELECT abacus_locate('one', 5, 5) IS NULL AS one, abacus_locate('line', 2, 4) IS NULL AS line;
SELECT count(*) FROM abacus_simplices('line');

-- they wait for the point that makes them a triangulation
SELECT abacus_stage('line', 'SELECT 100, 10, 0');
SELECT abacus_triangulate('line');
SELECT * FROM abacus_check('line');
SELECT abacus_stage('equal', 'VALUES (60, 6, 5), (61, 5, 6)');
SELECT abacus_triangulate('equal');
SELECT v0, v1, v2 FROM abacus_simplices('equal');
SELECT * FROM abacus_check('equal');

-- of equal points the first in input order is the vertex, and every point says which
SELECT abacus_triangulate('twins',
    'VALUES (30, 0, 0), (10, 0, 0), (20, 1, 0), (21, 1, -0.0::float8), (5, 0, 1), (30, 0, 0), (7, 0, 1)');
SELECT id, x, y, vertex FROM abacus_vertices('twins') ORDER BY id, vertex;
SELECT name, value FROM abacus_stats('twins')
WHERE name IN ('points', 'inserted', 'vertices', 'duplicates', 'simplices', 'hull_facets') ORDER BY name;
SELECT * FROM abacus_check('twins');
-- ids need not be unique: equal ids, distinct points
SELECT abacus_triangulate('same_ids', 'SELECT 7, i % 3, i / 3 FROM generate_series(0, 8) i');
SELECT * FROM abacus_check('same_ids');

-- the whole range of doubles
SELECT abacus_triangulate('range',
    'VALUES (1, 1e-300::float8, 1e-300::float8), (2, 1e300, 0), (3, 0, 1e300), (4, -1e300, -1e300),
            (5, 0, 0), (6, 4.9406564584124654e-324, 0), (7, 1, 1)');
SELECT * FROM abacus_check('range');
-- many points far below the resolution of the curve
SELECT abacus_triangulate('tight',
    'SELECT i, 1 + (i % 40) * 2.3e-16, 1 + (i / 40) * 2.3e-16 FROM generate_series(0, 1599) i
     UNION ALL VALUES (5000, 0, 0), (5001, 1e6, 0), (5002, 0, 1e6)') > 0 AS built;
SELECT * FROM abacus_check('tight');
-- a fan: one vertex in every triangle
SELECT abacus_triangulate('fan',
    'SELECT i, cos(radians(i * 0.72)), sin(radians(i * 0.72)) FROM generate_series(1, 500) i
     UNION ALL SELECT 0, 0, 0') ;
SELECT * FROM abacus_check('fan');

DROP TABLE one, two, equal, line, twins, same_ids, range, tight, fan;

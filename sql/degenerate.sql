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

-- The same in space: less than a tetrahedron.
CREATE FUNCTION less(what text, query text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    mesh text := 'less_' || what;
    simplices bigint := abacus_triangulate(mesh, query, dimension => 3);
    faults bigint := (SELECT count(*) FROM abacus_check(mesh::regclass));
BEGIN
    RETURN format('%s: %s tetrahedra, %s faults, located: %s', what, simplices, faults,
                  abacus_locate(mesh::regclass, 1, 1, 1) IS NOT NULL);
END $$;
SELECT less(what, query) FROM (VALUES
    ('nothing', 'SELECT 1, 1, 1, 1 WHERE false'),
    ('one', 'SELECT 1, 1, 1, 1'),
    ('two', 'VALUES (1, 1, 1, 1), (2, 2, 2, 2)'),
    ('three', 'VALUES (1, 1, 1, 1), (2, 2, 0, 0), (3, 0, 2, 0)'),
    ('equal', 'SELECT i, 1, 1, 1 FROM generate_series(1, 50) i'),
    ('pair', 'SELECT i, i % 2, 1, 1 FROM generate_series(1, 50) i'),
    ('line', 'SELECT i, i, 2 * i - 1, 3 * i - 2 FROM generate_series(-20, 20) i'),
    ('plane', 'SELECT i, i % 7, i / 7, 2 * (i % 7) - i / 7 FROM generate_series(0, 48) i'),
    ('tilted', 'SELECT i, a * 0.1, b * 0.1, a * 0.1 FROM (SELECT i, i % 9 AS a, i / 9 AS b FROM generate_series(0, 80) i) t'),
    ('circle', 'VALUES (1, 5, 0, 1), (2, 4, 3, 1), (3, 3, 4, 1), (4, 0, 5, 1), (5, -3, 4, 1), (6, -5, 0, 1), (7, 0, -5, 1)')
) AS t (what, query);
SELECT id, vertex FROM abacus_vertices('less_three') ORDER BY id;
-- they wait for the points that make them a triangulation, in as many steps as it takes
SELECT abacus_stage('less_nothing', 'VALUES (1, 0, 0, 0), (2, 1, 0, 0)'), abacus_triangulate('less_nothing');
SELECT abacus_stage('less_nothing', 'VALUES (3, 2, 0, 0), (4, 0, 1, 0)'), abacus_triangulate('less_nothing');
SELECT abacus_stage('less_nothing', 'VALUES (5, 0, 0, 1)'), abacus_triangulate('less_nothing');
SELECT v0, v1, v2, v3 FROM abacus_simplices('less_nothing') ORDER BY 1, 2, 3, 4;
SELECT mesh, abacus_stage(mesh::regclass, 'SELECT 1000, 0, 0, 50'), abacus_triangulate(mesh::regclass)
FROM (VALUES ('less_three'), ('less_equal'), ('less_pair'), ('less_line'), ('less_plane'), ('less_tilted'), ('less_circle')) AS t (mesh);
SELECT abacus_stage('less_equal', 'VALUES (60, 2, 1, 1), (61, 1, 2, 1)'), abacus_triangulate('less_equal');
SELECT v0, v1, v2, v3 FROM abacus_simplices('less_equal');
SELECT mesh, count(fault) AS faults
FROM (VALUES ('less_nothing'::regclass), ('less_three'), ('less_equal'), ('less_pair'), ('less_line'), ('less_plane'), ('less_tilted'), ('less_circle')) AS t (mesh)
     LEFT JOIN LATERAL abacus_check(mesh) ON true GROUP BY mesh ORDER BY mesh::text;
-- a plane under a tip: as many tetrahedra as the plane has triangles
SELECT abacus_triangulate('plane_itself', 'SELECT i, i % 7, i / 7 FROM generate_series(0, 48) i');

-- equal points, of which the first in input order is the vertex; equal ids, distinct points
SELECT abacus_triangulate('twins',
    'VALUES (30, 0, 0, 0), (10, 0, 0, -0.0::float8), (20, 1, 0, 0), (21, 1, -0.0::float8, 0), (5, 0, 1, 0), (8, 0, 0, 1), (7, 0, 1, 0)', dimension => 3);
SELECT id, x, y, z, vertex FROM abacus_vertices('twins') ORDER BY id, vertex;
SELECT name, value FROM abacus_stats('twins') WHERE name IN ('points', 'vertices', 'duplicates') ORDER BY name;
SELECT abacus_triangulate('same_ids', 'SELECT 7, i % 3, i / 3 % 3, i / 9 FROM generate_series(0, 26) i', dimension => 3);
SELECT * FROM abacus_check('twins') UNION ALL SELECT * FROM abacus_check('same_ids');

-- the whole range of doubles
SELECT abacus_triangulate('range',
    'VALUES (1, 1e-300::float8, 1e-300::float8, 1e-300::float8), (2, 1e300, 0, 0), (3, 0, 1e300, 0), (4, -1e300, -1e300, 0),
            (5, 0, 0, 0), (6, 4.9406564584124654e-324, 0, 0), (7, 1, 1, 1), (8, 0, 0, 1.7976931348623157e308), (9, 0, 0, -1e-308)', dimension => 3) > 0 AS built;
-- many points far below the resolution of the curve
SELECT abacus_triangulate('tight',
    'SELECT i, 1 + (i % 12) * 2.3e-16, 1 + (i / 12 % 12) * 2.3e-16, 1 + (i / 144) * 2.3e-16 FROM generate_series(0, 1727) i
     UNION ALL VALUES (5000, 0, 0, 0), (5001, 1e6, 0, 0), (5002, 0, 1e6, 0), (5003, 0, 0, 1e6)', dimension => 3) > 0 AS built;
-- integer points on one sphere, with and without its centre, which is in every tetrahedron
CREATE TABLE sphere AS
SELECT row_number() OVER () AS id, x, y, z
FROM generate_series(-45, 45) AS x, generate_series(-45, 45) AS y, generate_series(-45, 45) AS z WHERE x * x + y * y + z * z = 45 * 45;
SELECT abacus_triangulate('ball', 'TABLE sphere', dimension => 3) > 0 AS built;
SELECT abacus_triangulate('star', 'TABLE sphere UNION ALL SELECT 0, 0, 0, 0', dimension => 3) = (SELECT 2 * count(*) - 4 FROM sphere) AS as_many_as_hull_facets;
SELECT count(*) FROM abacus_simplices('star') WHERE v0 <> 0;
-- two skew lines: a quadratic number of tetrahedra
SELECT abacus_triangulate('skew', 'SELECT i, i, 0, 0 FROM generate_series(1, 40) i UNION ALL SELECT 100 + i, 0, i, 1 FROM generate_series(1, 40) i', dimension => 3);
SELECT mesh, count(fault) AS faults
FROM (VALUES ('range'::regclass), ('tight'), ('ball'), ('star'), ('skew')) AS t (mesh) LEFT JOIN LATERAL abacus_check(mesh) ON true GROUP BY mesh ORDER BY mesh::text;

DROP TABLE less_nothing, less_one, less_two, less_three, less_equal, less_pair, less_line, less_plane, less_tilted, less_circle,
    plane_itself, twins, same_ids, range, tight, ball, star, skew, sphere;
DROP FUNCTION less;

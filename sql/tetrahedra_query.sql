-- Locating, walking and the content of meshes of dimension 3, against brute force in SQL.
CREATE TABLE points (id int PRIMARY KEY, x int, y int, z int);
INSERT INTO points SELECT i, i % 4 * 4, i / 4 % 4 * 4, i / 16 * 4 FROM generate_series(0, 63) i;
SELECT abacus_triangulate('field', 'TABLE points', dimension => 3);

-- det(b - a, c - a, d - a): exact, since all numbers here are small integers
CREATE FUNCTION det(ax float8, ay float8, az float8, bx float8, by float8, bz float8,
                    cx float8, cy float8, cz float8, dx float8, dy float8, dz float8)
RETURNS float8 LANGUAGE sql IMMUTABLE AS $$
    SELECT (bx - ax) * ((cy - ay) * (dz - az) - (cz - az) * (dy - ay)) -
           (by - ay) * ((cx - ax) * (dz - az) - (cz - az) * (dx - ax)) +
           (bz - az) * ((cx - ax) * (dy - ay) - (cy - ay) * (dx - ax))
$$;
CREATE FUNCTION orientation(s abacus_simplex) RETURNS float8 LANGUAGE sql STABLE AS $$
    SELECT sign(det(a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z))
    FROM points AS a, points AS b, points AS c, points AS d
    WHERE a.id = s.v0 AND b.id = s.v1 AND c.id = s.v2 AND d.id = s.v3
$$;

-- positive orientation, least id first, from every function that returns tetrahedra
SELECT 'abacus_simplices' AS returned_by, orientation(s), v0 < least(v1, v2, v3) AS least_first, v1 < least(v2, v3) AS then_least, count(*)
FROM abacus_simplices('field') AS s GROUP BY 1, 2, 3, 4
UNION ALL
SELECT 'abacus_locate', orientation(s), v0 < least(v1, v2, v3), v1 < least(v2, v3), count(*)
FROM points AS p, abacus_locate('field', p.x + 0.5, p.y + 1, p.z + 1.75) AS s WHERE s.v0 IS NOT NULL GROUP BY 1, 2, 3, 4
UNION ALL
SELECT 'abacus_walk', orientation(n), n.v0 < least(n.v1, n.v2, n.v3), n.v1 < least(n.v2, n.v3), count(*)
FROM abacus_simplices('field') AS s, generate_series(0, 3) AS f, abacus_walk('field', s, f) AS n WHERE n.v0 IS NOT NULL GROUP BY 1, 2, 3, 4;

-- the empty sphere, in exact numbers: no point is inside that of any tetrahedron
CREATE FUNCTION in_sphere(s abacus_simplex, e points) RETURNS numeric LANGUAGE sql STABLE AS $$
    WITH r AS (
        SELECT n, (p.x - e.x)::numeric AS x, (p.y - e.y)::numeric AS y, (p.z - e.z)::numeric AS z
        FROM points AS p, unnest(ARRAY[s.v0, s.v1, s.v2, s.v3]) WITH ORDINALITY AS v (id, n) WHERE p.id = v.id)
    SELECT sum((CASE r.n WHEN 1 THEN 1 WHEN 2 THEN -1 WHEN 3 THEN 1 ELSE -1 END) * (r.x * r.x + r.y * r.y + r.z * r.z) *
               (a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x)))
    FROM r, r AS a, r AS b, r AS c
    WHERE a.n < b.n AND b.n < c.n AND r.n NOT IN (a.n, b.n, c.n)
$$;
-- the sign that means inside, from one tetrahedron whose sphere is known
SELECT sign(in_sphere(s, ROW(99, 1, 1, 1))) AS inside, sign(in_sphere(s, ROW(99, 100, 1, 1))) AS outside
FROM abacus_simplices('field') AS s ORDER BY v0, v1, v2, v3 LIMIT 1;
SELECT count(*) AS tests, count(*) FILTER (WHERE in_sphere(s, p) > 0) AS inside, count(*) FILTER (WHERE in_sphere(s, p) = 0) AS on_the_sphere
FROM abacus_simplices('field') AS s, points AS p WHERE p.x + p.y + p.z <= 12;

-- every place on a fine lattice in and around the box: inside, on facets, on edges, on vertices,
-- outside; always the containing tetrahedron with the least code, then the least ids
CREATE TEMP TABLE sides AS
SELECT s, s.code, s.v0, s.v1, s.v2, s.v3, a.x AS ax, a.y AS ay, a.z AS az, b.x AS bx, b.y AS by, b.z AS bz,
       c.x AS cx, c.y AS cy, c.z AS cz, d.x AS dx, d.y AS dy, d.z AS dz
FROM abacus_simplices('field') AS s JOIN points AS a ON a.id = v0 JOIN points AS b ON b.id = v1
     JOIN points AS c ON c.id = v2 JOIN points AS d ON d.id = v3;
CREATE TEMP TABLE containing AS
SELECT x, y, z, array_agg(t.s ORDER BY t.code, t.v0, t.v1, t.v2, t.v3) AS simplices
FROM generate_series(-1, 13) AS x CROSS JOIN generate_series(-1, 13) AS y CROSS JOIN generate_series(-2, 13, 2) AS z
     LEFT JOIN sides AS t ON
         x BETWEEN least(ax, bx, cx, dx) AND greatest(ax, bx, cx, dx) AND
         y BETWEEN least(ay, by, cy, dy) AND greatest(ay, by, cy, dy) AND
         z BETWEEN least(az, bz, cz, dz) AND greatest(az, bz, cz, dz) AND
         det(x, y, z, bx, by, bz, cx, cy, cz, dx, dy, dz) >= 0 AND
         det(ax, ay, az, x, y, z, cx, cy, cz, dx, dy, dz) >= 0 AND
         det(ax, ay, az, bx, by, bz, x, y, z, dx, dy, dz) >= 0 AND
         det(ax, ay, az, bx, by, bz, cx, cy, cz, x, y, z) >= 0
GROUP BY x, y, z;
SELECT CASE WHEN simplices = '{NULL}' THEN 0 ELSE cardinality(simplices) END AS containing, count(*) AS places,
       bool_and(simplices[1] IS NOT DISTINCT FROM abacus_locate('field', x, y, z)) AS located
FROM containing GROUP BY 1 ORDER BY 1;
-- a step beyond the hull is outside
SELECT abacus_locate('field', 6, 6, 12) IS NULL AS hull, abacus_locate('field', 6, 6, 12 + 2e-15) IS NULL AS beyond,
       abacus_locate('field', 12, 12, 12) IS NULL AS corner, abacus_locate('field', 6, 6, -5e-324) IS NULL AS below,
       abacus_locate('field', 1e308, 0, -1e308) IS NULL AS far;
-- arguments
SELECT abacus_locate('field', 1, 1, NULL) IS NULL AS null_z, abacus_locate('field', NULL, 1, 1) IS NULL AS null_x,
       abacus_locate(NULL, 1, 1, 1) IS NULL AS null_mesh, abacus_locate('field', 1, 1, '-Infinity') IS NULL AS infinite;
SELECT abacus_locate('field', 1, 1, 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('field', 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate(mesh => 'field', x => 1, y => 2, z => 3) = abacus_locate('field', 1, 2, 3) AS by_name;

-- walking there and back across every facet: the shared corners, and the hull
SELECT count(*) AS steps, count(n.code) AS inner_steps, count(*) - count(n.code) AS hull,
       count(*) FILTER (WHERE s IN (abacus_walk('field', n, 0), abacus_walk('field', n, 1), abacus_walk('field', n, 2), abacus_walk('field', n, 3))) AS back,
       count(*) FILTER (WHERE (SELECT count(*) FROM unnest(ARRAY[s.v0, s.v1, s.v2, s.v3]) v WHERE v IN (n.v0, n.v1, n.v2, n.v3)) = 3) AS shared,
       count(*) FILTER (WHERE (ARRAY[s.v0, s.v1, s.v2, s.v3])[1 + f] IN (n.v0, n.v1, n.v2, n.v3)) AS opposite_shared
FROM abacus_simplices('field') AS s, generate_series(0, 3) AS f, LATERAL abacus_walk('field', s, f) AS n;
SELECT value AS hull_facets FROM abacus_stats('field') WHERE name = 'hull_facets';
-- the corners in any order: the facet is that opposite the given corner
SELECT abacus_walk('field', s, 1) IS NOT DISTINCT FROM abacus_walk('field', ROW(s.code, s.v3, s.v0, s.v1, s.v2), 2) AS any_order
FROM abacus_locate('field', 6, 5, 4.5) AS s;
SELECT abacus_walk('field', abacus_locate('field', 6, 6, 6), 4);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', abacus_locate('field', 6, 6, 6), -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(1, 2, 3, 4, 5), 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(1, 2, 3, 4, NULL), 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(NULL, NULL, NULL, NULL, NULL), 0) IS NULL AS nulls;
SELECT count(*) AS none FROM points AS p, abacus_locate('field', p.x - 100, p.y, p.z) AS s, abacus_walk('field', s, 0) AS n WHERE n.v0 IS NOT NULL;
-- a mesh of one dimension takes nothing from one of the other
SELECT abacus_triangulate('plane', 'SELECT id, x, y FROM points WHERE z = 0');
SELECT abacus_locate('plane', 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('plane', abacus_locate('field', 1, 1, 1), 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', abacus_locate('plane', 1, 1), 0);
\echo :LAST_ERROR_SQLSTATE
-- after errors the session reads on
SELECT (abacus_locate('field', 2, 1, 3)).v0 IS NOT NULL AS found;

-- 2D keeps the same convention: det(v1 - v0, v2 - v0) > 0, the least id first
SELECT sign((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) AS orientation, v0 < least(v1, v2) AS least_first, v3, count(*)
FROM (SELECT (abacus_simplices('plane')).*
      UNION ALL SELECT s.* FROM points AS p, abacus_locate('plane', p.x + 0.5, p.y + 1) AS s WHERE s.v0 IS NOT NULL
      UNION ALL SELECT n.* FROM abacus_simplices('plane') AS s, generate_series(0, 2) AS f, abacus_walk('plane', s, f) AS n WHERE n.v0 IS NOT NULL) AS t
     JOIN points AS a ON a.id = v0 JOIN points AS b ON b.id = v1 JOIN points AS c ON c.id = v2
GROUP BY 1, 2, 3;

-- a cursor goes on reading what it began with
BEGIN;
DECLARE reader CURSOR FOR SELECT abacus_simplices('field');
MOVE 1 FROM reader;
SELECT abacus_stage('field', 'VALUES (100, 1, 2, 3), (101, 20, 20, 20)'), abacus_triangulate('field') > 0 AS grown;
MOVE ALL FROM reader;
SELECT count(*) FROM abacus_check('field');
ROLLBACK;
SELECT count(*) FROM abacus_simplices('field');

DROP FUNCTION orientation, in_sphere, det;
DROP TABLE points, field, plane, sides, containing;

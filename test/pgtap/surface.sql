-- Surfaces through larger meshes in space: the properties of a surface, in SQL; settings, rights, estimates.
BEGIN;
SELECT no_plan();
SELECT setseed(0.25);
CREATE TABLE points AS SELECT id, x, y, z, sqrt(x * x + y * y + z * z) AS radius, x + 2 * y AS slope
FROM (SELECT id, 2 * random() - 1 AS x, 2 * random() - 1 AS y, 2 * random() - 1 AS z FROM generate_series(1, 20000) AS id) AS p;
SELECT isnt(abacus_triangulate('ball', 'TABLE points', '{radius,slope}', dimension => 3), NULL, 'a mesh in space');
CREATE TEMP TABLE sphere AS SELECT row_number() OVER () AS n, s.* FROM abacus_isosurface('ball', 0.7, 'radius', 'slope') AS s;

-- closed, dense, shared to the bit
CREATE TEMP TABLE corner AS SELECT n, i, CASE i WHEN 1 THEN v0 WHEN 2 THEN v1 ELSE v2 END AS v, corners[i][1] AS x, corners[i][2] AS y, corners[i][3] AS z, "values"[i] AS slope FROM sphere, generate_series(1, 3) AS i;
CREATE TEMP TABLE side AS SELECT v0 AS a, v1 AS b FROM sphere UNION ALL SELECT v1, v2 FROM sphere UNION ALL SELECT v2, v0 FROM sphere;
SELECT is_empty($$ SELECT a, b FROM side GROUP BY a, b HAVING count(*) > 1 $$, 'no side is there twice in one direction');
SELECT is_empty($$ SELECT a, b FROM side EXCEPT SELECT b, a FROM side $$, 'each is there in both');
SELECT is((SELECT max(v) + 1 FROM corner), (SELECT count(DISTINCT v) FROM corner), 'numbers are dense');
SELECT is((SELECT min(v) FROM corner), 0::bigint, 'from 0');
SELECT is_empty($$ SELECT v FROM corner GROUP BY v HAVING count(DISTINCT (x, y, z, slope)) > 1 $$, 'corners of one number are one');
SELECT is((SELECT max(v) + 1 FROM corner) + (SELECT count(*) FROM sphere), (SELECT count(*) FROM side) / 2 + 2, 'Euler: a sphere');
SELECT is_empty($$ SELECT * FROM sphere WHERE v0 > v1 OR v0 > v2 $$, 'the least number comes first');
SELECT cmp_ok((SELECT max(abs(x + 2 * y - slope)) FROM corner), '<', 1e-12::float8, 'what is carried varies linearly');
SELECT cmp_ok((SELECT max(abs(sqrt(x * x + y * y + z * z) - 0.7)) FROM corner), '<', 0.05::float8, 'near the sphere');
-- normals towards lower values: inside
SELECT cmp_ok((SELECT avg(CASE WHEN (x1 * (y2 * z3 - z2 * y3) - y1 * (x2 * z3 - z2 * x3) + z1 * (x2 * y3 - y2 * x3)) < 0 THEN 1 ELSE 0 END)
    FROM (SELECT corners[1][1] AS x1, corners[1][2] AS y1, corners[1][3] AS z1, corners[2][1] AS x2, corners[2][2] AS y2, corners[2][3] AS z2, corners[3][1] AS x3, corners[3][2] AS y3, corners[3][3] AS z3 FROM sphere) AS t), '>', 0.99, 'they are turned to the lower values');

-- for any settings, and however the mesh was made
SET LOCAL work_mem = '64kB';
SELECT bag_eq($$ SELECT v0, v1, v2, corners, "values" FROM abacus_isosurface('ball', 0.7, 'radius', 'slope') $$, $$ SELECT v0, v1, v2, corners, "values" FROM sphere $$, 'the same in little memory');
RESET work_mem;
SELECT isnt(abacus_create('grown', 3, '{radius,slope}'), NULL, 'another mesh');
SELECT isnt(abacus_insert('grown', 'SELECT * FROM points WHERE id % 3 = 2'), NULL, 'in parts');
SELECT isnt(abacus_insert('grown', 'SELECT * FROM points WHERE id % 3 <> 2 ORDER BY id DESC'), NULL, 'in parts');
SELECT bag_eq($$ SELECT v0, v1, v2, corners, "values" FROM abacus_isosurface('grown', 0.7, 'radius', 'slope') $$, $$ SELECT v0, v1, v2, corners, "values" FROM sphere $$, 'the same of the same points');
SELECT bag_eq($$ SELECT polygon, "values" FROM abacus_section('grown', '{0.1,0,0}', '{1,1,0.2}', 'slope') $$, $$ SELECT polygon, "values" FROM abacus_section('ball', '{0.1,0,0}', '{1,1,0.2}', 'slope') $$, 'and so is a section');
SELECT is(abacus_draw_volume('grown', attribute => 'radius', mode => 'max', width => 60), abacus_draw_volume('ball', attribute => 'radius', mode => 'max', width => 60), 'and a picture');

-- a section tiles its plane
CREATE TEMP TABLE polygon AS SELECT row_number() OVER () AS n, cardinality(polygon) / 3 AS corners, polygon, "values" FROM abacus_section('ball', '{0,0,0.125}', '{0,0,1}', 'slope');
SELECT is_empty($$ SELECT * FROM polygon, generate_series(3, cardinality(polygon), 3) AS i WHERE polygon[i] <> 0.125 $$, 'in the plane');
SELECT cmp_ok((SELECT abs(sum(x * next_y - next_x * y) / 2 - 4) FROM (
    SELECT polygon[3 * i + 1] AS x, polygon[3 * i + 2] AS y, polygon[3 * ((i + 1) % corners) + 1] AS next_x, polygon[3 * ((i + 1) % corners) + 2] AS next_y
    FROM polygon, LATERAL generate_series(0, corners - 1) AS i) AS t), '<', 0.1::float8, 'all of the square, turned to the left');
SELECT is((SELECT count(*) FROM polygon WHERE cardinality("values") <> corners), 0::bigint, 'a value for each corner');

-- loaded, with a hole
CREATE TABLE shell AS SELECT v0, v1, v2, v3 FROM abacus_cells('ball', max_edge => 0.5) WHERE NOT (abs(corners[1][1]) < 0.3 AND abs(corners[1][2]) < 0.3);
CREATE TABLE shell_points AS SELECT * FROM points WHERE id IN (SELECT unnest(ARRAY[v0, v1, v2, v3]) FROM shell);
SELECT isnt(abacus_load('hollow', 'TABLE shell_points', 'TABLE shell', '{radius,slope}'), NULL, 'a mesh with a hole');
SELECT cmp_ok((SELECT count(*) FROM abacus_isosurface('hollow', 0.7, 'radius')), '<', (SELECT count(*) FROM sphere), 'its surface ends at the hole');
SELECT cmp_ok((SELECT count(*) FROM abacus_section('hollow', '{0,0,0.125}', '{0,0,1}', 'slope')), '<', (SELECT count(*) FROM polygon), 'and so does its section');

-- estimates
CREATE FUNCTION pg_temp.expected(query text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan json;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
    RETURN plan -> 0 -> 'Plan' ->> 'Plan Rows';
END $$;
SELECT cmp_ok(abs(ln(pg_temp.expected($$ SELECT * FROM abacus_isosurface('ball', 0.7, 'radius') $$) / (SELECT count(*) FROM sphere))), '<', ln(3)::float8, 'about as many triangles are expected');
SELECT cmp_ok(abs(ln(pg_temp.expected($$ SELECT * FROM abacus_section('ball', '{0,0,0}', '{0,0,1}', 'radius') $$) / (SELECT count(*) FROM polygon))), '<', ln(3)::float8, 'and polygons');
SELECT is(pg_temp.expected($$ SELECT * FROM abacus_isosurface(NULL, 0.7) $$), 1::float8, 'of no mesh none');

-- privileges
CREATE ROLE abacus_surveyor;
SET LOCAL ROLE abacus_surveyor;
SELECT throws_ok($$ SELECT * FROM abacus_isosurface('ball', 0.7, 'radius') $$, '42501', NULL, 'the surface in a mesh that one may not read');
SELECT throws_ok($$ SELECT * FROM abacus_section('ball', '{0,0,0}', '{0,0,1}', 'radius') $$, '42501', NULL, 'a section');
SELECT throws_ok($$ SELECT abacus_draw_volume('ball') $$, '42501', NULL, 'a picture');
RESET ROLE;
GRANT SELECT ON ball TO abacus_surveyor;
SET LOCAL ROLE abacus_surveyor;
SELECT is((SELECT count(*) FROM abacus_isosurface('ball', 0.7, 'radius')), (SELECT count(*) FROM abacus_isosurface('ball', 0.7, 'radius', 'slope')), 'with SELECT on the mesh one may');
RESET ROLE;
SELECT * FROM finish();
ROLLBACK;

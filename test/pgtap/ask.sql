-- Nearest vertices and windows of larger meshes, compared with SQL over all vertices and simplices.
BEGIN;
SELECT no_plan();
SELECT setseed(0.5);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z, random() AS height FROM generate_series(1, 6000) AS id;
SELECT isnt(abacus_triangulate('field', 'SELECT id, x, y, height FROM points', '{height}'), NULL, 'a mesh in the plane');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z FROM points LIMIT 2000', dimension => 3), NULL, 'one in space');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('field') WHERE (v0 + v1 + v2) % 9 > 0;
CREATE TABLE corners AS SELECT id, x, y FROM points WHERE id IN (SELECT v0 FROM triangles UNION SELECT v1 FROM triangles UNION SELECT v2 FROM triangles);
SELECT isnt(abacus_load('holes', 'TABLE corners', 'TABLE triangles'), NULL, 'one with holes');
CREATE TABLE places AS SELECT id, 1.4 * random() - 0.2 AS x, 1.4 * random() - 0.2 AS y, 1.4 * random() - 0.2 AS z FROM generate_series(1, 40) AS id;

-- the nearest
CREATE FUNCTION pg_temp.nearest(points regclass, k int) RETURNS TABLE (id bigint, rank bigint, vertex bigint) LANGUAGE plpgsql AS $$
BEGIN
    RETURN QUERY EXECUTE format('SELECT p.id::bigint, n.rank, n.id::bigint FROM places p, LATERAL (
        SELECT q.id, row_number() OVER (ORDER BY (q.x - p.x) ^ 2 + (q.y - p.y) ^ 2) AS rank FROM %s q ORDER BY rank LIMIT %s) n', points, k);
END $$;
SELECT bag_eq($$ SELECT id, rank, vertex FROM abacus_nearest('field', 'SELECT id, x, y FROM places', 7) $$, $$ SELECT * FROM pg_temp.nearest('points', 7) $$, 'the nearest of many places');
SELECT bag_eq($$ SELECT id, rank, vertex FROM abacus_nearest('holes', 'SELECT id, x, y FROM places', 5) $$, $$ SELECT * FROM pg_temp.nearest('corners', 5) $$, 'of a mesh with holes');
SELECT bag_eq($$ SELECT p.id::bigint, n.vertex FROM places p, LATERAL abacus_nearest('field', x, y, 3) n $$, $$ SELECT id, vertex FROM pg_temp.nearest('points', 3) $$, 'of one place');
SELECT bag_eq($$ SELECT id, rank, vertex FROM abacus_nearest('solid', 'SELECT id, x, y, z FROM places', 4) $$,
    $$ SELECT p.id::bigint, n.rank, n.id::bigint AS vertex FROM places p, LATERAL (SELECT q.id, row_number() OVER (ORDER BY (q.x - p.x) ^ 2 + (q.y - p.y) ^ 2 + (q.z - p.z) ^ 2) AS rank FROM points q WHERE q.id <= 2000 ORDER BY rank LIMIT 4) n $$, 'in space');
SELECT is((SELECT count(DISTINCT vertex) FROM abacus_nearest('field', 0.5, 0.5, 100000)), 6000::bigint, 'all, if k is more');
SELECT is((SELECT count(*) FROM abacus_nearest('field', 0.5, 0.5, 100) n JOIN points p ON p.id = n.vertex AND p.x = n.x AND p.y = n.y AND ARRAY[p.height] = n.attributes), 100::bigint, 'with their attributes');
SET LOCAL abacus.cache_size = '1MB';
SELECT bag_eq($$ SELECT p.id::bigint, n.vertex FROM places p, LATERAL abacus_nearest('holes', x, y, 3) n $$, $$ SELECT id, vertex FROM pg_temp.nearest('corners', 3) $$, 'with a small cache');
RESET abacus.cache_size;

-- windows
SELECT bag_eq($$ SELECT * FROM abacus_simplices('field', ARRAY[0, 0], ARRAY[1, 1]) $$, $$ SELECT * FROM abacus_simplices('field') $$, 'a window around all');
SELECT bag_eq($$ SELECT code, v0, v1, v2, v3 FROM abacus_cells('field', ARRAY[0.4, 0.4], ARRAY[0.5, 0.45]) $$, $$ SELECT * FROM abacus_simplices('field', ARRAY[0.4, 0.4], ARRAY[0.5, 0.45]) $$, 'the same cells');
SELECT bag_has($$ SELECT v0, v1, v2 FROM abacus_simplices('field', ARRAY[0.4, 0.4], ARRAY[0.5, 0.45]) $$,
    $$ SELECT s.v0, s.v1, s.v2 FROM abacus_simplices('field') s JOIN points p ON p.id IN (s.v0, s.v1, s.v2) AND p.x BETWEEN 0.4 AND 0.5 AND p.y BETWEEN 0.4 AND 0.45 GROUP BY 1, 2, 3 $$, 'all with a corner in the window');
SELECT is_empty($$ SELECT * FROM abacus_cells('field', ARRAY[0.4, 0.4], ARRAY[0.5, 0.45]) WHERE greatest(corners[1][1], corners[2][1], corners[3][1]) < 0.4 OR least(corners[1][2], corners[2][2], corners[3][2]) > 0.45 $$, 'none beside it');
SELECT is((SELECT count(*) FROM abacus_cells('field') c JOIN points a ON a.id = v0 JOIN points b ON b.id = v1 JOIN points d ON d.id = v2
           WHERE corners = ARRAY[[a.x, a.y], [b.x, b.y], [d.x, d.y]] AND "values" = ARRAY[[a.height], [b.height], [d.height]]),
          (SELECT count(*) FROM abacus_simplices('field')), 'corners and attributes are those of the points');
SELECT set_eq($$ SELECT n.* FROM abacus_cells('holes', ARRAY[0.3, 0.3], 0.05) c, LATERAL abacus_simplices('holes', ARRAY[c.corners[1][1], c.corners[1][2]], 0) n $$,
              $$ SELECT n.* FROM abacus_cells('holes', ARRAY[0.3, 0.3], 0.05) c, LATERAL abacus_star('holes', c.corners[1][1], c.corners[1][2]) n $$, 'a ball of radius 0 around a vertex is its star');

SELECT bag_eq($$ SELECT id FROM abacus_vertices('field', ARRAY[0.1, 0.2], ARRAY[0.7, 0.9]) $$, $$ SELECT id::bigint FROM points WHERE x BETWEEN 0.1 AND 0.7 AND y BETWEEN 0.2 AND 0.9 $$, 'vertices of a window');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('field', ARRAY[-5, -5], ARRAY[5, 5]) $$, $$ SELECT id::bigint FROM points $$, 'of one around all');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('solid', ARRAY[0, 0, 0], 0.7) $$, $$ SELECT id::bigint FROM points WHERE id <= 2000 AND x * x + y * y + z * z <= 0.7 * 0.7 $$, 'of a ball in space');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('holes', ARRAY[0.1, 0.2], ARRAY[0.7, 0.9]) $$, $$ SELECT id::bigint FROM corners WHERE x BETWEEN 0.1 AND 0.7 AND y BETWEEN 0.2 AND 0.9 $$, 'of a mesh with holes');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('field', 'height', 0.3, 0.35) $$, $$ SELECT id::bigint FROM points WHERE height BETWEEN 0.3 AND 0.35 $$, 'of a range of an attribute');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('field', 'height', 0.3, 0.35, ARRAY[0.1, 0.2], ARRAY[0.7, 0.9]) $$, $$ SELECT id::bigint FROM points WHERE height BETWEEN 0.3 AND 0.35 AND x BETWEEN 0.1 AND 0.7 AND y BETWEEN 0.2 AND 0.9 $$, 'in a window');
CREATE FUNCTION pg_temp.edges(mesh regclass) RETURNS TABLE (v0 bigint, v1 bigint) LANGUAGE sql AS $$
    SELECT DISTINCT least(a, b), greatest(a, b) FROM abacus_simplices(mesh), LATERAL (VALUES (v0, v1), (v0, v2), (v1, v2), (v0, v3), (v1, v3), (v2, v3)) AS e (a, b) WHERE a IS NOT NULL AND b IS NOT NULL $$;
SELECT bag_eq($$ SELECT v0, v1 FROM abacus_edges('field') $$, $$ SELECT * FROM pg_temp.edges('field') $$, 'edges in the plane');
SELECT bag_eq($$ SELECT v0, v1 FROM abacus_edges('solid') $$, $$ SELECT * FROM pg_temp.edges('solid') $$, 'in space');
SELECT bag_eq($$ SELECT v0, v1 FROM abacus_edges('holes') $$, $$ SELECT * FROM pg_temp.edges('holes') $$, 'of a mesh with holes');
SELECT is((SELECT sum(length) < 1.000001 * sum(l) AND sum(length) > 0.999999 * sum(l) FROM abacus_edges('field') e JOIN points a ON a.id = v0 JOIN points b ON b.id = v1, LATERAL sqrt((a.x - b.x) ^ 2 + (a.y - b.y) ^ 2) AS l), true, 'their lengths');

-- what the planner expects
CREATE FUNCTION pg_temp.expected(query text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan json;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
    RETURN plan -> 0 -> 'Plan' ->> 'Plan Rows';
END $$;
SELECT is(pg_temp.expected($$ SELECT * FROM abacus_nearest('field', 0.5, 0.5, 25) $$), 25::float8, 'k rows of the nearest');
SELECT is(pg_temp.expected($$ SELECT * FROM abacus_nearest('field', 0.5, 0.5) $$), 1::float8, 'one, if k is left out');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_cells('field') $$), '>', 6000::float8, 'all cells');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_cells('field', ARRAY[0.4, 0.4], ARRAY[0.5, 0.45]) $$), '<', 600::float8, 'few of a window');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_vertices('field', 'height', 0.3, 0.35) $$), '<', 600::float8, 'and of a range');

-- privileges
CREATE ROLE abacus_asker;
SET LOCAL ROLE abacus_asker;
SELECT throws_ok($$ SELECT * FROM abacus_nearest('field', 0.5, 0.5) $$, '42501', NULL, 'the nearest of a mesh that one may not read');
SELECT throws_ok($$ SELECT * FROM abacus_cells('field') $$, '42501', NULL, 'its cells');
SELECT throws_ok($$ SELECT * FROM abacus_star('field', 0.5, 0.5) $$, '42501', NULL, 'a star');
RESET ROLE;
GRANT SELECT ON field TO abacus_asker;
SET LOCAL ROLE abacus_asker;
SELECT is((SELECT count(*) FROM abacus_vertices('field', ARRAY[-5, -5], ARRAY[5, 5])), 6000::bigint, 'a window takes no privilege on the vertex table');
SELECT is((SELECT count(*) FROM abacus_edges('field', ARRAY[0.5, 0.5], 0.1) LIMIT 1) > 0, true, 'nor do edges');
RESET ROLE;
SELECT * FROM finish();
ROLLBACK;

-- Rays, profiles, lines of sight and rasters of larger meshes, compared with one another and with SQL;
-- streams, estimates, privileges.
BEGIN;
SELECT no_plan();
SELECT setseed(0.25);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z, random() AS height FROM generate_series(1, 5000) AS id;
SELECT isnt(abacus_triangulate('field', 'SELECT id, x, y, height FROM points', '{height}'), NULL, 'a mesh in the plane');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z, height FROM points LIMIT 2000', '{height}', dimension => 3), NULL, 'one in space');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('field') WHERE (v0 + v1 + v2) % 9 > 0;
CREATE TABLE corners AS SELECT id, x, y, height FROM points WHERE id IN (SELECT v0 FROM triangles UNION SELECT v1 FROM triangles UNION SELECT v2 FROM triangles);
SELECT isnt(abacus_load('holes', 'TABLE corners', 'TABLE triangles'), NULL, 'one with holes');
CREATE TABLE rays AS SELECT id, 2 * random() - 0.5 AS x, 2 * random() - 0.5 AS y, 2 * random() - 0.5 AS z, random() - 0.5 AS dx, random() - 0.5 AS dy, random() - 0.5 AS dz
FROM generate_series(1, 40) AS id;

-- the middle of each piece lies in its simplex
CREATE FUNCTION pg_temp.wrong(mesh regclass) RETURNS bigint LANGUAGE sql AS
$$ SELECT count(*) FROM rays, abacus_ray(mesh, ARRAY[x, y], ARRAY[dx, dy]) AS r,
          abacus_locate(mesh, x + (enters + leaves) / 2 * dx, y + (enters + leaves) / 2 * dy) AS l
   WHERE leaves - enters > 1e-9 AND (r.v0, r.v1, r.v2) IS DISTINCT FROM (l.v0, l.v1, l.v2) $$;
SELECT is(pg_temp.wrong('field'), 0::bigint, 'simplices of rays');
SELECT is(pg_temp.wrong('holes'), 0::bigint, '... over holes');
SELECT is((SELECT count(*) FROM rays, abacus_ray('solid', ARRAY[x, y, z], ARRAY[dx, dy, dz]) AS r,
        abacus_locate('solid', x + (enters + leaves) / 2 * dx, y + (enters + leaves) / 2 * dy, z + (enters + leaves) / 2 * dz) AS l
    WHERE leaves - enters > 1e-9 AND (r.v0, r.v1, r.v2, r.v3) IS DISTINCT FROM (l.v0, l.v1, l.v2, l.v3)), 0::bigint, '... in space');
-- there is nothing between two pieces
CREATE FUNCTION pg_temp.gaps(mesh regclass, OUT gaps bigint, OUT wrong bigint) LANGUAGE sql AS
$$ SELECT count(*) FILTER (WHERE next - leaves > 1e-9),
          count(*) FILTER (WHERE next - leaves > 1e-9 AND NOT abacus_locate(mesh, x + (leaves + next) / 2 * dx, y + (leaves + next) / 2 * dy) IS NULL)
   FROM (SELECT rays.*, leaves, lead(enters) OVER (PARTITION BY id ORDER BY enters, leaves) AS next
         FROM rays, abacus_ray(mesh, ARRAY[x, y], ARRAY[dx, dy])) AS r $$;
SELECT is((SELECT gaps FROM pg_temp.gaps('field')), 0::bigint, 'a convex mesh is left once');
SELECT is((SELECT wrong FROM pg_temp.gaps('holes')), 0::bigint, 'gaps are holes');
SELECT cmp_ok((SELECT gaps FROM pg_temp.gaps('holes')), '>', 100::bigint, '... of which there are many');
CREATE TABLE ample AS SELECT id, r.* FROM rays, abacus_ray('holes', ARRAY[x, y], ARRAY[dx, dy]) AS r;
SET LOCAL abacus.cache_size = '1MB';
SELECT bag_eq('SELECT id, r.* FROM rays, abacus_ray(''holes'', ARRAY[x, y], ARRAY[dx, dy]) AS r', 'TABLE ample', 'with a small cache');
RESET abacus.cache_size;

-- profiles
SELECT is((SELECT count(*) FROM rays, abacus_profile('field', ARRAY[x, y, x + dx, y + dy]) AS p
    WHERE abs(p.value - abacus_interpolate('field', p.x, p.y)) > 1e-9), 0::bigint, 'values of profiles');
SELECT is((SELECT count(*) FROM rays, abacus_profile('solid', ARRAY[x, y, z, x + dx, y + dy, z + dz]) AS p
    WHERE abs(p.value - abacus_interpolate('solid', p.x, p.y, p.z)) > 1e-9), 0::bigint, '... in space');
SELECT is((SELECT count(*) FROM rays, abacus_profile('holes', ARRAY[x, y, x + dx, y + dy]) AS p WHERE p.value IS NOT NULL),
    (SELECT sum(n)::bigint FROM (SELECT id, count(*) + count(*) FILTER (WHERE starts IS DISTINCT FROM ends) AS n
        FROM (SELECT id, enters AS starts, lag(leaves) OVER (PARTITION BY id ORDER BY enters, leaves) AS ends
              FROM rays, abacus_ray('holes', ARRAY[x, y], ARRAY[dx, dy]) WHERE enters < 1) AS r GROUP BY id) AS t), 'a row for each end of a piece');

-- rasters
CREATE FUNCTION pg_temp.different(mesh regclass, method text, outside text) RETURNS bigint LANGUAGE sql AS
$$ SELECT count(*) FROM abacus_raster(mesh, '{-0.1, -0.1}', '{1.1, 1.2}', 60, 50, 'height', method, outside) AS r, unnest(r."values") WITH ORDINALITY AS u (v, i)
   WHERE v IS DISTINCT FROM abacus_interpolate(mesh, -0.1::float8 + (i - 0.5) * (1.1::float8 - -0.1::float8) / 60, 1.2::float8 - ("row" + 0.5) * (1.2::float8 - -0.1::float8) / 50, 'height', method, outside) $$;
SELECT is(pg_temp.different(mesh::regclass, method, outside), 0::bigint, format('raster of %s, %s, %s', mesh, method, outside))
FROM unnest('{field,holes}'::text[]) mesh, unnest('{linear,nearest,natural}'::text[]) method, unnest('{null,nearest}'::text[]) outside WHERE (mesh, method) <> ('holes', 'natural');
SET LOCAL work_mem = '64kB';
SELECT is(pg_temp.different('field', 'linear', 'null'), 0::bigint, 'in bands');
DECLARE tall CURSOR FOR SELECT abacus_raster('field', '{0, 0}', '{1, 1}', 10, 2000000000);
FETCH 1 FROM tall;
SELECT pass('a cursor takes what it reads');
CLOSE tall;
RESET work_mem;

-- estimates
CREATE FUNCTION pg_temp.expected(query text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan json;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
    RETURN plan -> 0 -> 'Plan' ->> 'Plan Rows';
END $$;
SELECT is(pg_temp.expected($$ SELECT * FROM abacus_raster('field', '{0, 0}', '{1, 1}', 10, 77) $$), 77::float8, 'rows of a raster');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_ray('field', '{-1, 0.4}', '{1, 0.1}') $$) / (SELECT count(*) FROM abacus_ray('field', '{-1, 0.4}', '{1, 0.1}')),
    '<', 2::float8, 'rows of a ray: not too many');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_profile('field', '{-1, 0.4, 2, 0.7}') $$) / (SELECT count(*) FROM abacus_ray('field', '{-1, 0.4}', '{1, 0.1}')),
    '>', 0.5::float8, '... nor too few');

-- lines do not depend on the history of a mesh, to the last bit
CREATE FUNCTION pg_temp.halton(i integer, base integer) RETURNS float8 LANGUAGE sql IMMUTABLE AS $$
    SELECT sum((i / (base ^ k)::integer % base) / (base ^ (k + 1))) FROM generate_series(0, 9) AS k $$;
CREATE TEMP TABLE crowd AS SELECT i AS id, pg_temp.halton(i, 2) AS x, pg_temp.halton(i, 3) AS y, pg_temp.halton(i, 5) AS z, sin(i) AS value
    FROM generate_series(1, 3000) AS i;
SELECT abacus_triangulate('crowded', 'TABLE crowd', '{value}', 3) > 0;
SELECT abacus_triangulate('grown', 'SELECT * FROM crowd WHERE id % 3 > 0 ORDER BY sin(id)', '{value}', 3) > 0;
SELECT abacus_insert('grown', 'SELECT * FROM crowd WHERE id % 3 = 0') = 1000;
SELECT results_eq($$ SELECT (enters, leaves, v0, v1, v2, v3)::text FROM generate_series(1, 9) AS i, abacus_ray('grown', '{0, 0, 0}', ARRAY[1, i / 10.0, 1 / (1.0 + i)]) AS r $$,
    $$ SELECT (enters, leaves, v0, v1, v2, v3)::text FROM generate_series(1, 9) AS i, abacus_ray('crowded', '{0, 0, 0}', ARRAY[1, i / 10.0, 1 / (1.0 + i)]) AS r $$,
    'rays through a mesh that has grown');
SELECT results_eq($$ SELECT p::text FROM abacus_profile('grown', '{0, 0, 0, 0.9, 0.7, 0.3, 0.1, 0.8, 0.9}') AS p $$,
    $$ SELECT p::text FROM abacus_profile('crowded', '{0, 0, 0, 0.9, 0.7, 0.3, 0.1, 0.8, 0.9}') AS p $$, '... and profiles');

-- a cancelled statement ends soon
CREATE FUNCTION pg_temp.is_cancelled(query text) RETURNS boolean LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE query;
    RETURN false;
EXCEPTION WHEN query_canceled THEN
    RETURN true;
END $$;
SET LOCAL statement_timeout = '300ms';
SELECT ok(pg_temp.is_cancelled($$ SELECT count(*) FROM abacus_raster('field', '{0, 0}', '{1, 1}', 20000, 20000) $$), 'cancelled');
RESET statement_timeout;

-- privileges
CREATE ROLE walker;
SET LOCAL ROLE walker;
SELECT throws_ok($$ SELECT * FROM abacus_ray('field', '{0, 0}', '{1, 1}') $$, '42501', NULL, 'a ray needs a privilege');
SELECT throws_ok($$ SELECT * FROM abacus_profile('field', '{0, 0, 1, 1}') $$, '42501', NULL, 'so does a profile');
SELECT throws_ok($$ SELECT * FROM abacus_visible('field', '{0, 0}', '{1, 1}') $$, '42501', NULL, '... a line of sight');
SELECT throws_ok($$ SELECT * FROM abacus_raster('field', '{0, 0}', '{1, 1}', 2, 2) $$, '42501', NULL, '... a raster');
RESET ROLE;
SELECT * FROM finish();
ROLLBACK;

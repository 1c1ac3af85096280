-- Meshes that outgrow their domain, seen by the session that changes them.
BEGIN;
SELECT plan(20);

CREATE FUNCTION pg_temp.figure(mesh regclass, figure text) RETURNS numeric LANGUAGE sql AS
    $$ SELECT value::numeric FROM abacus_stats(mesh) WHERE name = figure $$;
-- Deterministic, all different on each axis.
CREATE FUNCTION pg_temp.points(first int, last int, corner float8, edge float8)
    RETURNS TABLE (id int, x float8, y float8, height float8) LANGUAGE sql AS
    $$ SELECT i, corner + edge * (i::bigint * 7919 % 10007) / 10007.0, corner + edge * (i::bigint * 104729 % 10009) / 10009.0, i / 8.0
       FROM generate_series(first, last) AS i $$;
CREATE TABLE points (id int PRIMARY KEY, x float8, y float8, height float8);
SELECT abacus_create('tracked', 2, '{height}');
SELECT abacus_track('tracked', 'points');
CREATE FUNCTION pg_temp.is_that_of_the_points(which text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_triangulate('fresh', 'SELECT id, x, y, height FROM points ORDER BY id');
    RETURN NEXT set_eq('SELECT v0, v1, v2 FROM abacus_simplices(''tracked'')',
                       'SELECT v0, v1, v2 FROM abacus_simplices(''fresh'')', which || ': the simplices');
    RETURN NEXT set_eq('SELECT id, x, y, attributes, vertex FROM abacus_vertices(''tracked'')',
                       'SELECT id, x, y, attributes, vertex FROM abacus_vertices(''fresh'')', which || ': the points');
    RETURN NEXT is_empty('SELECT * FROM abacus_check(''tracked'')', which || ': the check');
    DROP TABLE fresh;
END $$;

-- Row by row, from nothing.
DO $$
DECLARE
    p record;
BEGIN
    FOR p IN SELECT * FROM pg_temp.points(1, 200, 0, 1) LOOP
        INSERT INTO points VALUES (p.id, p.x, p.y, p.height);
    END LOOP;
END $$;
SELECT cmp_ok(pg_temp.figure('tracked', 'outside'), '<', 100::numeric, 'row by row: the domain has grown');
SELECT pg_temp.is_that_of_the_points('row by row');

-- A change that is rolled back, with the session's data in memory.
SELECT is((SELECT count(*) FROM points, abacus_locate('tracked', x, y) WHERE code IS NOT NULL), 200::bigint, 'all are found before');
SAVEPOINT before;
INSERT INTO points SELECT * FROM pg_temp.points(1001, 1500, -20, 50);
INSERT INTO points SELECT id + 2000, x, y, height FROM points WHERE id <= 20; -- repeated
SELECT is(pg_temp.figure('tracked', 'outside'), 0::numeric, 'many outside: another domain');
SELECT is(pg_temp.figure('tracked', 'duplicates'), 20::numeric, 'repeated points are kept');
SELECT is((SELECT count(*) FROM points, abacus_locate('tracked', x, y) WHERE code IS NOT NULL), 720::bigint, 'all are found after');
SELECT pg_temp.is_that_of_the_points('many outside');
ROLLBACK TO before;
SELECT is((SELECT count(*) FROM points, abacus_locate('tracked', x, y) WHERE code IS NOT NULL), 200::bigint, 'and after it was undone');
SELECT pg_temp.is_that_of_the_points('undone');

-- Staged points count as well.
SELECT abacus_untrack('tracked', 'points');
SELECT abacus_stage('tracked', 'SELECT * FROM pg_temp.points(3001, 3300, 1000, 2000)');
SELECT cmp_ok(pg_temp.figure('tracked', 'outside'), '>=', 300::numeric, 'staged points are outside');
SELECT abacus_triangulate('tracked');
SELECT is(pg_temp.figure('tracked', 'outside'), 0::numeric, 'no longer when they are in the mesh');
SELECT is_empty($$ SELECT * FROM abacus_check('tracked') $$, 'which is sound');

-- A distant point is left outside.
SELECT abacus_insert('tracked', 'VALUES (1, 1e300::float8, -1e300::float8, NULL::float8)');
SELECT is(pg_temp.figure('tracked', 'outside'), 1::numeric, 'a single point far away');
SELECT isnt((SELECT code FROM abacus_locate('tracked', 1e300, -1e300)), NULL, 'it is found');

SELECT * FROM finish();
ROLLBACK;

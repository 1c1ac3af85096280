-- Threads that distribute points while the query is read end with the statement, however that ends.
BEGIN;
SELECT plan(9);
SET LOCAL maintenance_work_mem = '4MB';
SET LOCAL abacus.threads = 3;
SET LOCAL client_min_messages = warning;
CREATE FUNCTION pg_temp.threads() RETURNS int LANGUAGE sql AS
$$ SELECT (regexp_match(pg_read_file('/proc/self/status'), 'Threads:\s+(\d+)'))[1]::int $$;
CREATE FUNCTION pg_temp.points(n int, bad int) RETURNS text LANGUAGE sql AS
$$ SELECT format('SELECT i::bigint AS id, i * 0.7548776662466927 %% 1 AS x, i * 0.5698402909980532 %% 1 + 0 / (i - %s) AS y FROM generate_series(1, %s) AS i', bad, n) $$;

SELECT throws_ok(format('SELECT abacus_triangulate(%L, %L)', 'fails', pg_temp.points(150000, 140000)), '22012', NULL, 'the query fails late');
SELECT is(pg_temp.threads(), 1, 'no thread is left');
SELECT lives_ok($$ DO $do$ BEGIN FOR i IN 1..5 LOOP
    BEGIN PERFORM abacus_triangulate('fails', pg_temp.points(150000, 100000 + i)); EXCEPTION WHEN division_by_zero THEN NULL; END;
END LOOP; END $do$ $$, 'and again, in subtransactions');
SELECT is(pg_temp.threads(), 1, 'no thread is left then');
SELECT lives_ok(format('SELECT abacus_triangulate(%L, %L)', 'whole', pg_temp.points(150000, 0)), 'the same query without a failure');
SELECT is(pg_temp.threads(), 1, 'no thread is left in the end');
SELECT is_empty($$ SELECT * FROM abacus_check('whole') $$, 'the mesh is right');
-- A query that itself starts threads, while others distribute its rows
SELECT lives_ok($$ SELECT abacus_triangulate('nested', 'SELECT id, x, y FROM (' || pg_temp.points(120000, 0) || ') AS p
    WHERE (abacus_locate(''whole'', 0.5, 0.5)).code IS NOT NULL') $$, 'a query that reads another mesh');
SET LOCAL abacus.threads = 1;
SELECT abacus_triangulate('alone', pg_temp.points(120000, 0));
SELECT is_empty($$ (SELECT v0, v1, v2 FROM abacus_simplices('nested') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('alone'))
    UNION ALL (SELECT v0, v1, v2 FROM abacus_simplices('alone') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('nested')) $$, 'makes the mesh of one thread');
SELECT * FROM finish();
ROLLBACK;

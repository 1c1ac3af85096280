-- Several threads check meshes and locate many places: the same answers, and a clean end whatever ends them.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;

CREATE TABLE points AS
SELECT i AS id, (i * 7919) % 1009 + i / 1009.0 AS x, (i * 104729) % 997 AS y, (i * 37) % 101 AS z FROM generate_series(1, 3000) i;
CREATE TABLE places AS
SELECT i AS id, (i * 337) % 1021 + i / 991.0 AS x, (i * 557) % 1003 + 0.25 AS y, (i * 13) % 97 AS z FROM generate_series(1, 700) i;
SELECT abacus_triangulate('plane', 'SELECT id, x, y, z AS height FROM points');
SELECT abacus_triangulate('space', 'SELECT id, x, y, z FROM points WHERE id <= 1000', dimension => 3);
SET LOCAL abacus.cache_size = '1MB';
SET LOCAL abacus.tiny_intervals = on;

-- threads of this process, after those that have just ended are gone
CREATE FUNCTION pg_temp.threads() RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE n bigint;
BEGIN
    FOR tries IN 1 .. 100 LOOP
        n := (SELECT count(*) FROM pg_ls_dir('/proc/self/task'));
        EXIT WHEN n = 1;
        PERFORM pg_sleep(0.01);
    END LOOP;
    RETURN n;
END $$;

-- the rows of a query in order, with this many threads
CREATE FUNCTION pg_temp.answer(query text, n int) RETURNS text[] LANGUAGE plpgsql AS $$
DECLARE answer text[];
BEGIN
    PERFORM set_config('abacus.threads', n::text, false);
    EXECUTE format('SELECT array_agg(q::text) FROM (%s) q', query) INTO answer;
    RETURN answer;
END $$;
CREATE FUNCTION pg_temp.same(query text, name text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE alone text[] := pg_temp.answer(query, 1);
BEGIN
    RETURN NEXT cmp_ok(cardinality(alone), '>=', 1, name || ': there are answers');
    FOR n IN 2 .. 7 LOOP
        CONTINUE WHEN n IN (5, 6);
        RETURN NEXT ok(pg_temp.answer(query, n) = alone, format('%s: the same by %s threads', name, n));
    END LOOP;
    RETURN NEXT is(pg_temp.threads(), 1::bigint, name || ': no thread is left');
END $$;
SELECT pg_temp.same($$ SELECT * FROM abacus_locate('plane', 'SELECT id, x, y FROM places') $$, 'locate in the plane');
SELECT pg_temp.same($$ SELECT * FROM abacus_locate('space', 'SELECT id, x, y, z FROM places') $$, 'locate in space');
SELECT pg_temp.same($$ SELECT * FROM abacus_interpolate('plane', 'SELECT id, x, y FROM places') $$, 'linear');
SELECT pg_temp.same($$ SELECT * FROM abacus_interpolate('plane', 'SELECT id, x, y FROM places', method => 'natural') $$, 'natural');
SELECT pg_temp.same($$ SELECT * FROM abacus_nearest('plane', 'SELECT id, x, y FROM places', 4) $$, 'nearest');
SELECT pg_temp.same($$ SELECT * FROM abacus_weights('plane', 'SELECT id, x, y FROM places', method => 'natural') $$, 'weights');
SELECT pg_temp.same($$ SELECT * FROM abacus_raster('plane', '{0, 0}', '{900, 900}', 30, 20, method => 'natural') $$, 'pixels');

-- faults
SELECT pg_temp.same($$ SELECT count(*) FROM (SELECT * FROM abacus_check('plane') UNION ALL SELECT * FROM abacus_check('space')) f $$,
                    'check of sound meshes');
SAVEPOINT sound;
UPDATE plane SET page = overlay(page::bytea PLACING '\x55' FROM 700)::abacus_page WHERE code > (SELECT percentile_disc(0.6) WITHIN GROUP (ORDER BY code) FROM plane);
SELECT pg_temp.same($$ SELECT * FROM abacus_check('plane') $$, 'check of damaged pages');
SELECT pg_temp.same($$ SELECT * FROM abacus_check('plane', 2) $$, 'the first two faults');
ROLLBACK TO sound;
DELETE FROM space WHERE code = (SELECT percentile_disc(0.4) WITHIN GROUP (ORDER BY code) FROM space);
SELECT pg_temp.same($$ SELECT * FROM abacus_check('space') $$, 'check without a page');
ROLLBACK TO sound;

-- any call of the database may fail
SET LOCAL abacus.threads = 3;
CREATE FUNCTION pg_temp.inject(query text, expected text[]) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    n int := 0;
    failures int := 0;
    answer text[];
    sound boolean := true;
BEGIN
    WHILE answer IS NULL LOOP
        n := n + 1 + n / 8;
        BEGIN
            PERFORM set_config('abacus.fail_host_call', n::text, false);
            answer := pg_temp.answer(query, 3);
        EXCEPTION WHEN io_error OR out_of_memory THEN
            failures := failures + 1;
            sound := sound AND pg_temp.threads() = 1;
        END;
        PERFORM set_config('abacus.fail_host_call', '0', false);
    END LOOP;
    RETURN NEXT cmp_ok(failures, '>', 15, format('it fails, up to call %s', n));
    RETURN NEXT ok(sound, 'each time no thread is left');
    RETURN NEXT ok(answer = expected, 'and then it answers');
    RETURN NEXT is((SELECT count(*) FROM abacus_progress WHERE pid = pg_backend_pid()), 0::bigint, 'and its progress has ended');
END $$;
SELECT pg_temp.inject($$ SELECT * FROM abacus_locate('plane', 'SELECT id, x, y FROM places') $$,
                      pg_temp.answer($$ SELECT * FROM abacus_locate('plane', 'SELECT id, x, y FROM places') $$, 1));
SELECT pg_temp.inject($$ SELECT count(*) FROM abacus_check('plane') $$, ARRAY['(0)']);

-- a timeout while threads are at work
CREATE FUNCTION pg_temp.fails(command text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN 'succeeds';
EXCEPTION WHEN OTHERS OR query_canceled THEN
    RETURN SQLSTATE;
END $$;
SET LOCAL abacus.threads = 1;
SELECT abacus_triangulate('wide', 'SELECT i, (i * 7919) % 60013 + i / 60013.0, i::bigint * 104729 % 59999 FROM generate_series(1, 60000) i');
SET LOCAL abacus.threads = 3;
SET LOCAL statement_timeout = '30ms';
SELECT is(pg_temp.fails($$ SELECT * FROM abacus_check('wide') $$), '57014', 'a check that takes too long');
SELECT is(pg_temp.fails($$ SELECT * FROM abacus_locate('wide', 'SELECT i, i, i FROM generate_series(1, 60000) i') $$), '57014',
          'a location that takes too long');
SET LOCAL statement_timeout = 0;
SELECT is(pg_temp.threads(), 1::bigint, 'no thread is left');

-- counts of builds
SELECT is((SELECT sum(value) FROM abacus_stats('wide') WHERE name IN ('passes', 'put_off', 'waited_ns')), 0::float8, 'one thread has no passes');
SELECT abacus_triangulate('shared', 'SELECT id, x, y FROM points');
SELECT ok((SELECT bool_and(value > 0) FROM abacus_stats('shared') WHERE name IN ('passes', 'put_off', 'waited_ns')), 'several have');

-- repeatedly: memory is freed
CREATE FUNCTION pg_temp.resident() RETURNS bigint LANGUAGE sql AS
    $$ SELECT (split_part(s, ' ', 2)::bigint - split_part(s, ' ', 3)::bigint) * 4
       FROM pg_read_file('/proc/self/statm', 0, 100) s $$; -- private memory, kB
CREATE FUNCTION pg_temp.abort(times int) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE aborted bigint := 0;
BEGIN
    FOR n IN 1 .. times LOOP
        BEGIN
            PERFORM set_config('abacus.fail_host_call', (1 + n * 7 % 90)::text, false);
            CASE n % 4
                WHEN 0 THEN PERFORM abacus_check('plane');
                WHEN 1 THEN PERFORM abacus_locate('plane', 'SELECT id, x, y FROM places LIMIT 200');
                ELSE PERFORM abacus_triangulate('aborted', 'SELECT id, x, y FROM points LIMIT 150');
            END CASE;
            RAISE division_by_zero;
        EXCEPTION
            WHEN io_error OR out_of_memory THEN aborted := aborted + 1;
            WHEN division_by_zero THEN NULL;
        END;
        PERFORM set_config('abacus.fail_host_call', '0', false);
    END LOOP;
    RETURN aborted;
END $$;
SELECT cmp_ok(pg_temp.abort(100), '>', 50::bigint, 'most are aborted');
CREATE TEMP TABLE resident AS SELECT pg_temp.resident() AS kb;
SELECT cmp_ok(pg_temp.abort(1000), '>', 500::bigint, 'again');
SELECT cmp_ok(pg_temp.resident() - (SELECT kb FROM resident), '<', 8192::bigint, '1,000 aborted builds, checks and locations leak nothing');
SELECT is(pg_temp.threads(), 1::bigint, 'and leave no thread');

SELECT * FROM finish();
ROLLBACK;

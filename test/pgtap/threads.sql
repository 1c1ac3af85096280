-- Threads end with the statement, whatever ends it: an error of the database, a cancel, a timeout. No change
-- is incomplete, nothing is left behind, and the session still works.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;

CREATE TABLE points AS
SELECT i AS id, (i * 7919) % 1009 + i / 1009.0 AS x, (i * 104729) % 997 AS y, i AS height FROM generate_series(1, 3000) i;
SET LOCAL abacus.threads = 3;
SET LOCAL abacus.tiny_intervals = on;
SET LOCAL abacus.cache_size = '1MB';

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
CREATE FUNCTION pg_temp.fails(command text, state text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN 'succeeds';
EXCEPTION WHEN OTHERS OR query_canceled THEN
    RETURN SQLSTATE;
END $$;

SELECT abacus_triangulate('field', 'SELECT * FROM points WHERE id <= 1000');
CREATE TEMP TABLE before AS SELECT * FROM abacus_simplices('field');

CREATE FUNCTION pg_temp.inject(change text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    n int := 0;
    failures int := 0;
    done boolean := false;
    sound boolean := true;
BEGIN
    WHILE NOT done LOOP
        n := n + 1 + n / 20;
        BEGIN
            PERFORM set_config('abacus.fail_host_call', n::text, false);
            EXECUTE change;
            done := true;
            PERFORM set_config('abacus.fail_host_call', '0', false);
        EXCEPTION WHEN io_error OR out_of_memory THEN
            PERFORM set_config('abacus.fail_host_call', '0', false);
            failures := failures + 1;
            sound := sound AND pg_temp.threads() = 1
                AND NOT EXISTS (SELECT FROM abacus_simplices('field') EXCEPT SELECT FROM before);
        END;
    END LOOP;
    RETURN NEXT cmp_ok(failures, '>', 50, format('a change fails, up to call %s, and then succeeds', n));
    RETURN NEXT ok(sound, 'each time no thread is left, and the mesh is as it was');
END $$;
SELECT pg_temp.inject($$ SELECT abacus_insert('field', 'SELECT * FROM points WHERE id > 1000') $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh is sound');
TRUNCATE before;
INSERT INTO before SELECT * FROM abacus_simplices('field');
SELECT pg_temp.inject($$ SELECT abacus_delete('field', 'SELECT * FROM points WHERE id > 1000') $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh is sound');

-- a timeout while threads are at work
CREATE TABLE many AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 40000) i;
SET LOCAL statement_timeout = '300ms';
SELECT is(pg_temp.fails($$ SELECT abacus_triangulate('timed', 'TABLE many') $$, '57014'), '57014', 'a timeout');
SET LOCAL statement_timeout = 0;
SELECT is(pg_temp.threads(), 1::bigint, 'no thread is left');

-- repeatedly: memory is freed
CREATE FUNCTION pg_temp.resident() RETURNS bigint LANGUAGE sql AS
    $$ SELECT (split_part(s, ' ', 2)::bigint - split_part(s, ' ', 3)::bigint) * 4
       FROM pg_read_file('/proc/self/statm', 0, 100) s $$; -- private memory, kB
CREATE FUNCTION pg_temp.abort(times int) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    FOR n IN 1 .. times LOOP
        BEGIN
            PERFORM set_config('abacus.fail_host_call', (100 + n % 200)::text, false);
            PERFORM abacus_insert('field', 'SELECT id + 5000, x + 0.5, y, height FROM points WHERE id <= 300');
            RAISE io_error;
        EXCEPTION WHEN io_error OR out_of_memory THEN NULL;
        END;
        PERFORM set_config('abacus.fail_host_call', '0', false);
    END LOOP;
END $$;
SELECT pg_temp.abort(100);
CREATE TEMP TABLE resident AS SELECT pg_temp.resident() AS kb;
SELECT pg_temp.abort(900);
SELECT cmp_ok(pg_temp.resident() - (SELECT kb FROM resident), '<', 8192::bigint, '1,000 aborted changes leak nothing');
SELECT is(pg_temp.threads(), 1::bigint, 'and leave no thread');

SELECT * FROM finish();
ROLLBACK;

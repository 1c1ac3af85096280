-- Segments fixed by several threads: the mesh and the errors are those of one thread.
BEGIN;
SELECT no_plan();

SELECT setseed(0.5);
CREATE TABLE point AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 4000) AS i;
SELECT abacus_triangulate('coarse', 'SELECT * FROM point WHERE id % 4 = 0');
-- edges of the coarse mesh, which cross many triangles of the fine one, and points inside every tenth of them
CREATE TABLE segment AS SELECT row_number() OVER (ORDER BY v0, v1) AS line, v0, v1 FROM abacus_edges('coarse') ORDER BY v0, v1;
CREATE TABLE corner AS SELECT line, 1 AS position, v0 AS point FROM segment UNION ALL SELECT line, 2, v1 FROM segment;

CREATE FUNCTION pg_temp.lined(name text, threads int) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    SET LOCAL abacus.threads = 1;
    PERFORM abacus_triangulate(name, 'TABLE point');
    PERFORM set_config('abacus.threads', threads::text, true), set_config('abacus.tiny_intervals', (threads > 1)::text, true), set_config('abacus.cache_size', '1MB', true);
    PERFORM abacus_constrain(name, 'TABLE corner');
    RETURN md5((SELECT string_agg(s::text, ';' ORDER BY s) FROM (SELECT v0, v1, v2 FROM abacus_simplices(name::regclass)) AS s)
            || (SELECT string_agg(e::text, ';' ORDER BY e) FROM abacus_edges(name::regclass, fixed => true) AS e));
END $$;
SELECT is(pg_temp.lined('by_' || n, n), pg_temp.lined('alone_' || n, 1), n || ' threads') FROM unnest(ARRAY[2, 3, 7]) AS n;
SELECT is((SELECT count(*) FROM abacus_edges('by_3', fixed => true)), (SELECT count(*) FROM segment), 'every segment is an edge');
SELECT is_empty($$ SELECT * FROM abacus_check('by_3') $$, 'a sound mesh');
SELECT cmp_ok((SELECT value FROM abacus_stats('by_3') WHERE name = 'passes'), '>=', 2::float8, 'threads have fixed them, and again what they put off');
SELECT cmp_ok((SELECT value FROM abacus_stats('by_3') WHERE name = 'put_off'), '>', 0::float8, 'some segments leave an interval');
SELECT is((SELECT value FROM abacus_stats('alone_3') WHERE name = 'passes'), 0::float8, 'one thread makes no pass');

-- crossings are reported as by one thread, and change nothing
CREATE FUNCTION pg_temp.crossing(name text, threads int) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    detail text;
BEGIN
    PERFORM set_config('abacus.threads', threads::text, true), set_config('abacus.tiny_intervals', (threads > 1)::text, true);
    PERFORM abacus_constrain(name, 'SELECT line + 100000, position, point FROM corner UNION ALL SELECT 200000 + n, k, (ARRAY[4 * n, 4 * n + 2001])[k]
        FROM generate_series(1, 300) AS n, generate_series(1, 2) AS k');
    RETURN 'no crossing';
EXCEPTION WHEN invalid_parameter_value THEN
    GET STACKED DIAGNOSTICS detail = PG_EXCEPTION_DETAIL;
    RETURN SQLERRM || ' ' || detail;
END $$;
SELECT matches(pg_temp.crossing('by_2', 3), '^lines cross There are [0-9]{4,} crossings; these are the first ten:', 'several threads report crossings');
SELECT is(pg_temp.crossing('by_2', 7), pg_temp.crossing('alone_2', 1), 'the same as one thread');
SELECT is_empty($$ SELECT * FROM abacus_check('by_2') $$, 'nothing has changed');
SELECT is((SELECT count(*) FROM abacus_edges('by_2', fixed => true)), (SELECT count(*) FROM segment), 'no edge more');

SELECT * FROM finish();
ROLLBACK;

-- The fixed edges of windows: those of all lines that meet the window, found without reading the table of lines.
BEGIN;
SELECT no_plan();

CREATE TABLE point AS SELECT i AS id, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y FROM generate_series(1, 3000) AS i
    UNION ALL SELECT 10000 + i, i / 50.0, 0.5 FROM generate_series(0, 50) AS i;
SELECT abacus_triangulate('field', 'TABLE point') > 0 AS made;
-- a long line through many vertices, parts of it once more, and the other way; short lines, each an edge
SELECT abacus_constrain('field', 'VALUES (100000, 1, 10000), (100000, 2, 10050), (100001, 1, 10030), (100001, 2, 10010), (100002, 1, 10010), (100002, 2, 10011), (100002, 3, 10040)');
SELECT abacus_constrain('field', 'VALUES (100003, 1, 10005), (100003, 2, 10025)', kind => 'soft');
SELECT abacus_constrain('field', 'SELECT n, p, CASE p WHEN 1 THEN v0 ELSE v1 END FROM (SELECT row_number() OVER () AS n, v0, v1 FROM abacus_edges(''field'') WHERE v0 % 3 = 0) AS e, generate_series(1, 2) AS p', kind => 'soft') > 0 AS short;

CREATE FUNCTION pg_temp.same(what text, "window" text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    RETURN NEXT results_eq(format('SELECT * FROM abacus_edges(''field'', %s, fixed => true) ORDER BY v0, v1', "window"),
        format('SELECT f.* FROM abacus_edges(''field'', fixed => true) AS f WHERE (v0, v1) IN (SELECT v0, v1 FROM abacus_edges(''field'', %s)) ORDER BY v0, v1', "window"), what);
END $$;
SELECT pg_temp.same('a box', $$ '{0.3,0.45}', '{0.4,0.55}' $$);
SELECT pg_temp.same('a box in a corner', $$ '{0,0}', '{0.1,0.1}' $$);
SELECT pg_temp.same('a box of one edge', $$ '{0.505,0.5}', '{0.506,0.5}' $$);
SELECT pg_temp.same('a box without lines', $$ '{0.5000001,0.0000001}', '{0.5000001,0.0000001}' $$);
SELECT pg_temp.same('a ball', $$ '{0.5,0.5}'::float8[], 0.1 $$);
SELECT pg_temp.same('short edges', $$ max_edge => 0.021 $$);
SELECT pg_temp.same('edges too short for the long line', $$ max_edge => 0.019 $$);
SELECT pg_temp.same('short edges in a box', $$ '{0.2,0.2}', '{0.8,0.8}', 0.02 $$);
SELECT pg_temp.same('all', $$ '{-1,-1}', '{2,2}' $$);
SELECT results_eq($$ SELECT v0, v1, lines, kind FROM abacus_edges('field', '{0.505,0.5}', '{0.506,0.5}', fixed => true) $$,
    $$ VALUES (10025::bigint, 10026::bigint, '{100000,100001,100002}'::bigint[], 'hard') $$, 'the lines over an edge');
SELECT results_eq($$ SELECT lines FROM abacus_edges('field', '{0.21,0.5}', '{0.211,0.5}', fixed => true) $$,
    $$ VALUES ('{100000,100001,100002,100003}'::bigint[]) $$, 'one line more');
-- edges that have no room in work_mem are joined
SET LOCAL work_mem = '64kB';
SELECT pg_temp.same('too many for work_mem', $$ '{-1,-1}', '{2,2}' $$);
RESET work_mem;

-- the cost grows with the answer: pages of the table of lines that are read for a window
SELECT abacus_create('many', 2);
SELECT abacus_constrain('many', 'SELECT i, p, NULL, i % 200 + 0.4 * p, i / 200 FROM generate_series(0, 39999) AS i, generate_series(1, 2) AS p') AS lines;
CREATE FUNCTION pg_temp.touched(statement text) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    before bigint;
BEGIN
    before := pg_stat_get_xact_blocks_fetched('many_lines'::regclass);
    EXECUTE statement;
    RETURN pg_stat_get_xact_blocks_fetched('many_lines'::regclass) - before;
END $$;
SELECT cmp_ok(pg_temp.touched($$ SELECT count(*) FROM abacus_edges('many', fixed => true) $$), '>', 400::bigint, 'all lines');
SELECT is((SELECT count(*) FROM abacus_edges('many', '{100.3,50}', '{101.3,51}', fixed => true)), 2::bigint, 'two edges');
SELECT cmp_ok(pg_temp.touched($$ SELECT count(*) FROM abacus_edges('many', '{100.3,50}', '{101.3,51}', fixed => true) $$), '<', 100::bigint, 'of a window of two');

SELECT * FROM finish();
ROLLBACK;

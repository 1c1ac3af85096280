-- What abacus_lines returns is taken back, whatever has become of its points; lines that wait and cross go one by one.
BEGIN;
SELECT no_plan();

CREATE TABLE point AS SELECT 10 * x + y AS id, x, y, x * 0.5 AS h FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y;
SELECT abacus_triangulate('field', 'TABLE point');
-- takes the lines back in several ways, and expects the lines and edges that there were
CREATE FUNCTION pg_temp.taken_back(mesh regclass, what text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    columns text;
BEGIN
    EXECUTE format('CREATE TEMPORARY TABLE given AS SELECT * FROM abacus_lines(%L)', mesh);
    EXECUTE format('CREATE TEMPORARY TABLE had AS SELECT e.*, (SELECT count(*) FROM abacus_vertices(%1$L)) AS points FROM abacus_edges(%1$L, fixed => true) AS e', mesh);
    -- the last names vertices by their places, and so by their ids; what a line has had is given up
    FOREACH columns IN ARRAY '{"point, x, y, part","point, x, y, NULL::float8 AS h, part","NULL, x, y, part"}'::text[] LOOP
        PERFORM abacus_constrain(mesh, format('SELECT line, position, %s FROM given', columns), existing => 'replace');
        IF columns !~ 'NULL,' THEN
            RETURN NEXT results_eq(format('SELECT * FROM abacus_lines(%L)', mesh), 'TABLE given', what || ': ' || columns);
        END IF;
        RETURN NEXT results_eq(format('SELECT e.*, (SELECT count(*) FROM abacus_vertices(%1$L)) FROM abacus_edges(%1$L, fixed => true) AS e', mesh), 'TABLE had', what || ', edges: ' || columns);
        RETURN NEXT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), what || ', sound: ' || columns);
    END LOOP;
    DROP TABLE given, had;
END $$;

-- a repeated point
SELECT abacus_insert('field', 'VALUES (600, 2, 2, 1)');
SELECT abacus_constrain('field', 'VALUES (4, 1, 600), (4, 2, 12), (5, 1, 22), (5, 2, 33)');
-- it goes: its vertex is meant
SELECT is(abacus_delete('field', 'VALUES (600, 2, 2)'), 1::bigint, 'it goes');
SELECT is(abacus_constrain('field', 'SELECT line, position, point FROM abacus_lines(''field'')', existing => 'replace'), 2::bigint, 'ids alone: its place in the line is meant');
SELECT results_eq($$ SELECT point, x, y FROM abacus_lines('field') WHERE line = 4 $$, $$ VALUES (600::bigint, 2::float8, 2::float8), (12, 1, 2) $$, 'the line keeps it');
SELECT is(abacus_constrain('field', 'SELECT line, position, point, x, y FROM abacus_lines(''field'')', existing => 'replace'), 2::bigint, 'ids and places');
SELECT is((SELECT count(*) FROM abacus_vertices('field') WHERE id = 600), 0::bigint, 'it does not come again');
-- and comes elsewhere
SELECT abacus_insert('field', 'VALUES (600, 9, 9, 1)');
SELECT pg_temp.taken_back('field', 'an id that is elsewhere now');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'VALUES (6, 1, 600, 3, 2), (6, 2, 0, 0, 0)') $$, '22023', 'point 600 is at another place in the mesh', 'another place than the lines name');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'VALUES (6, 1, 600, 2, 2), (6, 2, 600, 3, 2)') $$, '22023', 'point 600 is at another place in the mesh', 'one of two places');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'VALUES (6, 1, 700, 2, 2), (6, 2, 700, 3, 2)') $$, '22023', 'point 700 is given with two places', 'unknown at both');
-- the vertex goes, a repeated point takes its place
SELECT abacus_insert('field', 'VALUES (601, 2, 2, 1), (602, 3, 3, 1.5)');
SELECT is(abacus_delete('field', 'VALUES (22, 2, 2), (33, 3, 3)'), 2::bigint, 'vertices that lines name by their ids go, as others are there');
SELECT pg_temp.taken_back('field', 'vertices with other ids');
-- one id at two places
SELECT abacus_insert('field', 'VALUES (500, 8, 8, 1), (500, 8, 9, 1)');
SELECT abacus_constrain('field', 'VALUES (7, 1, NULL, 8, 8), (7, 2, NULL, 8, 9)');
SELECT results_eq($$ SELECT point FROM abacus_lines('field') WHERE line = 7 $$, $$ VALUES (500::bigint), (500) $$, 'a line with one id twice');
SELECT pg_temp.taken_back('field', 'one id at two places');
SELECT is(abacus_constrain('field', 'VALUES (8, 1, 500, 8, 8), (8, 2, 500, 8, 9)'), 1::bigint, 'an id with its place is a point, though the id is elsewhere, too');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'VALUES (9, 1, 500), (9, 2, 0)') $$, '22023', 'several points of the mesh have the id 500', 'not the id alone');
-- into another mesh of the same points
SELECT abacus_triangulate('copy', 'SELECT id, x, y FROM abacus_vertices(''field'') ORDER BY sequence', lines => 'SELECT line, position, NULL, x, y, part FROM abacus_lines(''field'')') > 0 AS made;
SELECT results_eq($$ SELECT lines, length FROM abacus_edges('copy', fixed => true) ORDER BY 1, 2 $$, $$ SELECT lines, length FROM abacus_edges('field', fixed => true) ORDER BY 1, 2 $$, 'a copy');

-- lines that wait
SELECT abacus_create('crossed', 2);
SELECT abacus_stage('crossed', 'SELECT 10 * x + y, x, y FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y WHERE x <> 5 OR y NOT IN (1, 2, 5)');
SELECT abacus_constrain('crossed', 'VALUES (1, 1, 31), (1, 2, 71), (2, 1, 50), (2, 2, 54), (3, 1, 32), (3, 2, 72), (4, 1, 45), (4, 2, 65), (5, 1, 54), (5, 2, 56), (6, 1, 3), (6, 2, 33)');
SELECT throws_ok($$ SELECT abacus_insert('crossed', 'VALUES (500, 20, 20)') $$, '22023', 'lines cross', 'they cannot be built');
SELECT is(abacus_unconstrain('crossed', 'VALUES (4)'), 1::bigint, 'one of two goes, while two others cross');
SELECT is((SELECT count(*) FROM abacus_edges('crossed', fixed => true)), 0::bigint, 'the others wait on');
SELECT throws_ok($$ SELECT abacus_insert('crossed', 'VALUES (500, 20, 20)') $$, '22023', 'lines cross', 'which an insert says');
SELECT is(abacus_constrain('crossed', 'VALUES (7, 1, 8), (7, 2, 28)'), 1::bigint, 'another one waits with them');
SELECT is((SELECT count(*) FROM abacus_crossings('crossed', 'SELECT 1, 1, 1 WHERE false')), 2::bigint, 'the crossings');
SELECT is(abacus_constrain('crossed', 'VALUES (7, 1, 8), (7, 2, 38)', existing => 'replace'), 1::bigint, 'and is replaced');
SELECT is(abacus_unconstrain('crossed', 'VALUES (2)'), 1::bigint, 'the last that crosses');
SELECT results_eq($$ SELECT DISTINCT lines FROM abacus_edges('crossed', fixed => true) ORDER BY 1 $$, $$ VALUES ('{1}'::bigint[]), ('{3}'), ('{5}'), ('{6}'), ('{7}') $$, 'the others have their edges');
SELECT is_empty($$ SELECT * FROM abacus_check('crossed') $$, 'and are sound');
SELECT abacus_triangulate('fresh', 'SELECT id, x, y FROM abacus_vertices(''crossed'')', lines => 'SELECT line, position, point FROM abacus_lines(''crossed'')') > 0 AS made;
SELECT is_empty($$ (SELECT v0, v1, v2 FROM abacus_simplices('crossed') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('fresh')) UNION ALL
                   (SELECT v0, v1, v2 FROM abacus_simplices('fresh') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('crossed')) $$, 'as if they had been given at once');
-- fixed lines go while others wait
SELECT abacus_stage('crossed', 'VALUES (700, 30, 30), (701, 20, 0), (702, 0, 20)');
SELECT abacus_constrain('crossed', 'VALUES (8, 1, 700), (8, 2, 99), (9, 1, 701), (9, 2, 702), (10, 1, 9), (10, 2, 700)');
SELECT is(abacus_unconstrain('crossed', 'VALUES (1), (6)'), 2::bigint, 'fixed lines');
SELECT is_empty($$ SELECT FROM abacus_edges('crossed', fixed => true) WHERE lines && '{1,6}' $$, 'they are free');
SELECT is(abacus_unconstrain('crossed', 'VALUES (9)'), 1::bigint, 'a waiting one');
SELECT isnt_empty($$ SELECT FROM abacus_edges('crossed', fixed => true) WHERE lines = '{10}' $$, 'the others come');
SELECT is_empty($$ SELECT * FROM abacus_check('crossed') $$, 'sound again');
SELECT is(abacus_unconstrain('crossed', 'SELECT line FROM abacus_lines(''crossed'')'), 5::bigint, 'all go');
SELECT abacus_triangulate('bare', 'SELECT id, x, y FROM abacus_vertices(''crossed'')') > 0 AS made;
SELECT is_empty($$ (SELECT v0, v1, v2 FROM abacus_simplices('crossed') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('bare')) $$, 'nothing is left of them');

SELECT * FROM finish();
ROLLBACK;

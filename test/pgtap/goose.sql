-- abacus_goose: the interface; its table and its figures.
BEGIN;
SELECT no_plan();
CREATE EXTENSION IF NOT EXISTS cube;
CREATE EXTENSION abacus_lab;

SELECT has_function('abacus_goose', ARRAY['text', 'text', 'integer'], 'abacus_goose');
SELECT volatility_is('abacus_goose', 'volatile', 'it makes a table');
SELECT isnt(obj_description('abacus_goose(text, text, integer)'::regprocedure), NULL, 'it has a comment');

CREATE TABLE points AS SELECT i AS id, (i * 7919) % 251 AS x, (i * 104729) % 241 AS y, (i * 31337) % 239 AS z FROM generate_series(1, 600) AS i;
CREATE TABLE figures AS SELECT * FROM abacus_goose('flat', 'SELECT id, x, y FROM points');
CREATE FUNCTION pg_temp.figure(text) RETURNS float8 LANGUAGE sql AS $$ SELECT value FROM figures WHERE name = $1 $$;

SELECT columns_are('flat', '{v0,v1,v2,x0,y0,x1,y1,x2,y2,box}'::name[], 'a row a triangle');
SELECT col_type_is('flat', 'box', 'box', 'a box in the plane');
SELECT index_is_type('flat', 'flat_box_idx', 'gist');
SELECT is_empty('SELECT * FROM flat WHERE NOT (flat IS NOT NULL)', 'without a NULL');
SELECT is((SELECT count(*)::float8 FROM flat), pg_temp.figure('simplices'), 'simplices are rows');
SELECT is((SELECT count(DISTINCT (x, y))::float8 FROM points), pg_temp.figure('vertices'), 'vertices are distinct points');
SELECT is(pg_temp.figure('created') - pg_temp.figure('deleted'), pg_temp.figure('simplices') + pg_temp.figure('hull_facets'), 'what was created and not deleted is there');
SELECT is(round((pg_temp.figure('search_percent') + pg_temp.figure('incircle_percent') + pg_temp.figure('delete_percent')
                 + pg_temp.figure('insert_percent') + pg_temp.figure('other_percent'))::numeric, 9), 100::numeric, 'shares add up');
SELECT cmp_ok(pg_temp.figure('other_percent'), '>=', 0::float8, 'none is negative');
SELECT cmp_ok(pg_temp.figure('found_per_search'), '>=', pg_temp.figure('hits_per_search'), 'hits are found');
SELECT cmp_ok(pg_temp.figure('boxes_per_search'), '>=', pg_temp.figure('found_per_search'), 'what is found was looked at');
SELECT is_empty('SELECT name FROM figures WHERE description IS NULL OR value IS NULL', 'all are described');

-- A box contains the circle through the corners: on each side, a part of it.
SELECT is_empty($$
    SELECT * FROM flat WHERE NOT box @> box(polygon(path(ARRAY_TO_STRING(ARRAY[point(x0, y0), point(x1, y1), point(x2, y2)], ',')))) $$,
    'boxes hold the corners');
SELECT is_empty($$
    SELECT f.* FROM flat AS f, points AS p WHERE NOT EXISTS (SELECT FROM flat AS g WHERE g.box && box(point(p.x, p.y), point(p.x, p.y)) AND (p.x, p.y) IN ((x0, y0), (x1, y1), (x2, y2))) $$,
    'each point is a corner of a row found at its place');

SELECT abacus_triangulate('flat_mesh', 'SELECT id, x, y FROM points');
SELECT set_eq('SELECT v0, v1, v2 FROM flat', $$ SELECT v0, v1, v2 FROM abacus_simplices('flat_mesh') $$, 'the triangles of Abacus');
SELECT lives_ok($$ SELECT * FROM abacus_goose('solid', 'TABLE points', dimension => 3) $$, 'in space');
SELECT columns_are('solid', '{v0,v1,v2,v3,x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3,box}'::name[], 'a row a tetrahedron');
SELECT abacus_triangulate('solid_mesh', 'TABLE points', dimension => 3);
SELECT set_eq('SELECT v0, v1, v2, v3 FROM solid', $$ SELECT v0, v1, v2, v3 FROM abacus_simplices('solid_mesh') $$, 'the tetrahedra of Abacus');

-- Nothing else may write the table meanwhile, and an attempt does not crash the server.
CREATE FUNCTION pg_temp.intrude(box text) RETURNS bigint LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE format('INSERT INTO intruded VALUES (1, 2, 3, %L, 0, 1, 0, 0, 1, %L)', 'NaN', box);
    RETURN 1;
END $$;
SELECT throws_ok($$ SELECT * FROM abacus_goose('intruded', 'SELECT CASE WHEN id = 300 THEN pg_temp.intrude(''(-9,-9),(999,999)'') ELSE id END, x, y FROM points') $$,
                 'XX001', NULL, 'a row that is not a simplex');
SELECT hasnt_table('intruded', 'nothing is left');
SELECT throws_ok($$ SELECT * FROM abacus_goose('dropped', 'SELECT id, x, y FROM points WHERE pg_temp.drop_table() IS NULL') $$, '42883', NULL, 'an error of the query');
CREATE FUNCTION pg_temp.drop_table() RETURNS bigint LANGUAGE plpgsql AS $$ BEGIN DROP TABLE dropped; END $$;
SELECT throws_ok($$ SELECT * FROM abacus_goose('dropped', 'SELECT id, x, y FROM points WHERE pg_temp.drop_table() IS NULL') $$, '55006', NULL, 'the table is in use');

-- In parallel workers, functions, triggers and cursors it works like any function.
CREATE FUNCTION pg_temp.twice() RETURNS bigint LANGUAGE plpgsql AS $$
BEGIN
    PERFORM * FROM abacus_goose('inner', 'SELECT id, x, y FROM points');
    BEGIN
        PERFORM * FROM abacus_goose('outer', 'SELECT id, x, y FROM points');
        RAISE division_by_zero;
    EXCEPTION WHEN division_by_zero THEN NULL;
    END;
    RETURN (SELECT count(*) FROM "inner");
END $$;
SELECT is(pg_temp.twice()::float8, pg_temp.figure('simplices'), 'a subtransaction takes its table along');
SELECT hasnt_table('outer', 'and nothing else');
DELETE FROM flat WHERE v0 < 300;
SELECT is((SELECT count(*) FROM flat WHERE box && '(-9999,-9999),(9999,9999)'), (SELECT count(*) FROM flat), 'the index goes on as an index');
SELECT * FROM finish();
ROLLBACK;

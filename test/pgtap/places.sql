-- Many places located by one call: the same answers as one by one, for any memory; and special cases.
BEGIN;
SELECT no_plan();
SELECT setseed(0.25);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 20000) AS id;
SELECT isnt(abacus_triangulate('field', 'SELECT id, x, y, z AS height FROM points', '{height}'), NULL, 'a mesh in the plane, with an attribute');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z FROM points LIMIT 4000', dimension => 3), NULL, 'one in space');

-- inside, outside, on vertices, on facets; ids come back unchanged, even repeated ones
CREATE TABLE places AS
    SELECT (id % 7000)::int AS id, 1.2 * random() - 0.1 AS x, 1.2 * random() - 0.1 AS y, 1.2 * random() - 0.1 AS z FROM generate_series(1, 8000) AS id
    UNION ALL SELECT -id, x, y, z FROM points WHERE id % 20 = 0
    UNION ALL SELECT 10000 + a.id, (a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2 FROM points a JOIN points b ON b.id = a.id + 1 WHERE a.id % 50 = 0
    UNION ALL SELECT 50000, 1e308, -1e308, 0 UNION ALL SELECT 50001, '-0', 0, 0;
-- single calls in one expression: meshes of both dimensions by turns, and rows that are kept
CREATE TABLE located AS
    SELECT id, CASE WHEN id % 3 = 0 THEN 'solid' ELSE 'field' END::regclass AS mesh,
           CASE WHEN id % 3 = 0 THEN abacus_locate('solid', 0.1 + x / 2, 0.1 + y / 2, 0.1 + z / 2) ELSE abacus_locate('field', 0.1 + x / 2, 0.1 + y / 2) END AS simplex
    FROM points WHERE id <= 30;
SELECT results_eq($$ SELECT id, (abacus_walk(mesh, simplex, 1)).* FROM located ORDER BY id $$,
                  $$ SELECT id, (abacus_walk('field', simplex, 1)).* FROM located WHERE mesh = 'field'::regclass
                     UNION ALL SELECT id, (abacus_walk('solid', simplex, 1)).* FROM located WHERE mesh = 'solid'::regclass ORDER BY id $$,
                  'a walk in meshes of both dimensions in turns');
SELECT is((SELECT count(*) FROM located WHERE (simplex).v3 IS NOT NULL), 10::bigint, 'four corners in space');
SELECT results_eq($$ SELECT (unnest(array_agg(abacus_walk(mesh, simplex, 0) ORDER BY id))).* FROM located $$,
                  $$ SELECT (abacus_walk(mesh, simplex, 0)).* FROM located ORDER BY id $$, 'rows that are kept stay as they are');
CREATE FUNCTION pg_temp.one_by_one() RETURNS TABLE (id bigint, code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint) LANGUAGE sql AS
    $$ SELECT p.id, s.* FROM places p LEFT JOIN LATERAL abacus_locate('field', x, y) s ON true $$;
CREATE FUNCTION pg_temp.one_by_one_in_space() RETURNS TABLE (id bigint, code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint) LANGUAGE sql AS
    $$ SELECT p.id, s.* FROM places p LEFT JOIN LATERAL abacus_locate('solid', x, y, z) s ON true $$;
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('field', 'SELECT id, x, y FROM places') $$, $$ SELECT * FROM pg_temp.one_by_one() $$, 'the answers of each, in the plane');
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('solid', 'SELECT id, x, y, z FROM places') $$, $$ SELECT * FROM pg_temp.one_by_one_in_space() $$, 'in space');
SELECT cmp_ok((SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM places') WHERE code IS NULL), '>', 1000::bigint, 'some are outside');
SET LOCAL work_mem = '64kB';
SET LOCAL abacus.cache_size = '1MB';
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('field', 'SELECT id, x, y FROM places') $$, $$ SELECT * FROM pg_temp.one_by_one() $$, 'with little memory, in the plane');
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('solid', 'SELECT id, x, y, z FROM places') $$, $$ SELECT * FROM pg_temp.one_by_one_in_space() $$, 'in space');
RESET work_mem;
RESET abacus.cache_size;
SELECT results_eq($$ SELECT id FROM abacus_locate('field', 'SELECT id, x, z FROM points ORDER BY x') $$,
                  $$ SELECT id FROM abacus_locate('field', 'SELECT id, x, z FROM points ORDER BY z') $$, 'in an order that depends on the places alone');

-- as part of other queries
SELECT is((SELECT count(*) FROM (SELECT abacus_locate('field', 'SELECT id, x, y FROM places') LIMIT 3) AS t), 3::bigint, 'among the columns');
SELECT is((SELECT count(*) FROM (VALUES ('field'), ('field')) AS m (mesh), LATERAL abacus_locate(mesh, 'SELECT 1, 0.5, 0.5')), 2::bigint, 'once a row');
SELECT is((SELECT count(*) FROM abacus_locate('field', $$ SELECT id, 0.5, 0.5 FROM abacus_locate('field', 'SELECT id, x, y FROM places LIMIT 100') $$)), 100::bigint, 'within its own query');
SELECT is((SELECT count(*) FROM abacus_locate('field', NULL)), 0::bigint, 'strict');
SELECT is((SELECT (abacus_walk('field', (code, v0, v1, v2, v3)::abacus_simplex, 0)).v0 IS NOT NULL FROM abacus_locate('field', 'SELECT 1, 0.5, 0.5')), true, 'a simplex to walk from');
PREPARE located AS SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM places') WHERE code IS NOT NULL;
CREATE TEMP TABLE inside AS SELECT count(*) FROM pg_temp.one_by_one() WHERE code IS NOT NULL;
SELECT results_eq('located', 'TABLE inside', 'prepared');

-- the state is that of the snapshot, whatever the query does
CREATE FUNCTION pg_temp.grow(n int) RETURNS int LANGUAGE plpgsql AS $$
BEGIN
    IF n = 500 THEN
        PERFORM abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 2 = 0');
    END IF;
    RETURN n;
END $$;
CREATE TEMP TABLE before AS SELECT * FROM abacus_locate('field', 'SELECT id, x, y FROM points LIMIT 1000');
SAVEPOINT changed;
SELECT throws_ok($$ SELECT * FROM abacus_locate('field', 'SELECT pg_temp.grow(id), x, y FROM points LIMIT 1000') $$, '55006', NULL, 'a query that changes the mesh');
SELECT is(pg_temp.grow(500), 500, 'the mesh changes');
SELECT isnt((SELECT count(*) FROM (SELECT * FROM abacus_locate('field', 'SELECT id, x, y FROM points LIMIT 1000') EXCEPT TABLE before) AS t), 0::bigint, 'which the next call sees');
ROLLBACK TO changed;
SELECT bag_eq($$ SELECT * FROM abacus_locate('field', 'SELECT id, x, y FROM points LIMIT 1000') $$, 'TABLE before', 'unless it is rolled back');
DECLARE answers CURSOR FOR SELECT * FROM abacus_locate('field', 'SELECT id, x, y FROM points LIMIT 1000');
MOVE 1 FROM answers;
SELECT is(abacus_delete('field', 'SELECT id, x, y FROM points WHERE id <= 1000'), 1000::bigint, 'points go');
CREATE FUNCTION pg_temp.rest() RETURNS SETOF before LANGUAGE plpgsql AS $$
DECLARE
    answers refcursor := 'answers';
    answer before;
BEGIN
    LOOP
        FETCH answers INTO answer;
        EXIT WHEN NOT FOUND;
        RETURN NEXT answer;
    END LOOP;
END $$;
CREATE TEMP TABLE rest AS SELECT * FROM pg_temp.rest();
SELECT is((SELECT count(*) FROM rest), 999::bigint, 'a cursor goes on');
SELECT is_empty($$ TABLE rest EXCEPT TABLE before $$, 'with what it began');

-- places that cannot be located
SELECT throws_ok($$ SELECT abacus_locate('field', 'SELECT 1, 0.5') $$, '42804', 'source query returns 2 columns, but the mesh takes 3', 'a column is missing');
SELECT set_eq($$ SELECT * FROM abacus_locate('field', 'SELECT id, x, y, z, NULL, places FROM places') $$,
              $$ SELECT * FROM abacus_locate('field', 'SELECT id, x, y FROM places') $$, 'other columns make no difference');
SELECT throws_ok($$ SELECT abacus_locate('solid', 'SELECT id, x, y FROM places') $$, '42804', NULL, 'z is missing');
SELECT throws_ok($$ SELECT abacus_locate('field', 'SELECT 1, NULL::float8, 1') $$, '22004', 'x of point 1 is NULL', 'a coordinate that is NULL');
SELECT throws_ok($$ SELECT abacus_locate('field', 'SELECT 1, 1, ''NaN''::float8') $$, '22023', 'y of point 1 is not finite', 'one that is no number');
SELECT throws_ok($$ SELECT abacus_locate('field', 'DELETE FROM places RETURNING id, x, y') $$, '22023', NULL, 'a query that is none');
SELECT throws_ok($$ SELECT abacus_locate('field', 'SELECT 1, 1 / 0, 0') $$, '22012', NULL, 'an error of the query');
SELECT throws_ok($$ SELECT abacus_locate('points', 'SELECT 1, 1, 1') $$, '42809', NULL, 'a table that is no mesh');
SELECT is((SELECT count(*) FROM abacus_progress WHERE pid = pg_backend_pid()), 0::bigint, 'none of them goes on');

-- meshes without simplices, and meshes made elsewhere
SELECT isnt(abacus_create('empty', 2), NULL, 'an empty mesh');
SELECT results_eq($$ SELECT * FROM abacus_locate('empty', 'VALUES (1, 0, 0), (2, 3, 4)') ORDER BY id $$,
                  $$ VALUES (1::bigint, NULL::bigint, NULL::bigint, NULL::bigint, NULL::bigint, NULL::bigint, NULL::float8[]), (2, NULL, NULL, NULL, NULL, NULL, NULL) $$, 'all is outside');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('field') WHERE (v0 + v1 + v2) % 9 > 0;
CREATE TABLE corners AS SELECT id, x, y FROM points WHERE id IN (SELECT v0 FROM triangles UNION SELECT v1 FROM triangles UNION SELECT v2 FROM triangles);
SELECT isnt(abacus_load('holes', 'TABLE corners', 'TABLE triangles'), NULL, 'a mesh with holes');
SELECT bag_eq($$ SELECT id, v0, v1, v2 FROM abacus_locate('holes', 'SELECT id, x, y FROM places WHERE id BETWEEN 0 AND 400') $$,
              $$ SELECT p.id::bigint, s.v0, s.v1, s.v2 FROM places p LEFT JOIN LATERAL abacus_locate('holes', x, y) s ON true WHERE id BETWEEN 0 AND 400 $$, 'the answers of each');

-- privileges: the caller's, on the mesh and on the tables that the query reads
CREATE ROLE abacus_surveyor;
GRANT SELECT ON places TO abacus_surveyor;
SET LOCAL ROLE abacus_surveyor;
SELECT throws_ok($$ SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM places') $$, '42501', NULL, 'a mesh that one may not read');
RESET ROLE;
GRANT SELECT ON field TO abacus_surveyor;
SET LOCAL ROLE abacus_surveyor;
SELECT lives_ok($$ SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM places') $$, 'one that one may');
SELECT throws_ok($$ SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM points') $$, '42501', NULL, 'places that one may not');
RESET ROLE;

SELECT * FROM finish();
ROLLBACK;

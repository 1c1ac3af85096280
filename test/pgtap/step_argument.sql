-- A stored step read in place of attributes: the same values, pictures and tiles as of a mesh that has them as attributes; and what is refused.
BEGIN;
SELECT no_plan();
CREATE TABLE points AS SELECT i AS id, (i * 0.7548776662466927 % 1)::float8 AS x, (i * 0.5698402909980532 % 1)::float8 AS y, (i * 0.4301597090019468 % 1)::float8 AS z FROM generate_series(-200, 300) AS i;
CREATE VIEW solution AS SELECT id, x, y, z, sin(5 * x) + y * y AS u, CASE WHEN x > 0.1 THEN x - y END AS w FROM points;
SELECT isnt(abacus_triangulate('plane', 'SELECT id, x, y, z FROM points', '{z}'), NULL, 'a plane');
SELECT isnt(abacus_triangulate('plane_same', 'SELECT id, x, y, u, w FROM solution', '{1,2}'), NULL, 'with the solution as attributes');
SELECT isnt(abacus_triangulate('space', 'SELECT id, x, y, z FROM points', dimension => 3), NULL, 'a space without attributes');
SELECT isnt(abacus_triangulate('space_same', 'SELECT id, x, y, z, u, w FROM solution', '{1,2}', dimension => 3), NULL, 'with the solution');
CREATE FUNCTION pg_temp.store(mesh regclass, step bigint, parts int, wanted text DEFAULT 'u, w') RETURNS bigint LANGUAGE sql AS
    $$ SELECT sum(abacus_store(mesh, step, parts, p, format('SELECT v.id, %s FROM abacus_share_vertices(%L, %s, %s, 0) AS v JOIN solution AS s USING (id) WHERE owner = %s ORDER BY local', wanted, mesh, parts, p, p)))::bigint FROM generate_series(0, parts - 1) AS p $$;
CREATE FUNCTION pg_temp.plan(query text) RETURNS SETOF text LANGUAGE plpgsql AS $$ BEGIN RETURN QUERY EXECUTE 'EXPLAIN (COSTS OFF) ' || query; END $$;
SELECT is(pg_temp.store('plane', 1, 3), 501::bigint, 'a step of the plane');
SELECT is(pg_temp.store('plane', -2, 2, '1'), 501::bigint, 'one with a single value');
SELECT is(pg_temp.store('space', 1, 4), 501::bigint, 'a step of the space');
SELECT is(pg_temp.store('plane_same', 1, 2), 501::bigint, 'the step and the attributes in one mesh, whose pages decide in which order triangles are drawn');

-- values at places, to the last bit
CREATE TABLE places AS SELECT row_number() OVER () AS n, i / 10.0 AS x, j / 10.0 AS y, 0.37 AS z FROM generate_series(-1, 11) AS i, generate_series(-1, 11) AS j UNION ALL SELECT 1000 + id, x, y, z FROM points WHERE id % 10 = 0;
SELECT is_empty(format($$ SELECT * FROM (SELECT n, abacus_interpolate('plane', x, y, '%s', '%s', '%s', step => 1) AS of_step, abacus_interpolate('plane_same', x, y, '%s', '%s', '%s') AS of_attribute FROM places) AS s
                             WHERE of_step IS DISTINCT FROM of_attribute $$, number, method, outside, name, method, outside), format('%s, %s, %s', name, method, outside))
FROM (VALUES (1, '1'), (2, '2')) AS v (number, name), unnest('{linear,natural,nearest}'::text[]) AS method, unnest('{"null",nearest}'::text[]) AS outside;
SELECT results_eq(format($$ SELECT * FROM abacus_interpolate('plane', 'SELECT n, x, y FROM places', '{2,1}', '%s', '%s', step => 1) ORDER BY id $$, method, outside),
                  format($$ SELECT * FROM abacus_interpolate('plane_same', 'SELECT n, x, y FROM places', '{2,1}', '%s', '%s') ORDER BY id $$, method, outside), format('many places, %s, %s', method, outside))
FROM unnest('{linear,natural,nearest}'::text[]) AS method, unnest('{"null",nearest}'::text[]) AS outside;
SELECT is_empty(format($$ SELECT * FROM (SELECT n, abacus_interpolate('space', x, y, z, '%s', '%s', step => 1) AS of_step, abacus_interpolate('space_same', x, y, z, '%s', '%s') AS of_attribute FROM places) AS s
                             WHERE of_step IS DISTINCT FROM of_attribute $$, number, method, name, method), format('in space: %s, %s', name, method))
FROM (VALUES (1, '1'), (2, '2')) AS v (number, name), unnest('{linear,natural,nearest}'::text[]) AS method;
SELECT results_eq($$ SELECT * FROM abacus_interpolate('space', 'SELECT n, x, y, z FROM places', step => 1) ORDER BY id $$, $$ SELECT * FROM abacus_interpolate('space_same', 'SELECT n, x, y, z FROM places') ORDER BY id $$, 'many places in space, all values');
SELECT results_eq($$ SELECT * FROM abacus_interpolate('plane', 'SELECT n, x, y FROM places', '1', step => -2) ORDER BY id $$, $$ SELECT id, CASE WHEN "values" IS NOT NULL THEN '{1}'::float8[] END FROM abacus_interpolate('plane_same', 'SELECT n, x, y FROM places', '1') ORDER BY id $$, 'the only value, by its number');
SELECT is(abacus_interpolate('plane', 0.5, 0.5, step => -2), 1::float8, 'or without');
SELECT is(abacus_interpolate('plane', 0.5, 0.5, '1', within => 'POLYGON((0.4 0.4, 0.6 0.4, 0.6 0.6, 0.4 0.4))', step => 1), abacus_interpolate('plane_same', 0.5, 0.5, '1', within => 'POLYGON((0.4 0.4, 0.6 0.4, 0.6 0.6, 0.4 0.4))'), 'within');
SELECT is(abacus_interpolate('plane', 0.5, 0.5, 'z', step => NULL), abacus_interpolate('plane', 0.5, 0.5), 'no step');
-- with threads, and with little memory
SET LOCAL abacus.threads = 2;
SELECT results_eq($$ SELECT * FROM abacus_interpolate('plane', 'SELECT i, i * 0.618034 % 1, i * 0.414214 % 1 FROM generate_series(1, 20000) AS i', step => 1) ORDER BY id $$,
                  $$ SELECT * FROM abacus_interpolate('plane_same', 'SELECT i, i * 0.618034 % 1, i * 0.414214 % 1 FROM generate_series(1, 20000) AS i') ORDER BY id $$, 'by threads');
RESET abacus.threads;
SET LOCAL abacus.cache_size = '1MB';
SET LOCAL work_mem = '64kB';
SELECT results_eq($$ SELECT * FROM abacus_interpolate('plane', 'SELECT n, x, y FROM places', step => 1) ORDER BY id $$, $$ SELECT * FROM abacus_interpolate('plane_same', 'SELECT n, x, y FROM places') ORDER BY id $$, 'with little memory');
RESET work_mem;
RESET abacus.cache_size;

-- by parallel workers
SET LOCAL parallel_setup_cost = 0;
SET LOCAL parallel_tuple_cost = 0;
SET LOCAL min_parallel_table_scan_size = 0;
SELECT matches((SELECT string_agg(line, ' ') FROM pg_temp.plan('SELECT max(abacus_interpolate(''plane'', x, y, ''1'', step => 1)) FROM places') AS line), 'Gather', 'workers take part');
SELECT is((SELECT max(abacus_interpolate('plane', x, y, '1', step => 1)) FROM places), (SELECT max(abacus_interpolate('plane_same', x, y, '1')) FROM places), 'with the same values');
RESET parallel_setup_cost;
RESET parallel_tuple_cost;
RESET min_parallel_table_scan_size;

-- pictures and tiles, byte for byte
SELECT is(md5(abacus_draw('plane_same', 200, attribute => '1', step => 1)), md5(abacus_draw('plane_same', 200, attribute => '1')), 'a picture');
SELECT isnt(md5(abacus_draw('plane', 200, attribute => '1', step => 1)), md5(abacus_draw('plane', 200, attribute => 'z')), 'another than of the attribute');
SELECT is(md5(abacus_draw('plane', 200, attribute => '2', exaggeration => 1, contours => 0.1, legend => 'u', step => 1)), md5(abacus_draw('plane_same', 200, attribute => '2', exaggeration => 1, contours => 0.1, legend => 'u')), 'with contours and relief');
SELECT is(md5(abacus_draw_section('space', '{0.5,0.5,0.5}', '{1,2,3}', 200, attribute => '2', contours => 0.1, step => 1)), md5(abacus_draw_section('space_same', '{0.5,0.5,0.5}', '{1,2,3}', 200, attribute => '2', contours => 0.1)), 'a section');
SELECT is(md5(abacus_draw_volume('space', width => 100, attribute => '1', step => 1)), md5(abacus_draw_volume('space_same', width => 100, attribute => '1')), 'a volume');
SELECT is(md5(abacus_tile_picture('plane', z, 0, 0, world => '{0,0,1}', attribute => '1', range => '{0,2}', step => 1)), md5(abacus_tile_picture('plane_same', z, 0, 0, world => '{0,0,1}', attribute => '1', range => '{0,2}')), format('a tile at zoom %s', z)) FROM generate_series(0, 4, 2) AS z;
SELECT is(md5(abacus_tile_vector('plane_same', z, 0, 0, world => '{0,0,1}', attribute => '1', contours => 0.2, step => 1)), md5(abacus_tile_vector('plane_same', z, 0, 0, world => '{0,0,1}', attribute => '1', contours => 0.2)), format('a vector tile at zoom %s', z)) FROM generate_series(0, 4, 2) AS z;
SELECT is(md5(abacus_tile_terrain('plane', 1, 0, 0, world => '{0,0,1}', attribute => '1', step => 1)), md5(abacus_tile_terrain('plane_same', 1, 0, 0, world => '{0,0,1}', attribute => '1')), 'heights');
SELECT is(md5(abacus_tile_mesh('plane', 1, 0, 0, '1', world => '{0,0,1}', format => 'glb', step => 1)), md5(abacus_tile_mesh('plane_same', 1, 0, 0, '1', world => '{0,0,1}', format => 'glb')), 'terrain of triangles');
SELECT is(md5(abacus_draw('plane', 200, step => -2)), md5(abacus_draw('plane', 200, attribute => '1', step => -2)), 'the only value is drawn without its number');
-- functions of a step, for tile servers
SELECT is((SELECT count(*) FROM abacus_tiles('plane', world => '{0,0,1}', attribute => '1', step => 1)), 4::bigint, 'four functions');
SELECT is(md5((SELECT tile FROM plane_picture(1, 0, 0, '{}'))), md5(abacus_tile_picture('plane', 1, 0, 0, world => '{0,0,1}', attribute => '1', range => (SELECT ARRAY[min(u), max(u)] FROM solution), step => 1)), 'of its range');
CREATE TABLE tags AS SELECT etag FROM plane_picture(1, 0, 0, '{}') UNION ALL SELECT etag FROM plane_picture(1, 0, 0, '{"step": -2}');
SELECT isnt((SELECT tile FROM plane_picture(1, 0, 0, '{"step": -2}')), (SELECT tile FROM plane_picture(1, 0, 0, '{}')), 'and of another step');
SELECT is(pg_temp.store('plane', 1, 3), 501::bigint, 'stored again');
INSERT INTO tags SELECT etag FROM plane_picture(1, 0, 0, '{}');
SELECT is((SELECT count(DISTINCT etag) FROM tags), 3::bigint, 'ETags differ');

-- labels stay, attributes in pages of their own make no difference
SELECT isnt(abacus_label(mesh, format('SELECT code, v0, v1, v2, v0 %% 5 AS soil FROM abacus_simplices(%L)', mesh)), NULL, 'labels') FROM unnest('{plane,plane_same}'::regclass[]) AS mesh;
SELECT is(pg_temp.store('plane', 1, 3), 501::bigint, 'a step of the mesh with labels');
SELECT is(md5(abacus_draw('plane', 200, attribute => 'soil', step => 1)), md5(abacus_draw('plane_same', 200, attribute => 'soil')), 'a picture of labels');
CREATE FUNCTION pg_temp.many(count int, name text) RETURNS text LANGUAGE sql AS $$ SELECT string_agg(format(name, i), ', ' ORDER BY i) FROM generate_series(1, count) AS i $$;
SELECT isnt(abacus_triangulate('apart', format('SELECT id, x, y, %s FROM points', pg_temp.many(40, 'x * %s')), string_to_array(pg_temp.many(40, 'a%s'), ', ')), NULL, 'attributes apart');
SELECT is(pg_temp.store('apart', 1, 2), 501::bigint, 'a step of that mesh');
SELECT results_eq($$ SELECT * FROM abacus_interpolate('apart', 'SELECT n, x, y FROM places', method => 'nearest', step => 1) ORDER BY id $$, $$ SELECT * FROM abacus_interpolate('plane_same', 'SELECT n, x, y FROM places', method => 'nearest') ORDER BY id $$, 'its values');
SELECT is(md5(abacus_draw('apart', 200, attribute => '1', edges => false, step => 1)), md5(abacus_draw('plane_same', 200, attribute => '1', edges => false)), 'its picture');
-- steps with very many values
SELECT is(pg_temp.store('apart', 2, 1, pg_temp.many(1000, 'u + %s')), 501::bigint, 'a thousand values');
SELECT is_empty($$ SELECT n FROM places WHERE abacus_interpolate('apart', x, y, '1000', 'nearest', step => 2) IS DISTINCT FROM abacus_interpolate('plane_same', x, y, '1', 'nearest') + 1000 $$, 'the last of them');
SELECT is((SELECT array_length("values", 1) FROM abacus_interpolate('apart', 'SELECT 1, 0.5, 0.5', step => 2)), 1000, 'all of them');
SELECT is(pg_temp.store('apart', 3, 1, pg_temp.many(1001, 'u')), 501::bigint, 'one more');
SELECT throws_ok($$ SELECT abacus_interpolate('apart', 0.5, 0.5, '1', step => 3) $$, '54000', 'step 3 has 1001 values at each vertex', 'is too many');
SELECT is(pg_temp.store('apart', 4, 2, 'NULL::float8'), 501::bigint, 'nothing but NULL');
SELECT is(abacus_interpolate('apart', 0.5, 0.5, step => 4), NULL, 'gives NULL');
SELECT is(pg_temp.store('apart', 5, 2, '''Infinity''::float8, ''NaN''::float8'), 501::bigint, 'Infinity and NaN');
SELECT set_eq($$ SELECT "values" FROM apart_steps WHERE step = 5 AND id IS NOT NULL $$, $$ VALUES (ARRAY['Infinity', NULL]::float8[]) $$, 'are kept, and NULL');
SELECT is(abacus_interpolate('apart', 0.5, 0.5, '1', 'nearest', step => 5), 'Infinity'::float8, 'and read');

-- what is refused
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.5, 0.5, '1', step => 9) $$, '42704', 'mesh "plane" has no step 9', 'no such step');
SELECT throws_ok($$ SELECT abacus_draw_volume('space_same', step => 1) $$, '42704', 'mesh "space_same" has no step 1', 'no steps at all');
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.5, 0.5, 'z', step => 1) $$, '42703', 'step has no attribute "z"', 'an attribute of the mesh');
SELECT throws_ok($$ SELECT * FROM abacus_interpolate('plane', 'SELECT 1, 0.5, 0.5', '{3}', step => 1) $$, '42703', 'step has no attribute "3"', 'a value too many');
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.5, 0.5, step => 1) $$, '42702', 'step has 2 attributes, and none is named', 'one of two');
SELECT throws_ok($$ SELECT abacus_tile_picture('plane', 0, 0, 0, world => '{0,0,1}', range => '{0,1}', step => 1) $$, '42702', 'step has 2 attributes, and none is named', 'also in a tile');
SELECT isnt(abacus_store('plane', 4, 2, 1, 'SELECT v.id, 1 FROM abacus_share_vertices(''plane'', 2, 1, 0) AS v WHERE owner = 1'), NULL, 'half of a step');
SELECT throws_ok($$ SELECT abacus_tile_vector('plane', 0, 0, 0, world => '{0,0,1}', step => 4) $$, '55000', 'step 4 of mesh "plane" is not whole', 'is not whole');
SELECT isnt(abacus_store('plane', 4, 2, 0, 'SELECT v.id, 1, 2 FROM abacus_share_vertices(''plane'', 2, 0, 0) AS v WHERE owner = 0'), NULL, 'the other half with two values');
SELECT results_eq($$ SELECT stored, whole FROM abacus_steps('plane') WHERE step = 4 $$, $$ VALUES (2, false) $$, 'makes it no whole');
SELECT throws_ok($$ SELECT abacus_draw('plane', 100, step => 4) $$, '55000', 'step 4 of mesh "plane" is not whole', 'which is not read');
SELECT throws_ok($$ SELECT abacus_draw('plane', 100, max_error => 1, step => 1) $$, '22023', 'step cannot be read where an error is allowed', 'levels have no steps');
SELECT throws_ok($$ SELECT abacus_tile_terrain('plane', 0, 0, 0, world => '{0,0,1}', pixel_error => 1, step => 1) $$, '22023', 'step cannot be read where an error is allowed', 'nor tiles of levels');
SELECT isnt(abacus_octree_create('tree', 2, '{0,0}', '{1,1}', '{v}'), NULL, 'a quadtree');
SELECT throws_ok($$ SELECT abacus_draw('tree', 100, step => 1) $$, '22023', 'octree "tree" has no steps', 'has no steps');
SELECT throws_ok($$ SELECT abacus_interpolate('points', 0.5, 0.5, step => 1) $$, '42809', NULL, 'not a mesh');

-- rows as others have changed them
UPDATE plane_steps SET "values" = '{}' WHERE step = 1 AND id = 7;
SELECT is(abacus_interpolate('plane', x, y, '1', step => 1), NULL, 'too few values are missing') FROM points WHERE id = 7;
DELETE FROM plane_steps WHERE step = 1 AND id = 8;
SELECT is(abacus_interpolate('plane', x, y, '1', step => 1), NULL, 'a row that is gone') FROM points WHERE id = 8;
SELECT is((SELECT "values" FROM abacus_interpolate('plane', 'SELECT id, x, y FROM points WHERE id = 8', '{1,2}', step => 1)), '{NULL,NULL}'::float8[], 'also among many');
UPDATE plane_steps SET "values" = '{3}' WHERE step = 1 AND id IS NULL;
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.5, 0.5, step => 1) $$, 'XX001', 'step 1 of mesh "plane" is not as abacus_store() writes it', 'what the parts say');
DELETE FROM plane_steps WHERE step = 1;
SELECT is(pg_temp.store('plane', 1, 3), 501::bigint, 'stored anew');

-- each statement sees what was stored before it, also in one function
CREATE FUNCTION pg_temp.follow() RETURNS float8[] LANGUAGE plpgsql AS $$
DECLARE
    found float8[] := '{}';
BEGIN
    FOR i IN 1..3 LOOP
        PERFORM pg_temp.store('plane', 20, 2, i::text);
        found := found || abacus_interpolate('plane', 0.5, 0.5, step => 20);
        BEGIN
            PERFORM pg_temp.store('plane', 20, 2, '10 * ' || i);
            found := found || abacus_interpolate('plane', 0.5, 0.5, step => 20);
            RAISE division_by_zero;
        EXCEPTION WHEN division_by_zero THEN
            found := found || abacus_interpolate('plane', 0.5, 0.5, step => 20);
        END;
    END LOOP;
    RETURN found;
END $$;
SELECT is(pg_temp.follow(), '{1,10,1,2,20,2,3,30,3}'::float8[], 'in each round of a loop');

-- the mesh has changed: values by ids, NULL for new vertices
SELECT isnt(abacus_insert('plane', 'SELECT 1000, 0.5, 0.5, 0'), NULL, 'a new vertex');
SELECT is(abacus_interpolate('plane', 0.5, 0.5, '1', step => 1), NULL, 'has no value');
SELECT is(abacus_interpolate('plane', x, y, '1', step => 1), u, 'the others have theirs') FROM solution WHERE id = 100;

-- privileges and policies
CREATE ROLE reader_of_steps;
GRANT SELECT ON plane, plane_vertices, points, places TO reader_of_steps;
SET LOCAL ROLE reader_of_steps;
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.2, 0.2, '1', step => 1) $$, '42501', NULL, 'no privilege on the steps');
SELECT throws_ok($$ SELECT abacus_draw('plane', 100, attribute => '1', step => 1) $$, '42501', NULL, 'nor for a picture');
SELECT throws_ok($$ SELECT abacus_tile_etag('plane', 1) $$, '42501', NULL, 'nor for a tag');
RESET ROLE;
GRANT SELECT ON plane_steps TO reader_of_steps;
SET LOCAL ROLE reader_of_steps;
SELECT isnt(abacus_interpolate('plane', 0.2, 0.2, '1', step => 1), NULL, 'with it');
RESET ROLE;
ALTER TABLE plane_steps ENABLE ROW LEVEL SECURITY;
CREATE POLICY evens ON plane_steps FOR SELECT USING (id IS NULL OR id % 2 = 0);
SET LOCAL ROLE reader_of_steps;
SELECT throws_ok($$ SELECT abacus_interpolate('plane', 0.2, 0.2, '1', step => 1) $$, '0A000', NULL, 'no rows by policies');
SELECT throws_ok($$ SELECT abacus_draw('plane', 100, attribute => '1', step => 1) $$, '0A000', NULL, 'nor pictures');
RESET ROLE;
SELECT * FROM finish();
ROLLBACK;

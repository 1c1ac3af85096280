-- Every call of the database, and every allocation, by the core fails once: each time there is an ERROR of
-- the expected kind, no relation stays open, no change is incomplete, and the session still works.
BEGIN;
SELECT no_plan();

CREATE TABLE points AS
SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y, i AS height FROM generate_series(1, 3000) i;

-- Runs `command` with the n-th call failing, for n = 1, 2, ... until it succeeds.
-- After each failure `verify` must return true. Late failures are sampled.
CREATE FUNCTION pg_temp.inject(what text, command text, verify text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    n int := 0;
    done boolean := false;
    sound boolean := true;
    states text[] := '{}';
    verified boolean;
BEGIN
    WHILE NOT done LOOP
        n := n + 1 + n / 40;
        BEGIN
            PERFORM set_config('abacus.fail_host_call', n::text, false);
            EXECUTE command;
            done := true;
            PERFORM set_config('abacus.fail_host_call', '0', false);
        EXCEPTION WHEN io_error OR out_of_memory THEN
            PERFORM set_config('abacus.fail_host_call', '0', false);
            states := states || SQLSTATE::text;
            EXECUTE verify INTO verified;
            sound := sound AND verified;
        END;
    END LOOP;
    RETURN NEXT ok(cardinality(states) > 0, format('%s fails (%s times, up to call %s) and then succeeds', what, cardinality(states), n));
    RETURN NEXT ok(sound, format('%s leaves everything as it was', what));
    RETURN NEXT ok('58030' = ANY (states), format('%s: the database''s own error comes through', what));
END $$;

SELECT pg_temp.inject('triangulate from a query',
    $$ SELECT abacus_triangulate('made', 'TABLE points') $$,
    $$ SELECT to_regclass('made') IS NULL AND to_regclass('made_vertices') IS NULL AND NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT is_empty($$ SELECT * FROM abacus_check('made') $$, 'the mesh is sound');

SELECT isnt(abacus_create('field', 2, '{height}'), NULL, 'a mesh');
SELECT pg_temp.inject('stage', $$ SELECT abacus_stage('field', 'TABLE points') $$,
    $$ SELECT count(*) = 0 FROM abacus_vertices('field') $$);
SET LOCAL abacus.cache_size = '1MB';
SELECT pg_temp.inject('triangulate', $$ SELECT abacus_triangulate('field') $$,
    $$ SELECT (SELECT count(*) FROM abacus_simplices('field')) = 0 AND (SELECT count(vertex) FROM abacus_vertices('field')) = 0 $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh is sound');
SELECT results_eq($$ SELECT v0, v1, v2 FROM abacus_simplices('field') s ORDER BY least(v0, v1, v2), v0 + v1 + v2 $$,
                  $$ SELECT v0, v1, v2 FROM abacus_simplices('made') s ORDER BY least(v0, v1, v2), v0 + v1 + v2 $$, 'and the same as the other');

-- growing a mesh that already has pages
SELECT is(abacus_stage('field', 'SELECT 10000 + id, x + 0.5, y + 0.5, height FROM points WHERE id <= 500'), 500::bigint, 'more points');
SELECT pg_temp.inject('growing', $$ SELECT abacus_triangulate('field') $$,
    $$ SELECT (SELECT count(*) FROM abacus_simplices('field')) = (SELECT count(*) FROM abacus_simplices('made')) $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the grown mesh is sound');

-- a step in place of attributes
SELECT isnt(abacus_store('made', 1, 1, 0, 'SELECT id, x FROM abacus_share_vertices(''made'', 1, 0, 0)'), NULL, 'a step');
SELECT pg_temp.inject('a picture of a step', $$ SELECT abacus_draw('made', 50, step => 1) $$, 'SELECT true');
SELECT pg_temp.inject('values of a step', $$ SELECT count(*) FROM abacus_interpolate('made', 'SELECT id, x + 0.1, y FROM points WHERE id <= 50', step => 1) $$, 'SELECT true');

-- octrees
SELECT isnt(abacus_octree_create('tree', 2, '{0,0}', '{1009,1009}', '{v}'), NULL, 'an octree');
SELECT pg_temp.inject('an octree from points', $$ SELECT abacus_octree_from_points('tree', 'SELECT id, x, y FROM points', 1) $$,
    $$ SELECT count(*) = 1 FROM abacus_octants('tree') $$);
CREATE TEMP TABLE leaves AS SELECT * FROM abacus_octants('tree');
SELECT pg_temp.inject('balance', $$ SELECT abacus_octree_balance('tree') $$,
    $$ SELECT count(*) = (SELECT count(*) FROM leaves) FROM abacus_octants('tree') $$);
SELECT pg_temp.inject('refining by a query',
    $$ SELECT abacus_octree_from_size('tree', 'SELECT array_agg(CASE WHEN x < 300 THEN 12.0::float8 END ORDER BY n) FROM unnest($1, $2) WITH ORDINALITY AS c(x, y, n)') $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT abacus_octree_balance('tree');
DROP TABLE leaves;
CREATE TEMP TABLE leaves AS SELECT * FROM abacus_octants('tree');
SELECT pg_temp.inject('an update of leaves', $$ SELECT abacus_octree_update('tree', 'SELECT code, level FROM leaves') $$,
    $$ SELECT count(*) = 0 FROM abacus_octants('tree') WHERE attributes[1] IS NOT NULL $$);
SELECT pg_temp.inject('nodes', $$ SELECT count(*) FROM abacus_octree_nodes('tree') $$, 'SELECT true');
SELECT pg_temp.inject('elements', $$ SELECT count(*) FROM abacus_octree_elements('tree') $$, 'SELECT true');
SELECT pg_temp.inject('a window of leaves', $$ SELECT count(*) FROM abacus_octants('tree', ARRAY[100, 100], ARRAY[200, 200]) $$, 'SELECT true');
SELECT pg_temp.inject('leaves at places', $$ SELECT sum((abacus_octree_locate('tree', x, y)).level) FROM points $$, 'SELECT true');
SELECT pg_temp.inject('a ball of leaves', $$ SELECT count(*) FROM abacus_octants('tree', ARRAY[100, 100], 50) $$, 'SELECT true');
SELECT pg_temp.inject('nearest leaves', $$ SELECT sum(distance) FROM abacus_octree_nearest('tree', 2000, 500, 100) $$, 'SELECT true');
SELECT pg_temp.inject('nearest leaves of many places', $$ SELECT sum(distance) FROM abacus_octree_nearest('tree', 'SELECT id, x, y FROM points WHERE id <= 300', 3) $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT pg_temp.inject('leaves at many places', $$ SELECT sum(level) FROM abacus_octree_locate('tree', 'SELECT id, x, y FROM points') $$, 'SELECT true');
SELECT pg_temp.inject('a value between leaves', $$ SELECT abacus_octree_interpolate('tree', 500, 500) IS NULL $$, 'SELECT true');
SELECT pg_temp.inject('values between leaves', $$ SELECT sum("values"[1]) FROM abacus_octree_interpolate('tree', 'SELECT id, x, y FROM points') $$, 'SELECT true');
SELECT pg_temp.inject('triangles', $$ SELECT count(*) FROM abacus_octree_tetrahedra('tree') $$, 'SELECT true');
SELECT pg_temp.inject('a picture of leaves', $$ SELECT length(abacus_draw('tree', 40, attribute => 'v')) $$, 'SELECT true');
SELECT pg_temp.inject('a picture of some leaves', $$ SELECT length(abacus_draw('tree', 40, lower => '{100,100}', upper => '{200,200}')) $$, 'SELECT true');
SELECT isnt(abacus_octree_create('again', 2, '{0,0}', '{1009,1009}', '{v}'), NULL, 'another one');
SELECT pg_temp.inject('loading', $$ SELECT abacus_octree_from_rows('again', 'SELECT code, level, attributes[1] FROM abacus_octants(''tree'')') $$,
    $$ SELECT count(*) = 1 FROM abacus_octants('again') $$);
SELECT bag_eq($$ SELECT * FROM abacus_octants('again') $$, $$ SELECT * FROM abacus_octants('tree') $$, 'the same leaves');
SELECT pg_temp.inject('merging', $$ SELECT abacus_octree_coarsen('tree', 'SELECT 3, x, y FROM points') $$,
    $$ SELECT count(*) = (SELECT count(*) FROM leaves) FROM abacus_octants('tree') $$);
SELECT is_empty($$ SELECT * FROM abacus_check('tree') $$, 'the octree is sound');
DROP TABLE leaves;
CREATE TEMP TABLE leaves AS SELECT * FROM abacus_octants('tree');
SELECT pg_temp.inject('refining at places', $$ SELECT abacus_octree_refine('tree', 'SELECT 9, x, y FROM points WHERE id <= 5') $$,
    $$ SELECT count(*) = (SELECT count(*) FROM leaves) FROM abacus_octants('tree') $$);
SELECT pg_temp.inject('neighbours', $$ SELECT count(*) FROM abacus_octree_neighbours('tree', 0) $$, 'SELECT true');
SELECT is_empty($$ SELECT * FROM abacus_check('tree') $$, 'the refined octree is sound');
-- attributes apart
CREATE VIEW wide_points AS SELECT id, x, y, height, sin(id) AS a1, sin(id * 2) AS a2, sin(id * 3) AS a3, sin(id * 4) AS a4, sin(id * 5) AS a5, sin(id * 6) AS a6, sin(id * 7) AS a7 FROM points;
SELECT pg_temp.inject('triangulating with many attributes', $$ SELECT abacus_triangulate('wide', 'TABLE wide_points') $$, $$ SELECT to_regclass('wide') IS NULL $$);
SELECT ok(EXISTS (SELECT FROM wide WHERE code < -1), 'they are apart');
CREATE TABLE wide_before AS SELECT code, part, page::bytea AS page FROM wide;
CREATE FUNCTION pg_temp.untouched() RETURNS text LANGUAGE sql AS 'SELECT $q$ SELECT NOT EXISTS ((SELECT code, part, page::bytea FROM wide) EXCEPT TABLE wide_before) $q$::text';
SELECT pg_temp.inject('deleting from it', $$ SELECT abacus_delete('wide', 'SELECT id, x, y FROM points WHERE id % 9 = 0') $$, pg_temp.untouched());
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('replacing in it', $$ SELECT abacus_insert('wide', 'SELECT id, x, y, -height, a2, a1, a4, a3, a6, a5, a7 FROM wide_points WHERE id % 2 = 0', on_duplicate => 'replace') $$, pg_temp.untouched());
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('updating attributes', $$ SELECT abacus_update('wide', 'SELECT id, x, y, height AS a7 FROM wide_points WHERE id % 2 = 0') $$, pg_temp.untouched());
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
SELECT pg_temp.inject('updating attributes among the simplices', $$ SELECT abacus_update('field', 'SELECT id, x, y, -id AS height FROM points') $$,
    $$ SELECT count(*) = 0 FROM abacus_vertices('field') WHERE attributes[1] < 0 $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'that mesh is sound');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('field') WHERE attributes[1] = -id $$, $$ SELECT id::bigint FROM points $$, 'and its attributes are right');
SELECT is(abacus_update('field', 'SELECT id, x, y, height FROM points'), 3000::bigint, 'they are as they were');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('adding an attribute', $$ SELECT abacus_add_attribute('wide', 'more') $$, pg_temp.untouched());
SELECT pg_temp.inject('dropping it', $$ SELECT abacus_drop_attribute('wide', 'more') $$,
    $$ SELECT count(*) = 9 FROM abacus_attributes('wide') $$);
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
SELECT pg_temp.inject('adding an attribute among the simplices', $$ SELECT abacus_add_attribute('field', 'more') $$,
    $$ SELECT count(*) = 1 FROM abacus_attributes('field') $$);
SELECT pg_temp.inject('dropping that', $$ SELECT abacus_drop_attribute('field', 'more') $$,
    $$ SELECT count(*) = 2 FROM abacus_attributes('field') $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'that mesh is sound');
CREATE TEMP TABLE field_before AS SELECT * FROM abacus_simplices('field');
SELECT pg_temp.inject('a deletion that returns', $$ SELECT count(*) FROM abacus_delete_returning('field', 'SELECT id, x, y FROM points WHERE id % 3 = 0') $$,
    $$ SELECT (SELECT count(*) FROM abacus_simplices('field')) = (SELECT count(*) FROM field_before) $$);
SELECT pg_temp.inject('an insertion that returns', $$ SELECT count(*) FROM abacus_insert_returning('field', 'SELECT id, x, y, height FROM points WHERE id % 3 = 0') $$,
    $$ SELECT (SELECT count(*) FROM abacus_simplices('field')) < (SELECT count(*) FROM field_before) $$);
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'that mesh is sound');
SELECT set_eq($$ SELECT v0, v1, v2 FROM abacus_simplices('field') $$, $$ SELECT v0, v1, v2 FROM field_before $$, 'and the same');
SELECT pg_temp.inject('reading attributes', $$ SELECT sum("values"[2]) FROM abacus_interpolate('wide', 'SELECT id, x, y FROM points') $$, 'SELECT true');
SELECT bag_eq($$ SELECT id, attributes[1:3] AS a FROM abacus_vertices('wide') $$,
    $$ SELECT id::bigint, CASE WHEN id % 2 = 0 THEN ARRAY[-height, a2, a1] ELSE ARRAY[height, a1, a2] END FROM wide_points WHERE id % 2 = 0 OR id % 9 > 0 $$, 'and they are right');

-- labels of simplices
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('labelling', $$ SELECT abacus_label('wide', 'SELECT code, v0, v1, v2, v0 AS least FROM abacus_simplices(''wide'')') $$, pg_temp.untouched());
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('another label', $$ SELECT abacus_label('wide', 'SELECT code, v0, v1, v2, v1 AS next FROM abacus_simplices(''wide'') WHERE v0 % 2 = 0') $$, pg_temp.untouched());
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('deleting from a labelled mesh', $$ SELECT abacus_delete('wide', 'SELECT id, x, y FROM points WHERE id % 9 = 1') $$, pg_temp.untouched());
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');
SELECT is_empty($$ SELECT FROM abacus_cells('wide') WHERE labels[1] <> v0 OR labels[2] IS DISTINCT FROM CASE WHEN v0 % 2 = 0 AND labels[1] IS NOT NULL THEN v1 END $$, 'and its labels are right');
SELECT pg_temp.inject('reading labels', $$ SELECT sum(labels[1]) FROM abacus_locate('wide', 'SELECT id, x, y FROM points') $$, 'SELECT true');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('marking', $$ SELECT abacus_mark('wide', 'SELECT code, v0, v1, v2, 0, v1 % 7 FROM abacus_simplices(''wide'') WHERE v0 % 3 = 0') $$, pg_temp.untouched());
SELECT abacus_inherit_labels('wide');
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('inheriting labels, keeping markers', $$ SELECT abacus_delete('wide', 'SELECT id, x, y FROM points WHERE id % 9 = 2') $$, pg_temp.untouched());
DELETE FROM wide_before;
INSERT INTO wide_before SELECT code, part, page::bytea FROM wide;
SELECT pg_temp.inject('another attribute beside labels', $$ SELECT abacus_add_attribute('wide', 'more') $$, pg_temp.untouched());
SELECT pg_temp.inject('reading markers', $$ SELECT count(*) FROM abacus_facets('wide') $$, 'SELECT true');
SELECT pg_temp.inject('a picture of labels', $$ SELECT abacus_draw('wide', 64, attribute => 'least') $$, 'SELECT true');
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'it is sound');

-- fixed edges
SELECT abacus_triangulate('fenced', 'SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y FROM generate_series(1, 1500) AS i');
CREATE TABLE fence AS SELECT row_number() OVER (ORDER BY v0, v1) AS line, v0, v1 FROM abacus_edges('fenced') WHERE v0 % 5 = 0;
SELECT pg_temp.inject('lines', $$ SELECT abacus_constrain('fenced', 'SELECT line, 1, v0 FROM fence UNION ALL SELECT line, 2, v1 FROM fence') $$,
    $$ SELECT to_regclass('fenced_lines') IS NULL AND NOT EXISTS (SELECT FROM abacus_lines('fenced')) $$);
SELECT pg_temp.inject('fixed edges', $$ SELECT count(*) FROM abacus_edges('fenced', fixed => true) $$, 'SELECT true');
SELECT pg_temp.inject('deletion beside lines', $$ SELECT abacus_delete('fenced', 'SELECT v.id, v.x, v.y FROM abacus_vertices(''fenced'') AS v WHERE v.id % 3 = 1 AND NOT EXISTS (SELECT FROM fence AS f WHERE v.id IN (f.v0, f.v1))') $$,
    $$ SELECT count(*) = 1500 FROM abacus_vertices('fenced') $$);
SELECT pg_temp.inject('lines go', $$ SELECT abacus_unconstrain('fenced', 'SELECT line FROM fence WHERE line % 2 = 0') $$,
    $$ SELECT (SELECT count(DISTINCT line) FROM abacus_lines('fenced')) = (SELECT count(*) FROM fence) $$);
SELECT is_empty($$ SELECT * FROM abacus_check('fenced') $$, 'it is sound');
SELECT is((SELECT count(*) FROM abacus_edges('fenced', fixed => true)), (SELECT count(*) FROM fence WHERE line % 2 = 1), 'the edges of the other lines are fixed');

-- meshes made elsewhere, Delaunay and not
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('made');
SELECT pg_temp.inject('load', $$ SELECT abacus_load('loaded', 'SELECT id, x, y FROM abacus_vertices(''made'')', 'TABLE triangles') $$,
    $$ SELECT to_regclass('loaded') IS NULL AND to_regclass('loaded_vertices') IS NULL AND NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SET LOCAL maintenance_work_mem = '1MB';
SELECT pg_temp.inject('load with holes', $$ SELECT abacus_load('holes', 'SELECT id, x, y FROM abacus_vertices(''made'')', 'SELECT * FROM triangles WHERE v0 % 5 > 0') $$,
    $$ SELECT to_regclass('holes') IS NULL AND to_regclass('holes_vertices') IS NULL $$);
RESET maintenance_work_mem;
SELECT pg_temp.inject('load with lines', $$ SELECT abacus_load('fixed', 'SELECT id, x, y FROM abacus_vertices(''made'')', 'TABLE triangles', lines => 'SELECT 1, v0, v1 FROM triangles WHERE v0 % 5 > 0') $$,
    $$ SELECT to_regclass('fixed') IS NULL AND to_regclass('fixed_vertices') IS NULL AND to_regclass('fixed_lines') IS NULL $$);
SELECT is_empty($$ SELECT * FROM abacus_check('loaded') UNION ALL SELECT * FROM abacus_check('holes') UNION ALL SELECT * FROM abacus_check('fixed') $$, 'the loaded meshes are sound');
SELECT pg_temp.inject('locate in holes', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''5MB''; PERFORM abacus_locate(''holes'', x + 0.25, y + 0.25) FROM points; END' $$, 'SELECT true');
SELECT pg_temp.inject('check holes', $$ SELECT count(*) FROM abacus_check('holes') $$, 'SELECT true');

-- readers
CREATE FUNCTION pg_temp.answers() RETURNS bigint LANGUAGE sql AS
    $$ SELECT sum((abacus_locate('field', x + 0.25, y + 0.25)).v0 % 1000003) FROM points $$;
CREATE TEMP TABLE answer AS SELECT pg_temp.answers();
-- another cache size than the verification's makes the session read the mesh again
SELECT pg_temp.inject('locate', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''3MB''; PERFORM pg_temp.answers(); END' $$,
    $$ SELECT pg_temp.answers() = (TABLE answer) $$);
SET LOCAL work_mem = '64kB';
SELECT pg_temp.inject('locate many', $$ SELECT count(*) FROM abacus_locate('field', 'SELECT id, x + 0.25, y + 0.25 FROM points, generate_series(1, 4)') $$,
    $$ SELECT pg_temp.answers() = (TABLE answer) AND NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
RESET work_mem;
SELECT pg_temp.inject('walk', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''4MB''; PERFORM abacus_walk(''field'', s, 0) FROM abacus_simplices(''field'') s; END' $$,
    $$ SELECT pg_temp.answers() = (TABLE answer) $$);
SELECT pg_temp.inject('simplices', $$ SELECT count(*) FROM abacus_simplices('field') $$, 'SELECT true');
SELECT pg_temp.inject('vertices', $$ SELECT count(*) FROM abacus_vertices('field') $$, 'SELECT true');
SELECT pg_temp.inject('nearest', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''5MB''; PERFORM abacus_nearest(''field'', x + 0.25, y + 0.25, 4) FROM points; END' $$,
    $$ SELECT pg_temp.answers() = (TABLE answer) $$);
SELECT pg_temp.inject('nearest of many', $$ SELECT count(*) FROM abacus_nearest('field', 'SELECT id, x + 0.25, y + 0.25 FROM points', 2) $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT pg_temp.inject('cells of a window', $$ SELECT count(*) FROM abacus_cells('field', ARRAY[100, 100], ARRAY[300, 300]) $$, 'SELECT true');
SELECT pg_temp.inject('edges', $$ SELECT count(*) FROM abacus_edges('field') $$, 'SELECT true');
SELECT pg_temp.inject('volume', $$ SELECT abacus_volume('field', 100, 'height') $$, 'SELECT true');
SELECT pg_temp.inject('volume between', $$ SELECT abacus_volume('field', 'field', 'height') $$, 'SELECT true');
SELECT pg_temp.inject('contours', $$ SELECT count(*) FROM abacus_contours('field', 300) $$, 'SELECT true');
SELECT pg_temp.inject('bands', $$ SELECT count(*) FROM abacus_contours('field', 300, polygonize => true, lower => '{100,100}', upper => '{300,300}') $$, 'SELECT true');
SELECT pg_temp.inject('vertices of a range', $$ SELECT count(*) FROM abacus_vertices('field', 'height', 100, 300) $$, 'SELECT true');
SELECT pg_temp.inject('star', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''6MB''; PERFORM abacus_star(''field'', x, y) FROM points; END' $$,
    $$ SELECT pg_temp.answers() = (TABLE answer) $$);
SELECT pg_temp.inject('voronoi', $$ SELECT count(*) FROM abacus_voronoi('field', ARRAY[100, 100], ARRAY[300, 300]) $$, 'SELECT true');
SET work_mem = '64kB';
SELECT pg_temp.inject('outline', $$ SELECT count(*) FROM abacus_alpha_shape('field', 40) $$, 'SELECT true');
SELECT pg_temp.inject('spanning tree', $$ SELECT count(*) FROM abacus_spanning_tree('field') $$, 'SELECT true');
RESET work_mem;
SELECT pg_temp.inject('check', $$ SELECT count(*) FROM abacus_check('field') $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT pg_temp.inject('draw', $$ SELECT abacus_draw('field', 100) $$, 'SELECT true');
-- tiles, by all triangles and by samples
SELECT pg_temp.inject('picture tile', $$ SELECT abacus_tile_picture('field', 0, 0, 0, world => '{0,0,400}', attribute => 'height', range => '{0,500}', contours => 50) $$, 'SELECT true');
SELECT pg_temp.inject('sampled picture tile', $$ SELECT abacus_tile_picture('field', 0, 0, 0, world => '{0,0,400}', size => 10, attribute => 'height', range => '{0,500}') $$, 'SELECT true');
SELECT pg_temp.inject('vector tile', $$ SELECT abacus_tile_vector('field', 2, 1, 1, world => '{0,0,400}', attribute => 'height', contours => 20) $$, 'SELECT true');
SELECT pg_temp.inject('vector tile of many', $$ SELECT abacus_tile_vector('field', 0, 0, 0, world => '{-2000,-2000,4000}', attribute => 'height', contours => 20) $$, 'SELECT true');
SELECT pg_temp.inject('terrain tile', $$ SELECT abacus_tile_terrain('field', 0, 0, 0, world => '{0,0,400}', size => 64, attribute => 'height') $$, 'SELECT true');
SELECT abacus_triangulate('shire', 'SELECT * FROM points', lines => 'SELECT 1, n, i FROM unnest(ARRAY[100, 200, 300, 100]) WITH ORDINALITY AS u (i, n)', attributes => '{height}');
SELECT abacus_region('shire', $$VALUES ('farm', 1)$$);
SELECT pg_temp.inject('picture with regions', $$ SELECT abacus_draw('shire', 40, regions => true, lines => true) $$, 'SELECT true');
SELECT pg_temp.inject('sampled tile with regions', $$ SELECT abacus_tile_picture('shire', 0, 0, 0, world => '{0,0,1010}', size => 10, regions => true, lines => true) $$, 'SELECT true');
SELECT pg_temp.inject('vector tile with regions', $$ SELECT abacus_tile_vector('shire', 1, 0, 0, world => '{0,0,1010}') $$, 'SELECT true');
SELECT pg_temp.inject('region at places', $$ DO 'BEGIN SET LOCAL abacus.cache_size = ''3MB''; PERFORM abacus_region_at(''shire'', x, y) FROM points; END' $$, 'SELECT true');
SELECT pg_temp.inject('tile functions', $$ SELECT abacus_tiles('field', world => '{0,0,400}', attribute => 'height') $$, $$ SELECT to_regproc('field_mvt') IS NULL $$);
SELECT abacus_triangulate('solid', 'SELECT id, x, y, (id * 37) % 101 FROM points', dimension => 3);
SELECT pg_temp.inject('draw a section', $$ SELECT abacus_draw_section('solid', '{0,0,50}', '{1,2,3}', 100) $$, 'SELECT true');
SELECT pg_temp.inject('section', $$ SELECT count(*) FROM abacus_section('solid', '{0,0,50}', '{1,2,3}') $$, 'SELECT true');
SELECT pg_temp.inject('draw what is inside', $$ SELECT abacus_draw_volume('solid', width => 50) $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
SELECT abacus_triangulate('warm', 'SELECT id, x, y, (id * 37) % 101, x + y FROM points', '{heat}', dimension => 3);
SET work_mem = '64kB';
SELECT pg_temp.inject('isosurface', $$ SELECT count(*) FROM abacus_isosurface('warm', 1000) $$,
    $$ SELECT NOT EXISTS (SELECT FROM abacus_progress WHERE pid = pg_backend_pid()) $$);
RESET work_mem;

-- only the locks of a transaction that has read and written are held, and that of the part of a step that it has stored
SELECT set_eq($$ SELECT locktype, mode, objsubid FROM pg_locks
                 WHERE pid = pg_backend_pid() AND locktype NOT IN ('relation', 'virtualxid', 'transactionid', 'object') $$, $$ VALUES ('advisory', 'ExclusiveLock', 3::smallint) $$, 'no other lock');
SELECT is((SELECT count(*) FROM pg_cursors WHERE name LIKE '<unnamed%'), 0::bigint, 'no portal');
SELECT is((SELECT count(*) FROM pg_backend_memory_contexts WHERE name IN ('Abacus host', 'Abacus core', 'Abacus error') AND level > 4), 0::bigint, 'no memory of failed calls');

SELECT * FROM finish();
ROLLBACK;

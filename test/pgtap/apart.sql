-- Attributes apart from the simplices: a mesh with many attributes answers like one with only the attribute
-- in question.
BEGIN;
SELECT no_plan();
SELECT setseed(0.5);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z, CASE WHEN id % 97 > 0 THEN 100 * random() END AS h FROM generate_series(1, 4000) AS id;
CREATE FUNCTION pg_temp.wide(source text, z text) RETURNS text LANGUAGE sql AS $$ -- h is the 36th of 40 attributes
    SELECT format('SELECT id, x, y%s, %s, h, %s FROM %s', z, (SELECT string_agg(format('sin(id * %s) AS a%s', i, i), ', ') FROM generate_series(1, 35) i),
                  (SELECT string_agg(format('id / 7 + %s AS a%s', i, i), ', ') FROM generate_series(37, 40) i), source) $$;
CREATE FUNCTION h_of(attributes float8[]) RETURNS int LANGUAGE sql AS $$ SELECT CASE cardinality(attributes) WHEN 1 THEN 1 ELSE 36 END $$;
CREATE FUNCTION pg_temp.same(query text, what text, VARIADIC meshes text[] DEFAULT '{narrow,wide}') RETURNS text LANGUAGE sql AS $$
    SELECT bag_eq(format(query, meshes[2]), format(query, meshes[1]), what) $$;
CREATE FUNCTION pg_temp.sound(what text) RETURNS text LANGUAGE sql AS $$
    SELECT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), what || ': ' || mesh) FROM unnest('{narrow,wide,solid,wide_solid}'::text[]) mesh $$;
SELECT isnt(abacus_triangulate('narrow', 'SELECT id, x, y, h FROM points'), NULL, 'a mesh with one attribute');
SELECT isnt(abacus_triangulate('wide', pg_temp.wide('points', '')), NULL, 'and one with forty');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z, h FROM points WHERE id <= 1500', dimension => 3), NULL, 'in space with one');
SELECT isnt(abacus_triangulate('wide_solid', pg_temp.wide('points WHERE id <= 1500', ', z'), dimension => 3), NULL, 'and forty');
SELECT is((SELECT min(code) = -1 FROM narrow), true, 'one attribute is in the simplex pages');
SELECT is((SELECT bool_and(c > 0) FROM (SELECT count(*) FILTER (WHERE code < -1) AS c FROM wide UNION ALL SELECT count(*) FILTER (WHERE code < -1) FROM wide_solid) counts), true, 'forty are apart');
SELECT pg_temp.sound('sound');
SELECT isnt(abacus_triangulate('bare', 'SELECT id, x, y FROM points'), NULL, 'a mesh without attributes');
SELECT bag_eq($$ SELECT code, part, page::bytea AS page FROM wide WHERE code >= 0 $$, $$ SELECT code, part, page::bytea AS page FROM bare WHERE code >= 0 $$, 'its simplex pages are those of a mesh without any');

-- every query that reads attributes
CREATE TABLE places AS SELECT id, 1.2 * random() - 0.1 AS x, 1.2 * random() - 0.1 AS y, 1.2 * random() - 0.1 AS z FROM generate_series(1, 300) id;
CREATE FUNCTION pg_temp.all_queries(what text) RETURNS SETOF text LANGUAGE sql AS $body$
    SELECT pg_temp.same($$ SELECT id, x, y, attributes[h_of(attributes)], vertex FROM abacus_vertices('%s') $$, what || ': vertices')
    UNION ALL SELECT pg_temp.same($$ SELECT id, x, y, sequence FROM abacus_vertices('%s', 'h', 20, 30) $$, what || ': a range')
    UNION ALL SELECT pg_temp.same($$ SELECT number, id, attributes[h_of(attributes)] FROM abacus_numbered_vertices('%s') $$, what || ': numbered vertices')
    UNION ALL SELECT pg_temp.same($$ SELECT id, attributes[h_of(attributes)] FROM abacus_vertices('%s', ARRAY[0.2, 0.2], ARRAY[0.4, 0.5]) $$, what || ': a window')
    UNION ALL SELECT pg_temp.same($$ SELECT p.id, n.vertex, n.attributes[h_of(n.attributes)] FROM places p, LATERAL abacus_nearest('%s', p.x, p.y, 4) n $$, what || ': the nearest')
    UNION ALL SELECT pg_temp.same(format($$ SELECT * FROM abacus_interpolate('%%s', 'SELECT id, x, y FROM places', attributes => '{h}', method => %L, outside => %L) $$, method, outside), what || ': interpolated, ' || method || ', ' || outside)
        FROM unnest('{linear,natural,nearest}'::text[]) method, unnest('{"null",nearest}'::text[]) outside
    UNION ALL SELECT pg_temp.same($$ SELECT id, abacus_interpolate('%s', x, y, 'h'), abacus_gradient('%1$s', x, y, 'h'), abacus_slope('%1$s', x, y, 'h')::text FROM places $$, what || ': at each place')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_raster('%s', ARRAY[0, 0], ARRAY[1, 1], 40, 30, 'h') $$, what || ': a raster')
    UNION ALL SELECT pg_temp.same($$ SELECT id, value, closed, path FROM abacus_contours('%s', 10, attribute => 'h') $$, what || ': contours')
    UNION ALL SELECT pg_temp.same($$ SELECT id, value, path FROM abacus_contours('%s', 20, polygonize => true, attribute => 'h') $$, what || ': bands')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_profile('%s', ARRAY[0.1, 0.1, 0.9, 0.7, 0.3, 0.8], 'h') $$, what || ': a profile')
    UNION ALL SELECT pg_temp.same($$ SELECT v.* FROM places, LATERAL abacus_visible('%s', ARRAY[0.5, 0.5], ARRAY[x, y], 'h', 90) v WHERE id < 50 $$, what || ': sights')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_volume('%s', 50, 'h') $$, what || ': a volume')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_volume('narrow', '%s'::regclass, 'h', ARRAY[0.1, 0.1], ARRAY[0.3, 0.3], other_attribute => 'h') $$, what || ': a volume between two')
    UNION ALL SELECT pg_temp.same($$ SELECT c.code, v0, v1, v2, ARRAY(SELECT "values"[i][CASE array_length("values", 2) WHEN 1 THEN 1 ELSE 36 END] FROM generate_series(1, 3) i) FROM abacus_cells('%s') c $$, what || ': cells')
    UNION ALL SELECT pg_temp.same($$ SELECT name, least, greatest, nulls FROM abacus_attributes('%s') WHERE name = 'h' $$, what || ': ranges of values')
    UNION ALL SELECT pg_temp.same($$ SELECT id, attributes[h_of(attributes)] FROM abacus_vertices('%s') $$, what || ': vertices in space', 'solid', 'wide_solid')
    UNION ALL SELECT pg_temp.same(format($$ SELECT * FROM abacus_interpolate('%%s', 'SELECT id, x, y, z FROM places', attributes => '{h}', method => %L) $$, method), what || ': interpolated in space, ' || method, 'solid', 'wide_solid') FROM unnest('{linear,natural,nearest}'::text[]) method
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_isosurface('%s', 50, 'h', 'h') $$, what || ': an isosurface', 'solid', 'wide_solid')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_section('%s', ARRAY[0.5, 0.5, 0.5], ARRAY[1, 2, 3], 'h') $$, what || ': a section', 'solid', 'wide_solid')
    UNION ALL SELECT pg_temp.same($$ SELECT * FROM abacus_raster('%s', ARRAY[0, 0, 0.5], ARRAY[1, 1, 0.5], 20, 20, 'h') $$, what || ': a raster in space', 'solid', 'wide_solid')
$body$;
SELECT pg_temp.all_queries('built');
-- pages come in another order, which may round a pixel differently; here it does not
SELECT pg_temp.same($$ SELECT md5(abacus_draw('%s', 200, attribute => 'h')) $$, 'a picture');
SELECT pg_temp.same($$ SELECT md5(abacus_draw_section('%s', ARRAY[0.5, 0.5, 0.5], ARRAY[1, 2, 3], 100, attribute => 'h')) AS section, md5(abacus_draw_volume('%1$s', width => 50, attribute => 'h')) AS volume $$, 'pictures in space', 'solid', 'wide_solid');
SET LOCAL abacus.cache_size = '1MB';
SELECT pg_temp.all_queries('with a small cache');
RESET abacus.cache_size;

-- all forty values
SELECT bag_eq($$ SELECT id, attributes FROM abacus_vertices('wide') $$,
    $$ SELECT id::bigint, ARRAY(SELECT sin(id * i) FROM generate_series(1, 35) i) || h || ARRAY(SELECT (id / 7 + i)::float8 FROM generate_series(37, 40) i) FROM points $$, 'all of all vertices');
-- their pages are counted, and an update moves no others
CREATE TABLE counted AS SELECT name, value FROM abacus_stats('wide') WHERE name !~ '^session|_ns$';
SELECT is(abacus_update('wide', 'SELECT id, x, y, id / 7 + 40 AS a40 FROM points'), 4000::bigint, 'one of forty gets the values it has');
SELECT bag_eq($$ SELECT name FROM abacus_stats('wide') s JOIN counted c USING (name) WHERE s.value > c.value AND name !~ '_bytes|^bytes_per' $$,
    $$ VALUES ('loads'), ('bytes_read') $$, 'pages have been read only');
SELECT is(abacus_update('wide', 'SELECT id, x, y, id / 7 + 41 AS a40 FROM points'), 4000::bigint, 'one of forty is updated');
SELECT bag_eq($$ SELECT name FROM abacus_stats('wide') s JOIN counted c USING (name) WHERE s.value > c.value AND name !~ '_bytes|^bytes_per' $$,
    $$ VALUES ('loads'), ('stores'), ('rewrites'), ('bytes_read'), ('bytes_written') $$, 'pages have been read and written');
SELECT cmp_ok((SELECT s.value - c.value FROM abacus_stats('wide') s JOIN counted c USING (name) WHERE name = 'stores'), '<=',
    (SELECT count(*)::float8 FROM wide WHERE code < -1) / 2 + 1, 'of one group of two');
SELECT is(abacus_update('wide', 'SELECT id, x, y, id / 7 + 40 AS a40 FROM points'), 4000::bigint, 'and is as before');

-- changes
CREATE TABLE more AS SELECT id + 10000 AS id, x, y, z, h / 2 AS h FROM points WHERE id % 5 = 0 -- repeated
    UNION ALL SELECT 20000 + id, random(), random(), random(), 100 * random() FROM generate_series(1, 1000) id;
CREATE FUNCTION pg_temp.change(command text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE counts bigint[] := '{}'; n bigint; mesh text;
BEGIN
    FOREACH mesh IN ARRAY '{narrow,wide,solid,wide_solid}'::text[] LOOP
        EXECUTE format(command, mesh, CASE mesh WHEN 'narrow' THEN 'SELECT id, x, y, h FROM %s' WHEN 'solid' THEN 'SELECT id, x, y, z, h FROM %s' WHEN 'wide' THEN pg_temp.wide('%s', '') ELSE pg_temp.wide('%s', ', z') END) INTO n;
        counts := counts || n;
    END LOOP;
    RETURN NEXT is(counts[2], counts[1], 'as many in the plane');
    RETURN NEXT is(counts[4], counts[3], 'as many in space');
END $$;
SELECT pg_temp.change($$ SELECT abacus_insert(%L, format(%L, 'more')) $$);
SELECT pg_temp.sound('after an insertion');
SELECT pg_temp.all_queries('inserted');
-- other attributes, of vertices and of points that equal one
CREATE TABLE newer AS SELECT id, x, y, z, CASE WHEN id % 13 > 0 THEN h + 1 END AS h FROM more WHERE id % 2 = 0;
SELECT pg_temp.change($$ SELECT abacus_update(%L, format(%L, 'newer')) $$);
SELECT pg_temp.sound('after an update');
SELECT bag_eq($$ SELECT id, attributes[1] FROM abacus_vertices('narrow') WHERE id > 10000 $$, $$ SELECT m.id::bigint, CASE WHEN n.id IS NULL THEN m.h ELSE n.h END FROM more m LEFT JOIN newer n USING (id) $$, 'other values');
SELECT pg_temp.same($$ SELECT id, x, y, vertex, attributes[h_of(attributes)] FROM abacus_vertices('%s') $$, 'the same where they are apart');
SELECT pg_temp.same($$ SELECT id, x, y, z, vertex, attributes[h_of(attributes)] FROM abacus_vertices('%s') $$, 'and in space', 'solid', 'wide_solid');
-- the repeated ones take over
SELECT pg_temp.change($$ SELECT abacus_delete(%L, format(%L, 'points WHERE id %% 10 = 0')) $$);
SELECT pg_temp.sound('after a deletion');
SELECT pg_temp.all_queries('passed on');
SELECT pg_temp.change($$ SELECT abacus_insert(%L, format(%L, '(SELECT id, x, y, z, -h AS h FROM more WHERE id %% 3 = 0) again'), on_duplicate => 'replace') $$);
SELECT pg_temp.sound('after a replacement');
SELECT pg_temp.all_queries('replaced');
-- most leave: the rest is triangulated again
SELECT pg_temp.change($$ SELECT abacus_delete(%L, format(%L, '(SELECT * FROM points UNION ALL SELECT * FROM more) gone WHERE id %% 4 > 0')) $$);
SELECT pg_temp.sound('after most have left');
SELECT pg_temp.all_queries('left');
-- far away: another domain
CREATE TABLE far AS SELECT 30000 + id AS id, 50 * random() AS x, 50 * random() AS y, 50 * random() AS z, random() AS h FROM generate_series(1, 3000) id;
SELECT pg_temp.change($$ SELECT abacus_insert(%L, format(%L, 'far')) $$);
SELECT pg_temp.sound('in another domain');
SELECT pg_temp.all_queries('far');
-- all but two leave, and all come again
SELECT pg_temp.change($$ SELECT abacus_delete(%L, format(%L, '(SELECT * FROM points UNION ALL SELECT * FROM more UNION ALL SELECT * FROM far) gone WHERE id > 8')) $$);
SELECT pg_temp.change($$ SELECT abacus_delete(%L, format(%L, 'points WHERE id > 2')) $$);
SELECT pg_temp.sound('without simplices');
SELECT is((SELECT count(*) FROM wide WHERE code <> -1), 0::bigint, 'no page is left');
SELECT pg_temp.change($$ SELECT abacus_insert(%L, format(%L, 'points')) $$);
SELECT pg_temp.sound('again');
SELECT pg_temp.all_queries('again');

-- loaded meshes, Delaunay or not
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('narrow') WHERE (v0 + v1 + v2) % 9 > 0;
CREATE TABLE whole AS SELECT v0, v1, v2 FROM abacus_simplices('narrow');
DROP TABLE narrow, wide;
SELECT isnt(abacus_load('narrow', 'SELECT id, x, y, h FROM points', 'TABLE triangles'), NULL, 'loaded with holes');
SELECT isnt(abacus_load('wide', pg_temp.wide('points', ''), 'TABLE triangles'), NULL, 'with forty attributes');
SELECT pg_temp.sound('loaded');
SELECT pg_temp.same($$ SELECT id, x, y, attributes[h_of(attributes)] FROM abacus_vertices('%s') $$, 'vertices of holes');
SELECT pg_temp.same($$ SELECT * FROM abacus_interpolate('%s', 'SELECT id, x, y FROM places', attributes => '{h}') $$, 'interpolated beside holes');
SELECT pg_temp.same($$ SELECT p.id, n.vertex, n.attributes[h_of(n.attributes)] FROM places p, LATERAL abacus_nearest('%s', p.x, p.y, 4) n $$, 'the nearest beside holes');
SELECT pg_temp.same($$ SELECT * FROM abacus_raster('%s', ARRAY[0, 0], ARRAY[1, 1], 40, 30, 'h') $$, 'a raster with holes');
SELECT pg_temp.same($$ SELECT * FROM abacus_profile('%s', ARRAY[0.1, 0.1, 0.9, 0.7, 0.3, 0.8], 'h') $$, 'a profile across holes');
SELECT pg_temp.same($$ SELECT * FROM abacus_volume('%s', 50, 'h') $$, 'a volume with holes');
SELECT pg_temp.same($$ SELECT number, id, attributes[h_of(attributes)] FROM abacus_numbered_vertices('%s') $$, 'numbered beside holes');
DROP TABLE narrow, wide;
SELECT isnt(abacus_load('narrow', 'SELECT id, x, y, h FROM points', 'TABLE whole'), NULL, 'loaded, Delaunay');
SELECT isnt(abacus_load('wide', pg_temp.wide('points', ''), 'TABLE whole'), NULL, 'with forty attributes');
SELECT pg_temp.change($$ SELECT abacus_insert(%L, format(%L, 'more')) $$);
SELECT pg_temp.sound('loaded and changed');
SELECT pg_temp.all_queries('loaded');

-- a table that a mesh follows: an UPDATE of attributes touches no simplex
CREATE TABLE followed AS SELECT id, x, y, h, sin(id * i.i) AS a1, cos(id) AS a2, 1.0::float8 * id AS a3, 2.0::float8 * id AS a4, 3.0::float8 * id AS a5 FROM points, (VALUES (1)) i(i);
SELECT isnt(abacus_create('follower', 2, '{h,a1,a2,a3,a4,a5}'), NULL, 'a mesh to follow a table');
SELECT is((SELECT abacus_track('follower', 'followed', '{id,x,y,h,a1,a2,a3,a4,a5}')), 4000::bigint, 'follows it');
CREATE FUNCTION pg_temp.in_step() RETURNS text LANGUAGE sql AS $$
    SELECT bag_eq($q$ SELECT id, x, y, attributes FROM abacus_vertices('follower') $q$, $q$ SELECT id::bigint, x, y, ARRAY[h, a1, a2, a3, a4, a5] FROM followed $q$, 'in step') $$;
SELECT pg_temp.in_step();
CREATE TABLE before AS SELECT code, part, page::bytea AS page FROM follower WHERE code >= 0;
UPDATE followed SET h = h + 1, a3 = NULL WHERE id % 3 = 0;
SELECT pg_temp.in_step();
SELECT bag_eq($$ SELECT code, part, page::bytea AS page FROM follower WHERE code >= 0 $$, 'TABLE before', 'no simplex page is another one');
UPDATE followed SET x = y, y = x WHERE id % 7 = 0;
SELECT pg_temp.in_step();
UPDATE followed SET id = -id WHERE id % 11 = 0;
SELECT pg_temp.in_step();
DELETE FROM followed WHERE id % 2 = 0;
SELECT pg_temp.in_step();
SELECT is_empty($$ SELECT * FROM abacus_check('follower') $$, 'and sound');
TRUNCATE followed;
SELECT is((SELECT count(*) FROM follower WHERE code <> -1), 0::bigint, 'nothing is left of it');
SELECT is_empty($$ SELECT * FROM abacus_check('follower') $$, 'and sound');

-- in batches, and from waiting points
SELECT isnt(abacus_create('slow', 2, ARRAY(SELECT 'a' || i FROM generate_series(1, 40) i)), NULL, 'a mesh to be built in batches');
SELECT is((SELECT abacus_stage('slow', pg_temp.wide('points', ''))), 4000::bigint, 'points wait');
SELECT is((SELECT count(*) FROM abacus_vertices('slow') WHERE sequence IS NOT NULL AND cardinality(attributes) = 40), 4000::bigint, 'with their attributes');
SELECT isnt(abacus_insert('slow', pg_temp.wide('more', '')), NULL, 'and come in with others');
SELECT is_empty($$ SELECT * FROM abacus_check('slow') $$, 'sound');
SELECT is((SELECT count(*) FROM abacus_vertices('slow')), 5800::bigint, 'all of them');

-- meshes of format 3 have any number of attributes with the simplices, and are changed in that format
SELECT isnt(abacus_create('old', 2, '{h,a1,a2,a3,a4,a5}'), NULL, 'an empty mesh');
SELECT is((SELECT get_byte(page::bytea, 6) FROM old WHERE code = -1), 4, 'of format 4');
UPDATE old SET page = set_byte(page::bytea, 6, 3)::abacus_page WHERE code = -1;
CREATE VIEW six AS SELECT id, x, y, h, sin(id) AS a1, cos(id) AS a2, 1.0::float8 * id AS a3, 2.0::float8 * id AS a4, 3.0::float8 * id AS a5 FROM points;
SELECT is(abacus_insert('old', 'TABLE six'), 4000::bigint, 'with points, of format 3');
SELECT is((SELECT array_agg(DISTINCT get_byte(page::bytea, 6)) FROM old), '{3,6}', 'still so, with six attributes in the pages');
SELECT is(abacus_delete('old', 'SELECT id, x, y FROM points WHERE id % 3 = 0'), 1333::bigint, 'some leave');
SELECT bag_eq($$ SELECT id, attributes FROM abacus_vertices('old') $$, $$ SELECT id::bigint, ARRAY[h, a1, a2, a3, a4, a5] FROM six WHERE id % 3 > 0 $$, 'the others are there');
SELECT is_empty($$ SELECT * FROM abacus_check('old') $$, 'sound');
SELECT is((SELECT count(*) FROM old WHERE code < -1), 0::bigint, 'nothing is apart');

-- damage is noticed
CREATE FUNCTION pg_temp.damaged(command text, what text, kind text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE found text;
BEGIN
    BEGIN
        EXECUTE command;
        SELECT fault INTO found FROM abacus_check('slow') LIMIT 1;
        RAISE EXCEPTION 'undo';
    EXCEPTION WHEN raise_exception THEN
    END;
    RETURN NEXT is(found, kind, what);
END $$;
SELECT pg_temp.damaged($$ DELETE FROM slow WHERE code = (SELECT min(code) FROM slow WHERE code > (SELECT min(code) FROM slow)) $$, 'a page that is missing', 'attributes');
SELECT pg_temp.damaged($$ UPDATE slow SET page = set_byte(page::bytea, 500, get_byte(page::bytea, 500) # 1)::abacus_page WHERE code = (SELECT min(code) FROM slow) $$, 'a byte', 'attributes');
SELECT pg_temp.damaged($$ UPDATE slow SET page = (SELECT page FROM slow WHERE code >= 0 LIMIT 1) WHERE code = (SELECT min(code) FROM slow) $$, 'another kind of page', 'attributes');
SELECT pg_temp.damaged($$ UPDATE slow SET code = -2, part = 7 WHERE code = (SELECT max(code) FROM slow WHERE code < -1) $$, 'a page elsewhere', 'attributes');
SELECT pg_temp.damaged($$ INSERT INTO narrow SELECT code, part, page FROM wide WHERE code < -1 LIMIT 1; DROP TABLE slow; ALTER TABLE narrow RENAME TO slow $$, 'a page where none is', 'interval');
SELECT is_empty($$ SELECT * FROM abacus_check('slow') $$, 'sound again');
SELECT * FROM finish();
ROLLBACK;

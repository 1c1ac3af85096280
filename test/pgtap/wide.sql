-- Meshes with as many attributes as possible: a waiting point takes a row of its own, and names have rows
-- beside the header.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;
CREATE TABLE points AS SELECT id, (id * 7919 % 211 + id / 1000.0)::float8 AS x, (id * 104729 % 223)::float8 AS y, (id * 31 % 97)::float8 AS z FROM generate_series(1, 300) id;
-- value i of a point; every 50th is missing
CREATE FUNCTION value_of(id bigint, i int) RETURNS float8 LANGUAGE sql IMMUTABLE AS $$ SELECT CASE WHEN (id + i) % 50 > 0 THEN sin(id * i) END $$;
CREATE FUNCTION values_of(id bigint, n int) RETURNS float8[] LANGUAGE sql IMMUTABLE AS $$ SELECT array_agg(value_of(id, i) ORDER BY i) FROM generate_series(1, n) i $$;
-- a query of points that are computed once, with columns a1 to an
CREATE FUNCTION pg_temp.wide(source text, n int, z text DEFAULT '') RETURNS text LANGUAGE sql AS $$
    SELECT format('SELECT id, x, y%s, %s FROM (SELECT id, x, y, z, values_of(id, %s) AS a FROM %s OFFSET 0) p', z, string_agg(format('a[%s] AS a%1$s', i), ', ' ORDER BY i), n, source) FROM generate_series(1, n) i $$;
CREATE FUNCTION pg_temp.sound(mesh text, what text) RETURNS text LANGUAGE sql AS $$ SELECT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), what || ' is sound') $$;
CREATE FUNCTION pg_temp.holds(mesh text, source text, n int, what text) RETURNS text LANGUAGE sql AS $$
    SELECT bag_eq(format('SELECT id, attributes FROM abacus_vertices(%L)', mesh), format('SELECT id::bigint, values_of(id, %s) FROM %s', n, source), what) $$;
CREATE FUNCTION pg_temp.name_rows(mesh text) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE n bigint; BEGIN EXECUTE format('SELECT count(*) FROM %I WHERE code = -1 AND part > 0', mesh) INTO n; RETURN n; END $$;

-- built, in the plane and in space
SELECT isnt(abacus_triangulate('wide', pg_temp.wide('points', 1000)), NULL, 'a mesh with 1,000 attributes');
SELECT isnt(abacus_triangulate('solid', pg_temp.wide('points', 1000, ', z'), dimension => 3), NULL, 'and one in space');
SELECT pg_temp.sound(mesh, mesh) FROM unnest('{wide,solid}'::text[]) mesh;
SELECT pg_temp.holds(mesh, 'points', 1000, 'all values of ' || mesh) FROM unnest('{wide,solid}'::text[]) mesh;
SELECT is((SELECT get_byte(page::bytea, 6) FROM wide WHERE (code, part) = (-1, 0)), 6, 'is of format 6');
SELECT is(pg_temp.name_rows('wide'), 9::bigint, 'with names in nine rows');
SELECT bag_eq($$ SELECT name, nulls FROM abacus_attributes('wide') $$, $$ SELECT 'a' || i, count(*) FILTER (WHERE (id + i) % 50 = 0) FROM points, generate_series(1, 1000) i GROUP BY i $$, 'the names, and what is missing');
SELECT isnt(abacus_triangulate('bare', 'SELECT id, x, y FROM points'), NULL, 'a mesh without attributes');
SELECT bag_eq($$ SELECT code, part, page::bytea AS page FROM wide WHERE code >= 0 $$, $$ SELECT code, part, page::bytea AS page FROM bare WHERE code >= 0 $$, 'has the same simplex pages');

-- questions
SELECT isnt(abacus_triangulate('narrow', 'SELECT id, x, y, value_of(id, 777) AS h FROM points'), NULL, 'one of the attributes alone');
SELECT bag_eq($$ SELECT * FROM abacus_raster('wide', ARRAY[0, 0], ARRAY[200, 200], 20, 20, 'a777') $$, $$ SELECT * FROM abacus_raster('narrow', ARRAY[0, 0], ARRAY[200, 200], 20, 20, 'h') $$, 'a raster of it');
SELECT bag_eq($$ SELECT code, v0, v1, v2, ARRAY["values"[1][777], "values"[2][777], "values"[3][777]] FROM abacus_cells('wide') $$, $$ SELECT code, v0, v1, v2, ARRAY["values"[1][1], "values"[2][1], "values"[3][1]] FROM abacus_cells('narrow') $$, 'cells');
SELECT is((SELECT cardinality("values") FROM abacus_cells('solid') LIMIT 1), 4000, 'cells in space');
SELECT bag_eq($$ SELECT id, "values"[777] FROM abacus_interpolate('wide', 'SELECT id, x - 0.25, y FROM points') $$, $$ SELECT id, "values"[1] FROM abacus_interpolate('narrow', 'SELECT id, x - 0.25, y FROM points') $$, 'interpolated, all attributes at once');
SELECT bag_eq($$ SELECT id, x, y FROM abacus_vertices('wide', 'a777', 0.2, 0.3) $$, $$ SELECT id, x, y FROM abacus_vertices('narrow', 'h', 0.2, 0.3) $$, 'a range');
SELECT bag_eq($$ SELECT id, "values"[1000] FROM abacus_interpolate('wide', 'SELECT id, x, y FROM points', attributes => (SELECT array_agg('a5'::text ORDER BY i) FROM generate_series(1, 1000) i)) $$, $$ SELECT id, value_of(id, 5) FROM points $$, 'one attribute a thousand times');
SELECT throws_ok($$ SELECT * FROM abacus_interpolate('wide', 'SELECT id, x, y FROM points', attributes => (SELECT array_agg('a5'::text) FROM generate_series(1, 1001))) $$, '54000', 'at most 1000 attributes can be requested');
SELECT results_eq($$ SELECT vertex, attributes FROM abacus_nearest('wide', 100, 100, 5) $$, $$ SELECT id::bigint, values_of(id, 1000) FROM points ORDER BY (x - 100) ^ 2 + (y - 100) ^ 2 LIMIT 5 $$, 'the nearest');

-- changed
CREATE VIEW more AS SELECT id + 1000 AS id, x, y, z FROM points WHERE id % 3 = 0 -- repeated
    UNION ALL SELECT id + 2000, x + 0.5, y + 0.25, z + 0.125 FROM points WHERE id % 4 = 0;
CREATE VIEW all_points AS TABLE points UNION ALL TABLE more;
SELECT is(abacus_insert('wide', pg_temp.wide('more', 1000)), 175::bigint, 'points are inserted, some equal vertices');
SELECT is(abacus_insert('solid', pg_temp.wide('more', 1000, ', z')), 175::bigint, 'in space');
SELECT pg_temp.sound(mesh, mesh) FROM unnest('{wide,solid}'::text[]) mesh;
SELECT pg_temp.holds(mesh, 'all_points', 1000, 'all values of ' || mesh) FROM unnest('{wide,solid}'::text[]) mesh;
SELECT cmp_ok((SELECT max(length(page::bytea)) FROM solid_vertices), '>', 7936, 'a repeated point in space takes more than a full page');
SELECT is(abacus_update('wide', 'SELECT id, x, y, 1 AS a1000, 2 AS a1 FROM all_points'), 475::bigint, 'of all points the last and the first attribute are updated');
SELECT is((SELECT count(*) FROM abacus_vertices('wide') WHERE attributes[1000] = 1 AND attributes[1] = 2 AND attributes[2:999] IS NOT DISTINCT FROM (values_of(id, 999))[2:999]), 475::bigint, 'and no other');
SELECT is(abacus_update('wide', format('SELECT id, x, y, %s FROM all_points', (SELECT string_agg(format('value_of(id, %s) AS a%1$s', i), ', ') FROM unnest('{1,1000}'::int[]) i))), 475::bigint, 'back');
SELECT pg_temp.holds('wide', 'all_points', 1000, 'all values');
SELECT is(abacus_delete('wide', 'SELECT id, x, y FROM points WHERE id % 2 = 0'), 150::bigint, 'repeated ones take over');
SELECT pg_temp.holds('wide', 'all_points WHERE id > 300 OR id % 2 = 1', 1000, 'with their attributes');
SELECT is(abacus_insert('wide', pg_temp.wide('(SELECT id + 5000 AS id, x, y, z FROM points) p', 1000), on_duplicate => 'replace'), 300::bigint, 'all are replaced');
SELECT pg_temp.holds('wide', '(SELECT id + 5000 AS id FROM points UNION ALL SELECT id FROM more WHERE id > 2000) p', 1000, 'by the new ones');
SELECT pg_temp.sound('wide', 'the mesh');
SELECT is(abacus_delete('wide', 'SELECT id, x, y FROM all_points WHERE id NOT IN (1, 2)'), 373::bigint, 'all leave but two');
SELECT pg_temp.sound('wide', 'what waits');
SELECT pg_temp.holds('wide', '(VALUES (5001), (5002)) p(id)', 1000, 'and wait');
SELECT is((SELECT count(*) FROM abacus_vertices('wide') WHERE sequence IS NOT NULL), 2::bigint, 'without simplices');

-- points that wait
SELECT is(abacus_stage('wide', pg_temp.wide('points WHERE id BETWEEN 10 AND 20', 1000)), 11::bigint, 'points are staged');
SELECT pg_temp.holds('wide', '(SELECT id FROM points WHERE id BETWEEN 10 AND 20 UNION ALL VALUES (5001), (5002)) p', 1000, 'and wait with their attributes');
SELECT is(abacus_update('wide', 'SELECT id, x, y, 7 AS a500 FROM points WHERE id = 11'), 1::bigint, 'one of them is updated');
SELECT is((SELECT attributes[500] FROM abacus_vertices('wide') WHERE id = 11), 7::float8, 'it is so');
SELECT is(abacus_update('wide', 'SELECT id, x, y, value_of(id, 500) AS a500 FROM points WHERE id = 11'), 1::bigint, 'and back');
SELECT pg_temp.sound('wide', 'what waits');
SELECT isnt(abacus_insert('wide', pg_temp.wide('points WHERE id > 100', 1000)), NULL, 'and come in with others');
SELECT pg_temp.holds('wide', '(SELECT id FROM points WHERE id BETWEEN 10 AND 20 OR id > 100 UNION ALL VALUES (5001), (5002)) p', 1000, 'all of them');
SELECT pg_temp.sound('wide', 'the mesh');
SELECT lives_ok($$ SELECT abacus_create('empty', 3, ARRAY(SELECT 'a' || i FROM generate_series(1, 1000) i)) $$, 'an empty mesh');
SELECT is(abacus_stage('empty', pg_temp.wide('points', 1000, ', z')), 300::bigint, 'where all wait');
SELECT is((SELECT count(*) FROM empty_vertices), 300::bigint, 'each in a row');
SELECT is((SELECT max(pg_column_size(v)) < 8160 FROM empty_vertices v), true, 'which a heap page has room for');
SELECT isnt(abacus_triangulate('empty'), NULL, 'are triangulated');
SELECT pg_temp.holds('empty', 'points', 1000, 'with all values');
SELECT pg_temp.sound('empty', 'it');

-- the limit
SELECT throws_ok($$ SELECT abacus_add_attribute('solid', 'one_more') $$, '54000', 'a mesh can have at most 1000 attributes');
SELECT throws_ok($$ SELECT abacus_create('wider', 2, ARRAY(SELECT 'a' || i FROM generate_series(1, 1001) i)) $$, '54000', 'a mesh can have at most 1000 attributes');
SELECT throws_ok(format('SELECT abacus_triangulate(%L, %L)', 'wider', pg_temp.wide('points', 1001)), '54000', 'a mesh can have at most 1000 attributes');
CREATE FUNCTION pg_temp.hint(command text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE found text; BEGIN EXECUTE command; RETURN NULL; EXCEPTION WHEN program_limit_exceeded THEN GET STACKED DIAGNOSTICS found = PG_EXCEPTION_HINT; RETURN found; END $$;
SELECT is(pg_temp.hint($$ SELECT abacus_add_attribute('solid', 'one_more') $$), 'Drop attributes that are not needed with abacus_drop_attribute(), or keep them in another mesh.', 'the hint');
SELECT pg_temp.holds('solid', 'all_points', 1000, 'nothing has changed');

-- dropped, renamed, added
SELECT lives_ok($$ SELECT abacus_drop_attribute('solid', 'a400'), abacus_rename_attribute('solid', 'a1000', 'last') $$, 'one is dropped, and another one renamed');
SELECT bag_eq($$ SELECT id, attributes FROM abacus_vertices('solid') $$, $$ SELECT id::bigint, (values_of(id, 1000))[:399] || (values_of(id, 1000))[401:] FROM all_points $$, 'the others are there');
SELECT is((SELECT array_agg(name) FROM (SELECT name FROM abacus_attributes('solid') OFFSET 996) n), '{a998,a999,last}', 'with their names');
SELECT lives_ok($$ SELECT abacus_add_attribute('solid', 'one_more') $$, 'there is room for one more');
SELECT is(abacus_update('solid', 'SELECT id, x, y, z, id AS one_more FROM all_points'), 475::bigint, 'which gets values');
SELECT bag_eq($$ SELECT id, attributes FROM abacus_vertices('solid') $$, $$ SELECT id::bigint, (values_of(id, 1000))[:399] || (values_of(id, 1000))[401:] || id::float8 FROM all_points $$, 'all of them');
SELECT pg_temp.sound('solid', 'the mesh');
SELECT isnt(abacus_triangulate('growing', pg_temp.wide('points WHERE id <= 50', 99)), NULL, 'a mesh with 99 attributes');
SELECT is(pg_temp.name_rows('growing'), 0::bigint, 'has its names in the header');
SELECT lives_ok($$ SELECT abacus_add_attribute('growing', 'a100') $$, 'with 100');
SELECT is((SELECT array_agg(get_byte(page::bytea, 6)) FROM growing WHERE code = -1), '{4}', 'as well');
SELECT lives_ok($$ SELECT abacus_add_attribute('growing', 'a101') $$, 'with 101');
SELECT is((SELECT array_agg(get_byte(page::bytea, 6)) FROM growing WHERE (code, part) = (-1, 0)), '{6}', 'it comes to format 6');
SELECT is(pg_temp.name_rows('growing'), 1::bigint, 'with a row of names');
SELECT pg_temp.sound('growing', 'it');
SELECT lives_ok($$ SELECT abacus_drop_attribute('growing', 'a101') $$, 'with 100 again');
SELECT is((SELECT array_agg(get_byte(page::bytea, 6)) FROM growing WHERE (code, part) = (-1, 0)), '{4}', 'it is as before');
SELECT pg_temp.holds('growing', 'points WHERE id <= 50', 100, 'with all values') FROM (SELECT abacus_update('growing', 'SELECT id, x, y, value_of(id, 100) AS a100 FROM points WHERE id <= 50')) u;
SELECT pg_temp.sound('growing', 'it');

-- labels beside them
SELECT is(abacus_label('solid', 'SELECT code, v0, v1, v2, v3, v0 AS first, v3 AS last_one FROM abacus_simplices(''solid'')') > 0, true, 'simplices get labels');
SELECT is(abacus_labels('solid'), '{first,last_one}', 'with names');
SELECT is((SELECT count(*) FROM abacus_cells('solid') WHERE labels[1] IS DISTINCT FROM v0 OR labels[2] IS DISTINCT FROM v3), 0::bigint, 'which they keep');
SELECT is((SELECT array_agg(name) FROM (SELECT name FROM abacus_attributes('solid') OFFSET 997) n), '{a999,last,one_more}', 'and attributes theirs');
SELECT pg_temp.sound('solid', 'it');

-- loaded
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('bare');
SELECT isnt(abacus_load('loaded', pg_temp.wide('points', 1000), 'TABLE triangles'), NULL, 'a loaded mesh');
SELECT pg_temp.holds('loaded', 'points', 1000, 'with all values');
SELECT pg_temp.sound('loaded', 'it');
SELECT isnt(abacus_load('holes', pg_temp.wide('points', 1000), 'SELECT * FROM triangles WHERE v0 % 7 > 0'), NULL, 'one with holes');
SELECT pg_temp.holds('holes', 'points WHERE EXISTS (SELECT FROM triangles WHERE v0 % 7 > 0 AND id IN (v0, v1, v2))', 1000, 'with all values');
SELECT pg_temp.sound('holes', 'it');

-- published
SELECT lives_ok($$ SELECT abacus_publish('solid', 'cells', 'solid_points') $$, 'published');
SELECT bag_eq('SELECT id, a1, a399, a401, last, one_more FROM solid_points', 'SELECT id::bigint, value_of(id, 1) AS a1, value_of(id, 399) AS a399, value_of(id, 401) AS a401, value_of(id, 1000) AS last, id::float8 AS one_more FROM all_points WHERE id < 1000 OR id > 2000', 'columns of points');
SELECT bag_eq('SELECT id FROM solid_points WHERE one_more BETWEEN 40 AND 60', 'SELECT id::bigint FROM all_points WHERE id BETWEEN 40 AND 60', 'a condition on the last one');
SELECT is((SELECT min(cardinality("values")) FROM cells), 4000, 'cells');

-- a table that a mesh follows
SELECT lives_ok(format('CREATE TABLE followed (id bigint, x float8, y float8, %s)', (SELECT string_agg(format('a%s float8', i), ', ') FROM generate_series(1, 1000) i)), 'a table with 1,000 columns more');
SELECT lives_ok('INSERT INTO followed ' || pg_temp.wide('points', 1000), 'with points');
SELECT lives_ok($$ SELECT abacus_create('follower', 2, ARRAY(SELECT 'a' || i FROM generate_series(1, 1000) i)) $$, 'a mesh');
SELECT is((SELECT abacus_track('follower', 'followed')), 300::bigint, 'that follows it');
CREATE FUNCTION pg_temp.in_step(what text) RETURNS text LANGUAGE sql AS $$
    SELECT bag_eq($q$ SELECT id, x, y, attributes[1] AS a1, attributes[500] AS a500, attributes[1000] AS a1000 FROM abacus_vertices('follower') $q$, 'SELECT id, x, y, a1, a500, a1000 FROM followed', what) $$;
SELECT pg_temp.in_step('in step');
UPDATE followed SET a1000 = 1000, a1 = NULL WHERE id % 3 = 0;
SELECT pg_temp.in_step('after an update');
UPDATE followed SET x = x + 0.125 WHERE id % 5 = 0;
DELETE FROM followed WHERE id % 4 = 0;
SELECT lives_ok('INSERT INTO followed ' || pg_temp.wide('more', 1000), 'more points');
SELECT pg_temp.in_step('after all changes');
SELECT pg_temp.sound('follower', 'it');

-- carried by the text of its rows, like a dump
CREATE TABLE restored OF abacus_simplex_page (page WITH OPTIONS NOT NULL, PRIMARY KEY (code, part));
CREATE TABLE restored_vertices OF abacus_vertex_page (page WITH OPTIONS NOT NULL, PRIMARY KEY (first, part));
INSERT INTO restored SELECT code, part, page::text::abacus_page FROM solid;
INSERT INTO restored_vertices SELECT first, part, page::text::abacus_page FROM solid_vertices;
SELECT bag_eq($$ SELECT id, attributes FROM abacus_vertices('restored') $$, $$ SELECT id, attributes FROM abacus_vertices('solid') $$, 'restored');
SELECT pg_temp.sound('restored', 'it');
SELECT is(abacus_delete('restored', 'SELECT id, x, y, z FROM points WHERE id < 50'), 49::bigint, 'and changed');
SELECT pg_temp.sound('restored', 'it');

-- damage is noticed
CREATE FUNCTION pg_temp.damaged(command text, what text, kind text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE found text; error text := 'none';
BEGIN
    BEGIN
        EXECUTE command;
        SELECT fault INTO found FROM abacus_check('loaded') LIMIT 1;
        BEGIN
            PERFORM abacus_locate('loaded', 1, 1);
        EXCEPTION WHEN data_corrupted THEN error := 'corrupted';
        END;
        RAISE EXCEPTION 'undo';
    EXCEPTION WHEN raise_exception THEN
    END;
    RETURN NEXT is(found, kind, what);
    RETURN NEXT is(error, CASE kind WHEN 'header' THEN 'corrupted' ELSE 'none' END, what || ': to readers');
END $$;
SELECT pg_temp.damaged($$ DELETE FROM loaded WHERE (code, part) = (-1, 4) $$, 'a missing row of names', 'header');
SELECT pg_temp.damaged($$ UPDATE loaded SET page = substr(page::bytea, 1, 640)::abacus_page WHERE (code, part) = (-1, 4) $$, 'one cut off', 'header');
SELECT pg_temp.damaged($$ UPDATE loaded SET page = set_byte(page::bytea, 64, 0)::abacus_page WHERE (code, part) = (-1, 4) $$, 'an empty name', 'header');
SELECT pg_temp.damaged($$ UPDATE loaded SET page = set_byte(page::bytea, 64, 255)::abacus_page WHERE (code, part) = (-1, 4) $$, 'a name that is no text', 'header');
SELECT pg_temp.damaged($$ INSERT INTO loaded SELECT code, 10, page FROM loaded WHERE (code, part) = (-1, 9) $$, 'a row of names too many', 'interval');
SELECT * FROM finish();
ROLLBACK;

-- A mesh that follows lines given as geometries: vertices that they make, values, rights, and every error.
BEGIN;
SELECT count(*) > 0 AS has_postgis FROM pg_available_extensions WHERE name = 'postgis' \gset
\if :has_postgis
SELECT no_plan();
SET client_min_messages = warning;
CREATE EXTENSION IF NOT EXISTS postgis;

CREATE TABLE spot (id int PRIMARY KEY, x float8, y float8, h float8);
INSERT INTO spot SELECT 10 * i + j, i, j, i + j FROM generate_series(0, 5) AS i, generate_series(0, 5) AS j;
CREATE TABLE breakline (id int PRIMARY KEY, geom geometry, kind text);
INSERT INTO breakline VALUES (1, 'LINESTRING Z (0 0 0, 0.5 0.5 100, 1 1 2)', 'hard'), (2, 'LINESTRING Z (0.5 0.5 100, 0.5 1.5 101)', 'soft'), (3, NULL, 'soft');
SELECT abacus_create('ground', 2, '{h}');

-- in its own transactions the mesh catches up at once
CREATE FUNCTION pg_temp.made() RETURNS TABLE (id bigint, x float8, y float8, h float8) LANGUAGE sql AS
    $$ SELECT id, x, y, attributes[1] FROM abacus_vertices('ground') WHERE id < 0 ORDER BY id DESC $$;
CREATE FUNCTION pg_temp.in_step(what text) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT results_eq('SELECT line, ST_AsText(ST_MakeLine(ST_MakePoint(x, y) ORDER BY position)), kind FROM abacus_lines(''ground'') GROUP BY line, kind ORDER BY line',
                      'SELECT id::bigint, ST_AsText(ST_Force2D(geom)), coalesce(kind, ''hard'') FROM breakline WHERE geom IS NOT NULL ORDER BY id', what || ': lines') UNION ALL
    SELECT is_empty('SELECT id, x, y, h FROM spot WHERE x IS NOT NULL EXCEPT ALL SELECT id, x, y, attributes[1] FROM abacus_vertices(''ground'')', what || ': points') UNION ALL
    SELECT is_empty('SELECT * FROM abacus_check(''ground'')', what || ': sound') $$;

SELECT is(abacus_track_lines('ground', 'breakline', kind => 'kind', z => 'h'), 2::bigint, 'lines alone: an empty mesh gets them');
SELECT results_eq('SELECT x, y, h FROM pg_temp.made()', 'VALUES (0.0::float8, 0.0::float8, 0.0::float8), (0.5, 0.5, 100), (1, 1, 2), (0.5, 1.5, 101)', 'all vertices are theirs');
SELECT is(abacus_track('ground', 'spot'), 38::bigint, 'points that come later replace vertices that lines have made');
SELECT results_eq('SELECT x, y, h FROM pg_temp.made()', 'VALUES (0.5::float8, 0.5::float8, 100::float8), (0.5, 1.5, 101)', 'others stay');
SET CONSTRAINTS ALL IMMEDIATE;
SELECT pg_temp.in_step('points and lines');
SELECT is((SELECT array_agg(kind ORDER BY line) FROM (SELECT DISTINCT line, kind FROM abacus_lines('ground')) AS l), '{hard,soft}', 'kinds are those of the column');

-- vertices that lines have made come and go
CREATE TEMP TABLE before AS SELECT * FROM pg_temp.made();
UPDATE breakline SET geom = 'LINESTRING Z (0 0 0, 0.5 0.5 100, 0 1 1)' WHERE id = 1;
SELECT results_eq('SELECT * FROM pg_temp.made()', 'TABLE before', 'a vertex that stays keeps its id');
DELETE FROM breakline WHERE id = 1;
SELECT results_eq('SELECT * FROM pg_temp.made()', 'TABLE before', 'a vertex that another line names stays');
UPDATE breakline SET geom = 'LINESTRING Z (0.5 0.5 55, 0.5 1.5 101)' WHERE id = 2;
SELECT results_eq('SELECT h FROM pg_temp.made()', 'VALUES (55::float8), (101)', 'it gets another value');
INSERT INTO breakline VALUES (4, 'LINESTRING (0.5 0.5, 1.5 0.5)');
SELECT results_eq('SELECT h FROM pg_temp.made()', 'VALUES (55::float8), (101), (NULL)', 'a line without Z gives none');
UPDATE breakline SET geom = ST_Force2D(geom) WHERE id = 2;
SELECT results_eq('SELECT h FROM pg_temp.made()', 'VALUES (NULL::float8), (NULL), (NULL)', 'a value goes with the line that gave it');
UPDATE breakline SET geom = 'LINESTRING Z (0.5 0.5 7, 1.5 0.5 8)' WHERE id = 4;
SELECT results_eq('SELECT x, y, h FROM pg_temp.made()', 'VALUES (0.5::float8, 0.5::float8, 7::float8), (0.5, 1.5, NULL), (1.5, 0.5, 8)', 'another line gives one');
UPDATE breakline SET geom = NULL WHERE id = 2;
SELECT results_eq('SELECT x, y FROM pg_temp.made()', 'VALUES (0.5::float8, 0.5::float8), (1.5, 0.5)', 'a row without a geometry is no line');
SELECT pg_temp.in_step('NULL');
SELECT throws_ok($$ INSERT INTO breakline VALUES (5, 'LINESTRING Z (0.5 0.5 9, 1 0 1)') $$, '22023', 'attribute "h" has two values at (0.5, 0.5)', 'two lines with two values');
SELECT throws_ok($$ UPDATE breakline SET geom = 'LINESTRING Z (0 0 9, 0.5 0.5 7)' WHERE id = 4 $$, '22023', 'attribute "h" has two values at (0, 0)', 'a line with another value than a point');
SELECT throws_ok($$ INSERT INTO breakline VALUES (5, 'LINESTRING (0 1, 2 0.1)') $$, '22023', 'lines cross', 'lines that cross');
SELECT throws_ok($$ INSERT INTO breakline VALUES (5, 'SRID=4326;LINESTRING (3 3, 4 4)'), (6, 'SRID=2154;LINESTRING (4 3, 5 4)') $$, '22023', NULL, 'two systems');
SELECT throws_ok($$ INSERT INTO breakline VALUES (5, 'POINT (3 3)') $$, '22023', NULL, 'no line');
SELECT throws_ok($$ INSERT INTO breakline VALUES (5, 'LINESTRING (3 3, 3 3)') $$, '22023', 'line 5 has a segment of length zero', 'no length');
SELECT lives_ok($$ INSERT INTO breakline VALUES (5, 'LINESTRING EMPTY') $$, 'an empty geometry is no line');
DELETE FROM breakline WHERE id = 5;
SELECT pg_temp.in_step('after errors');

-- a point comes where a line has made a vertex, and goes again
INSERT INTO spot VALUES (100, 0.5, 0.5, 7);
SELECT results_eq('SELECT x, y FROM pg_temp.made()', 'VALUES (1.5::float8, 0.5::float8)', 'a point of the table is the vertex');
SELECT is((SELECT point FROM abacus_lines('ground') WHERE line = 4 AND position = 1), 100::bigint, 'which the line names');
DELETE FROM spot WHERE id = 100;
SELECT is((SELECT count(*) FROM pg_temp.made() WHERE (x, y, h) = (0.5, 0.5, 7)), 1::bigint, 'without it the line has made it');
DELETE FROM spot WHERE id = 11;
SELECT pg_temp.in_step('a point at the end of no line goes');
SET CONSTRAINTS ALL DEFERRED;
UPDATE spot SET x = 0.5, y = 0.5, h = 1 WHERE id = 22;
SELECT throws_ok('SET CONSTRAINTS ALL IMMEDIATE', '22023', 'attribute "h" has two values at (0.5, 0.5)', 'a point with another value');
UPDATE spot SET h = 7 WHERE id = 22;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT pg_temp.in_step('a point moves onto a line');
UPDATE spot SET x = 1.5, h = 8 WHERE id = 22;
SELECT pg_temp.in_step('and along it');

-- a point within a segment splits it
INSERT INTO spot VALUES (101, 1, 0.5, 3);
SELECT is((SELECT count(*) FROM abacus_edges('ground', fixed => true)), 2::bigint, 'a segment in two edges');
DELETE FROM spot WHERE id = 101;
SELECT is((SELECT count(*) FROM abacus_edges('ground', fixed => true)), 1::bigint, 'and in one');

-- labels and markers of what stays
SELECT abacus_label('ground', 'SELECT code, v0, v1, v2, 5 AS soil FROM abacus_simplices(''ground'')') > 0 AS labelled;
CREATE TEMP TABLE far AS SELECT v0, v1, v2 FROM abacus_cells('ground', label => 'soil') WHERE least(v0, v1, v2) >= 40;
UPDATE breakline SET geom = ST_Translate(geom, 0, -0.25, 0) WHERE id = 4;
SELECT is_empty($$ TABLE far EXCEPT SELECT v0, v1, v2 FROM abacus_cells('ground', label => 'soil') $$, 'triangles that stay keep their labels');
SELECT isnt_empty('TABLE far', 'there are some');

-- everything goes and comes
TRUNCATE breakline;
SELECT is_empty('SELECT * FROM pg_temp.made()', 'no line, no vertex');
INSERT INTO breakline VALUES (1, 'MULTILINESTRING ((0.25 0.25, 0.75 0.25), (0.25 0.75, 0.75 0.75))');
TRUNCATE spot;
SELECT is((SELECT count(*) FROM abacus_vertices('ground')), 4::bigint, 'the vertices of the lines are left');
SELECT is((SELECT count(*) FROM abacus_edges('ground', fixed => true)), 2::bigint, 'with their edges');
DELETE FROM breakline;
SELECT is((SELECT count(*) FROM abacus_vertices('ground')), 0::bigint, 'nothing is left');
INSERT INTO breakline VALUES (1, 'LINESTRING (0 0, 4 0)');
INSERT INTO breakline VALUES (2, 'LINESTRING (1 0, 2 0)');
UPDATE breakline SET geom = 'LINESTRING (1 0, 3 0)' WHERE id = 2;
SELECT is((SELECT count(*) FROM abacus_vertices('ground')), 4::bigint, 'lines wait for a triangle');
INSERT INTO spot VALUES (1, 2, 2, 0);
SELECT is((SELECT count(*) FROM abacus_edges('ground', fixed => true)), 3::bigint, 'and get their edges with it');
DELETE FROM spot;
SELECT is((SELECT count(*) FROM abacus_simplices('ground')), 0::bigint, 'and wait again');
DELETE FROM breakline WHERE id = 1;
SELECT is((SELECT count(*) FROM abacus_vertices('ground')), 2::bigint, 'lines that wait may go');
SELECT pg_temp.in_step('waiting');
INSERT INTO spot SELECT 10 * i + j, i, j, i + j FROM generate_series(0, 5) AS i, generate_series(0, 5) AS j;
SELECT pg_temp.in_step('all again');

-- by hand
SELECT throws_ok($$ SELECT abacus_constrain('ground', 'VALUES (9, 1, 50), (9, 2, 51)') $$, '55000', 'lines of mesh "ground" are rows of table "breakline", which it follows', 'no line by hand');
SELECT throws_ok($$ SELECT abacus_unconstrain('ground', 'VALUES (2)') $$, '55000', NULL, 'nor without one');
SELECT abacus_untrack('ground', 'spot');
SELECT throws_ok($$ SELECT abacus_drop_attribute('ground', 'h') $$, '55000', NULL, 'the attribute of Z stays');
SELECT lives_ok($$ SELECT abacus_insert('ground', 'VALUES (900, 0.5, 2.5, 1)') $$, 'points that follow no table are changed by hand');
SELECT throws_ok($$ SELECT abacus_track('ground', 'spot') $$, '55000', NULL, 'and are surplus for a table');
SELECT is(abacus_track('ground', 'spot', synchronize => true), 36::bigint, 'which takes them out');
SELECT pg_temp.in_step('synchronized');

-- many attributes are apart from the simplices
DO $$ DECLARE
    names text := (SELECT string_agg('a' || i, ',') FROM generate_series(1, 40) AS i);
BEGIN
    EXECUTE 'CREATE TABLE wide (id int PRIMARY KEY, x float8, y float8, ' || replace(names, ',', ' float8,') || ' float8)';
    INSERT INTO wide (id, x, y, a3, a40) SELECT i, i % 71, i / 71, i, -i FROM generate_series(0, 3000) AS i;
    PERFORM abacus_create('wide_mesh', 2, ('{' || names || '}')::text[]);
    PERFORM abacus_track('wide_mesh', 'wide');
END $$;
CREATE TABLE wide_line (id int, geom geometry);
INSERT INTO wide_line VALUES (1, 'LINESTRING Z (0.5 0.5 7, 10.5 0.5 8)'), (2, 'LINESTRING Z (10.5 0.5 8, 10.5 9.5 9)');
SELECT abacus_track_lines('wide_mesh', 'wide_line', z => 'a3');
SELECT results_eq($$ SELECT id, attributes[3] FROM abacus_vertices('wide_mesh') WHERE id < 0 ORDER BY id DESC $$, 'VALUES (-1::bigint, 7::float8), (-2, 8), (-3, 9)', 'apart: vertices that lines make');
UPDATE wide_line SET geom = 'LINESTRING Z (0.5 0.5 7, 10.5 0.25 5)' WHERE id = 1;
INSERT INTO wide (id, x, y, a3) VALUES (9000, 0.5, 0.5, 7);
SELECT results_eq($$ SELECT id, attributes[3] FROM abacus_vertices('wide_mesh') WHERE id < 0 ORDER BY id DESC $$, 'VALUES (-2::bigint, 8::float8), (-3, 9), (-4, 5)', 'apart: they come and go');
DELETE FROM wide WHERE id = 9000;
DELETE FROM wide_line;
SELECT is((SELECT count(*) FROM abacus_vertices('wide_mesh') WHERE id < 0), 0::bigint, 'apart: all have gone');
SELECT is_empty($$ SELECT * FROM abacus_check('wide_mesh') $$, 'apart: sound');

-- rights: the writer of a table needs none on the mesh
CREATE ROLE track_lines_owner; CREATE ROLE track_lines_writer;
CREATE SCHEMA place; GRANT USAGE ON SCHEMA place TO track_lines_owner, track_lines_writer;
GRANT CREATE ON SCHEMA place TO track_lines_owner;
SET ROLE track_lines_owner;
CREATE TABLE place.edge (line int, geom geometry);
SELECT abacus_create('place.field', 2);
SELECT abacus_insert('place.field', 'VALUES (1, 0, 0), (2, 9, 0), (3, 9, 9), (4, 0, 9)');
SELECT abacus_track_lines('place.field', 'place.edge');
GRANT SELECT, INSERT, UPDATE, DELETE, TRUNCATE ON place.edge TO track_lines_writer;
SET ROLE track_lines_writer;
SELECT lives_ok($$ INSERT INTO place.edge VALUES (1, 'LINESTRING (1 1, 5 5)') $$, 'a writer of the table needs no right on the mesh');
SELECT throws_ok($$ SELECT count(*) FROM abacus_lines('place.field') $$, '42501', NULL, 'and has none');
SELECT throws_ok($$ SELECT abacus_track_lines('place.field', 'place.edge') $$, '42501', NULL, 'nor may he track it');
CREATE TEMP TABLE fake (line int, geom geometry);
CREATE TRIGGER fake AFTER INSERT ON fake REFERENCING NEW TABLE AS n FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked_lines('place.field', 'hard', '', '', 'line', 'geom');
SELECT throws_ok($$ INSERT INTO fake VALUES (1, 'LINESTRING (1 1, 5 5)') $$, '55000', NULL, 'a trigger by hand reaches no mesh');
DROP TABLE fake;
RESET ROLE;
SELECT is((SELECT count(*) FROM abacus_lines('place.field')), 2::bigint, 'the line is there');
ALTER TABLE place.edge ENABLE ROW LEVEL SECURITY;
CREATE POLICY few ON place.edge USING (line > 100);
SET ROLE track_lines_owner;
INSERT INTO place.edge VALUES (2, 'LINESTRING (1 2, 5 6)');
SELECT is((SELECT count(DISTINCT line) FROM abacus_lines('place.field')), 2::bigint, 'policies do not hide lines from the owner');
RESET ROLE;
ALTER TABLE place.edge FORCE ROW LEVEL SECURITY;
SELECT throws_ok($$ INSERT INTO place.edge VALUES (3, 'LINESTRING (1 3, 5 7)') $$, '42501', NULL, 'policies that would are an error');
ALTER TABLE place.edge NO FORCE ROW LEVEL SECURITY;
-- another owner of lines
CREATE ROLE track_lines_other; GRANT USAGE, CREATE ON SCHEMA place TO track_lines_other;
SET ROLE track_lines_owner;
SELECT abacus_untrack('place.field', 'place.edge');
DELETE FROM place.edge;
SET ROLE track_lines_other;
CREATE TABLE place.others (line int, "position" int, point int);
SELECT throws_ok($$ SELECT abacus_track_lines('place.field', 'place.others') $$, '42501', NULL, 'not without rights on the mesh');
RESET ROLE;
GRANT SELECT, INSERT, UPDATE, DELETE ON place.field, place.field_vertices, place.field_lines TO track_lines_other;
SET ROLE track_lines_other;
SELECT throws_ok($$ SELECT abacus_track_lines('place.field', 'place.others') $$, '55000', NULL, 'lines that are there are surplus');
SELECT is(abacus_track_lines('place.field', 'place.others', synchronize => true), 0::bigint, 'with rights');
INSERT INTO place.others VALUES (1, 1, 1), (1, 2, 3);
RESET ROLE;
SELECT is((SELECT count(*) FROM abacus_edges('place.field', fixed => true)), 1::bigint, 'their lines are fixed edges');
REVOKE INSERT ON place.field FROM track_lines_other;
SELECT throws_ok($$ INSERT INTO place.others VALUES (2, 1, 1), (2, 2, 2) $$, '42501', NULL, 'rights are checked each time');
DROP TABLE place.field;
SELECT lives_ok($$ INSERT INTO place.others VALUES (2, 1, 1), (2, 2, 2) $$, 'without the mesh nothing follows');

-- calls that are not those of abacus_track_lines()
SELECT throws_ok('SELECT abacus_tracked_lines()', '39P01', NULL, 'no trigger');
CREATE TABLE own (line int, geom geometry);
CREATE TRIGGER t BEFORE INSERT ON own FOR EACH ROW EXECUTE FUNCTION abacus_tracked_lines('ground', 'hard', '', '', 'line', 'geom');
SELECT throws_ok($$ INSERT INTO own VALUES (1, NULL) $$, '39P01', NULL, 'not before');
DROP TRIGGER t ON own;
CREATE TRIGGER t AFTER INSERT ON own REFERENCING NEW TABLE AS n FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked_lines('ground', 'firm', '', '', 'line', 'geom');
SELECT throws_ok($$ INSERT INTO own VALUES (1, NULL) $$, '39P01', 'trigger "t" has wrong arguments', 'wrong arguments');
SELECT * FROM finish();
\else
SELECT plan(1);
SELECT skip('PostGIS is not installed', 1);
\endif
ROLLBACK;

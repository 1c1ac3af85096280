-- The attributes of a mesh: their names and their values.
CREATE SCHEMA regress_attributes;
SET search_path = regress_attributes, public;
SELECT abacus_create('field', 2, '{height,"Depth, m",none}');
SELECT * FROM abacus_attributes('field');
SELECT abacus_insert('field', 'VALUES (1, 0, 0, 5, -1.5, NULL::real), (2, 10, 0, 7, ''-Infinity'', NULL), (3, 0, 10, ''NaN''::float8, 0, NULL)');
SELECT * FROM abacus_attributes('field');
-- points that equal a vertex, and points that wait, count
SELECT abacus_insert('field', 'VALUES (4, 0, 0, 100, 0, 0)');
SELECT abacus_stage('field', 'VALUES (5, 3, 3, -100, 0, -0.0)');
SELECT * FROM abacus_attributes('field');
SELECT least, greatest FROM abacus_attributes('field') WHERE name = 'height';
SELECT abacus_create('plain', 3);
SELECT * FROM abacus_attributes('plain');
SELECT * FROM abacus_attributes(NULL);
SELECT abacus_attributes('pg_class');

-- messages list them
SELECT abacus_draw('field', attribute => 'Height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('plain', '{0,0,0}', '{0,0,1}', attribute => 'vs');

-- other names
SELECT abacus_rename_attribute('field', 'height', 'Height');
SELECT length(abacus_draw('field', 8, 8, attribute => 'Height')) > 0 AS drawn;
SELECT abacus_rename_attribute('field', 'height', 'h');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_rename_attribute('field', 'Height', 'none');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_rename_attribute('field', 'Height', 'Height');
SELECT abacus_rename_attribute('field', 'Height', '');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_rename_attribute('field', 'Height', repeat('x', 64));
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_rename_attribute('field', 'Height', NULL);
BEGIN;
SELECT abacus_rename_attribute('field', 'Height', 'z');
SELECT string_agg(name, '|' ORDER BY position) FROM abacus_attributes('field');
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_rename_attribute('field', 'Height', 'z');
COMMIT;
SELECT string_agg(name, '|' ORDER BY position) FROM abacus_attributes('field');
-- nothing else has changed
SELECT * FROM abacus_check('field');
SELECT id, attributes FROM abacus_vertices('field') ORDER BY id;
-- also of a mesh that is not Delaunay
SELECT abacus_load('loaded', 'VALUES (1, 0, 0, 1), (2, 4, 0, 2), (3, 4, 1, 3), (4, 0, 1, 4), (5, 2, 0.1, 5)',
                   'VALUES (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)', '{h}');
SELECT abacus_rename_attribute('loaded', 'h', 'height');
SELECT * FROM abacus_attributes('loaded');
-- users who may change the mesh may rename; users who may read it may ask
CREATE ROLE regress_attributes_user;
GRANT USAGE ON SCHEMA regress_attributes TO regress_attributes_user;
SET ROLE regress_attributes_user;
SELECT * FROM abacus_attributes('field');
RESET ROLE;
GRANT SELECT ON field, field_vertices TO regress_attributes_user;
SET ROLE regress_attributes_user;
SELECT name FROM abacus_attributes('field');
SELECT abacus_rename_attribute('field', 'Height', 'z');
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;

-- more attributes, and fewer: of vertices, of equal points, of points that wait
SELECT abacus_create('changing', 2, '{a,b}');
SELECT abacus_insert('changing', 'SELECT i, i % 30, i / 30, i, -i FROM generate_series(0, 899) i');
SELECT abacus_insert('changing', 'VALUES (1000, 3, 3, 1, 2), (1001, 3, 3, 3, 4)');
SELECT abacus_stage('changing', 'VALUES (2000, 0.5, 0.5, 5, 6)');
CREATE TABLE simplices AS SELECT * FROM abacus_simplices('changing');
SELECT abacus_add_attribute('changing', 'c');
SELECT * FROM abacus_attributes('changing');
SELECT id, attributes, vertex FROM abacus_vertices('changing') WHERE id IN (93, 1000, 1001, 2000) ORDER BY id;
SELECT count(*) FROM (SELECT * FROM abacus_simplices('changing') EXCEPT TABLE simplices) s;
SELECT abacus_add_attribute('changing', 'd'), abacus_add_attribute('changing', 'e'), abacus_add_attribute('changing', 'f');
SELECT abacus_update('changing', 'SELECT i AS id, i % 30 AS x, i / 30 AS y, 100 + i AS f, i / 2 AS c FROM generate_series(0, 899) i');
SELECT count(*) > 0 AS apart FROM changing WHERE code < -1;
SELECT abacus_drop_attribute('changing', 'b');
SELECT id, attributes FROM abacus_vertices('changing') WHERE id IN (93, 1000, 1001, 2000) ORDER BY id;
SELECT position, name, "least", "greatest", nulls FROM abacus_attributes('changing');
SELECT * FROM abacus_check('changing');
SELECT bool_and(abacus_interpolate('changing', i % 30, i / 30, attribute => 'f') = 100 + i) FROM generate_series(0, 899) i;
SELECT abacus_drop_attribute('changing', name) FROM (VALUES ('a'), ('c'), ('d'), ('e')) AS names(name);
SELECT id, attributes FROM abacus_vertices('changing') WHERE id IN (93, 1000) ORDER BY id;
BEGIN;
SELECT abacus_drop_attribute('changing', 'f');
SELECT id, attributes FROM abacus_vertices('changing') WHERE id IN (93, 1000) ORDER BY id;
SELECT * FROM abacus_attributes('changing');
SELECT abacus_insert('changing', 'VALUES (3000, 7.5, 7.5)');
SELECT * FROM abacus_check('changing');
ROLLBACK;
SELECT count(vertex), sum(attributes[1]) FROM abacus_vertices('changing');
-- an empty mesh
SELECT abacus_create('empty', 3, '{a}');
SELECT abacus_add_attribute('empty', 'b'), abacus_drop_attribute('empty', 'a');
SELECT name FROM abacus_attributes('empty');
-- what it does not do
SELECT abacus_add_attribute('changing', 'f');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_add_attribute('changing', '');
SELECT abacus_drop_attribute('changing', 'a');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_add_attribute('changing', NULL), abacus_drop_attribute('changing', NULL);
SELECT abacus_load('notch', 'VALUES (1, 0, 0, 1), (2, 4, 0, 2), (3, 4, 1, 3), (4, 0, 1, 4), (5, 2, 0.1, 5)', 'VALUES (1, 2, 5), (2, 3, 5), (3, 4, 5)', '{h}');
SELECT abacus_add_attribute('notch', 'more');
SELECT id, attributes FROM abacus_vertices('notch') ORDER BY id;
SELECT abacus_create('full', 2, array_agg('a' || i)) FROM generate_series(1, 1000) i;
SELECT abacus_add_attribute('full', 'more');
\echo :LAST_ERROR_SQLSTATE
BEGIN READ ONLY;
SELECT abacus_drop_attribute('changing', 'f');
COMMIT;
SET ROLE regress_attributes_user;
SELECT abacus_add_attribute('field', 'z');
SELECT abacus_drop_attribute('field', 'Height');
RESET ROLE;
-- a mesh that follows a table, until it does not
CREATE TABLE followed AS SELECT id::int, x, y, attributes[1] AS f FROM abacus_vertices('changing');
SELECT abacus_track('changing', 'followed');
SELECT abacus_add_attribute('changing', 'g');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_drop_attribute('changing', 'f');
SELECT abacus_untrack('changing', 'followed');
SELECT abacus_add_attribute('changing', 'g');
ALTER TABLE followed ADD g float8 DEFAULT 7;
SELECT abacus_track('changing', 'followed', synchronize => true);
SELECT count(*), sum(attributes[2]) FROM abacus_vertices('changing');
SELECT abacus_untrack('changing', 'followed');
-- foreign tables name attributes by their numbers
SELECT abacus_publish('changing', geometry => false);
SELECT abacus_drop_attribute('changing', 'f');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_add_attribute('changing', 'h');
SELECT sum(f), sum(g) FROM changing_points;
SELECT abacus_unpublish('changing') > 0 AS unpublished;
SELECT abacus_drop_attribute('changing', 'f');

SET client_min_messages = warning;
DROP SCHEMA regress_attributes CASCADE;
DROP ROLE regress_attributes_user;

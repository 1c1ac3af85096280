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

SET client_min_messages = warning;
DROP SCHEMA regress_attributes CASCADE;
DROP ROLE regress_attributes_user;

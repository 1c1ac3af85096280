-- Points at the place of others, and points that span no simplex: notices and choices.
CREATE SCHEMA regress_duplicates;
SET search_path = regress_duplicates, public;

-- ways in: each tells how many
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10), (2, 10, 0, 20), (3, 0, 10, 30), (4, 10, 10, 40), (5, 0, 0, 50)', '{height}');
SELECT abacus_insert('field', 'VALUES (6, 10, 0, 60), (7, -0.0, 0, 70), (8, 5, 5, 80), (9, 5, 5, 90)');
SELECT abacus_stage('field', 'VALUES (10, 5, 5, 100)');
SELECT abacus_triangulate('field');
SELECT abacus_stage('field', 'VALUES (11, 5, 5, 110), (12, 5, 6, 120)');
CALL abacus_build('field');
CALL abacus_build('field');
SELECT id, x, y, attributes[1] AS height, vertex FROM abacus_vertices('field') ORDER BY id;

-- a resurveyed height: the place has one point afterwards
SELECT abacus_insert('field', 'VALUES (13, 10, 0, 130)', on_duplicate => 'replace');
SELECT abacus_insert('field', 'VALUES (14, 5, 5, 140), (15, 7, 7, 150), (16, 5, 5, 160), (17, 7, 7, 170)', on_duplicate => 'replace');
SELECT id, x, y, attributes[1] AS height, vertex FROM abacus_vertices('field') ORDER BY id;
SELECT * FROM abacus_check('field');
SELECT name, value FROM abacus_stats('field') WHERE name IN ('vertices', 'duplicates');
-- and is gone when that one is deleted
SELECT abacus_delete('field', 'VALUES (0, 5, 5)');
SELECT count(*) FROM abacus_vertices('field') WHERE x = 5 AND y = 5;

-- refused: nothing changes
SELECT abacus_insert('field', 'VALUES (20, 1, 2, 0), (21, 7, 7, 0)', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', 'VALUES (20, 1, 2, 0), (21, 1, 2, 0)', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', 'VALUES (20, 1, 2, 0), (21, 2, 1, 0)', on_duplicate => 'error');
SELECT abacus_insert('field', 'VALUES (20, 1, 3, 0)', on_duplicate => 'Replace');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', 'VALUES (20, 1, 3, 0)', on_duplicate => NULL);
-- points that waited before are kept as ever
SELECT abacus_stage('field', 'VALUES (30, 1, 2, 1), (31, 3, 3, 1), (32, 3, 3, 2)');
SELECT abacus_insert('field', 'VALUES (33, 4, 3, 3)', on_duplicate => 'error');
SELECT abacus_stage('field', 'VALUES (34, 4, 4, 4)');
SELECT abacus_insert('field', 'VALUES (35, 4, 4, 5)', on_duplicate => 'replace');
SELECT id, x, y, attributes[1] AS height, vertex FROM abacus_vertices('field') WHERE id >= 20 ORDER BY id;
SELECT * FROM abacus_check('field');

-- where all wait: on one line
SELECT abacus_create('line', 2, '{height}');
SELECT abacus_insert('line', 'VALUES (1, 0, 0, 10)');
SELECT abacus_insert('line', 'VALUES (2, 1, 1, 20), (3, 2, 2, 30), (4, 1, 1, 40)');
SELECT abacus_insert('line', 'VALUES (5, 2, 2, 50), (6, 3, 3, 60), (7, 2, 2, 70)', on_duplicate => 'replace');
SELECT id, x, attributes[1] AS height FROM abacus_vertices('line') ORDER BY id;
SELECT abacus_insert('line', 'VALUES (8, 4, 4, 80), (9, 1, 1, 90)', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('line', 'VALUES (8, 4, 4, 80), (9, 4, 4, 90)', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('line', 'VALUES (8, 4, 4, 80)', on_duplicate => 'error');
SELECT abacus_triangulate('line');
CALL abacus_build('line');
-- with one beside it they have a triangle each, and of those at (1, 1) the first is the vertex
SELECT abacus_insert('line', 'VALUES (10, 0, 4, 100), (11, 0, 4, 110), (12, 3, 3, 120)', on_duplicate => 'replace');
SELECT id, x, y, attributes[1] AS height, vertex FROM abacus_vertices('line') ORDER BY id;
SELECT * FROM abacus_check('line');
-- many on a line and again with other heights, more than are held
SELECT abacus_create('long', 2, '{height}');
SELECT abacus_insert('long', 'SELECT i, i % 10000, 0, i FROM generate_series(0, 29999) AS i', on_duplicate => 'replace');
SELECT count(*), min(id), max(id) FROM abacus_vertices('long');
SELECT abacus_insert('long', 'SELECT -i, i, 0, 0 FROM generate_series(1000, 10999) AS i', on_duplicate => 'replace');
SELECT count(*), min(id), max(id), count(*) FILTER (WHERE id < 0) FROM abacus_vertices('long');
SELECT abacus_insert('long', 'VALUES (1, 0, 1, 1)');
SELECT * FROM abacus_check('long');

-- in space
SELECT abacus_triangulate('flat', 'SELECT i, i % 7, i / 7, 3, i FROM generate_series(1, 30) AS i', '{value}', 3);
SELECT abacus_insert('flat', 'SELECT i, i % 7, i / 7, 3, -i FROM generate_series(1, 40) AS i', on_duplicate => 'replace');
SELECT abacus_insert('flat', 'VALUES (0, 0, 0, 0, 0)', on_duplicate => 'error');
SELECT abacus_insert('flat', 'SELECT i, i % 7, i / 7, 3, 1000 FROM generate_series(39, 41) AS i', on_duplicate => 'replace');
SELECT count(*), min(attributes[1]), max(attributes[1]) FROM abacus_vertices('flat');
SELECT * FROM abacus_check('flat');

-- in a transaction with others
BEGIN;
SELECT abacus_insert('flat', 'VALUES (50, 0, 0, 0, 1)', on_duplicate => 'replace');
SAVEPOINT before;
SELECT abacus_insert('flat', 'VALUES (51, 0, 0, 0, 2)', on_duplicate => 'replace');
ROLLBACK TO before;
COMMIT;
SELECT id, attributes FROM abacus_vertices('flat') WHERE z = 0;

-- a mesh that follows a table has all its rows, and tells the same
CREATE TABLE spots (id int, x float8, y float8);
INSERT INTO spots VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1), (4, 0, 1);
SELECT abacus_create('spotted', 2);
SELECT abacus_track('spotted', 'spots');
INSERT INTO spots VALUES (5, 0, 1), (6, 1, 1);
UPDATE spots SET id = 7 WHERE id = 6;
DELETE FROM spots WHERE id > 2;
INSERT INTO spots VALUES (3, 2, 0);

SET client_min_messages = warning;
DROP SCHEMA regress_duplicates CASCADE;

-- Building in batches, each committed.
CREATE TABLE points AS
SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y, (i * 37) % 101 AS z FROM generate_series(1, 3000) i;
-- Corners are shown from the least id on.
CREATE FUNCTION triangles(mesh regclass) RETURNS SETOF bigint[] LANGUAGE sql AS $$
    SELECT CASE least(v0, v1, v2) WHEN v0 THEN ARRAY[v0, v1, v2] WHEN v1 THEN ARRAY[v1, v2, v0] ELSE ARRAY[v2, v0, v1] END
    FROM abacus_simplices(mesh) ORDER BY 1
$$;
CREATE FUNCTION counts(mesh regclass, OUT points float8, OUT inserted float8, OUT vertices float8, OUT duplicates float8) LANGUAGE sql AS $$
    SELECT sum(value) FILTER (WHERE name = 'points'), sum(value) FILTER (WHERE name = 'inserted'),
           sum(value) FILTER (WHERE name = 'vertices'), sum(value) FILTER (WHERE name = 'duplicates')
    FROM abacus_stats(mesh)
$$;
SELECT abacus_triangulate('once', 'SELECT id, x, y FROM points') AS simplices;

-- The same mesh, whatever the batch; nothing is left to do then.
SELECT abacus_create('field', 2);
CALL abacus_build('field');
SELECT abacus_stage('field', 'SELECT id, x, y FROM points UNION ALL SELECT -id, x, y FROM points WHERE id <= 100');
CALL abacus_build('field', 250);
SELECT * FROM counts('field');
SELECT array(SELECT triangles('field')) = array(SELECT triangles('once')) AS same;
SELECT * FROM abacus_check('field');
SELECT xmin AS header FROM field WHERE code = -1 \gset
CALL abacus_build('field');
SELECT xmin = :header AS untouched FROM field WHERE code = -1;

-- Points staged later are added; a batch may be greater than what there is.
SELECT abacus_stage('field', 'SELECT 3000 + id, x + 0.5, y + 0.25 FROM points WHERE id <= 700');
CALL abacus_build(mesh => 'field', batch => 9223372036854775807);
SELECT abacus_stage('once', 'SELECT 3000 + id, x + 0.5, y + 0.25 FROM points WHERE id <= 700'), abacus_triangulate('once');
SELECT array(SELECT triangles('field')) = array(SELECT triangles('once')) AS same;
SELECT * FROM counts('field');

-- Each point its own batch, the smallest cache, and in space.
SET abacus.cache_size = '1MB';
SELECT abacus_create('solid', 3, '{height}');
SELECT abacus_stage('solid', 'SELECT id, x, y, z, id FROM points WHERE id <= 300');
CALL abacus_build('solid', 1);
SELECT abacus_triangulate('solid_once', 'SELECT id, x, y, z, id AS height FROM points WHERE id <= 300', dimension => 3) AS simplices;
SELECT * FROM counts('solid');
SELECT count(*) FROM (SELECT v0, v1, v2, v3 FROM abacus_simplices('solid') EXCEPT SELECT v0, v1, v2, v3 FROM abacus_simplices('solid_once')) s;
SELECT * FROM abacus_check('solid');
RESET abacus.cache_size;

-- Too few points, or all on one line: they wait.
SELECT abacus_create('line', 2);
SELECT abacus_stage('line', 'SELECT i, i, i FROM generate_series(1, 5) i');
CALL abacus_build('line', 2);
SELECT * FROM counts('line');
SELECT abacus_stage('line', 'VALUES (6, 1, 0), (7, 1, 1), (8, 9, 9)');
CALL abacus_build('line', 2);
SELECT * FROM counts('line');
SELECT * FROM abacus_check('line');

-- Pages are rewritten in each batch, and what they leave is used again.
INSERT INTO points SELECT i, (i * 7919) % 10007, (i * 104729) % 9973, 0 FROM generate_series(3001, 80000::bigint) i;
SELECT abacus_triangulate('large', 'SELECT id, x, y FROM points') AS simplices;
SELECT abacus_create('small', 2);
SELECT abacus_stage('small', 'SELECT id, x, y FROM points');
CALL abacus_build('small', 1000);
SELECT value > 200 AS rewritten FROM abacus_stats('small') WHERE name = 'rewrites';
SELECT pg_table_size('small') + pg_indexes_size('small') <= 1.1 * (pg_table_size('large') + pg_indexes_size('large')) AS small;
SELECT array(SELECT triangles('small')) = array(SELECT triangles('large')) AS same;

-- It commits, so it has to be called where that is possible.
BEGIN;
CALL abacus_build('once');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
CREATE FUNCTION build(mesh regclass) RETURNS void LANGUAGE plpgsql AS $$ BEGIN CALL abacus_build(mesh); END $$;
SELECT build('once');
DROP FUNCTION build;
CREATE PROCEDURE build(mesh regclass) LANGUAGE sql AS $$ CALL abacus_build(mesh) $$;
CALL build('once');
DO $$
BEGIN
    CALL abacus_build('once');
EXCEPTION WHEN invalid_transaction_termination THEN
    RAISE NOTICE 'not in a block with an exception clause';
END $$;
SELECT abacus_stage('once', 'SELECT 10000, 2000, 2000');
-- it may also commit in procedures and blocks that may commit themselves
DO $$
DECLARE
    mesh regclass;
BEGIN
    FOR mesh IN SELECT unnest('{field,once}'::regclass[]) LOOP
        PERFORM abacus_stage(mesh, 'SELECT 10001, 2000, 1000');
        CALL abacus_build(mesh);
    END LOOP;
    RAISE NOTICE '% points left', (SELECT sum(points - inserted) FROM counts('once'));
END $$;
BEGIN;
SAVEPOINT before;
CALL abacus_build('once');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- Arguments
CALL abacus_build('once', 0);
\echo :LAST_ERROR_SQLSTATE
CALL abacus_build('once', NULL);
CALL abacus_build(NULL);
\echo :LAST_ERROR_SQLSTATE
CALL abacus_build('points');
\echo :LAST_ERROR_SQLSTATE
CALL abacus_build(0);
\echo :LAST_ERROR_SQLSTATE
CALL abacus_build('pg_class');
SET default_transaction_read_only = on;
CALL abacus_build('once');
\echo :LAST_ERROR_SQLSTATE
RESET default_transaction_read_only;
SET default_transaction_isolation = 'repeatable read';
SELECT abacus_stage('once', 'SELECT 10000 + i, 3000 + i, i * i FROM generate_series(2, 10) i');
CALL abacus_build('once', 3);
SELECT * FROM abacus_check('once');
RESET default_transaction_isolation;

-- A large mesh that single rows have led out of its domain gets another one, also when nothing waits.
SELECT count(abacus_triangulate('corner', 'SELECT i, i * 7919 % 70001, i * 104729 % 70003 FROM generate_series(1::bigint, 70000) i'));
CREATE VIEW outside AS SELECT value AS outside FROM abacus_stats('corner') WHERE name = 'outside';
DO $$ BEGIN FOR n IN 0 .. 9 LOOP
    PERFORM abacus_insert('corner', format('SELECT 70000 + i, 100000 + i * 7919 %% 70001, i * 104729 %% 70003 FROM generate_series(%s + 1::bigint, %s + 1050) i', 1050 * n, 1050 * n));
END LOOP; END $$;
TABLE outside;
CREATE TEMP TABLE before AS SELECT v0, v1, v2 FROM abacus_simplices('corner');
CALL abacus_build('corner');
TABLE outside;
SELECT count(*) FROM (SELECT v0, v1, v2 FROM abacus_simplices('corner') EXCEPT TABLE before) AS other;
SELECT count(*) FROM (TABLE before EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('corner')) AS gone;
SELECT * FROM abacus_check('corner');
DROP TABLE before;
DROP TABLE corner CASCADE;

-- A mesh with many attributes in its simplex pages, of format 3, gets them apart.
SELECT abacus_create('former', 2, '{a,b,c,d,e,f}');
UPDATE former SET page = set_byte(page::bytea, 6, 3)::abacus_page WHERE code = -1;
SELECT abacus_insert('former', 'SELECT id, x, y, z, sin(id), cos(id), tan(id), id, -id FROM points');
SELECT abacus_stage('former', 'SELECT 5000 + id, x, y, 1, 2, 3, 4, 5, 6 FROM points WHERE id < 10');
CREATE TABLE former_points AS SELECT id, x, y, attributes FROM abacus_vertices('former');
CREATE TABLE former_simplices AS SELECT * FROM abacus_simplices('former');
CREATE TABLE former_pages AS SELECT count(*) AS pages FROM former WHERE code >= 0;
SELECT array_agg(DISTINCT get_byte(page::bytea, 6)) AS format_and_attributes, count(*) FILTER (WHERE code < -1) AS apart FROM former;
CALL abacus_build('former');
SELECT get_byte(page::bytea, 6) AS format FROM former WHERE code = -1;
SELECT count(*) FILTER (WHERE code < -1) > 0 AS apart, array_agg(DISTINCT get_byte(page::bytea, 6)) FILTER (WHERE code >= 0) AS attributes_of_simplex_pages FROM former;
SELECT count(*) * 2.5 < (TABLE former_pages) AS full_pages FROM former WHERE code >= 0;
SELECT count(*) FROM (SELECT id, x, y, attributes FROM abacus_vertices('former') EXCEPT TABLE former_points) v;
SELECT count(*) FROM (TABLE former_points EXCEPT SELECT id, x, y, attributes FROM abacus_vertices('former')) v;
SELECT count(*) FROM (SELECT * FROM abacus_simplices('former') EXCEPT TABLE former_simplices) s;
SELECT count(*) FROM (TABLE former_simplices EXCEPT SELECT * FROM abacus_simplices('former')) s;
SELECT * FROM abacus_check('former');
CALL abacus_build('former'); -- nothing is left to do

-- Without its vertex table a mesh cannot be built.
DROP TABLE line_vertices;
CALL abacus_build('line');
-- after an error nothing is held
SELECT count(*) FROM pg_locks WHERE pid = pg_backend_pid() AND relation = 'line'::regclass;
SELECT count(*) FROM abacus_progress WHERE pid = pg_backend_pid();

DROP TABLE points, once, field, solid, solid_once, line, large, small, former, former_points, former_simplices, former_pages;
DROP FUNCTION triangles, counts;
DROP PROCEDURE build;

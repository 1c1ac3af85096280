-- A mesh is a table: GRANT and REVOKE decide.
CREATE ROLE regress_abacus_owner;
CREATE ROLE regress_abacus_reader;
CREATE SCHEMA regress_abacus AUTHORIZATION regress_abacus_owner;
GRANT USAGE ON SCHEMA regress_abacus TO regress_abacus_reader;
SET search_path = regress_abacus, public;

SET ROLE regress_abacus_owner;
CREATE TABLE points AS SELECT i AS id, i % 5 AS x, i / 5 AS y FROM generate_series(0, 24) i;
SELECT abacus_triangulate('field', 'TABLE points');

SET ROLE regress_abacus_reader;
SELECT abacus_create('mine', 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('field', 1.5, 1.5);
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM abacus_simplices('field');
SELECT count(*) FROM abacus_vertices('field');
SELECT * FROM abacus_check('field');
SELECT count(*) FROM abacus_stats('field');
SELECT abacus_draw('field') IS NULL;
SELECT abacus_stage('field', 'SELECT 1, 2, 3');
SELECT abacus_triangulate('field');
CALL abacus_build('field');
\echo :LAST_ERROR_SQLSTATE

-- reading needs SELECT; the vertex table is asked for where it is used
SET ROLE regress_abacus_owner;
GRANT SELECT ON field TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT (abacus_locate('field', 1.5, 1.5)).v0 IS NOT NULL AS located;
SELECT count(*) FROM abacus_simplices('field');
SELECT count(*) FROM abacus_vertices('field');
\echo :LAST_ERROR_SQLSTATE
SET ROLE regress_abacus_owner;
GRANT SELECT ON field_vertices TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT count(*) FROM abacus_vertices('field');
SELECT * FROM abacus_check('field');
-- writing needs INSERT, UPDATE and DELETE as well, on both
SELECT abacus_stage('field', 'SELECT 100, 2.5, 2.5');
SET ROLE regress_abacus_owner;
GRANT INSERT, UPDATE, DELETE ON field TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT abacus_stage('field', 'SELECT 100, 2.5, 2.5');
\echo :LAST_ERROR_SQLSTATE
SET ROLE regress_abacus_owner;
GRANT INSERT, UPDATE, DELETE ON field_vertices TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT abacus_stage('field', 'SELECT 100, 2.5, 2.5'), abacus_triangulate('field');
SELECT abacus_stage('field', 'SELECT 101, 2.5, 3.5');
CALL abacus_build('field');
-- the source query runs as the caller
SELECT abacus_stage('field', 'TABLE points');
\echo :LAST_ERROR_SQLSTATE

-- a session's cache does not outlive the privilege, nor does it serve another role
BEGIN;
SELECT (abacus_locate('field', 1.5, 1.5)).v0 IS NOT NULL AS located;
SET LOCAL ROLE regress_abacus_owner;
SELECT (abacus_locate('field', 1.5, 1.5)).v0 IS NOT NULL AS located;
REVOKE SELECT ON field FROM regress_abacus_reader;
SET LOCAL ROLE regress_abacus_reader;
SELECT abacus_locate('field', 1.5, 1.5);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- row-level security
SET ROLE regress_abacus_owner;
ALTER TABLE field ENABLE ROW LEVEL SECURITY;
SELECT (abacus_locate('field', 1.5, 1.5)).v0 IS NOT NULL AS owner;
SET ROLE regress_abacus_reader;
SELECT abacus_locate('field', 1.5, 1.5);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('field');
SET ROLE regress_abacus_owner;
ALTER TABLE field DISABLE ROW LEVEL SECURITY;
ALTER TABLE field_vertices ENABLE ROW LEVEL SECURITY;
SET ROLE regress_abacus_reader;
SELECT (abacus_locate('field', 1.5, 1.5)).v0 IS NOT NULL AS located;
SELECT count(*) FROM abacus_vertices('field');
SET ROLE regress_abacus_owner;
ALTER TABLE field_vertices DISABLE ROW LEVEL SECURITY;

-- developer settings are for superusers
SET abacus.fail_host_call = 1;
\echo :LAST_ERROR_SQLSTATE
SET abacus.cache_size = '2MB';
SET abacus.no_such_setting = 1;
RESET abacus.cache_size;
-- to install the extension is a superuser's
SELECT DISTINCT superuser, trusted FROM pg_available_extension_versions WHERE name = 'abacus';
-- anyone may look at the progress of builds
SET ROLE regress_abacus_reader;
SELECT count(*) FROM abacus_progress;
RESET ROLE;
RESET search_path;
DROP SCHEMA regress_abacus CASCADE;
DROP ROLE regress_abacus_owner, regress_abacus_reader;

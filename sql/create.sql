-- Making, renaming, moving and dropping a mesh.
SELECT abacus_create('empty', 2);
SELECT c.relname, t.typname AS row_type, pg_get_constraintdef(k.oid) AS primary_key
FROM pg_class c JOIN pg_type t ON t.oid = c.reloftype JOIN pg_constraint k ON k.conrelid = c.oid AND k.contype = 'p'
WHERE c.relname LIKE 'empty%' ORDER BY 1;
SELECT code, part FROM empty;
SELECT count(*) FROM empty_vertices;
SELECT * FROM abacus_simplices('empty');
SELECT * FROM abacus_vertices('empty');
SELECT * FROM abacus_check('empty');
SELECT abacus_locate('empty', 0, 0) IS NULL AS outside;
SELECT abacus_triangulate('empty');
SELECT abacus_stage('empty', 'SELECT 1, 0, 0 WHERE false');
SELECT abacus_triangulate('empty');

-- qualified, quoted and long names
CREATE SCHEMA "Other Place";
SELECT abacus_create('"Other Place"."My Mesh"', 2, '{height,"two words"}', '{0,0}', '{1,2}');
SELECT name, value FROM abacus_stats('"Other Place"."My Mesh"') WHERE name IN ('dimension', 'attributes', 'points') ORDER BY name;
SELECT abacus_create(repeat('n', 54), 2) = repeat('n', 54)::regclass AS longest;
SELECT abacus_create(repeat('n', 55), 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('no_such_schema.m', 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('', 2);
\echo :LAST_ERROR_SQLSTATE

-- a name that is taken, of the mesh or of its vertex table
SELECT abacus_create('empty', 2);
\echo :LAST_ERROR_SQLSTATE
CREATE TABLE taken_vertices ();
SELECT abacus_create('taken', 2);
\echo :LAST_ERROR_SQLSTATE
SELECT to_regclass('taken') IS NULL AS nothing_left;
DROP TABLE taken_vertices;

-- what cannot be a mesh
SELECT abacus_create('bad', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 4);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', NULL);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, '{a,b,a}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, '{""}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, '{a,NULL}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, ARRAY[repeat('a', 64)]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, array_agg('a' || i)) FROM generate_series(1, 1001) i;
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, lower => '{0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, lower => '{0,0}', upper => '{1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, lower => '{0,0}', upper => '{1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('bad', 2, lower => '{0,NaN}', upper => '{1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT to_regclass('bad') IS NULL AND to_regclass('bad_vertices') IS NULL AS nothing_left;

-- the two tables stay together whatever they are called
SELECT abacus_triangulate('moved', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
ALTER TABLE moved RENAME TO moved_away;
ALTER TABLE moved_vertices SET SCHEMA "Other Place";
ALTER TABLE "Other Place".moved_vertices RENAME TO points;
SELECT id, vertex FROM abacus_vertices('moved_away') ORDER BY id;
SELECT abacus_stage('moved_away', 'SELECT 4, 1, 1'), abacus_triangulate('moved_away');
SELECT * FROM abacus_check('moved_away');
DROP TABLE moved_away;
SELECT to_regclass('"Other Place".points') IS NULL AS dropped;

-- as after a restore, without the dependency: found by name, bound by the next change
SELECT abacus_triangulate('restored', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
DELETE FROM pg_depend WHERE objid = 'restored_vertices'::regclass AND refobjid = 'restored'::regclass;
SELECT count(*) FROM abacus_vertices('restored');
ALTER TABLE restored_vertices RENAME TO elsewhere;
SELECT count(*) FROM abacus_vertices('restored');
\echo :LAST_ERROR_SQLSTATE
ALTER TABLE elsewhere RENAME TO restored_vertices;
SELECT abacus_triangulate('restored');
DROP TABLE restored;
SELECT to_regclass('restored_vertices') IS NULL AS dropped;

-- a mesh needs its extension, and its extension says so
\set VERBOSITY terse
DROP EXTENSION abacus;
\set VERBOSITY default
\echo :LAST_ERROR_SQLSTATE

-- temporary meshes
SELECT abacus_triangulate('pg_temp.passing', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT (abacus_locate('passing', 0.25, 0.25)).v0 IS NOT NULL AS inside;

DROP TABLE empty, passing;
DO $$ BEGIN EXECUTE 'DROP TABLE ' || repeat('n', 54); END $$;
DROP SCHEMA "Other Place" CASCADE;

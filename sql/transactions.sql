-- Rollback, savepoints, and what a session keeps of a mesh through them.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4)');
CREATE FUNCTION corners(x float8, y float8) RETURNS bigint[] LANGUAGE sql STABLE AS $$
    SELECT (SELECT array_agg(v ORDER BY v) FROM unnest(ARRAY[(s).v0, (s).v1, (s).v2]) v)
    FROM abacus_locate('field', x, y) s
$$;
SELECT corners(3, 1);

-- a change that is rolled back leaves nothing, not even in the session's cache
BEGIN;
SELECT abacus_stage('field', 'SELECT 5, 3, 1'), abacus_triangulate('field');
SELECT corners(3, 0.5);
ROLLBACK;
SELECT corners(3, 0.5);
SELECT count(*) FROM abacus_vertices('field');

-- savepoints: back to the mesh of the outer transaction, under an equal snapshot
BEGIN;
SELECT abacus_stage('field', 'SELECT 6, 1, 2'), abacus_triangulate('field');
SELECT corners(3, 0.5), corners(0.5, 2);
SAVEPOINT before;
SELECT abacus_stage('field', 'SELECT 7, 3, 1'), abacus_triangulate('field');
SELECT corners(3, 0.5), corners(0.5, 2);
ROLLBACK TO before;
SELECT corners(3, 0.5), corners(0.5, 2);
SELECT abacus_stage('field', 'SELECT 8, 2, 3'), abacus_triangulate('field');
RELEASE before;
SELECT * FROM abacus_check('field');
COMMIT;
SELECT corners(3, 0.5), corners(0.5, 2);
SELECT id FROM abacus_vertices('field') ORDER BY id;
SELECT * FROM abacus_check('field');

-- an error caught in a block
DO $$
BEGIN
    PERFORM abacus_stage('field', 'SELECT 9, 2, 3.5');
    BEGIN
        PERFORM abacus_triangulate('field');
        PERFORM abacus_stage('field', 'SELECT 10, 1 / 0, 0');
    EXCEPTION WHEN division_by_zero THEN
        RAISE NOTICE 'caught; the triangulation of the block is undone';
    END;
END $$;
SELECT id, vertex FROM abacus_vertices('field') WHERE id >= 9;
SELECT abacus_triangulate('field');
SELECT * FROM abacus_check('field');

-- several changes in one statement follow one another
SELECT abacus_stage('field', 'SELECT 20, 0.5, 0.5'), abacus_stage('field', 'SELECT 21, 0.5, 0.75'), abacus_triangulate('field');
SELECT id FROM abacus_vertices('field') WHERE id >= 20 ORDER BY id;
SELECT count(*) = abacus_triangulate('field') AS same FROM abacus_simplices('field');

-- TRUNCATE takes the header too
BEGIN;
TRUNCATE field;
SELECT abacus_locate('field', 1, 1);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
TRUNCATE field;
SELECT * FROM abacus_check('field');
ROLLBACK;
SELECT corners(3, 0.5);

-- read-only transactions read
BEGIN READ ONLY;
SELECT corners(3, 0.5);
SELECT abacus_stage('field', 'SELECT 1, 2, 3');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_triangulate('field');
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_create('other', 2);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_triangulate('other', 'VALUES (1, 2, 3)');
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_load('other', 'VALUES (1, 2, 3)', 'VALUES (1, 2, 3)');
ROLLBACK;

-- repeatable read
BEGIN ISOLATION LEVEL REPEATABLE READ;
SELECT abacus_stage('field', 'SELECT 30, 3.5, 3'), abacus_triangulate('field') > 0;
SELECT abacus_stage('field', 'SELECT 31, 3.5, 3.25'), abacus_triangulate('field') > 0;
SELECT * FROM abacus_check('field');
COMMIT;
BEGIN ISOLATION LEVEL SERIALIZABLE;
SELECT abacus_stage('field', 'SELECT 32, 3.5, 3.5'), abacus_triangulate('field') > 0;
COMMIT;
SELECT id FROM abacus_vertices('field') WHERE id >= 30 ORDER BY id;

-- a table that is being read is not changed under the reader
BEGIN;
DECLARE pages CURSOR FOR TABLE field;
MOVE 1 FROM pages;
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

DROP FUNCTION corners;
DROP TABLE field;

-- Changes that return the simplices that they have created and removed.
CREATE SCHEMA regress_returning;
SET search_path = regress_returning, public;
SELECT abacus_create('grid', 2, '{height}'), abacus_create('solid', 3);
SELECT created, v0, v1, v2, v3, corners FROM abacus_insert_returning('grid', 'VALUES (1, 0, 0, 5), (2, 4, 0, 6), (3, 0, 3, 7), (4, 4, 3, 8), (5, 1, 1, 9)');
-- one more: what is removed and what takes its place
SELECT created, v0, v1, v2, corners FROM abacus_insert_returning('grid', 'VALUES (6, 3.5, 2, 1)');
-- and back; those that come and go in one statement do not show
SELECT created, v0, v1, v2 FROM abacus_delete_returning('grid', 'VALUES (6, 3.5, 2), (7, 8, 8)');
SELECT count(*) FROM abacus_delete_returning('grid', 'VALUES (7, 8, 8)');
SELECT count(*) FROM abacus_insert_returning('grid', 'SELECT 1, 2, 3, 4 WHERE false');
-- a vertex of another id, a point beside a vertex
SELECT created, v0, v1, v2 FROM abacus_insert_returning('grid', 'VALUES (8, 4, 3, 2)', on_duplicate => 'replace');
SELECT count(*) FROM abacus_insert_returning('grid', 'VALUES (9, 4, 3, 2)');
SELECT created, v0, v1, v2 FROM abacus_delete_returning('grid', 'VALUES (8, 4, 3)');
-- points that wait, and all that leave
SELECT abacus_stage('solid', 'VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0)');
SELECT created, v0, v1, v2, v3, corners FROM abacus_insert_returning('solid', 'VALUES (4, 0, 0, 1)');
SELECT created, v0, v1, v2, v3 FROM abacus_delete_returning('solid', 'VALUES (4, 0, 0, 1)');

-- the difference of before and after, with any number of threads, in order
CREATE TABLE points AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y, (i * 1299709) % 991 AS z FROM generate_series(1::bigint, 4000) i;
CREATE TABLE changed (n int GENERATED ALWAYS AS IDENTITY, created boolean, code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint, corners float8[]);
CREATE TABLE before (LIKE abacus_simplex);
CREATE VIEW difference AS
(SELECT true AS created, s.* FROM abacus_simplices('solid') s EXCEPT SELECT true, b.* FROM before b) UNION ALL
(SELECT false, b.* FROM before b EXCEPT SELECT false, s.* FROM abacus_simplices('solid') s);
CREATE VIEW wrong AS
(TABLE difference EXCEPT SELECT created, code, v0, v1, v2, v3 FROM changed) UNION ALL
(SELECT created, code, v0, v1, v2, v3 FROM changed EXCEPT TABLE difference);
SELECT abacus_insert('solid', 'SELECT id, x, y, z FROM points WHERE id <= 3000');
INSERT INTO before SELECT * FROM abacus_simplices('solid');
INSERT INTO changed (created, code, v0, v1, v2, v3, corners) SELECT * FROM abacus_insert_returning('solid', 'SELECT id, x, y, z FROM points WHERE id > 3000');
TABLE wrong;
SELECT count(*) > 1000 AS many, count(*) = count(DISTINCT (created, v0, v1, v2, v3)) AS once, count(*) FILTER (WHERE earlier > code) AS unordered
FROM (SELECT *, lag(code) OVER (ORDER BY n) AS earlier FROM changed) c;
SELECT count(*) FROM changed JOIN abacus_cells('solid') c USING (code, v0, v1, v2, v3) WHERE created AND changed.corners IS DISTINCT FROM c.corners;
TRUNCATE before, changed;
INSERT INTO before SELECT * FROM abacus_simplices('solid');
SET abacus.threads = 3;
SET abacus.tiny_intervals = on;
SET work_mem = '64kB';
INSERT INTO changed (created, code, v0, v1, v2, v3, corners) SELECT * FROM abacus_delete_returning('solid', 'SELECT id, x, y, z FROM points WHERE id % 3 = 0');
RESET work_mem;
RESET abacus.tiny_intervals;
RESET abacus.threads;
TABLE wrong;
SELECT count(*) > 1000 AS many, count(*) FILTER (WHERE NOT created) > count(*) FILTER (WHERE created) AS fewer FROM changed;
SELECT * FROM abacus_check('solid');
-- an adaptive loop: as long as a triangle is larger than it should be, its centroid comes in
SELECT abacus_insert('grid', 'VALUES (100, 10, 0, 0), (101, 10, 10, 0), (102, 0, 10, 0)');
CREATE TABLE work AS SELECT corners FROM abacus_cells('grid');
DO $$
DECLARE
    next int := 1000;
BEGIN
    LOOP
        CREATE TEMP TABLE fresh AS SELECT next + row_number() OVER () AS id, (c[1][1] + c[2][1] + c[3][1]) / 3 AS x, (c[1][2] + c[2][2] + c[3][2]) / 3 AS y
        FROM (SELECT corners AS c FROM work) w WHERE abs((c[2][1] - c[1][1]) * (c[3][2] - c[1][2]) - (c[2][2] - c[1][2]) * (c[3][1] - c[1][1])) > 2;
        TRUNCATE work;
        INSERT INTO work SELECT corners FROM abacus_insert_returning('grid', 'SELECT id, x, y, 0 FROM fresh') WHERE created;
        EXIT WHEN NOT EXISTS (SELECT FROM fresh);
        next := next + (SELECT count(*) FROM fresh);
        DROP TABLE fresh;
    END LOOP;
END $$;
SELECT count(*) > 50 AS refined FROM abacus_simplices('grid');
SELECT count(*) FROM abacus_cells('grid') c WHERE abs((corners[2][1] - corners[1][1]) * (corners[3][2] - corners[1][2]) - (corners[2][2] - corners[1][2]) * (corners[3][1] - corners[1][1])) > 2;

-- errors change nothing
SELECT * FROM abacus_insert_returning('grid', 'VALUES (1, 4, 0, 6)', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_insert_returning('grid', 'VALUES (1, 4, 0, 6)', on_duplicate => 'all');
SELECT * FROM abacus_insert_returning('grid', 'VALUES (1, ''NaN''::float8, 0, 6)');
SELECT * FROM abacus_delete_returning('pg_class', 'VALUES (1, 0, 0)');
SELECT count(*) FROM abacus_insert_returning('grid', NULL);
BEGIN READ ONLY;
SELECT * FROM abacus_delete_returning('grid', 'VALUES (1, 0, 0)');
COMMIT;
SELECT abacus_load('notch', 'SELECT * FROM (VALUES (1, 0, 0), (2, 4, 0), (3, 1, 1), (4, 0, 4)) v(id, x, y)', 'SELECT * FROM (VALUES (1, 2, 3), (1, 3, 4)) s(v0, v1, v2)');
SELECT * FROM abacus_insert_returning('notch', 'VALUES (5, 9, 9)');
-- who may not change the mesh, and what is rolled back
CREATE ROLE regress_returning_user;
GRANT USAGE ON SCHEMA regress_returning TO regress_returning_user;
GRANT SELECT ON grid, grid_vertices TO regress_returning_user;
SET ROLE regress_returning_user;
SELECT * FROM abacus_insert_returning('grid', 'VALUES (1, 4, 0, 6)');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_delete_returning('grid', 'VALUES (1, 0, 0)');
RESET ROLE;
CREATE TABLE kept AS SELECT * FROM abacus_simplices('grid');
BEGIN;
SAVEPOINT a;
SELECT count(*) = (SELECT count(*) FROM kept) AS all_gone, bool_or(created) AS some_new FROM abacus_delete_returning('grid', 'SELECT id, x, y FROM abacus_vertices(''grid'')');
SELECT count(*) FROM abacus_simplices('grid');
ROLLBACK TO a;
SELECT count(*) FROM (SELECT * FROM abacus_simplices('grid') EXCEPT TABLE kept) s;
-- the whole change takes place, however many rows are wanted
SELECT count(*) FROM (SELECT FROM abacus_insert_returning('grid', 'VALUES (9001, 0.3, 0.2, 0), (9002, 9.7, 9.8, 0)') LIMIT 1) s;
SELECT id FROM abacus_vertices('grid') WHERE id > 9000 ORDER BY id;
ROLLBACK;
SELECT count(*) FROM (TABLE kept EXCEPT SELECT * FROM abacus_simplices('grid')) s;

SET client_min_messages = warning;
DROP SCHEMA regress_returning CASCADE;
DROP ROLE regress_returning_user;

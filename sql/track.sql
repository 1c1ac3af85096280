-- A mesh that follows a table: abacus_track, abacus_untrack.
SELECT abacus_create('field', 2, '{height}');
CREATE TABLE wells (gone int, id int PRIMARY KEY, name text, x real, y numeric, height float8,
                    twice float8 GENERATED ALWAYS AS (height * 2) STORED);
ALTER TABLE wells DROP COLUMN gone;
INSERT INTO wells SELECT i, 'w' || i, i % 5, i / 5, i FROM generate_series(0, 24) i;
INSERT INTO wells VALUES (25, 'nowhere', NULL, 3, 1), (26, 'beside 7', 2, 1, 26);

-- how far the points of the mesh and the table differ
CREATE FUNCTION apart() RETURNS bigint LANGUAGE sql AS $$
    WITH here AS (SELECT id, x::float8, y::float8, height FROM wells WHERE x IS NOT NULL AND y IS NOT NULL),
         there AS (SELECT id, x, y, attributes[1] FROM abacus_vertices('field'))
    SELECT (SELECT count(*) FROM (TABLE here EXCEPT ALL TABLE there) a)
         + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE here) b)
         + (SELECT count(*) FROM abacus_check('field')) $$;

-- an empty mesh gets the rows there are, those with coordinates
SELECT abacus_track('field', 'wells');
SELECT apart();
SELECT tgname, tgenabled FROM pg_trigger WHERE tgrelid = 'wells'::regclass ORDER BY tgname;

-- one row and many
INSERT INTO wells VALUES (30, 'new', 2.5, 2.5, 7);
SELECT apart();
INSERT INTO wells SELECT i, 'm', i % 7 + 0.5, i % 11 + 0.25, i FROM generate_series(100, 199) i;
SELECT apart();
UPDATE wells SET x = x + 1 WHERE id < 10;
SELECT apart();
UPDATE wells SET height = height + 1;
SELECT apart();
SELECT id, attributes FROM abacus_vertices('field') WHERE id IN (0, 30) ORDER BY id;
DELETE FROM wells WHERE id >= 150;
SELECT apart();
-- all at once: every point moves to the place of another
UPDATE wells SET x = y, y = x;
SELECT apart();
COPY wells (id, name, x, y, height) FROM STDIN;
200	copied	8	8	1
201	copied	\N	8	1
\.
SELECT apart();
INSERT INTO wells VALUES (200, 'again', 0, 0, 0), (202, 'new', 8.5, 8, 2)
    ON CONFLICT (id) DO UPDATE SET x = 9, name = excluded.name;
SELECT apart();
MERGE INTO wells USING (VALUES (200, 1), (202, 2), (203, 3)) AS s (id, what) ON wells.id = s.id
    WHEN MATCHED AND what = 1 THEN DELETE
    WHEN MATCHED THEN UPDATE SET y = 9
    WHEN NOT MATCHED THEN INSERT (id, x, y, height) VALUES (s.id, 7.5, 7.5, 3);
SELECT apart();
WITH gone AS (DELETE FROM wells WHERE id = 203 RETURNING *)
INSERT INTO wells (id, x, y, height) SELECT 204, x, y + 1, height FROM gone;
SELECT apart();

-- points of NULL are none; they come and go with their coordinates
UPDATE wells SET y = NULL WHERE id = 30;
SELECT apart(), count(*) FROM abacus_vertices('field') WHERE id = 30;
UPDATE wells SET y = 2 WHERE id = 30;
SELECT apart(), count(*) FROM abacus_vertices('field') WHERE id = 30;

-- a row without a place is refused, and nothing has changed
INSERT INTO wells VALUES (300, 'ok', 5, 6, 1), (301, 'bad', 'NaN', 6, 1);
\echo :LAST_ERROR_SQLSTATE
UPDATE wells SET x = 'Infinity' WHERE id = 3;
\echo :LAST_ERROR_SQLSTATE
SELECT apart(), count(*) FROM wells WHERE id >= 300;

-- several points at a place: the one whose row goes
INSERT INTO wells VALUES (400, 'first', 20, 20, 1), (401, 'second', 20, 20, 2), (402, 'third', 20, 20, 3);
DELETE FROM wells WHERE id = 401;
SELECT apart(), array_agg(id ORDER BY id) FROM abacus_vertices('field') WHERE x = 20;
UPDATE wells SET height = 10 WHERE id = 400;
SELECT apart();
DELETE FROM wells WHERE id = 400;
SELECT apart(), array_agg(id ORDER BY id) FROM abacus_vertices('field') WHERE x = 20;

-- a statement that changes no point leaves the mesh alone
SELECT ctid AS header FROM field WHERE code = -1 \gset
UPDATE wells SET name = 'renamed';
UPDATE wells SET x = x, height = height;
DELETE FROM wells WHERE false;
INSERT INTO wells (id, name) VALUES (500, 'nowhere');
SELECT ctid = :'header' AS untouched, apart() FROM field WHERE code = -1;

-- rollback and savepoints
BEGIN;
DELETE FROM wells WHERE id < 50;
SAVEPOINT s;
INSERT INTO wells (id, x, y) SELECT i, i, -i FROM generate_series(600, 699) i;
SELECT apart();
ROLLBACK TO s;
SELECT apart();
ROLLBACK;
SELECT apart();

-- TRUNCATE empties the mesh
BEGIN;
TRUNCATE wells;
SELECT apart(), count(*) FROM abacus_vertices('field');
SELECT name, value FROM abacus_stats('field') WHERE name IN ('points', 'vertices', 'duplicates', 'simplices', 'hull_facets');
INSERT INTO wells (id, x, y) VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1);
SELECT apart(), count(*) FROM abacus_simplices('field');
ROLLBACK;
SELECT apart();

-- foreign keys that cascade
CREATE TABLE owners (id int PRIMARY KEY);
INSERT INTO owners SELECT generate_series(1, 9);
ALTER TABLE wells ADD owner int REFERENCES owners ON DELETE CASCADE ON UPDATE CASCADE;
UPDATE wells SET owner = id % 9 + 1;
DELETE FROM owners WHERE id IN (3, 5);
SELECT apart(), count(*) FROM wells WHERE owner IN (3, 5);

-- names change
ALTER TABLE field RENAME TO meadow;
ALTER TABLE wells RENAME TO holes;
CREATE SCHEMA regress_track;
ALTER TABLE meadow SET SCHEMA regress_track;
UPDATE holes SET x = x + 0.5 WHERE id = 1;
ALTER TABLE holes RENAME TO wells;
ALTER TABLE regress_track.meadow SET SCHEMA public;
ALTER TABLE meadow RENAME TO field;
DROP SCHEMA regress_track;
SELECT apart();
ALTER TABLE wells RENAME height TO altitude;
UPDATE wells SET x = x + 0.5 WHERE id = 1;
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('field', 'wells');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('field', 'wells', '{id,x,y,altitude}') > 0 AS again;
UPDATE wells SET x = x + 0.5 WHERE id = 1;
ALTER TABLE wells RENAME altitude TO height;
SELECT abacus_track('field', 'wells') > 0 AS again, apart();
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'wells'::regclass AND NOT tgisinternal;

-- untracked, changed on both sides, and brought in step again
SELECT abacus_untrack('field', 'wells');
SELECT abacus_untrack('field', 'wells');
\echo :LAST_ERROR_SQLSTATE
DELETE FROM wells WHERE id < 3;
UPDATE wells SET height = 1000 WHERE id = 7;
SELECT abacus_insert('field', 'VALUES (900, 50, 50, 1)');
SELECT abacus_track('field', 'wells');
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'wells'::regclass AND NOT tgisinternal;
SELECT abacus_track('field', 'wells', synchronize => true) > 0 AS tracked, apart();
-- its points are those of the table alone, until it follows no more
SELECT abacus_delete('field', 'SELECT id, x, y FROM wells WHERE id = 7');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', 'SELECT 777 AS id, x, y FROM wells WHERE id = 7');
SELECT abacus_delete_returning('field', 'SELECT id, x, y FROM wells WHERE id = 7');
SELECT abacus_insert_returning('field', 'SELECT 777 AS id, x, y FROM wells WHERE id = 7');
SELECT abacus_stage('field', 'SELECT 777 AS id, x, y FROM wells WHERE id = 7');
SELECT abacus_update('field', 'SELECT id, x, y, 0 AS height FROM wells WHERE id = 7');
SELECT abacus_add_attribute('field', 'depth');
-- what the table does not give is free
BEGIN;
SELECT abacus_set_srid('field', 4326), abacus_rename_attribute('field', 'height', 'level');
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, 1 AS soil FROM abacus_simplices(''field'')') > 0 AS labelled,
       abacus_mark('field', 'SELECT code, v0, v1, v2, 0 AS facet, 7 AS marker FROM abacus_simplices(''field'') LIMIT 1') > 0 AS marked;
ROLLBACK;
CALL abacus_build('field');
SELECT apart();
-- a mesh that has missed a change
ALTER TABLE wells DISABLE TRIGGER USER;
UPDATE wells SET x = x + 1 WHERE id = 7;
ALTER TABLE wells ENABLE TRIGGER USER;
DELETE FROM wells WHERE id = 7;
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('field', 'wells', synchronize => true) > 0 AS tracked, apart();
UPDATE wells SET x = x - 1 WHERE id = 7;

-- one table, many meshes; one mesh, one table
CREATE TABLE others (id int, x int, y int, z int);
SELECT abacus_track('field', 'others');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('solid', 3);
SELECT abacus_create('upright', 2);
SELECT abacus_track('solid', 'others');
SELECT abacus_track('upright', 'others', '{id,x,z}');
INSERT INTO others SELECT i, i % 3, i / 3 % 3, i / 9 FROM generate_series(0, 26) i;
UPDATE others SET z = 5 WHERE id = 26;
DELETE FROM others WHERE id = 13;
SELECT count(*), sum(abs(v.x - t.x) + abs(v.y - t.y) + abs(v.z - t.z)) FROM abacus_vertices('solid') v JOIN others t USING (id);
SELECT count(*), sum(abs(v.x - t.x) + abs(v.y - t.z)) FROM abacus_vertices('upright') v JOIN others t USING (id);
SELECT * FROM abacus_check('solid');
SELECT * FROM abacus_check('upright');
-- dropping a mesh drops its triggers
DROP TABLE upright;
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'others'::regclass AND NOT tgisinternal;
DELETE FROM others WHERE id = 1;
SELECT count(*) FROM abacus_vertices('solid');

-- what cannot be tracked
CREATE TABLE parted (id int, x int, y int) PARTITION BY LIST (id);
CREATE TABLE part PARTITION OF parted DEFAULT;
CREATE VIEW view_of_others AS SELECT id, x, y, z FROM others;
SELECT abacus_create('flat', 2);
SELECT abacus_track('flat', 'part');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('flat', 'view_of_others');
SELECT abacus_track('others', 'others');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('flat', 'others', '{id,x}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('flat', 'others', '{id,x,nothing}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('flat', 'wells', '{id,x,name}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('pg_temp.passing', 2);
SELECT abacus_track('passing', 'others');
\echo :LAST_ERROR_SQLSTATE
CREATE TEMP TABLE moments AS SELECT id, x, y FROM others;
SELECT abacus_track('passing', 'moments');
DELETE FROM moments WHERE id = 2;
SELECT count(*) FROM abacus_vertices('passing');
-- temporary tables may be written in a transaction that only reads, and so may their mesh
BEGIN READ ONLY;
INSERT INTO moments VALUES (50, 7, 8);
INSERT INTO moments VALUES (51, 8, 7);
SELECT count(*) FROM abacus_vertices('passing') WHERE id >= 50;
COMMIT;
DROP TABLE moments, passing;
SELECT abacus_track(NULL, 'others');
SELECT abacus_track(0, 'others');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_untrack('flat', NULL) IS NULL AS strict;
BEGIN ISOLATION LEVEL REPEATABLE READ;
SELECT abacus_track('flat', 'others');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
CREATE TRIGGER by_hand AFTER INSERT ON others FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('solid', '3', 'id', 'x', 'y', 'z');
INSERT INTO others VALUES (40, 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE
DROP TRIGGER by_hand ON others;
CREATE TRIGGER by_hand AFTER INSERT ON others REFERENCING NEW TABLE AS added FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('solid', '2147483647', 'id', 'x', 'y', 'z');
INSERT INTO others VALUES (40, 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'parted'::regclass;

-- privileges: users who may write the table need no others; the mesh is written as the table's owner
CREATE ROLE regress_track_owner;
CREATE ROLE regress_track_writer;
CREATE SCHEMA regress_track AUTHORIZATION regress_track_owner;
GRANT USAGE ON SCHEMA regress_track TO regress_track_writer;
SET search_path = regress_track, public;
SET ROLE regress_track_owner;
CREATE TABLE spots (id int, x float8, y float8);
SELECT abacus_create('spotted', 2);
SELECT abacus_track('spotted', 'spots');
GRANT INSERT ON spots TO regress_track_writer;
SET ROLE regress_track_writer;
INSERT INTO spots VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1);
SELECT abacus_insert('spotted', 'VALUES (4, 1, 1)');
SELECT abacus_untrack('spotted', 'spots');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_track('spotted', 'spots');
\echo :LAST_ERROR_SQLSTATE
SET ROLE regress_track_owner;
SELECT abacus_track('field', 'spots');
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM abacus_simplices('spotted');
ALTER TABLE spots ENABLE ROW LEVEL SECURITY, FORCE ROW LEVEL SECURITY;
SELECT abacus_track('spotted', 'spots');
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;
-- the table's owner needs the privileges, not the user who asks
CREATE TABLE owned (id int, x float8, y float8);
ALTER TABLE owned OWNER TO regress_track_owner;
SELECT abacus_create('unowned', 2);
SELECT abacus_track('unowned', 'owned');
\echo :LAST_ERROR_SQLSTATE
GRANT ALL ON unowned TO regress_track_owner;
SELECT abacus_track('unowned', 'owned');
GRANT ALL ON unowned_vertices TO regress_track_owner;
SELECT abacus_track('unowned', 'owned');
REVOKE UPDATE ON unowned FROM regress_track_owner;
INSERT INTO owned VALUES (1, 2, 3);
DROP TABLE owned, unowned;
RESET search_path;
DROP SCHEMA regress_track CASCADE;
DROP ROLE regress_track_owner, regress_track_writer;

DROP TABLE field, wells, owners, others, solid, parted, flat CASCADE;
DROP FUNCTION apart;

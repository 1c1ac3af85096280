-- A mesh that follows a table at commit.
CREATE TABLE spots (id int PRIMARY KEY, x float8, y float8, h float8);
SELECT abacus_create('spotted', 2, '{h}');
SELECT abacus_track('spotted', 'spots', deferred => true);
CREATE FUNCTION apart() RETURNS bigint LANGUAGE sql AS $$
    WITH there AS (SELECT id, x, y, attributes[1] FROM abacus_vertices('spotted')),
         here AS (SELECT id, x, y, h FROM spots WHERE x IS NOT NULL AND y IS NOT NULL)
    SELECT (SELECT count(*) FROM (TABLE here EXCEPT ALL TABLE there) a)
         + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE here) b)
         + (SELECT count(*) FROM abacus_check('spotted')) $$;
SELECT tgname, encode(tgargs, 'escape') FROM pg_trigger WHERE tgrelid = 'spots'::regclass ORDER BY tgname;

-- a statement by itself is a transaction
INSERT INTO spots SELECT i, i % 7, i / 7, i FROM generate_series(0, 48) i;
SELECT apart();
UPDATE spots SET h = h + 1;
SELECT apart();
DELETE FROM spots WHERE id % 5 = 0;
SELECT apart();
-- in a transaction the mesh is as it was, until it has ended
BEGIN;
INSERT INTO spots VALUES (100, 20, 0, 1), (101, 20, 1, 2);
INSERT INTO spots VALUES (102, 21, 0, 3), (103, NULL, 0, 4);
SELECT count(*) FROM abacus_vertices('spotted') WHERE id >= 100;
UPDATE spots SET x = 22 WHERE id = 102;
UPDATE spots SET x = 23 WHERE id IN (102, 103);
UPDATE spots SET id = 104 WHERE id = 101;
DELETE FROM spots WHERE id IN (1, 100);
INSERT INTO spots VALUES (100, 20, 0, 5);
SELECT apart();
COMMIT;
SELECT apart(), array_agg(id ORDER BY id) FROM abacus_vertices('spotted') WHERE id >= 100;
-- ... once: one new header, whatever the number of statements
BEGIN;
SELECT ctid AS header FROM spotted WHERE code = -1 \gset
DO $$ BEGIN FOR i IN 1 .. 300 LOOP INSERT INTO spots VALUES (1000 + i, random(), random(), i); END LOOP; END $$;
SELECT ctid = :'header' AS untouched FROM spotted WHERE code = -1;
COMMIT;
SELECT apart();
-- what comes and goes leaves nothing
BEGIN;
INSERT INTO spots SELECT i, i % 100, i / 100, 0 FROM generate_series(2000, 2999) i;
DELETE FROM spots WHERE id >= 2000;
COMMIT;
SELECT apart();

-- savepoints
BEGIN;
INSERT INTO spots VALUES (3000, 1.5, 1.5, 0);
SAVEPOINT one;
INSERT INTO spots VALUES (3001, 1.5, 2.5, 0);
SAVEPOINT two;
DELETE FROM spots WHERE id = 3000;
INSERT INTO spots VALUES (3002, 2.5, 2.5, 0);
ROLLBACK TO two;
INSERT INTO spots VALUES (3003, 2.5, 1.5, 0);
RELEASE two;
SAVEPOINT three;
DELETE FROM spots WHERE id BETWEEN 1000 AND 1100;
ROLLBACK TO three;
COMMIT;
SELECT apart(), array_agg(id ORDER BY id) FROM abacus_vertices('spotted') WHERE id >= 3000;
BEGIN;
SAVEPOINT one;
INSERT INTO spots VALUES (3004, 3.5, 1.5, 0);
ROLLBACK TO one;
INSERT INTO spots VALUES (3005, 3.5, 2.5, 0);
SAVEPOINT two;
INSERT INTO spots VALUES (3006, 4.5, 2.5, 0);
RELEASE one;
SAVEPOINT one;
DELETE FROM spots WHERE id = 3006;
ROLLBACK TO one;
COMMIT;
SELECT apart(), array_agg(id ORDER BY id) FROM abacus_vertices('spotted') WHERE id >= 3000;
DO $$ BEGIN FOR i IN 1 .. 20 LOOP
    BEGIN
        INSERT INTO spots VALUES (3100 + i, 5.5 + i, 0, 0);
        PERFORM 1 / (i % 3);
    EXCEPTION WHEN division_by_zero THEN
        INSERT INTO spots VALUES (3200 + i, 5.5 + i, 1, 0);
    END;
END LOOP; END $$;
SELECT apart(), count(*) FROM abacus_vertices('spotted') WHERE id > 3100;
BEGIN;
INSERT INTO spots VALUES (3300, 0.1, 0.1, 0);
ROLLBACK;
SELECT apart();

-- TRUNCATE empties the mesh at once
BEGIN;
INSERT INTO spots VALUES (4000, 0.1, 0.1, 0);
SAVEPOINT one;
TRUNCATE spots;
SELECT count(*) FROM abacus_vertices('spotted');
INSERT INTO spots VALUES (4001, 0.1, 0.1, 0);
ROLLBACK TO one;
DELETE FROM spots WHERE id = 3005;
COMMIT;
SELECT apart(), count(*) FROM abacus_vertices('spotted') WHERE id >= 4000;
BEGIN;
INSERT INTO spots VALUES (4002, 0.2, 0.2, 0);
TRUNCATE spots;
INSERT INTO spots VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0);
COMMIT;
SELECT apart(), count(*) FROM abacus_simplices('spotted');

-- SET CONSTRAINTS
BEGIN;
INSERT INTO spots VALUES (4, 1, 1, 0);
SELECT apart();
SET CONSTRAINTS ALL IMMEDIATE;
SELECT apart();
INSERT INTO spots VALUES (5, 2, 1, 0);
SELECT apart();
SAVEPOINT one;
SET CONSTRAINTS ALL DEFERRED;
INSERT INTO spots VALUES (6, 2, 2, 0);
SELECT apart();
ROLLBACK TO one;
INSERT INTO spots VALUES (7, 2, 3, 0);
SELECT apart();
SET CONSTRAINTS ALL DEFERRED;
INSERT INTO spots VALUES (8, 2, 4, 0);
SAVEPOINT two;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT apart();
ROLLBACK TO two;
SELECT apart();
COMMIT;
SELECT apart();

-- what cannot be a point is refused by its statement, what is missing at commit
INSERT INTO spots VALUES (9, 'NaN', 0, 0);
SELECT abacus_delete('spotted', 'VALUES (8, 2, 4)');
ALTER TABLE spots DISABLE TRIGGER USER;
UPDATE spots SET y = 5 WHERE id = 8;
ALTER TABLE spots ENABLE TRIGGER USER;
BEGIN;
DELETE FROM spots WHERE id = 8;
COMMIT;
\echo :LAST_ERROR_SQLSTATE
SELECT apart();
ALTER TABLE spots DISABLE TRIGGER USER;
UPDATE spots SET y = 4 WHERE id = 8;
ALTER TABLE spots ENABLE TRIGGER USER;
SELECT apart();

-- two tables, several meshes, one of them deferred
CREATE TABLE others (id int, x float8, y float8);
SELECT abacus_create('at_once', 2, '{h}'), abacus_create('others_mesh', 2);
SELECT abacus_track('at_once', 'spots'), abacus_track('others_mesh', 'others', deferred => true);
BEGIN;
INSERT INTO others SELECT id, x + 0.5, y + 0.5 FROM spots;
INSERT INTO spots SELECT id + 100, x, y + 0.5, id FROM others;
SELECT (SELECT count(*) FROM abacus_vertices('spotted')) AS spotted, (SELECT count(*) FROM abacus_vertices('at_once')) AS at_once,
       (SELECT count(*) FROM abacus_vertices('others_mesh')) AS others;
COMMIT;
SELECT (SELECT count(*) FROM abacus_vertices('spotted')) AS spotted, (SELECT count(*) FROM abacus_vertices('at_once')) AS at_once,
       (SELECT count(*) FROM abacus_vertices('others_mesh')) AS others, apart();
-- tracked anew, untracked, built and dropped with points that wait for the commit
BEGIN;
INSERT INTO spots VALUES (500, 9, 9, 9);
SELECT abacus_track('spotted', 'spots');
SELECT apart();
INSERT INTO spots VALUES (501, 9, 8, 9);
SELECT apart();
SELECT abacus_track('spotted', 'spots', deferred => true);
INSERT INTO spots VALUES (502, 8, 9, 9);
SELECT abacus_untrack('spotted', 'spots');
SELECT apart();
SELECT abacus_track('spotted', 'spots', deferred => true);
INSERT INTO others VALUES (1000, 0, 0);
DROP TABLE others_mesh;
COMMIT;
SELECT apart();
DO $$ BEGIN
    INSERT INTO spots VALUES (503, 8, 8.5, 9);
    CALL abacus_build('spotted', 2);
    INSERT INTO spots VALUES (504, 8.5, 8, 9);
END $$;
SELECT apart();
-- an AFTER trigger that changes the rows of its own statement again
SELECT abacus_untrack('at_once', 'spots');
CREATE FUNCTION nudge() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN UPDATE spots SET x = x + 1 WHERE id = NEW.id; RETURN NULL; END $$;
CREATE TRIGGER nudge AFTER INSERT ON spots FOR EACH ROW EXECUTE FUNCTION nudge();
CREATE CONSTRAINT TRIGGER nudge_again AFTER INSERT ON spots DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION nudge();
BEGIN;
INSERT INTO spots VALUES (600, 0.5, 0.5, 1), (601, 0.6, 0.5, 1);
COMMIT;
SELECT apart(), array_agg(x ORDER BY x) FROM abacus_vertices('spotted') WHERE id IN (600, 601);
DROP TRIGGER nudge ON spots;
DROP TRIGGER nudge_again ON spots;
-- more than fits into memory, part of it taken back
BEGIN;
INSERT INTO spots SELECT i, i % 211, i / 211, i FROM generate_series(10000, 16000) i;
SAVEPOINT one;
DELETE FROM spots WHERE id BETWEEN 12000 AND 15000;
ROLLBACK TO one;
UPDATE spots SET y = -y WHERE id BETWEEN 14000 AND 14999;
SAVEPOINT two;
INSERT INTO spots SELECT i, i % 211, i / 211, i FROM generate_series(16001, 20000) i;
RELEASE two;
COMMIT;
SELECT apart(), count(*) FROM abacus_vertices('spotted') WHERE id >= 10000;
BEGIN ISOLATION LEVEL SERIALIZABLE;
DELETE FROM spots WHERE id >= 10000;
COMMIT;
SELECT apart();
SELECT abacus_track('spotted', 'spots', deferred => NULL);
\echo :LAST_ERROR_SQLSTATE
DROP TABLE spotted, at_once, spots, others;
DROP FUNCTION apart, nudge;

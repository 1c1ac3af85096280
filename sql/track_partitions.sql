-- A mesh that follows a table with partitions, or with children: at commit.
CREATE TABLE survey (id int, x float8, y float8, h float8, year int) PARTITION BY LIST (year);
CREATE TABLE survey_2020 PARTITION OF survey FOR VALUES IN (2020);
-- columns in another order, and one that has gone
CREATE TABLE survey_2021 (gone text, year int, h float8, y float8, x float8, id int);
ALTER TABLE survey_2021 DROP COLUMN gone;
ALTER TABLE survey ATTACH PARTITION survey_2021 FOR VALUES IN (2021);
CREATE TABLE survey_old PARTITION OF survey FOR VALUES IN (2000, 2001) PARTITION BY LIST (year);
CREATE TABLE survey_2000 PARTITION OF survey_old FOR VALUES IN (2000);
CREATE TABLE survey_2001 PARTITION OF survey_old FOR VALUES IN (2001);
INSERT INTO survey SELECT i, i % 10, i / 10, i, (ARRAY[2020, 2021, 2000, 2001])[1 + i % 4] FROM generate_series(0, 99) i;
CREATE FUNCTION apart(mesh regclass, source text) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    n bigint;
BEGIN
    EXECUTE format('WITH there AS (SELECT id, x, y, attributes[1] FROM abacus_vertices(%L)), here AS (SELECT id, x, y, h FROM %s)
        SELECT (SELECT count(*) FROM (TABLE here EXCEPT ALL TABLE there) a) + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE here) b)
             + (SELECT count(*) FROM abacus_check(%1$L))', mesh, source) INTO n;
    RETURN n;
END $$;
SELECT abacus_create('surveyed', 2, '{h}');
CREATE FUNCTION apart() RETURNS bigint LANGUAGE sql AS $$ SELECT apart('surveyed', 'survey') $$;
SELECT abacus_track('surveyed', 'survey_2020');
SELECT abacus_track('surveyed', 'survey_old');
SELECT abacus_track('surveyed', 'survey');
SELECT apart();
SELECT tgrelid::regclass, tgname, tgisinternal OR tgparentid <> 0 AS clone FROM pg_trigger
WHERE tgrelid IN (SELECT relid FROM pg_partition_tree('survey')) ORDER BY tgrelid::regclass::text, tgname;

-- by the table and by its partitions
INSERT INTO survey SELECT i, i % 10 + 0.5, i / 10, i, 2000 + i % 2 FROM generate_series(100, 199) i;
SELECT apart();
INSERT INTO survey_2020 SELECT i, i % 10 + 0.5, i / 10 + 0.5, i, 2020 FROM generate_series(200, 249) i;
SELECT apart();
COPY survey_2021 (id, x, y, h, year) FROM STDIN;
300	30	1	1	2021
301	31	2	2	2021
\.
COPY survey (id, x, y, h, year) FROM STDIN;
302	32	1	1	2021
303	33	2	2	2001
\.
SELECT apart();
UPDATE survey SET h = h + 1;
SELECT apart();
UPDATE survey_old SET x = x + 0.1 WHERE id % 3 = 0;
SELECT apart();
DELETE FROM survey_2001 WHERE id % 5 = 0;
DELETE FROM survey WHERE id % 7 = 0;
SELECT apart();
-- rows that go from one partition to another, with or without their points
UPDATE survey SET year = 2021 WHERE year = 2020 AND id % 2 = 0;
SELECT apart(), count(*) FROM survey_2021;
UPDATE survey SET year = 2020, x = x + 0.25 WHERE year IN (2000, 2021) AND id % 3 = 1;
SELECT apart(), count(*) FROM survey_2020;
MERGE INTO survey USING (VALUES (300, 1), (301, 2), (999, 3)) AS s (id, what) ON survey.id = s.id
    WHEN MATCHED AND what = 1 THEN DELETE
    WHEN MATCHED THEN UPDATE SET year = 2000
    WHEN NOT MATCHED THEN INSERT (id, x, y, h, year) VALUES (s.id, 40, 40, 1, 2020);
SELECT apart();

-- partitions that come: empty, or in step by another call
CREATE TABLE survey_2022 PARTITION OF survey FOR VALUES IN (2022);
INSERT INTO survey_2022 VALUES (400, 50, 50, 1, 2022);
INSERT INTO survey VALUES (401, 51, 50, 1, 2022);
SELECT apart();
CREATE TABLE survey_2023 (LIKE survey);
INSERT INTO survey_2023 VALUES (500, 60, 60, 1, 2023);
ALTER TABLE survey ATTACH PARTITION survey_2023 FOR VALUES IN (2023);
SELECT apart();
INSERT INTO survey_2023 VALUES (501, 61, 60, 1, 2023);
SELECT abacus_track('surveyed', 'survey', synchronize => true) > 0 AS tracked, apart();
-- one that has come since tells nobody of TRUNCATE by itself, until the mesh is tracked again
CREATE TABLE survey_2030 PARTITION OF survey FOR VALUES IN (2030);
INSERT INTO survey_2030 VALUES (550, 65, 60, 1, 2030), (551, 66, 60, 1, 2030);
TRUNCATE survey_2030;
SELECT apart();
SELECT abacus_track('surveyed', 'survey', synchronize => true) > 0 AS tracked, apart();
INSERT INTO survey_2030 VALUES (550, 65, 60, 1, 2030), (551, 66, 60, 1, 2030);
TRUNCATE survey_2030;
SELECT apart();
DROP TABLE survey_2030;
-- ... and go
ALTER TABLE survey DETACH PARTITION survey_2023;
SELECT apart();
INSERT INTO survey_2023 VALUES (502, 62, 60, 1, 2023);
SELECT abacus_track('surveyed', 'survey', synchronize => true) > 0 AS tracked, apart();
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'survey_2023'::regclass;
TRUNCATE survey_2023;
DROP TABLE survey_2023;
DROP TABLE survey_2022;
SELECT apart();
SELECT abacus_track('surveyed', 'survey', synchronize => true) > 0 AS tracked, apart();
-- detached, and truncated before the mesh is told
CREATE TABLE survey_2024 PARTITION OF survey FOR VALUES IN (2024);
SELECT abacus_track('surveyed', 'survey') > 0 AS tracked;
INSERT INTO survey VALUES (600, 70, 70, 1, 2024);
DELETE FROM survey WHERE id = 600;
ALTER TABLE survey DETACH PARTITION survey_2024;
INSERT INTO survey_2024 VALUES (601, 70, 70, 1, 2024);
TRUNCATE survey_2024;
SELECT apart();
DROP TABLE survey_2024;

-- TRUNCATE: of a partition, of some, of all
BEGIN;
INSERT INTO survey_2020 VALUES (700, 80, 80, 1, 2020);
TRUNCATE survey_2020;
INSERT INTO survey_2020 VALUES (701, 80, 80, 1, 2020);
COMMIT;
SELECT apart();
TRUNCATE survey_old;
SELECT apart();
BEGIN;
INSERT INTO survey VALUES (702, 81, 80, 1, 2020);
TRUNCATE survey;
SELECT count(*) FROM abacus_vertices('surveyed');
INSERT INTO survey VALUES (703, 0, 0, 1, 2020), (704, 1, 0, 1, 2021), (705, 0, 1, 1, 2000);
COMMIT;
SELECT apart(), count(*) FROM abacus_simplices('surveyed');
-- savepoints, errors
BEGIN;
INSERT INTO survey VALUES (800, 1, 1, 1, 2020);
SAVEPOINT one;
INSERT INTO survey VALUES (801, 2, 1, 1, 2021);
UPDATE survey SET year = 2000 WHERE id = 800;
ROLLBACK TO one;
COMMIT;
SELECT apart();
INSERT INTO survey VALUES (802, 'NaN', 1, 1, 2020);
INSERT INTO survey VALUES (NULL, 1, 1, 1, 2020);
\echo :LAST_ERROR_SQLSTATE
SELECT apart();
-- tracked again, the triggers fire as they did, clones too
ALTER TABLE survey ENABLE ALWAYS TRIGGER abacus_track_rows_surveyed;
SELECT abacus_track('surveyed', 'survey') > 0 AS tracked;
SELECT tgenabled, count(*) FROM pg_trigger WHERE tgname = 'abacus_track_rows_surveyed' GROUP BY tgenabled;
SELECT abacus_untrack('surveyed', 'survey');
SELECT abacus_track('surveyed', 'survey') > 0 AS tracked;
-- the mesh goes, and with it the triggers
SELECT abacus_untrack('surveyed', 'survey_2020');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_untrack('surveyed', 'survey');
SELECT count(*) FROM pg_trigger WHERE tgrelid IN (SELECT relid FROM pg_partition_tree('survey'));
SELECT abacus_track('surveyed', 'survey') > 0 AS tracked;
DROP TABLE surveyed;
SELECT count(*) FROM pg_trigger WHERE tgrelid IN (SELECT relid FROM pg_partition_tree('survey'));

-- an ordinary table that becomes a partition
SELECT abacus_create('surveyed', 2, '{h}');
CREATE TABLE survey_2025 (LIKE survey);
SELECT abacus_track('surveyed', 'survey_2025');
ALTER TABLE survey ATTACH PARTITION survey_2025 FOR VALUES IN (2025);
INSERT INTO survey_2025 VALUES (900, 0, 0, 1, 2025);
SELECT apart('surveyed', 'survey_2025');
SELECT abacus_track('surveyed', 'survey', synchronize => true) > 0 AS tracked, apart();
SELECT count(*) FROM pg_trigger WHERE tgrelid = 'survey_2025'::regclass;
INSERT INTO survey_2025 VALUES (901, 1, 5, 1, 2025);
SELECT apart();
DROP TABLE surveyed, survey;

-- children
CREATE TABLE wells (id int, x float8, y float8, h float8);
CREATE TABLE deep_wells (depth float8) INHERITS (wells);
CREATE TABLE dry_wells (since date) INHERITS (wells);
INSERT INTO wells VALUES (1, 0, 0, 1), (2, 4, 0, 1);
INSERT INTO deep_wells VALUES (3, 0, 4, 1, 100);
SELECT abacus_create('field', 2, '{h}');
SELECT abacus_track('field', 'deep_wells');
SELECT abacus_track('field', 'wells'), apart('field', 'wells');
INSERT INTO dry_wells VALUES (4, 4, 4, 1, 'today');
INSERT INTO deep_wells VALUES (5, 1, 2, 1, 200);
UPDATE wells SET h = h + id;
DELETE FROM wells WHERE id = 2;
SELECT apart('field', 'wells');
DELETE FROM ONLY wells WHERE id IN (1, 5);
UPDATE deep_wells SET x = x + 1;
SELECT apart('field', 'wells'), count(*) FROM abacus_vertices('field');
INSERT INTO wells VALUES (6, 7, 7, 7);
TRUNCATE ONLY wells;
SELECT apart('field', 'wells'), count(*) FROM abacus_vertices('field');
INSERT INTO wells VALUES (7, 7, 7, 7);
TRUNCATE deep_wells;
SELECT apart('field', 'wells'), count(*) FROM abacus_vertices('field');
TRUNCATE wells;
SELECT apart('field', 'wells'), count(*) FROM abacus_vertices('field');
INSERT INTO dry_wells VALUES (8, 4, 4, 1, 'today');
ALTER TABLE dry_wells NO INHERIT wells;
SELECT abacus_track('field', 'wells', synchronize => true);
SELECT abacus_untrack('field', 'dry_wells');
SELECT abacus_track('field', 'wells', synchronize => true), apart('field', 'wells');
SELECT abacus_untrack('field', 'wells');
SELECT count(*) FROM pg_trigger WHERE tgrelid IN ('wells'::regclass, 'deep_wells'::regclass, 'dry_wells'::regclass);
DROP TABLE field, dry_wells, deep_wells, wells;

-- what cannot be tracked
CREATE TABLE owned (id int, x float8, y float8) PARTITION BY LIST (id);
CREATE TABLE owned_part PARTITION OF owned DEFAULT;
CREATE ROLE regress_track_part;
ALTER TABLE owned_part OWNER TO regress_track_part;
SELECT abacus_create('mesh', 2);
SELECT abacus_track('mesh', 'owned');
\echo :LAST_ERROR_SQLSTATE
ALTER TABLE owned_part OWNER TO CURRENT_USER;
CREATE UNLOGGED TABLE owned_brief PARTITION OF owned FOR VALUES IN (1);
SELECT abacus_track('mesh', 'owned');
\echo :LAST_ERROR_SQLSTATE
DROP TABLE owned_brief;
-- users who may write the table write the mesh, on whichever way
SELECT abacus_track('mesh', 'owned');
GRANT INSERT, TRUNCATE ON owned, owned_part TO regress_track_part;
SET ROLE regress_track_part;
INSERT INTO owned VALUES (1, 2, 3);
INSERT INTO owned_part VALUES (2, 3, 4);
RESET ROLE;
SELECT count(*) FROM abacus_vertices('mesh');
SET ROLE regress_track_part;
TRUNCATE owned_part;
RESET ROLE;
SELECT count(*) FROM abacus_vertices('mesh');
-- a trigger by hand reads what its maker may read
GRANT TRIGGER ON owned_part TO regress_track_part;
SELECT abacus_untrack('mesh', 'owned');
GRANT ALL ON mesh, mesh_vertices TO regress_track_part;
INSERT INTO owned VALUES (1, 2, 3);
SET ROLE regress_track_part;
CREATE TRIGGER a BEFORE TRUNCATE ON owned_part EXECUTE FUNCTION abacus_tracked('mesh', '2', 'id', 'x', 'y');
CREATE TRIGGER b AFTER INSERT ON owned_part FOR EACH ROW EXECUTE FUNCTION abacus_tracked('mesh', '2', 'id', 'x', 'y');
TRUNCATE owned_part;
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;
DROP TABLE owned, mesh;
DROP ROLE regress_track_part;
DROP FUNCTION apart(), apart(regclass, text);

-- many rows, whose conversion takes memory for each: what is kept from row to row is kept
CREATE TABLE many (id int, x numeric, y numeric, note text) PARTITION BY HASH (id);
CREATE TABLE many_0 PARTITION OF many FOR VALUES WITH (modulus 2, remainder 0);
CREATE TABLE many_1 PARTITION OF many FOR VALUES WITH (modulus 2, remainder 1);
SELECT abacus_create('of_many', 2);
SELECT abacus_track('of_many', 'many');
INSERT INTO many SELECT i, (i * 7919) % 10007, (i * 104729) % 10009, repeat('x', i % 500) FROM generate_series(1, 6000) i;
UPDATE many SET x = x + 0.5, note = repeat('y', id % 300) WHERE id % 3 = 0;
DELETE FROM many WHERE id % 5 = 0;
SELECT count(*), (SELECT count(*) FROM many) AS rows, sum(abs(v.x - m.x) + abs(v.y - m.y)) AS apart
FROM abacus_vertices('of_many') v JOIN many m USING (id);
DROP TABLE many, of_many;

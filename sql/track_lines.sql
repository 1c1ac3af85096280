-- A mesh that follows a table of lines whose points are rows of the table of points that it follows.
CREATE TABLE peg (id int PRIMARY KEY, x float8, y float8, h float8);
INSERT INTO peg SELECT 10 * i + j, i, j, i + j FROM generate_series(0, 5) AS i, generate_series(0, 5) AS j;
CREATE TABLE wall (line int, position int, point int, part int, kind text, PRIMARY KEY (line, position));
INSERT INTO wall VALUES (1, 1, 0), (1, 2, 23);
INSERT INTO wall VALUES (2, 1, 4, NULL, 'soft'), (2, 2, 34, NULL, 'soft');
SELECT abacus_create('site', 2, '{h}');
SELECT abacus_track('site', 'peg');
SELECT abacus_track_lines('site', 'wall', kind => 'kind');
SELECT * FROM abacus_lines('site');
SELECT tgname, encode(tgargs, 'escape') FROM pg_trigger WHERE tgrelid = 'wall'::regclass ORDER BY tgname;

-- each statement follows at commit
INSERT INTO wall VALUES (3, 1, 50, NULL), (3, 2, 52, NULL), (3, 3, 53, 1), (3, 4, 54, 1);
UPDATE wall SET point = 24 WHERE line = 1 AND position = 2;
UPDATE wall SET kind = NULL WHERE line = 2;
DELETE FROM wall WHERE line = 3 AND position = 1 OR line = 3 AND position = 2;
SELECT line, position, point, x, y, kind, part FROM abacus_lines('site');
COPY wall FROM stdin;
4	1	40	\N	hard
4	2	30	\N	hard
\.
INSERT INTO wall VALUES (4, 2, 31) ON CONFLICT (line, position) DO UPDATE SET point = excluded.point;
MERGE INTO wall USING (VALUES (4, 1, 41), (4, 3, 32)) AS new (line, position, point) ON wall.line = new.line AND wall.position = new.position
WHEN MATCHED THEN UPDATE SET point = new.point WHEN NOT MATCHED THEN INSERT VALUES (new.line, new.position, new.point);
SELECT v0, v1, lines, kind FROM abacus_edges('site', fixed => true);

-- the lines follow their points
UPDATE peg SET x = 0.5 WHERE id = 0;
UPDATE peg SET h = 7 WHERE id = 24;
SELECT point, x, y FROM abacus_lines('site') WHERE line = 1;

-- in one transaction the order does not matter
BEGIN;
DELETE FROM peg WHERE id = 24;
INSERT INTO peg VALUES (24, 2.5, 3.5, 1);
UPDATE wall SET line = 11 WHERE line = 1;
SELECT line, point, x, y FROM abacus_lines('site') WHERE line IN (1, 11);
COMMIT;
SELECT line, point, x, y FROM abacus_lines('site') WHERE line IN (1, 11);
BEGIN;
INSERT INTO wall VALUES (5, 1, 200), (5, 2, 201);
INSERT INTO peg VALUES (200, 4.5, 0.5, 1), (201, 4.5, 1.5, 1);
COMMIT;
-- a line split in two, then merged
BEGIN;
UPDATE wall SET point = 14 WHERE line = 2 AND position = 2;
INSERT INTO wall VALUES (6, 1, 14), (6, 2, 34);
SET CONSTRAINTS ALL IMMEDIATE;
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('site') WHERE line IN (2, 6) GROUP BY line ORDER BY line;
DELETE FROM wall WHERE line = 6;
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('site') WHERE line IN (2, 6) GROUP BY line ORDER BY line;
SAVEPOINT s;
INSERT INTO wall VALUES (2, 3, 25);
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('site') WHERE line = 2 GROUP BY line;
ROLLBACK TO s;
COMMIT;
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('site') WHERE line = 2 GROUP BY line;

-- what cannot be followed, at commit
DELETE FROM peg WHERE id = 4;
INSERT INTO wall VALUES (7, 1, 3), (7, 2, 999);
INSERT INTO wall VALUES (7, 1, 1), (7, 2, 44);
INSERT INTO wall VALUES (7, 1, 3);
INSERT INTO wall VALUES (7, 1, 3), (7, 2, 3);
INSERT INTO wall VALUES (7, 1, 50, NULL, 'hard'), (7, 2, 51, NULL, 'soft');
INSERT INTO wall VALUES (7, 1, 50, NULL, 'stiff'), (7, 2, 51, NULL, 'stiff');
INSERT INTO wall VALUES (7, 1, NULL);
BEGIN;
INSERT INTO wall VALUES (7, 1, 1), (7, 2, 44);
UPDATE wall SET point = 2 WHERE line = 7 AND position = 2;
COMMIT;
DELETE FROM wall WHERE line = 7;
SELECT count(*) FROM peg WHERE id = 4;
SELECT count(*) FROM wall WHERE line = 7;

-- by hand
SELECT abacus_constrain('site', 'VALUES (9, 1, 50), (9, 2, 51)');
SELECT abacus_unconstrain('site', 'VALUES (2)');
SELECT abacus_insert('site', 'VALUES (9, 9, 9, 9)');
SELECT abacus_add_attribute('site', 'w');

-- TRUNCATE of both tables, in any order
BEGIN;
TRUNCATE peg;
INSERT INTO peg VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 4, 4, 0), (4, 0, 4, 0);
TRUNCATE wall;
INSERT INTO wall VALUES (1, 1, 1), (1, 2, 3);
COMMIT;
SELECT v0, v1, v2 FROM abacus_simplices('site') ORDER BY v0, v1;
TRUNCATE peg;
TRUNCATE wall;
SELECT v0, v1, v2 FROM abacus_simplices('site') ORDER BY v0, v1;

-- called again: in step, or not
INSERT INTO wall VALUES (1, 1, 1), (1, 2, 3);
SELECT abacus_track_lines('site', 'wall');
SELECT abacus_untrack('site', 'wall');
SELECT abacus_unconstrain('site', 'VALUES (1)');
SELECT abacus_constrain('site', 'VALUES (2, 1, 2), (2, 2, 4)');
UPDATE wall SET position = position * 10;
SELECT abacus_track_lines('site', 'wall');
SELECT abacus_track_lines('site', 'wall', synchronize => true);
SELECT line, position, point, kind FROM abacus_lines('site');
SELECT * FROM abacus_check('site');

-- names and renames
ALTER TABLE wall RENAME TO fence;
ALTER TABLE fence RENAME COLUMN line TO id;
INSERT INTO fence VALUES (2, 1, 2), (2, 2, 3);
SELECT abacus_track_lines('site', 'fence', '{id,position,point,part}', kind => 'soft', synchronize => true);
INSERT INTO fence VALUES (2, 1, 2), (2, 2, 3);
ALTER TABLE site RENAME TO place;
INSERT INTO fence VALUES (3, 1, 3), (3, 2, 4);
SELECT line, kind, array_agg(point ORDER BY position) FROM abacus_lines('place') GROUP BY line, kind ORDER BY line;
SELECT abacus_untrack('place', 'fence');
SELECT abacus_untrack('place', 'fence');

-- without a table of points, ids are points of the mesh, which is changed by hand
SELECT abacus_triangulate('hand', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4), (5, 1, 2)');
SELECT abacus_track_lines('hand', 'fence', '{id,position,point}');
UPDATE fence SET point = 5 WHERE id = 1 AND point = 3;
SELECT abacus_insert('hand', 'VALUES (6, 2, 2)');
INSERT INTO fence VALUES (7, 1, 6), (7, 2, 3);
SELECT abacus_delete('hand', 'VALUES (6, 2, 2)');
SELECT v0, v1, lines FROM abacus_edges('hand', fixed => true);
INSERT INTO fence VALUES (8, 1, 6), (8, 2, 77);
SELECT * FROM abacus_check('hand');

-- what cannot be tracked
SELECT abacus_track_lines('hand', 'peg');
SELECT abacus_track_lines('hand', 'fence', '{id,position}');
SELECT abacus_track_lines('hand', 'fence', '{id}');
SELECT abacus_track_lines('hand', 'fence', '{id,position,kind}');
SELECT abacus_track_lines('hand', 'fence', '{id,position,nothing}');
SELECT abacus_track_lines('hand', 'fence', '{id,position,point}', kind => 'firm');
SELECT abacus_track_lines('hand', 'fence', '{id,position,point}', z => 'h');
SELECT abacus_track_lines('place', 'fence', '{id,position,point}', z => 'h');
SELECT abacus_track_lines('hand', 'peg', '{id,x,y}');
SELECT abacus_track_lines('hand', NULL);
SELECT abacus_create('space', 3);
SELECT abacus_track_lines('space', 'fence', '{id,position,point}');
CREATE VIEW seen AS TABLE fence;
SELECT abacus_track_lines('hand', 'seen');
CREATE TABLE other (LIKE fence);
SELECT abacus_track_lines('hand', 'other', '{id,position,point}');
DROP TABLE hand, place, space, peg, other, fence CASCADE;

-- partitions
CREATE TABLE dyke (line int, position int, point int) PARTITION BY LIST (line);
CREATE TABLE dyke_1 PARTITION OF dyke FOR VALUES IN (1);
CREATE TABLE dyke_2 PARTITION OF dyke FOR VALUES IN (2);
CREATE TABLE pole (id int, x numeric, y numeric);
INSERT INTO pole VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4), (5, 1, 2);
SELECT abacus_create('polder', 2);
SELECT abacus_track_lines('polder', 'dyke');
SELECT abacus_track('polder', 'pole');
INSERT INTO dyke VALUES (1, 1, 1), (1, 2, 5);
INSERT INTO dyke_2 VALUES (2, 1, 5), (2, 2, 2);
UPDATE dyke SET line = 2, position = 0 WHERE line = 1 AND position = 2;
BEGIN;
DELETE FROM dyke WHERE line = 2 AND position = 1;
UPDATE dyke SET line = 2, position = position - 2 WHERE line = 1;
COMMIT;
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('polder') GROUP BY line;
DELETE FROM dyke WHERE position < 0;
SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('polder') GROUP BY line;
TRUNCATE dyke_2;
SELECT count(*) FROM abacus_lines('polder');
INSERT INTO pole VALUES (5, 3, 3);
INSERT INTO dyke VALUES (1, 1, 1), (1, 2, 5);
DROP TABLE polder, dyke, pole;

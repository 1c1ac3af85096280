-- Other attributes for points that stay where they are.
CREATE SCHEMA regress_update;
SET search_path = regress_update, public;
-- a few attributes, with the simplices; and more, apart
SELECT abacus_create('few', 2, '{height,depth}'), abacus_create('many', 2, '{a,b,c,d,e,f,height,depth}');
CREATE TABLE points AS SELECT i AS id, (i % 40) * 1.5 AS x, (i / 40) * 2.5 AS y, i / 4.0 AS height, -i AS depth FROM generate_series(0, 1599) i;
SELECT abacus_insert('few', 'TABLE points'), abacus_insert('many', 'SELECT id, x, y, 1, 2, 3, 4, 5, 6, height, depth FROM points');
CREATE TABLE before AS SELECT 'few' AS mesh, s.* FROM abacus_simplices('few') s UNION ALL SELECT 'many', s.* FROM abacus_simplices('many') s;
CREATE TABLE pages AS SELECT code, part, md5(page::bytea) AS page FROM many WHERE code >= 0;
SELECT abacus_update(mesh, 'SELECT id, x, y, NULL AS depth, height * 2 AS height FROM points WHERE id % 3 = 0') FROM (VALUES ('few'::regclass), ('many')) m(mesh);
CREATE VIEW wrong AS SELECT 'few' AS mesh, v.id FROM abacus_vertices('few') v JOIN points p USING (id)
WHERE attributes IS DISTINCT FROM CASE WHEN id % 3 = 0 THEN ARRAY[height * 2, NULL] ELSE ARRAY[height, depth] END::float8[]
UNION ALL SELECT 'many', v.id FROM abacus_vertices('many') v JOIN points p USING (id)
WHERE attributes IS DISTINCT FROM '{1,2,3,4,5,6}'::float8[] || CASE WHEN id % 3 = 0 THEN ARRAY[height * 2, NULL] ELSE ARRAY[height, depth] END::float8[];
SELECT * FROM wrong;
-- the same simplices; attributes that are apart touch no other page
(SELECT 'few' AS mesh, s.* FROM abacus_simplices('few') s UNION ALL SELECT 'many', s.* FROM abacus_simplices('many') s) EXCEPT TABLE before;
SELECT code, part, md5(page::bytea) AS page FROM many WHERE code >= 0 EXCEPT TABLE pages;
SELECT * FROM abacus_check('few') UNION ALL SELECT * FROM abacus_check('many');
SELECT abacus_interpolate('many', 0, 0, attribute => 'height') AS height, abacus_interpolate('few', 0, 0, attribute => 'depth') AS depth;
-- no rows; -0 is 0; the last of several rows counts
SELECT abacus_update('many', 'SELECT id, x, y, 0 AS height FROM points WHERE false');
SELECT abacus_update('many', 'SELECT 0, -0.0::float8, 0, h AS height FROM unnest(ARRAY[3, 2, 1]) h');
SELECT attributes[7] FROM abacus_vertices('many') WHERE id = 0;

-- equal points: the one with the id, or else the first
SELECT abacus_create('equal', 3, '{v}');
SELECT abacus_insert('equal', 'VALUES (1, 0, 0, 0, 1), (2, 4, 0, 0, 2), (3, 0, 4, 0, 3), (4, 0, 0, 4, 4), (5, 0, 0, 0, 5), (6, 0, 0, 0, 6)');
SELECT abacus_update('equal', 'SELECT id, 0, 0, 0, id * 10 AS v FROM unnest(ARRAY[6, 1, 9]) id');
SELECT id, vertex, attributes FROM abacus_vertices('equal') ORDER BY id;
-- points that wait, on one line, and points that are inserted first
SELECT abacus_create('line', 2, '{v}');
SELECT abacus_insert('line', 'SELECT i, i, 2 * i, i FROM generate_series(1, 5000) i');
SELECT abacus_update('line', 'SELECT i, i, 2 * i, -i AS v FROM generate_series(1, 5000, 2) i');
SELECT count(*), count(vertex) AS inserted, bool_and(attributes[1] = CASE id % 2 WHEN 0 THEN id ELSE -id END) FROM abacus_vertices('line');
SELECT abacus_stage('line', 'VALUES (0, 1, 0, 7)');
SELECT abacus_update('line', 'SELECT 0, 1, 0, 8 AS v');
SELECT count(vertex), sum(attributes[1]) FILTER (WHERE id = 0) FROM abacus_vertices('line');

-- errors change nothing
SELECT abacus_update('few', 'SELECT id, x, y + (id = 7)::int AS y, 0 AS height FROM points WHERE id < 10');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_update('many', 'SELECT id, x, y + (id = 7)::int AS y, 0 AS height FROM points WHERE id < 10');
SELECT abacus_update('few', 'SELECT id, x, y, 0 AS width FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_update('few', 'SELECT id, x, y, 0 AS height, 1 AS height FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_update('few', 'VALUES (0, 0, 0, 8)');
SELECT abacus_update('few', 'SELECT id, x, y FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_update('few', 'SELECT id, x FROM points');
SELECT abacus_update('few', 'SELECT id, x, y, ''high''::text AS height FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_update('few', 'SELECT id, x, NULL::float8, 1 AS height FROM points');
SELECT abacus_update('few', 'DELETE FROM points RETURNING id, x, y, height');
SELECT abacus_update('pg_class', 'SELECT id, x, y, height FROM points');
SELECT abacus_update('few', NULL);
BEGIN READ ONLY;
SELECT abacus_update('few', 'SELECT id, x, y, 0 AS height FROM points');
COMMIT;
SELECT abacus_create('none', 2), abacus_create('empty', 2, '{v}');
SELECT abacus_update('none', 'SELECT id, x, y, 0 AS height FROM points');
SELECT abacus_update('empty', 'SELECT 1, 2, 3, 4 AS v');
SELECT abacus_load('loaded', 'VALUES (1, 0, 0, 1), (2, 4, 0, 2), (3, 4, 1, 3), (4, 0, 1, 4), (5, 2, 0.1, 5)',
                   'VALUES (1, 2, 5), (2, 3, 5), (3, 4, 5)', '{h}');
SELECT abacus_update('loaded', 'SELECT 1, 0, 0, 2 AS h');
SELECT id, attributes FROM abacus_vertices('loaded') ORDER BY id;
SELECT count(*) FROM wrong WHERE id > 0;
-- a rollback, also to a savepoint
BEGIN;
SAVEPOINT a;
SELECT abacus_update(mesh, 'SELECT id, x, y, 0 AS height FROM points') FROM (VALUES ('few'::regclass), ('many')) m(mesh);
SELECT count(*) > 3000 AS changed FROM wrong;
ROLLBACK TO a;
SELECT count(*) FROM wrong WHERE id > 0;
COMMIT;

-- a table that is followed: an UPDATE of attributes alone touches no simplex page
CREATE TABLE wells AS SELECT id, x, y, 1 AS a, 2 AS b, 3 AS c, 4 AS d, 5 AS e, 6 AS f, height, depth FROM points;
SELECT abacus_create('followed', 2, '{a,b,c,d,e,f,height,depth}');
SELECT abacus_track('followed', 'wells');
CREATE TABLE followed_pages AS SELECT code, part, md5(page::bytea) AS page FROM followed WHERE code >= 0;
CREATE VIEW astray AS SELECT id FROM abacus_vertices('followed') v FULL JOIN wells w USING (id) WHERE v.attributes IS DISTINCT FROM ARRAY[a, b, c, d, e, f, height, depth]::float8[] OR v.x <> w.x OR v.y <> w.y;
UPDATE wells SET height = NULL, c = id WHERE id % 5 = 0;
SELECT * FROM astray;
SELECT code, part, md5(page::bytea) AS page FROM followed WHERE code >= 0 EXCEPT TABLE followed_pages;
-- with places and ids that change in the same statement, and equal points
UPDATE wells SET b = -id, x = CASE id % 7 WHEN 0 THEN x + 0.25 ELSE x END, id = CASE id % 11 WHEN 0 THEN id + 10000 ELSE id END;
SELECT * FROM astray;
INSERT INTO wells SELECT id + 20000, x, y, 1, 1, 1, 1, 1, 1, 1, 1 FROM wells WHERE id % 100 = 0;
UPDATE wells SET c = c + 1;
SELECT * FROM astray;
DELETE FROM wells WHERE id >= 20000;
UPDATE wells SET c = c + 1;
SELECT * FROM astray;
SELECT * FROM abacus_check('followed');
-- rows that agree in all but attributes, or in these, too; points that wait
CREATE TABLE twins (id int, x float8, y float8, v numeric, w float4);
SELECT abacus_create('twin_mesh', 2, '{v,w}');
SELECT abacus_track('twin_mesh', 'twins');
INSERT INTO twins SELECT 7, 0, 0, i / 2, 0 FROM generate_series(0, 9) i;
UPDATE twins SET v = v + 1;
CREATE VIEW twin_rows AS SELECT id, x, y, NULLIF(v, 'NaN')::float8 AS v, NULLIF(w, 'NaN')::float8 AS w FROM twins;
CREATE VIEW twin_points AS SELECT id, x, y, attributes[1] AS v, attributes[2] AS w FROM abacus_vertices('twin_mesh');
CREATE VIEW twins_astray AS (TABLE twin_rows EXCEPT ALL TABLE twin_points) UNION ALL (TABLE twin_points EXCEPT ALL TABLE twin_rows);
SELECT * FROM twins_astray;
INSERT INTO twins VALUES (1, 4, 0, 1, 1), (2, 0, 4, 2, 'NaN'), (7, 4, 4, NULL, '-0');
UPDATE twins SET v = CASE WHEN v > 3 THEN v - 1 ELSE v + 1 END, w = 0;
UPDATE twins SET w = 'NaN' WHERE id <> 7 OR v % 2 = 0;
UPDATE twins SET w = NULL WHERE v > 3;
SELECT * FROM twins_astray;
UPDATE twins SET v = w, w = v;
SELECT * FROM twins_astray;
-- and an AFTER trigger that changes its own rows, which cannot be followed
CREATE FUNCTION again() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN UPDATE regress_update.twins SET v = 100 WHERE id = 1 AND v <> 100; RETURN NULL; END $$;
CREATE TRIGGER aaa AFTER UPDATE ON twins FOR EACH ROW EXECUTE FUNCTION again();
UPDATE twins SET v = 50 WHERE id = 1;
\echo :LAST_ERROR_SQLSTATE
DROP TRIGGER aaa ON twins;
SELECT * FROM twins_astray;
SELECT * FROM abacus_check('twin_mesh');
-- a mesh that is not in step says so
ALTER TABLE wells DISABLE TRIGGER USER;
UPDATE wells SET c = c + 1 WHERE id = 9;
ALTER TABLE wells ENABLE TRIGGER USER;
UPDATE wells SET c = c + 1 WHERE id BETWEEN 8 AND 10;
\echo :LAST_ERROR_SQLSTATE
\set VERBOSITY terse
SET client_min_messages = warning;
DROP SCHEMA regress_update CASCADE;

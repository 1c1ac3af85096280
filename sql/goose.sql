-- abacus_goose: the same simplices as abacus_triangulate, from an R-tree.

CREATE EXTENSION abacus_lab;
CREATE SCHEMA goose;
SET search_path = goose, public;
CREATE FUNCTION counts(mesh text, query text, dimension integer DEFAULT 2)
RETURNS TABLE (name text, value float8) LANGUAGE sql AS $$
    SELECT name, value FROM abacus_goose(mesh, query, dimension)
    WHERE name IN ('vertices', 'duplicates', 'simplices', 'hull_facets') $$;

-- A square and its centre.
CREATE TABLE site (id int, x float8, y float8);
INSERT INTO site VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4), (5, 2, 2), (6, 4, 4);
SELECT * FROM counts('square', 'TABLE site ORDER BY id');
SELECT v0, v1, v2, x0, y0, x1, y1, x2, y2 FROM square ORDER BY v0, v1;
SELECT count(*) FROM square WHERE box && '(1,2),(1,2)';
SELECT count(*) AS figures, bool_and(value >= 0) AS sound, count(description) AS described
FROM abacus_goose('square_again', 'TABLE site');

-- In space with the type of an extension.
SELECT abacus_goose('cube', 'SELECT id, x, y, 0 FROM site', dimension => 3);
CREATE SCHEMA elsewhere;
CREATE EXTENSION cube SCHEMA elsewhere;
SELECT * FROM counts('ions', $$
    SELECT 100 * x + 10 * y + z, x, y, z
    FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y, generate_series(0, 3) AS z $$, 3);
SELECT attname, format_type(atttypid, atttypmod) FROM pg_attribute
WHERE attrelid = 'ions'::regclass AND attnum > 0 ORDER BY attnum;

-- Compared with abacus_triangulate: simplices that only one of the two has.
CREATE FUNCTION differences(query text, dimension integer DEFAULT 2)
RETURNS TABLE (simplices bigint, differing bigint) LANGUAGE plpgsql AS $$
BEGIN
    DROP TABLE IF EXISTS goose, abacus;
    PERFORM abacus_goose('goose', query, dimension);
    PERFORM abacus_triangulate('abacus', query, dimension => dimension);
    IF dimension = 2 THEN ALTER TABLE goose ADD v3 bigint; END IF;
    RETURN QUERY
    SELECT (SELECT count(*) FROM abacus_simplices('abacus')), count(*)
    FROM (SELECT v0, v1, v2, v3 FROM goose) AS g
         FULL JOIN abacus_simplices('abacus') AS a
         ON (a.v0, a.v1, a.v2) = (g.v0, g.v1, g.v2) AND a.v3 IS NOT DISTINCT FROM g.v3
    WHERE a.v0 IS NULL OR g.v0 IS NULL;
END $$;
SET client_min_messages = warning;
-- scattered; a grid, with every point twice; a circle around its centre
SELECT * FROM differences('SELECT i, i * 0.7548776662466927 % 1, i * 0.5698402909980532 % 1 FROM generate_series(1, 3000) AS i');
SELECT * FROM differences('SELECT i, i % 20, i / 20 % 20 FROM generate_series(0, 799) AS i');
SELECT * FROM differences('SELECT 0, 0, 0 UNION ALL SELECT i, cos(i), sin(i) FROM generate_series(1, 100) AS i');
SELECT * FROM differences('SELECT i, x, y FROM (VALUES (1, 25, 0), (2, 24, 7), (3, 20, 15), (4, 15, 20), (5, 7, 24), (6, 0, 25), (7, -7, 24), (8, -25, 0), (9, -15, -20), (10, 0, -25)) AS p (i, x, y)');
-- all on a line; all but one
SELECT * FROM differences('SELECT i, i, 3 * i FROM generate_series(1, 100) AS i');
SELECT * FROM differences('SELECT i, i, CASE i WHEN 70 THEN 1 ELSE 3 * i END FROM generate_series(1, 100) AS i');
-- far below and beyond the sizes that boxes can have
SELECT * FROM differences('SELECT i, i * 0.75487766 % 1 * 1e-12, i * 0.56984029 % 1 * 1e-12 FROM generate_series(1, 500) AS i');
SELECT * FROM differences('SELECT i, (i * 0.75487766 % 1) * 1e308, (i * 0.56984029 % 1) * -1e308 FROM generate_series(1, 200) AS i');
SELECT * FROM differences('SELECT i, power(10::float8, i % 17 * 30 - 240), -power(10::float8, i % 19 * 30 - 270) FROM generate_series(1, 300) AS i');
-- in space: scattered; a grid; a plane; a plane and a point
SELECT * FROM differences('SELECT i, i * 0.8191725133961645 % 1, i * 0.6710436067037893 % 1, i * 0.5497004779019703 % 1 FROM generate_series(1, 500) AS i', 3);
SELECT * FROM differences('SELECT i, i % 5, i / 5 % 5, i / 25 FROM generate_series(0, 124) AS i', 3);
SELECT * FROM differences('SELECT i, i % 5, i / 5, i % 5 + i / 5 FROM generate_series(0, 24) AS i', 3);
SELECT * FROM differences('SELECT i, i % 5, i / 5, CASE i WHEN 12 THEN 1 ELSE 0 END FROM generate_series(0, 24) AS i', 3);
SELECT * FROM differences('SELECT 1, 0, 0 WHERE false');
RESET client_min_messages;

-- Deleted rows have left the index, or it would be three times as large as one of the rows there are.
SELECT count(*) AS figures FROM abacus_goose('scattered', 'SELECT i, i * 0.7548776662466927 % 1, i * 0.5698402909980532 % 1 FROM generate_series(1, 3000) AS i');
CREATE INDEX fresh ON scattered USING gist (box);
SELECT pg_relation_size('scattered_box_idx') < 1.8 * pg_relation_size('fresh') AS is_kept_small;

-- Errors.
SELECT abacus_goose('square', 'TABLE site');
SELECT abacus_goose('wrong', 'TABLE site', 4);
SELECT abacus_goose('wrong', 'SELECT id, x FROM site');
SELECT abacus_goose('wrong', 'SELECT id, x, y, 1 FROM site');
SELECT abacus_goose('wrong', $$ SELECT 1, 'NaN'::float8, 0 $$);
SELECT abacus_goose('wrong', 'DELETE FROM site');
SELECT abacus_goose(NULL, 'TABLE site');
SELECT abacus_goose('nowhere.wrong', 'TABLE site');
BEGIN READ ONLY;
SELECT abacus_goose('wrong', 'TABLE site');
ROLLBACK;
BEGIN;
SELECT count(*) AS figures FROM abacus_goose('passing', 'TABLE site');
SAVEPOINT s;
SELECT count(*) AS figures FROM abacus_goose('wrong', 'TABLE site');
ROLLBACK TO s;
SELECT count(*) FROM passing;
COMMIT;
SELECT to_regclass('wrong') IS NULL AS nothing_left, count(*) FROM passing;

-- A publication of all tables asks no replica identity of it.
SET client_min_messages = error;
CREATE PUBLICATION all_tables FOR ALL TABLES;
RESET client_min_messages;
SELECT count(*) AS figures FROM abacus_goose('published', 'TABLE site');
SELECT count(*) FROM published;
DROP PUBLICATION all_tables;

-- A cancel is served at once, and leaves nothing behind.
\set VERBOSITY terse
SET statement_timeout = '300ms';
SELECT abacus_goose('wrong', 'SELECT i, i % 1000, i / 1000 FROM generate_series(1, 1000000) AS i');
SELECT abacus_goose('wrong', 'SELECT i, i * 0.75487766 % 1, i * 0.56984029 % 1 FROM generate_series(1, 20000) AS i');
RESET statement_timeout;
\set VERBOSITY default
SELECT to_regclass('wrong') IS NULL AS nothing_left;

-- Users who may create a table and read the points may call it.
CREATE ROLE regress_goose_user;
CREATE SCHEMA pond;
SET ROLE regress_goose_user;
SELECT abacus_goose('pond.wrong', 'VALUES (1, 0, 0)');
RESET ROLE;
GRANT CREATE, USAGE ON SCHEMA pond TO regress_goose_user;
SET ROLE regress_goose_user;
SELECT abacus_goose('pond.wrong', 'SELECT * FROM pg_authid');
SELECT count(*) AS figures FROM abacus_goose('pond.own', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
RESET ROLE;
SELECT tableowner FROM pg_tables WHERE tablename = 'own';

SET client_min_messages = warning;
DROP SCHEMA pond, goose, elsewhere CASCADE;
DROP EXTENSION abacus_lab;
DROP ROLE regress_goose_user;

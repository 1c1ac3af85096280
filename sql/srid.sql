-- The spatial reference system of a mesh: a number in its header.
CREATE SCHEMA regress_srid;
SET search_path = regress_srid, public;
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 5), (2, 10, 0, 7), (3, 0, 10, 9)', '{height}');
SELECT abacus_srid('field');
SELECT count(*) FROM abacus_stats('field') WHERE name = 'srid';
SELECT length(page::bytea) AS before FROM field WHERE (code, part) = (-1, 0) \gset
SELECT abacus_set_srid('field', 2154);
SELECT abacus_srid('field');
SELECT name, value, description FROM abacus_stats('field') WHERE name = 'srid';
SELECT length(page::bytea) - :before AS longer FROM field WHERE (code, part) = (-1, 0);

-- every change keeps it
SELECT abacus_insert('field', 'VALUES (4, 9, 9, 1)');
SELECT abacus_delete('field', 'VALUES (3, 0, 10)');
SELECT abacus_stage('field', 'VALUES (5, 3, 8, 1), (6, 4, 20, 2)');
SELECT abacus_triangulate('field');
SELECT abacus_stage('field', 'VALUES (7, 30, 80, 1)');
CALL abacus_build('field');
SELECT abacus_rename_attribute('field', 'height', 'h');
SELECT abacus_srid('field');
SELECT * FROM abacus_check('field');
CREATE TABLE wells (id int, x float8, y float8, h float8);
SELECT abacus_track('field', 'wells', synchronize => true);
INSERT INTO wells VALUES (1, 1, 1, 1), (2, 5, 1, 1), (3, 5, 5, 1);
TRUNCATE wells;
SELECT abacus_srid('field');
SELECT abacus_untrack('field', 'wells');
BEGIN;
SELECT abacus_set_srid('field', 4326);
SELECT abacus_srid('field');
ROLLBACK;
SELECT abacus_srid('field');
-- a mesh without points, one in space and one that is not Delaunay may have one
SELECT abacus_create('space', 3);
SELECT abacus_set_srid('space', 999999);
SELECT abacus_load('loaded', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 1), (4, 0, 1), (5, 2, 0.1)',
                   'VALUES (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)');
SELECT abacus_set_srid('loaded', 25832);
SELECT abacus_srid('space'), abacus_srid('loaded');
-- 0 takes it away
SELECT abacus_set_srid('field', 0);
SELECT abacus_srid('field');
SELECT length(page::bytea) - :before AS longer FROM field WHERE (code, part) = (-1, 0);

SELECT abacus_set_srid('field', -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_set_srid('field', 1000000);
SELECT abacus_set_srid('field', NULL);
SELECT abacus_srid(NULL);
SELECT abacus_srid('wells');
\echo :LAST_ERROR_SQLSTATE
BEGIN READ ONLY;
SELECT abacus_set_srid('field', 1);
COMMIT;
-- users who may change the mesh may set it; users who may read it may ask
CREATE ROLE regress_srid_user;
GRANT USAGE ON SCHEMA regress_srid TO regress_srid_user;
SET ROLE regress_srid_user;
SELECT abacus_srid('field');
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;
GRANT SELECT ON field, field_vertices TO regress_srid_user;
SET ROLE regress_srid_user;
SELECT abacus_srid('field');
SELECT abacus_set_srid('field', 1);
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;

-- a number out of range in the header
CREATE TABLE stored AS SELECT page::bytea AS bytes FROM loaded WHERE (code, part) = (-1, 0);
UPDATE loaded SET page = set_byte(bytes, length(bytes) - 5, 1)::abacus_page FROM stored WHERE (code, part) = (-1, 0);
SELECT abacus_srid('loaded');
\echo :LAST_ERROR_SQLSTATE

DROP OWNED BY regress_srid_user;
DROP ROLE regress_srid_user;
DROP TABLE field, space, loaded;
DROP SCHEMA regress_srid CASCADE;
-- in degrees: said once a statement of what is no use then, and of windows in other units
SELECT abacus_triangulate('globe', 'SELECT 10 * x + y, 7 + x / 100.0, 47 + y / 100.0, 100 * x AS height FROM generate_series(0, 9) x, generate_series(0, 9) y');
SELECT abacus_triangulate('metres', 'SELECT 10 * x + y, 400000 + x * 100, 5200000 + y * 100, 100 * x AS height FROM generate_series(0, 9) x, generate_series(0, 9) y');
SELECT count(s.slope) FROM generate_series(1, 5) i, abacus_slope('globe', 7.01, 47 + i / 100.0) s;
SELECT abacus_set_srid('globe', 4326);
SELECT count(s.slope) FROM generate_series(1, 5) i, abacus_slope('globe', 7.01, 47 + i / 100.0) s;
SELECT array_length(abacus_gradient('globe', 7.01, 47.015), 1);
SELECT cut > 0 AS cut FROM abacus_volume('globe', 100);
SELECT net = 0 AS none FROM abacus_volume('globe', 'globe');
SELECT length(abacus_draw('globe', 40, attribute => 'height', exaggeration => 1)) > 0 AS drawn;
SELECT length(abacus_draw('globe', 40, attribute => 'height', exaggeration => 9e-6)) > 0 AS drawn;
SELECT count(*) FROM abacus_cells('globe', '{7.01,47.01}', '{7.02,47.02}');
SELECT count(*) FROM abacus_cells('globe', '{400000,5200000}', '{400100,5200100}');
SELECT count(*) FROM generate_series(1, 3) i, abacus_vertices('metres', ARRAY[7, 47], ARRAY[7 + i, 48]);
SELECT area FROM abacus_volume('metres', 0, lower => '{7,47}', upper => '{8,48}');
SELECT count(*) FROM abacus_edges('metres', '{7.5,47}', 0.5);
SELECT count("values") FROM abacus_raster('metres', '{7,47}', '{8,48}', 2, 2);
SELECT count(*) FROM abacus_contours('metres', lower => '{7,47}', upper => '{8,48}');
SELECT count(*) FROM abacus_cells('metres', '{500000,5200000}', '{500100,5200100}');
SELECT count(*) FROM abacus_cells('metres', '{400000,5200000}', '{400100,5200100}');
DROP TABLE globe, metres;

-- Geometries of PostGIS: what errors say. test/pgtap/postgis.sql has the results. Without PostGIS there is
-- nothing to test.
SELECT NOT EXISTS (SELECT FROM pg_available_extensions WHERE name = 'postgis') AS absent \gset
\if :absent
\quit
\endif
SET client_min_messages = warning;
CREATE SCHEMA regress_postgis;
SET search_path = regress_postgis, public;
CREATE EXTENSION postgis;
CREATE EXTENSION abacus_postgis;
CREATE TABLE sites (id int, geom geometry, height float8);
INSERT INTO sites VALUES (1, 'SRID=2154;POINT(0 0)', 1), (2, 'SRID=2154;POINT(40 0)', 2), (3, 'SRID=2154;POINT(0 30)', 3), (4, 'SRID=2154;POINT(40 30)', NULL);
SELECT abacus_triangulate('terrain', 'TABLE sites');
SELECT abacus_triangulate('plain', 'SELECT id, ST_X(geom), ST_Y(geom) FROM sites');
SELECT abacus_triangulate('rock', 'VALUES (1, 0, 0, 0), (2, 9, 0, 0), (3, 0, 9, 0), (4, 0, 0, 9)', dimension => 3);

-- sources
SELECT abacus_insert('terrain', $$ VALUES (5, 'SRID=2154;POINT(1 1)'::geometry, 5), (6, 'SRID=4326;POINT(1 1)', 6) $$);
SELECT abacus_insert('terrain', $$ VALUES (5, 'POINT(1 1)'::geometry, 5) $$);
SELECT abacus_delete('plain', $$ VALUES (5, 'SRID=2154;POINT(1 1)'::geometry) $$);
SELECT abacus_triangulate('mixed', $$ VALUES (5, 'SRID=2154;POINT(1 1)'::geometry), (6, 'SRID=4326;POINT(1 1)') $$);
SELECT abacus_insert('terrain', $$ VALUES (5, 'SRID=2154;POINT EMPTY'::geometry, 5) $$);
SELECT abacus_insert('terrain', $$ VALUES (5, NULL::geometry, 5) $$);
SELECT abacus_insert('terrain', $$ VALUES (5, 'SRID=2154;MULTIPOINT(1 1, 2 2)'::geometry, 5) $$);
SELECT abacus_insert('terrain', $$ VALUES (5, 'SRID=2154;COMPOUNDCURVE(CIRCULARSTRING(0 0, 1 1, 1 0), (1 0, 0 1))'::geometry, 5) $$);
SELECT abacus_insert('rock', $$ VALUES (5, 'POINT(1 1)'::geometry) $$);
SELECT abacus_insert('terrain', 'SELECT 5, 1, geom FROM sites');
SELECT abacus_insert('terrain', 'SELECT geom, 5 FROM sites');
SELECT abacus_insert('terrain', 'SELECT 5, geom::geography, 5, 5 FROM sites');
SELECT abacus_triangulate('mixed', 'SELECT 5, geom, height, height FROM sites');

-- places
SELECT abacus_locate('terrain', 'SRID=4326;POINT(1 1)'::geometry);
SELECT abacus_locate('terrain', 'POINT(1 1)'::geometry);
SELECT abacus_locate('plain', 'SRID=4326;POINT(1 1)'::geometry);
SELECT abacus_interpolate('terrain', 'SRID=2154;MULTIPOINT(1 1)'::geometry);
SELECT abacus_interpolate('terrain', 'SRID=2154;CURVEPOLYGON(CIRCULARSTRING(0 0, 4 0, 4 4, 0 4, 0 0))'::geometry);
SELECT abacus_interpolate('terrain', 'SRID=2154;POINT(1 1)');
SELECT abacus_nearest('rock', 'POINT(1 1)'::geometry);
SELECT abacus_visible('terrain', 'SRID=2154;POINT(1 1)'::geometry, 'SRID=4326;POINT(2 2)'::geometry);

-- windows, areas, lines
SELECT * FROM abacus_cells_geom('terrain', 'SRID=4326;POINT(1 1)');
SELECT * FROM abacus_contours_geom('terrain', 1, bounds => 'POINT(1 1)');
SELECT * FROM abacus_contours_geom('rock', 1);
SELECT * FROM abacus_clip('terrain', 'SRID=2154;CURVEPOLYGON(CIRCULARSTRING(0 0, 4 0, 4 4, 0 4, 0 0))');
SELECT * FROM abacus_clip('rock', 'POLYGON((0 0, 1 0, 0 1, 0 0))');
SELECT * FROM abacus_profile_geom('rock', 'LINESTRING(0 0, 1 1)');
SELECT * FROM abacus_profile_geom('terrain', 'SRID=2154;POINT(1 1)');
SELECT * FROM abacus_drape('terrain', 'SRID=2154;TIN(((0 0 0, 0 1 0, 1 1 0, 0 0 0)))');
SELECT * FROM abacus_drape('terrain', 'SRID=2154;POINT(1 1)', 'depth');
SELECT * FROM abacus_drape('terrain', 'SRID=2154;POINT(1 1)', outside => 'zero');

-- where a height is missing
SELECT v0, v1, v2, geom IS NULL AS no_surface FROM abacus_cells_geom('terrain', attribute => 'height') ORDER BY v0, v1, v2;
SELECT v0, v1, v2, whole, geom IS NULL AS no_surface FROM abacus_clip('terrain', 'SRID=2154;POLYGON((1 1, 39 1, 39 29, 1 29, 1 1))', 'height') ORDER BY v0, v1, v2;
SELECT ST_AsText(abacus_drape('terrain', 'SRID=2154;LINESTRING(10 10, 39 29)', densify => true), 3);

-- a z that no attribute takes
CREATE TABLE lidar (id int, geom geometry(PointZ));
INSERT INTO lidar VALUES (1, 'POINT Z (0 0 5)'), (2, 'POINT Z (9 0 6)'), (3, 'POINT Z (0 9 7)'), (4, 'POINT Z (8 9 7)');
SET client_min_messages = notice;
SELECT abacus_triangulate('left_out', 'SELECT id, geom FROM lidar');
SELECT abacus_delete('left_out', 'SELECT id, geom FROM lidar WHERE id = 4');
SELECT abacus_triangulate('kept', 'SELECT id, geom, ST_Z(geom) AS z FROM lidar');
SELECT abacus_triangulate('tetrahedron', 'SELECT id, geom FROM (SELECT id, ST_Translate(geom, 0, 0, id * id)::geometry(PointZ) AS geom FROM lidar) AS moved', dimension => 3);
SET client_min_messages = warning;

DROP TABLE terrain, plain, rock, sites, lidar, left_out, kept, tetrahedron;
DROP EXTENSION abacus_postgis, postgis;
DROP SCHEMA regress_postgis CASCADE;

-- Levels of detail beside a mesh.
CREATE TABLE detail_ground AS
SELECT 100 * x + y AS id, 1000.0 * x AS x, 1000.0 * y AS y, 300 * sin(x / 15.0) * cos(y / 20.0) + 0.03 * x * y AS height, x - y::float8 AS other
FROM generate_series(0, 60) AS x, generate_series(0, 60) AS y;
SELECT abacus_triangulate('detail', 'SELECT id, x, y, height, other FROM detail_ground');
SELECT abacus_set_srid('detail', 3857);
CREATE FUNCTION ids(mesh regclass) RETURNS bigint[] LANGUAGE sql AS 'SELECT array_agg(id ORDER BY id) FROM abacus_vertices(mesh)';
SELECT level, level_mesh, error <= CASE level WHEN 1 THEN 3 WHEN 2 THEN 8 ELSE 30 END AS is_within, vertices
FROM abacus_levels('detail', '{3,8,30}', 'height');
SELECT level, mesh, attribute, max_error, greatest <= max_error AS is_within,
       stamp = (SELECT stamp FROM detail_level_1_thinning) AS same_state FROM detail_levels;
SELECT * FROM abacus_check('detail_level_2');
-- each is what abacus_thin makes of the full mesh, and its error is against that
SELECT abacus_thin('detail', 'detail_thin', 8, 'height') = (SELECT greatest FROM detail_levels WHERE level = 2) AS same_error;
SELECT ids('detail_thin') = ids('detail_level_2') AS same;
DROP TABLE detail_thin;
SELECT (SELECT max(abs(height - "values"[1])) FROM detail_ground JOIN abacus_interpolate('detail_level_3', 'SELECT id, x, y FROM detail_ground', '{height}') USING (id)) <= 30 AS is_within;

-- which level is fine enough
SELECT max_error, abacus_level('detail', max_error)
FROM unnest('{0,3,8,30,Infinity}'::float8[]) AS errors (max_error);
-- the error that it has counts, not the one that was allowed
SELECT level, abacus_level('detail', greatest) AS at_most, greatest < max_error AS is_less FROM detail_levels;
CREATE FUNCTION same(a bytea, b bytea) RETURNS boolean LANGUAGE sql AS 'SELECT a = b';
SELECT same(abacus_draw('detail', 90, attribute => 'height', max_error => 8), abacus_draw('detail_level_2', 90, attribute => 'height')) AS is_level,
       same(abacus_draw('detail', 90, attribute => 'height', max_error => 1), abacus_draw('detail', 90, attribute => 'height')) AS is_full,
       same(abacus_draw('detail', 90, max_error => 1e9), abacus_draw('detail_level_3', 90)) AS is_coarsest;
SELECT (SELECT count(*) FROM abacus_contours('detail', 50, attribute => 'height', max_error => 8)) AS lines,
       (SELECT array_agg(c::text) FROM abacus_contours('detail', 50, attribute => 'height', max_error => 8) AS c)
     = (SELECT array_agg(c::text) FROM abacus_contours('detail_level_2', 50, attribute => 'height') AS c) AS is_level;
-- a tile: the same error at all zooms, or one in pixels on the ground at its centre
SELECT same(abacus_tile_picture('detail', 9, 256, 255, attribute => 'height', range => '{0,400}', max_error => 8), abacus_tile_picture('detail_level_2', 9, 256, 255, attribute => 'height', range => '{0,400}')) AS picture,
       same(abacus_tile_vector('detail', 9, 256, 255, attribute => 'height', max_error => 8), abacus_tile_vector('detail_level_2', 9, 256, 255, attribute => 'height')) AS vector,
       same(abacus_tile_terrain('detail', 9, 256, 255, attribute => 'height', max_error => 8), abacus_tile_terrain('detail_level_2', 9, 256, 255, attribute => 'height')) AS terrain;
SELECT z, round(40075016.68 / 256 / 2 ^ z) AS pixel, abacus_level('detail', 40075016.68 / 256 / 2 ^ z),
       abacus_tile_terrain('detail', z, t, t - 1, attribute => 'height', pixel_error => 1)
     = abacus_tile_terrain(abacus_level('detail', 40075016.68 / 256 / 2 ^ z / cosh(pi() / 2 ^ z)), z, t, t - 1, attribute => 'height') AS same
FROM generate_series(9, 17) AS z, LATERAL (SELECT (2 ^ (z - 1))::int) AS tile (t);
SELECT size, same(abacus_tile_picture('detail', 14, 8192, 8191, size => size, pixel_error => 1), abacus_tile_picture('detail_level_1', 14, 8192, 8191, size => size)) AS is_level_1,
       same(abacus_tile_picture('detail', 14, 8192, 8191, size => size, pixel_error => 1), abacus_tile_picture('detail_level_2', 14, 8192, 8191, size => size)) AS is_level_2
FROM (VALUES (256), (512)) AS sizes (size);
SELECT same(abacus_tile_vector('detail', 6, 0, 63, world => '{0,0,65536}', attribute => 'height', pixel_error => 1), abacus_tile_vector('detail_level_1', 6, 0, 63, world => '{0,0,65536}', attribute => 'height')) AS own_world;
-- where the map is enlarged, a pixel is smaller on the ground
SELECT abacus_triangulate('north', $$SELECT id, 10 + x / 10000, 60 + y / 20000, height FROM detail_ground$$, '{height}');
SELECT abacus_set_srid('north', 4326);
SELECT count(*) FROM abacus_levels('north', '{50}');
SELECT same(abacus_tile_vector('north', z, x, y, pixel_error => 1), abacus_tile_vector('north_level_1', z, x, y)) AS is_level,
       same(abacus_tile_vector('north', z, x, y, pixel_error => 2), abacus_tile_vector('north_level_1', z, x, y)) AS is_level_of_two
FROM (SELECT 11 AS z, 1087 AS x, 565 AS y) AS tile;
DROP TABLE north;
SELECT count(*) FROM abacus_tiles('detail', attribute => 'height', pixel_error => 1);
SELECT same((SELECT tile FROM detail_terrain(14, 8192, 8191)), abacus_tile_terrain('detail_level_2', 14, 8192, 8191, attribute => 'height', fill => (SELECT least FROM abacus_attributes('detail') WHERE name = 'height'))) AS by_martin;

-- tables of their cells
SELECT abacus_publish('detail', geometry => false);
SELECT (SELECT count(*) FROM detail_cells_3) = (SELECT count(*) FROM abacus_simplices('detail_level_3')) AS published;

-- a mesh that has changed
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
CREATE TEMP TABLE tags AS SELECT abacus_tile_etag('detail') AS tag;
SELECT abacus_constrain('detail', 'VALUES (1, 1, 1010), (1, 2, 5040), (1, 3, 2020), (2, 1, 301), (2, 2, 305)');
SELECT abacus_delete('detail', 'SELECT id, x, y FROM detail_ground WHERE id % 100 = 60');
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
INSERT INTO tags SELECT abacus_tile_etag('detail');
-- those of a level by hand go
SELECT abacus_insert('detail_level_2', 'SELECT id, x, y, height, other FROM detail_ground WHERE id = 3030');
GRANT SELECT ON detail_level_2 TO PUBLIC;
SELECT level, level_mesh FROM abacus_levels_refresh('detail');
INSERT INTO tags SELECT abacus_tile_etag('detail');
SELECT count(DISTINCT tag) FROM tags;
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
SELECT has_table_privilege('public', 'detail_level_2', 'SELECT') AS still_granted;
SELECT (SELECT count(*) FROM detail_cells_3) = (SELECT count(*) FROM abacus_simplices('detail_level_3')) AS still_published;
SELECT * FROM abacus_check('detail_level_2');
SELECT abacus_thin('detail', 'detail_thin', 8, 'height') = (SELECT greatest FROM detail_levels WHERE level = 2) AS same_error;
SELECT ids('detail_thin') = ids('detail_level_2') AS same,
       (SELECT array_agg(l ORDER BY line, position) FROM abacus_lines('detail_thin') AS l) = (SELECT array_agg(l ORDER BY line, position) FROM abacus_lines('detail_level_2') AS l) AS same_lines;
DROP TABLE detail_thin;
-- a level is a mesh like any other
SELECT abacus_insert('detail_level_3', 'SELECT id, x, y, height, other FROM detail_ground WHERE id = 3031');
SELECT abacus_unconstrain('detail', 'VALUES (1), (2)');
SELECT count(*) FROM abacus_levels_refresh('detail');
SELECT count(*) FROM abacus_lines('detail_level_3');
SELECT relname FROM pg_class WHERE relname LIKE 'abacus_fresh%';
BEGIN;
SELECT count(*) FROM abacus_levels_refresh('detail');
SELECT abacus_delete('detail', 'SELECT id, x, y FROM detail_ground WHERE id < 1000');
SELECT count(*) FROM abacus_levels_refresh('detail');
ROLLBACK;
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';

-- names may change
ALTER TABLE detail_level_1 RENAME TO detail_finest;
ALTER TABLE detail_levels RENAME TO pyramid;
ALTER TABLE detail RENAME TO relief;
SELECT level, level_mesh FROM abacus_levels_refresh('relief');
ALTER TABLE relief RENAME TO detail;

-- errors
SELECT abacus_levels('detail', '{1}', 'height');
SELECT abacus_levels(NULL, '{1}');
SELECT abacus_level('detail', -1), abacus_level('detail', 'NaN');
SELECT abacus_draw('detail', max_error => -1);
SELECT abacus_draw('detail', attribute => 'other', max_error => 8);
SELECT abacus_draw('detail', within => 'forest', max_error => 8);
SELECT abacus_draw('detail', regions => true, max_error => 8);
SELECT abacus_tile_terrain('detail', 9, 256, 255, attribute => 'height', max_error => 8, pixel_error => 1);
SELECT abacus_tile_terrain('detail', 9, 256, 255, attribute => 'height', pixel_error => 'NaN');
SELECT abacus_levels_drop('detail');
SELECT count(*) FROM pg_class WHERE relname LIKE 'detail_%level%' OR relname IN ('detail_finest', 'pyramid', 'detail_cells_2');
SELECT abacus_draw('detail', max_error => 8);
SELECT abacus_tile_vector('detail', 9, 256, 255, attribute => 'height', pixel_error => 1);
SELECT abacus_contours('detail', attribute => 'height', max_error => 8);
SELECT abacus_level('detail', 8);
SELECT abacus_levels_refresh('detail');
SELECT abacus_levels_drop('detail');
SELECT abacus_levels('detail', NULL);
SELECT abacus_levels('detail', '{}', 'height');
SELECT abacus_levels('detail', '{1,NULL}', 'height');
SELECT abacus_levels('detail', '{1,NaN}', 'height');
SELECT abacus_levels('detail', '{-1,2}', 'height');
SELECT abacus_levels('detail', '{1,Infinity}', 'height');
SELECT abacus_levels('detail', '{1,1}', 'height');
SELECT abacus_levels('detail', '{{1,2}}', 'height');
SELECT abacus_levels('detail', '{1}');
SELECT abacus_levels('detail', '{1}', 'pepper');
SELECT abacus_levels('detail_ground', '{1}');
CREATE TABLE detail_level_2 ();
SELECT abacus_levels('detail', '{1,2}', 'height');
DROP TABLE detail_level_2;
SELECT count(*) FROM pg_class WHERE relname LIKE 'detail_%level%';
-- a level that was dropped
SELECT count(*) FROM abacus_levels('detail', '{1,8}', 'height');
DROP TABLE detail_level_2;
SELECT abacus_draw('detail', max_error => 8);
SELECT abacus_levels_refresh('detail');
SELECT abacus_levels_drop('detail');
-- a table of levels that was changed by hand: all levels are found
SELECT count(*) FROM abacus_levels('detail', '{1,8,20}', 'height');
DELETE FROM detail_levels WHERE level = 2;
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
SELECT abacus_levels_refresh('detail');
SELECT abacus_levels_drop('detail');
SELECT count(*) FROM pg_class WHERE relname LIKE 'detail_level%';
SELECT count(*) FROM abacus_levels('detail', '{1,8}', 'height');
CREATE TABLE bystander_points AS SELECT * FROM detail_ground WHERE id < 500;
SELECT count(*) FROM abacus_triangulate('bystander', 'TABLE bystander_points');
UPDATE detail_levels SET mesh = 'bystander' WHERE level = 2;
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
SELECT abacus_levels_refresh('detail');
SELECT abacus_levels_drop('detail');
SELECT count(*) > 0 AS is_there FROM abacus_vertices('bystander');
DROP TABLE bystander, bystander_points;
SELECT count(*) FROM abacus_levels('detail', '{1,8}', 'height');
DROP TABLE detail_levels;
SELECT name, value FROM abacus_stats('detail') WHERE name LIKE 'levels%';
SELECT abacus_levels('detail', '{1,8}', 'height');
SELECT abacus_levels_refresh('detail');
SELECT abacus_levels_drop('detail');
SELECT count(*) FROM pg_class WHERE relname LIKE 'detail_level%';
SELECT abacus_levels_drop('detail');
-- temporary tables of the session with the names of those of a refresh
SELECT count(*) FROM abacus_levels('detail', '{1,8}', 'height');
CREATE TEMPORARY TABLE abacus_fresh_0_level_1 ();
CREATE TEMPORARY TABLE abacus_fresh_1_level_2_vertices ();
SELECT count(*) FROM abacus_levels_refresh('detail');
DROP TABLE abacus_fresh_0_level_1, abacus_fresh_1_level_2_vertices;
-- what a transaction refuses is named by the function that was called
BEGIN READ ONLY;
SELECT abacus_levels('detail', '{1}', 'height');
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_levels_refresh('detail');
ROLLBACK;
BEGIN READ ONLY;
SELECT abacus_levels_drop('detail');
ROLLBACK;
BEGIN;
SELECT count(*) FROM abacus_levels_refresh('detail');
PREPARE TRANSACTION 'refreshed';
-- a role that may not read what is needed
CREATE ROLE regress_abacus_level;
GRANT SELECT ON detail, detail_vertices TO regress_abacus_level;
SET ROLE regress_abacus_level;
SELECT abacus_level('detail', 8);
SELECT name FROM abacus_stats('detail') WHERE name LIKE 'levels%';
RESET ROLE;
GRANT SELECT ON detail_levels TO regress_abacus_level;
SET ROLE regress_abacus_level;
SELECT abacus_contours('detail', attribute => 'height', max_error => 8);
RESET ROLE;
REVOKE ALL ON detail, detail_vertices, detail_levels FROM regress_abacus_level;
DROP ROLE regress_abacus_level;
SELECT abacus_levels_drop('detail');
-- in space, and dropped with the mesh
SELECT abacus_triangulate('detail_solid', $$
    SELECT i, (i * 0.8191725133961645) % 1, (i * 0.6710436067037893) % 1, (i * 0.5497004779019703) % 1,
           sin(3 * ((i * 0.8191725133961645) % 1)) + (i * 0.6710436067037893) % 1 FROM generate_series(1, 1000) AS i $$,
    '{salt}', dimension => 3);
SELECT level, error <= 0.2 AS is_within FROM abacus_levels('detail_solid', '{0.05,0.2}');
SELECT * FROM abacus_check('detail_solid_level_2');
DROP TABLE detail_solid;
SELECT relname FROM pg_class WHERE relname LIKE 'detail_solid%';
\set VERBOSITY terse
DROP TABLE detail, detail_ground CASCADE;
DROP FUNCTION ids, same;

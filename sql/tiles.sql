-- Tiles of web maps. What is in them test/unit/tile_test.cpp tests, and test/oracle by GDAL.
SELECT abacus_triangulate('hills', 'SELECT 100 * i + j AS id, 7 + i / 20.0 AS lon, 46 + j / 20.0 AS lat, 500 + 40 * i + 3 * j AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j ORDER BY 1');
-- Where it is on the map its SRID tells, or an argument
SELECT abacus_tile_vector('hills', 8, 133, 90);
SELECT abacus_tiles('hills');
SELECT length(abacus_tile_vector('hills', 8, 133, 90, srid => 4326)) > 0 AS has_some;
SELECT abacus_set_srid('hills', 4326);

-- What they are
SELECT encode(substr(abacus_tile_picture('hills', 8, 133, 90, attribute => 'height', range => '{500,1400}'), 1, 4), 'hex') AS png,
       encode(substr(abacus_tile_picture('hills', 8, 133, 90), 1, 4), 'hex') AS mesh,
       encode(substr(abacus_tile_terrain('hills', 8, 133, 90), 1, 4), 'hex') AS terrain,
       encode(substr(abacus_tile_vector('hills', 8, 133, 90), 1, 1), 'hex') AS mvt;
-- ids that browsers cannot tell apart come as text, too
SELECT abacus_triangulate('far_ids', 'SELECT id + 9007199254740991 - 220, lon, lat, height FROM (SELECT 21 * i + j AS id, 7 + i / 20.0 AS lon, 46 + j / 20.0 AS lat, 500 + 40 * i AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j) AS p');
SELECT position('id_text'::bytea IN near) > 0 AS near_text, position('id_text'::bytea IN far) > 0 AS text, position('v2_text'::bytea IN far) > 0 AS of_corners,
       position('9007199254740991'::bytea IN far) > 0 AS greatest, position('9007199254741003'::bytea IN far) > 0 AS beyond
FROM (SELECT abacus_tile_vector('hills', 8, 133, 90) AS near, abacus_tile_vector('far_ids', 8, 133, 90, srid => 4326) AS far) AS tiles;
DROP TABLE far_ids;
SELECT zoom, length(tile) > 0 AS has_some, position('contours'::bytea IN tile) > 0 AS contours, position('triangles'::bytea IN tile) > 0 AS triangles
FROM (VALUES (0, 0, 0), (8, 133, 90), (12, 2132, 1449)) AS t (zoom, x, y), abacus_tile_vector('hills', zoom, x, y, contours => 50) AS tile;
-- Sizes: width of a PNG
SELECT size, get_byte(tile, 18) * 256 + get_byte(tile, 19) AS width
FROM (VALUES (256), (512)) AS t (size), abacus_tile_terrain('hills', 8, 133, 90, size => size) AS tile;
-- Far away there is nothing
SELECT length(abacus_tile_vector('hills', 8, 0, 0)) AS nothing, abacus_tile_picture('hills', 8, 0, 0) = abacus_tile_picture('hills', 8, 1, 1) AS blank;
SELECT abacus_tile_vector('hills', NULL, 0, 0), abacus_tile_picture(NULL, 0, 0, 0), abacus_tile_terrain('hills', 0, NULL, 0), abacus_tile_etag(NULL);
-- Web Mercator
SELECT abacus_triangulate('metres', 'SELECT 100 * i + j AS id, 779000 + 5500 * i AS x, 5780000 + 5500 * j AS y, 500 + 40 * i + 3 * j AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j ORDER BY 1');
SELECT length(abacus_tile_vector('metres', 8, 133, 90, 3857)) > 1000 AS mvt;
SELECT abacus_tile_vector('metres', 8, 133, 90, 4326);
SELECT abacus_tile_picture('metres', 8, 133, 90, 4326);
SELECT abacus_set_srid('metres', 3857);
SELECT abacus_tile_vector('metres', 8, 133, 90) = abacus_tile_vector('metres', 8, 133, 90, 3857) AS same;
SELECT abacus_tile_terrain('metres', 8, 133, 90, 4326);
-- A map of its own: the whole mesh is its tile 0
SELECT abacus_triangulate('sheet', 'SELECT 100 * i + j AS id, i AS x, j AS y, i + j AS height FROM generate_series(0, 8) AS i, generate_series(0, 8) AS j ORDER BY 1');
SELECT abacus_tile_picture('sheet', 0, 0, 0, world => '{0,0,8}', size => 64, attribute => 'height', range => '{0,16}')
     = abacus_draw('sheet', 64, lower => '{0,0}', upper => '{8,8}', attribute => 'height', range => '{0,16}', transparent => true) AS same;
SELECT count(DISTINCT abacus_tile_picture('sheet', 0, 0, 0, world => '{0,0,8}', size => 64, attribute => 'height', range => range, edges => false, exaggeration => 1)) AS shaded,
       bool_or(abacus_tile_picture('sheet', 0, 0, 0, world => '{0,0,8}', size => 64, attribute => 'height', range => range, edges => false, exaggeration => 1)
             = abacus_tile_picture('sheet', 0, 0, 0, world => '{0,0,8}', size => 64, attribute => 'height', range => range, edges => false)) AS flat
FROM (VALUES ('{100,200}'::float8[]), ('{1e9,1e300}')) AS r (range);
SELECT abacus_tile_vector('sheet', 0, 0, 0, world => '{0,0}');
SELECT abacus_tile_vector('sheet', 0, 0, 0, world => '{0,0,-8}');
SELECT abacus_tile_vector('sheet', 0, 0, 0, world => '{0,0,Infinity}');
SELECT * FROM abacus_tiles('sheet', world => '{0,0,8}');
SELECT tile = abacus_tile_vector('sheet', 0, 0, 0, world => '{0,0,8}') AS same FROM sheet_vector(0, 0, 0);
SELECT abacus_tiles('sheet', world => '{0}');

-- Errors
SELECT abacus_tile_vector('hills', -1, 0, 0);
SELECT abacus_tile_picture('hills', 31, 0, 0);
-- heights that the encoding does not hold are said
SELECT abacus_triangulate('heights', 'VALUES (1, 0.0, 0.0, -40000.0), (2, 8, 0, 40000), (3, 0, 8, 0), (4, 8, 8, 0)', attributes => '{h}');
SELECT length(abacus_tile_terrain('heights', 0, 0, 0, world => '{0,0,8}', size => 8)) > 0 AS clamped;
SELECT length(abacus_tile_terrain('heights', 1, 1, 0, world => '{0,0,32}', size => 1, fill => 1e6)) > 0 AS clamped;
SELECT length(abacus_tile_terrain('heights', 1, 0, 0, world => '{0,0,8}', size => 8)) > 0 AS fits;
DROP TABLE heights;
SELECT abacus_tile_terrain('hills', 3, 8, 0);
SELECT abacus_tile_vector('hills', 3, 0, -1);
SELECT abacus_tile_vector('hills', 3, 0, 0, srid => 0);
SELECT abacus_tile_vector('sheet', 3, 0, 0, 25832);
SELECT abacus_tile_vector('sheet', 3, 0, 0, 0);
SELECT abacus_tile_picture('hills', 3, 0, 0, size => 0);
SELECT abacus_tile_terrain('hills', 3, 0, 0, size => 5000);
SELECT abacus_tile_terrain('hills', 3, 0, 0, fill => 'NaN');
SELECT abacus_tile_picture('hills', 3, 0, 0, attribute => 'height');
SELECT abacus_tile_picture('hills', 3, 0, 0, attribute => 'height', range => '{2,1}');
SELECT abacus_tile_picture('hills', 3, 0, 0, attribute => 'depth', range => '{1,2}');
SELECT abacus_tile_picture('hills', 3, 0, 0, attribute => 'height', range => '{1,2}', ramp => 'pink');
SELECT abacus_tile_vector('hills', 3, 0, 0, contours => 0);
SELECT abacus_tile_vector('hills', 3, 0, 0, max_edge => -1);
SELECT abacus_tile_vector('pg_class', 3, 0, 0);
SELECT abacus_triangulate('rock', 'SELECT i, i % 2, i / 2 % 2, i / 4, i FROM generate_series(0, 7) AS i', dimension => 3);
SELECT abacus_tile_vector('rock', 0, 0, 0);
SELECT abacus_tiles('rock');
SELECT abacus_create('bare', 2);
SELECT abacus_tile_terrain('bare', 0, 0, 0, 4326);
SELECT length(abacus_tile_vector('bare', 0, 0, 0, 4326)) AS nothing;
SELECT abacus_create('two', 2, '{a,b}');
SELECT abacus_tile_vector('two', 0, 0, 0, 4326);
SELECT abacus_tiles('two', 4326, attribute => 'b');
SELECT abacus_tiles('hills', contours => -1);
SELECT abacus_tiles('hills', srid => 25832);

-- Functions for tile servers
CREATE SCHEMA maps;
ALTER TABLE hills SET SCHEMA maps;
ALTER TABLE maps.hills RENAME TO "Hills";
SELECT * FROM abacus_tiles('maps."Hills"', contours => 50, ramp => 'viridis');
SELECT p.proname, pg_get_function_arguments(p.oid) AS arguments, pg_get_function_result(p.oid) AS result, p.provolatile, p.proparallel, obj_description(p.oid, 'pg_proc') AS comment
FROM pg_proc AS p WHERE pronamespace = 'maps'::regnamespace ORDER BY 1;
SELECT encode(substr(tile, 1, 4), 'hex') AS png, etag LIKE abacus_tile_etag('maps."Hills"') || '-%' AS has_stamp FROM maps."Hills_picture"(8, 133, 90, '{}');
SELECT tile = abacus_tile_vector('maps."Hills"', 8, 133, 90, contours => 50) AS same FROM maps."Hills_vector"(8, 133, 90, '{}');
SELECT tile = abacus_tile_vector('maps."Hills"', 8, 133, 90, contours => 20) AS other FROM maps."Hills_vector"(8, 133, 90, '{"contours": 20}');
SELECT maps."Hills_mvt"(8, 133, 90, contours => 20) = abacus_tile_vector('maps."Hills"', 8, 133, 90, contours => 20) AS named;
-- Terrain goes on as low as the mesh gets
SELECT tile = abacus_tile_terrain('maps."Hills"', 8, 133, 90, fill => 500) AS same, tile = abacus_tile_terrain('maps."Hills"', 8, 133, 90) AS drops
FROM maps."Hills_terrain"(8, 133, 90);
SELECT tile <> (SELECT tile FROM maps."Hills_picture"(8, 133, 90)) AS other FROM maps."Hills_picture"(8, 133, 90, '{"ramp": "magma"}');
-- What a request says is no SQL
SELECT * FROM maps."Hills_vector"(8, 133, 90, '{"contours": "1; DROP TABLE hills"}');
SELECT * FROM maps."Hills_picture"(8, 133, 90, '{"ramp": "x'' OR true --"}');
SELECT * FROM maps."Hills_vector"(8, 256, 0, '{}');
-- Another ETag after a change of the mesh, and of the functions
CREATE TEMPORARY TABLE etags AS SELECT etag FROM maps."Hills_picture"(8, 133, 90);
SELECT count(*) AS kept FROM etags JOIN maps."Hills_picture"(8, 133, 91) USING (etag);
SELECT abacus_insert('maps."Hills"', 'SELECT 9999, 7.512, 46.513, 900');
SELECT count(*) AS kept FROM etags JOIN maps."Hills_picture"(8, 133, 90) USING (etag);
UPDATE etags SET etag = (SELECT etag FROM maps."Hills_picture"(8, 133, 90));
SELECT count(*) FROM abacus_tiles('maps."Hills"', ramp => 'magma');
SELECT count(*) AS kept FROM etags JOIN maps."Hills_picture"(8, 133, 90) USING (etag);
-- They follow the mesh, and depend on it
ALTER TABLE maps."Hills" RENAME TO hills;
SELECT length(tile) > 0 AS has_some FROM maps."Hills_vector"(8, 133, 90);
\set VERBOSITY terse
DROP TABLE maps.hills;
\set VERBOSITY default
-- A role needs what it reads
CREATE ROLE regress_abacus_map;
GRANT USAGE ON SCHEMA maps TO regress_abacus_map;
SET ROLE regress_abacus_map;
SELECT * FROM maps."Hills_picture"(8, 133, 90);
SELECT abacus_tile_etag('maps.hills');
SELECT abacus_tiles('maps.hills');
RESET ROLE;
GRANT SELECT ON ALL TABLES IN SCHEMA maps, public TO regress_abacus_map;
SET ROLE regress_abacus_map;
SELECT length(tile) > 0 AS has_some FROM maps."Hills_picture"(8, 133, 90);
SELECT abacus_tiles('maps.hills');
RESET ROLE;
SET client_min_messages = warning;
DROP TABLE metres, rock, bare, two, sheet CASCADE;
DROP SCHEMA maps CASCADE;
REVOKE ALL ON ALL TABLES IN SCHEMA public FROM regress_abacus_map;
DROP ROLE regress_abacus_map;

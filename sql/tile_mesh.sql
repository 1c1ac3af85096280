-- Tiles of terrain as triangles. What is in them test/viewer/terrain.test.js reads with the decoders of others.
SELECT abacus_triangulate('hills', 'SELECT 100 * i + j AS id, 7 + i / 20.0 AS lon, 46 + j / 20.0 AS lat, 500 + 40 * i + 3 * j AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j ORDER BY 1');
-- Where it is on the globe its SRID tells, or an argument
SELECT abacus_tile_mesh('hills', 8, 266, 193);
SELECT length(abacus_tile_mesh('hills', 8, 266, 193, srid => 4326)) > 0 AS has_some;
SELECT abacus_set_srid('hills', 4326);
-- A tile of the mesh, all of its triangles far out, and nothing far away
SELECT z, x, y, length(tile) > 0 AS has_some FROM (VALUES (8, 266, 193), (0, 1, 0), (0, 0, 0), (8, 0, 0)) AS t (z, x, y), abacus_tile_mesh('hills', z, x, y) AS tile;
-- y counts from the south, or from the north
SELECT abacus_tile_mesh('hills', 8, 266, 193) = abacus_tile_mesh('hills', 8, 266, 62, scheme => 'xyz') AS same;
SELECT substr(abacus_tile_mesh('hills', 8, 266, 193, format => 'glb'), 1, 8) AS gltf_2,
       position('"centre":[7.3828125,46.0546875,'::bytea IN abacus_tile_mesh('hills', 8, 266, 193, format => 'glb')) > 0 AS has_centre;
-- The corner of a tile within a triangle has the height of its plane there
SELECT abacus_triangulate('slope', 'SELECT * FROM (VALUES (1, -1.0, -1.0, 0.0), (2, 3, -1, 40), (3, -1, 3, 0)) AS v (id, lon, lat, height)');
SELECT abacus_set_srid('slope', 4326);
-- Bytes 25 to 32 are floats: 10 at longitude 0, and 10 a degree
SELECT x, y, substr(tile, 25, 8) AS least_and_greatest, get_byte(tile, 88) AS vertices
FROM (VALUES (255, 128), (256, 128), (256, 127)) AS t (x, y), abacus_tile_mesh('slope', 8, x, y) AS tile;
-- A map of its own, as glTF
SELECT abacus_triangulate('sheet', 'SELECT 100 * i + j AS id, i AS x, j AS y, i + j AS height FROM generate_series(0, 8) AS i, generate_series(0, 8) AS j ORDER BY 1');
SELECT length(abacus_tile_mesh('sheet', 0, 0, 0, world => '{0,0,8}', format => 'glb')) > 0 AS has_some,
       length(abacus_tile_mesh('sheet', 1, 0, 0, world => '{0,0,8}', format => 'glb')) > 0 AS quarter;
-- The same bytes whatever the order in which the points came, however small the cache, and by several threads
SELECT abacus_triangulate('dense', 'SELECT i, 7 + (i * 7919 % 10007) / 10007.0, 46 + (i * 104729 % 10009) / 10009.0, i % 100 AS height FROM generate_series(1, 10000) AS i ORDER BY i');
SELECT abacus_triangulate('shuffled', 'SELECT i, 7 + (i * 7919 % 10007) / 10007.0, 46 + (i * 104729 % 10009) / 10009.0, i % 100 AS height FROM generate_series(1, 10000) AS i ORDER BY i * 31 % 10000');
CREATE TEMPORARY TABLE tiles AS SELECT z, x, y, abacus_tile_mesh('dense', z, x, y, srid => 4326) AS tile FROM (VALUES (0, 1, 0), (7, 133, 96), (8, 266, 193), (9, 533, 387)) AS t (z, x, y);
SET abacus.cache_size = '1MB';
SET abacus.threads = 1;
SELECT z, length(tile) > 0 AS has_some, tile = abacus_tile_mesh('shuffled', z, x, y, srid => 4326) AS same FROM tiles ORDER BY z;
RESET abacus.cache_size;
RESET abacus.threads;
-- Triangles with a corner that has no height are left out
SELECT abacus_triangulate('gaps', 'SELECT 100 * i + j AS id, 7 + i / 20.0 AS lon, 46 + j / 20.0 AS lat, CASE WHEN i < 10 THEN 500.0 END AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j ORDER BY 1');
SELECT x, length(tile) > 0 AS has_some FROM generate_series(1064, 1070) AS x, abacus_tile_mesh('gaps', 10, x, 776, srid => 4326) AS tile ORDER BY x;
SELECT abacus_tile_mesh(NULL, 0, 0, 0), abacus_tile_mesh('hills', NULL, 0, 0), abacus_tile_mesh('hills', 0, NULL, 0), abacus_tile_mesh('hills', 0, 0, NULL);

-- Errors
SELECT abacus_tile_mesh('hills', -1, 0, 0);
SELECT abacus_tile_mesh('hills', 30, 0, 0);
SELECT abacus_tile_mesh('hills', 3, 16, 0);
SELECT abacus_tile_mesh('hills', 3, 15, 8);
SELECT abacus_tile_mesh('hills', 3, 0, 0, format => 'obj');
SELECT abacus_tile_mesh('hills', 3, 0, 0, scheme => 'quadkey');
SELECT abacus_tile_mesh('hills', 3, 0, 0, attribute => 'depth');
SELECT abacus_tile_mesh('hills', 3, 0, 0, srid => 25832);
SELECT abacus_tile_mesh('sheet', 3, 0, 0, srid => 25832);
SELECT abacus_tile_mesh('sheet', 0, 0, 0, world => '{0,0,8}');
SELECT abacus_tile_mesh('sheet', 0, 0, 0, world => '{0,0}', format => 'glb');
SELECT abacus_tile_mesh('sheet', 1, 2, 0, world => '{0,0,8}', format => 'glb');
SELECT abacus_triangulate('metres', 'SELECT 100 * i + j AS id, 779000 + 5500 * i AS x, 5780000 + 5500 * j AS y, 500 + 40 * i + 3 * j AS height
    FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j ORDER BY 1');
SELECT abacus_tile_mesh('metres', 0, 0, 0, srid => 4326);
SELECT length(abacus_tile_mesh('metres', 8, 132, 165, srid => 3857)) > 0 AS has_some;
SELECT abacus_triangulate('rock', 'SELECT i, i % 2, i / 2 % 2, i / 4, i FROM generate_series(0, 7) AS i', dimension => 3);
SELECT abacus_tile_mesh('rock', 0, 0, 0, srid => 4326);
SELECT abacus_triangulate('flat', 'SELECT i, i % 3, i / 3 FROM generate_series(0, 8) AS i');
SELECT abacus_tile_mesh('flat', 0, 0, 0, srid => 4326);
SELECT abacus_create('two', 2, '{a,b}');
SELECT abacus_tile_mesh('two', 0, 0, 0, srid => 4326);
SELECT abacus_tile_mesh('two', 0, 0, 0, srid => 4326, attribute => 'b') IS NULL AS nothing;
-- A role needs what it reads
CREATE ROLE regress_abacus_tile;
SET ROLE regress_abacus_tile;
SELECT abacus_tile_mesh('hills', 8, 266, 193);
RESET ROLE;
DROP ROLE regress_abacus_tile;
DROP TABLE hills, slope, sheet, dense, shuffled, gaps, metres, rock, flat, two;

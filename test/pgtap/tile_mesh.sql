-- Terrain as triangles at the edges: borders on edges and vertices of the mesh, the ends of the world, faults, meshes smaller than a step, extreme coordinates.
BEGIN;
SELECT no_plan();

CREATE FUNCTION pg_temp.count(tile bytea, at integer) RETURNS integer LANGUAGE sql AS $$
    SELECT get_byte(tile, at) + 256 * get_byte(tile, at + 1) + 65536 * get_byte(tile, at + 2) $$;
CREATE FUNCTION pg_temp.vertices(tile bytea) RETURNS integer LANGUAGE sql AS $$ SELECT pg_temp.count(tile, 88) $$;
CREATE FUNCTION pg_temp.triangles(tile bytea) RETURNS integer LANGUAGE sql AS $$ SELECT pg_temp.count(tile, 92 + 6 * pg_temp.vertices(tile)) $$;

-- a square of two triangles, whose edges and diagonal are borders and a diagonal of tiles
SELECT abacus_triangulate('square', 'VALUES (1, 0.0, 0.0, 10.0), (2, 45, 0, 20), (3, 0, 45, 30), (4, 45, 45, 40)', attributes => '{h}');
SELECT abacus_set_srid('square', 4326);
SELECT is(pg_temp.triangles(abacus_tile_mesh('square', 2, 4, 2)), 2, 'a tile whose borders are the edges of the mesh');
SELECT is(pg_temp.vertices(abacus_tile_mesh('square', 2, 4, 2)), 4, 'with one vertex a corner');
SELECT is(abacus_tile_mesh('square', 2, x, y), NULL, format('tile 2/%s/%s only touches the mesh', x, y))
FROM generate_series(3, 5) AS x, generate_series(1, 3) AS y WHERE (x, y) <> (4, 2);
SELECT is((SELECT sum(pg_temp.triangles(abacus_tile_mesh('square', 4, x, y))) FROM generate_series(16, 19) AS x, generate_series(8, 11) AS y), 32::bigint,
          'tiles along a diagonal of theirs have two triangles, and so have the others');

-- the ends of the world
SELECT abacus_triangulate('world', 'SELECT 1000 * i + j, 10.0 * i - 180, 10.0 * j - 90, 100.0 * j FROM generate_series(0, 36) AS i, generate_series(0, 18) AS j', attributes => '{h}');
SELECT abacus_set_srid('world', 4326);
SELECT is((SELECT count(*) FROM generate_series(0, 3) AS x, generate_series(0, 1) AS y WHERE pg_temp.triangles(abacus_tile_mesh('world', 1, x, y)) > 100), 8::bigint,
          'every tile of a zoom has triangles of a mesh of the world');
SELECT isnt(abacus_tile_mesh('world', 29, 1073741823, 536870911), NULL, 'the last tile of the last zoom');
SELECT isnt(abacus_tile_mesh('world', 3, 0, 0, format => 'glb'), NULL, 'glTF at a pole');

-- a latitude that is none
SELECT abacus_triangulate('beyond', 'VALUES (1, 0.0, 0.0, 1.0), (2, 10, 0, 1), (3, 5, 91, 1)', attributes => '{h}');
SELECT throws_ok($$SELECT abacus_tile_mesh('beyond', 2, 4, 2, srid => 4326)$$, '22023', 'the mesh is not in longitude and latitude', 'a vertex beyond a pole');

-- smaller than a step of the tile: a triangle of a step, so that readers have something
SELECT abacus_triangulate('speck', 'VALUES (1, 7.00001, 46.00001, 500.0), (2, 7.00002, 46.00001, 510), (3, 7.00001, 46.00002, 520)', attributes => '{h}');
SELECT abacus_set_srid('speck', 4326);
SELECT is(pg_temp.triangles(abacus_tile_mesh('speck', 0, 1, 0)), 1, 'a mesh smaller than a step');
SELECT is(abacus_tile_mesh('speck', 0, 0, 0), NULL, 'which the other half of the world does not have');
SELECT is(pg_temp.triangles(abacus_tile_mesh('speck', 20, floor(187.00001 * 2 ^ 20 / 180)::integer, floor(136.00001 * 2 ^ 20 / 180)::integer)), 1, 'and its triangle where it is large');

-- values that are none
SELECT abacus_triangulate('holes', 'VALUES (1, 0.0, 0.0, float8 ''NaN''), (2, 45, 0, 1), (3, 0, 45, 1), (4, 45, 45, 1)', attributes => '{h}');
SELECT is(abacus_tile_mesh('holes', 2, 4, 2, srid => 4326) IS NULL, false, 'a triangle without a value is left out, and the other one stays');
SELECT is(pg_temp.triangles(abacus_tile_mesh('holes', 2, 4, 2, srid => 4326)), 1, 'alone');

-- a fault: two heights at one place
SELECT abacus_load('fault', 'VALUES (1, 0.0, 0.0, 0.0), (2, 45, 0, 0), (3, 0, 45, 0), (4, 45, 0, 100), (5, 0, 45, 100), (6, 45, 45, 100)',
                   'VALUES (1, 2, 3), (4, 6, 5)', split_nodes => true, attributes => '{h}');
SELECT is(pg_temp.vertices(abacus_tile_mesh('fault', 2, 4, 2, srid => 4326)), 6, 'each side of a fault keeps its heights');

-- coordinates and heights whose differences are no doubles
SELECT abacus_triangulate('vast', 'VALUES (1, -1.7e308, -1.7e308, 0.0), (2, 1.7e308, -1.7e308, 10), (3, -1.7e308, 1.7e308, 20)', attributes => '{h}');
SELECT isnt(abacus_tile_mesh('vast', 0, 0, 0, world => '{-8,-8,16}', format => 'glb'), NULL, 'a tile within a triangle that spans all doubles');

-- heights and places that floats do not hold
SELECT abacus_triangulate('high', 'SELECT i, i % 3 * 10.0, i / 3 * 10.0, CASE i WHEN 4 THEN 1e39 ELSE 5 END FROM generate_series(0, 8) AS i', attributes => '{h}');
SELECT throws_ok(format('SELECT abacus_tile_mesh(%L, 4, 16, 8, srid => 4326, format => %L)', 'high', f), '22003', 'a place of the tile is beyond the range of 32-bit floats', 'a height beyond floats, as ' || f)
FROM (VALUES ('quantized-mesh'), ('glb')) AS f (f);
SELECT abacus_update('high', 'SELECT 4 AS id, 10.0 AS x, 10.0 AS y, 3e38::float8 AS h');
SELECT isnt(abacus_tile_mesh('high', 4, 16, 8, srid => 4326), NULL, 'the greatest heights that floats hold');
SELECT isnt(abacus_tile_mesh('high', 4, 16, 8, srid => 4326, format => 'glb'), NULL, '... as glTF');
SELECT abacus_update('high', 'SELECT 4 AS id, 10.0 AS x, 10.0 AS y, 1e200::float8 AS h');
SELECT throws_ok($$SELECT abacus_tile_mesh('high', 0, 1, 0, srid => 4326)$$, '22003', NULL, 'a height far beyond floats');
SELECT is(abacus_tile_mesh('high', 4, 0, 0, srid => 4326), NULL, 'elsewhere there is no tile');
SELECT abacus_triangulate('far', 'VALUES (1, 0.0, 0.0, 1.0), (2, 1e39, 0, 1), (3, 0, 1e39, 1)', attributes => '{h}');
SELECT throws_ok($$SELECT abacus_tile_mesh('far', 0, 0, 0, world => '{0,0,1e39}', format => 'glb')$$, '22003', NULL, 'coordinates beyond floats');
SELECT isnt(abacus_tile_mesh('far', 0, 0, 0, world => '{0,0,1e37}', format => 'glb'), NULL, 'a part of the same mesh');
SELECT abacus_triangulate('steep', 'VALUES (1, 0.0, 0.0, 0.0), (2, 1, 0, 1e300), (3, 0, 1, -1e300), (4, -1, 0, 0), (5, 0, -1, 0)', attributes => '{h}');
SELECT isnt(abacus_tile_mesh('steep', 1, 0, 0, world => '{-2,-2,4}', format => 'glb'), NULL, 'beside triangles whose normals have no length in doubles');

-- a level of detail
SELECT abacus_triangulate('rough', 'SELECT 100 * i + j, 7 + i / 40.0, 46 + j / 40.0, 500 + (i * 7919 + j * 104729) % 13 FROM generate_series(0, 40) AS i, generate_series(0, 40) AS j', attributes => '{h}');
SELECT abacus_set_srid('rough', 4326);
SELECT count(*) FROM abacus_levels('rough', '{5, 20}');
SELECT ok(pg_temp.triangles(abacus_tile_mesh('rough', 5, 33, 24, max_error => 30)) < pg_temp.triangles(abacus_tile_mesh('rough', 5, 33, 24, max_error => 6)), 'a greater error, fewer triangles');
SELECT ok(pg_temp.triangles(abacus_tile_mesh('rough', 5, 33, 24, max_error => 6)) < pg_temp.triangles(abacus_tile_mesh('rough', 5, 33, 24)), 'and fewer than the mesh has');
SELECT is(abacus_tile_mesh('rough', 5, 33, 24, max_error => 1), abacus_tile_mesh('rough', 5, 33, 24), 'without a level that is fine enough the mesh is read');
SELECT abacus_triangulate('later', 'SELECT 100 * i + j, 7 + i / 40.0, 46 + j / 40.0, 500 + (i * 7919 + j * 104729) % 13 FROM generate_series(0, 40) AS i, generate_series(0, 40) AS j', attributes => '{h}');
SELECT count(*) FROM abacus_levels('later', '{5, 20}');
SELECT abacus_set_srid('later', 4326);
SELECT is(abacus_tile_mesh('later', 5, 33, 24, max_error => 6), abacus_tile_mesh('rough', 5, 33, 24, max_error => 6), 'levels that were made before the mesh had its SRID');
SELECT * FROM finish();
ROLLBACK;

-- The extension abacus_postgis: geometries as sources, as places and windows, and as results, compared with
-- PostGIS itself.
SELECT NOT EXISTS (SELECT FROM pg_available_extensions WHERE name = 'postgis') AS absent \gset
\if :absent
\echo 1..0 # SKIP PostGIS is not installed
\quit
\endif
BEGIN;
SELECT no_plan();
SET client_min_messages = warning;
-- in a schema of its own, which is not on the path when functions are called
CREATE SCHEMA gis;
CREATE EXTENSION postgis SCHEMA gis;
SET LOCAL search_path = public, gis;
CREATE EXTENSION abacus_postgis;

SELECT is_empty($$ SELECT p.oid::regprocedure FROM pg_depend d JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'abacus_postgis'
                   JOIN pg_proc p ON p.oid = d.objid WHERE d.classid = 'pg_proc'::regclass AND d.deptype = 'e' AND (obj_description(p.oid, 'pg_proc') IS NULL
                   OR provolatile <> 's' OR proparallel <> 's') $$, 'all functions have a comment, are stable and parallel safe');
SELECT is((SELECT extrelocatable FROM pg_extension WHERE extname = 'abacus_postgis'), true, 'it may move');

-- ---- Sources ---------------------------------------------------------------

CREATE TABLE sites (id bigint PRIMARY KEY, geom geometry(Point, 2154), height float8);
INSERT INTO sites SELECT i, ST_SetSRID(ST_MakePoint((i * 7919) % 1009 / 8.0, (i * 104729) % 997 / 8.0), 2154), (i * 31) % 89 FROM generate_series(1, 2000) AS i;
SELECT cmp_ok(abacus_triangulate('terrain', 'SELECT id, geom, height FROM sites'), '>', 3900::bigint, 'a mesh of a table with geometries');
SELECT is(abacus_srid('terrain'), 2154, 'which has their SRID');
SELECT is((SELECT string_agg(name, ',') FROM abacus_attributes('terrain')), 'height', 'and the columns behind them as attributes');
SELECT set_eq('SELECT id, x, y, attributes[1] FROM abacus_vertices(''terrain'')', 'SELECT id, ST_X(geom), ST_Y(geom), height FROM sites', 'the points are those of the table');
SELECT is(abacus_triangulate('plain', 'SELECT id, ST_X(geom), ST_Y(geom) FROM sites'), (SELECT count(*) FROM abacus_simplices('terrain')), 'as many triangles as of coordinates');
SELECT set_eq('SELECT v0, v1, v2 FROM abacus_simplices(''terrain'')', 'SELECT v0, v1, v2 FROM abacus_simplices(''plain'')', 'and the same ones');
SELECT is(abacus_srid('plain'), 0, 'of coordinates nobody knows the SRID');

SELECT is(abacus_insert('terrain', $$ SELECT 5000, 'SRID=2154;POINT Z (150 20 7)'::geometry, 3 $$), 1::bigint, 'a z is passed over in the plane');
SELECT is((SELECT attributes FROM abacus_nearest('terrain', 'SRID=2154;POINT(150 20)'::geometry)), '{3}', 'and is no attribute');
SELECT is(abacus_delete('terrain', $$ SELECT 5000, 'SRID=2154;POINT(150 20)'::geometry $$), 1::bigint, 'points are deleted by their geometries');
SELECT abacus_octree_create('octree_divided', 2, '{0,0}', '{128,128}');
SELECT cmp_ok(abacus_octree_from_points('octree_divided', 'SELECT id, geom FROM sites', 20), '>', 100::bigint, 'an octree of geometries');
SELECT is(abacus_srid('octree_divided'), 2154, 'has their SRID');
SELECT is((SELECT value FROM abacus_stats('octree_divided') WHERE name = 'srid'), 2154::float8, 'which its figures tell');
SELECT throws_ok($$ SELECT abacus_octree_from_points('octree_divided', 'SELECT id, ST_SetSRID(geom, 3857) FROM sites', 20) $$, '22023', 'geometry of point 1 has SRID 3857, but the octree has SRID 2154', 'others are refused');
SELECT lives_ok($$ SELECT abacus_octree_from_points('octree_divided', 'SELECT id, geom FROM sites', 10) $$, 'further ones of the same are not');
SELECT abacus_octree_create('octree_mixed', 2, '{0,0}', '{128,128}');
SELECT throws_ok($$ SELECT abacus_octree_from_points('octree_mixed', 'SELECT id, ST_SetSRID(geom, 2154 + (id % 2)::int) FROM sites', 20) $$, '22023', NULL, 'nor may they be of two');
SELECT is(abacus_srid('octree_mixed'), 0, 'and then nothing is kept');
SELECT throws_ok($$ SELECT * FROM abacus_octree_locate('octree_mixed', 'SELECT id, geom FROM sites') $$, '22023', NULL, 'places of a query have the SRID of the octree');
SELECT throws_ok($$ SELECT abacus_octree_from_points('octree_solid', 'SELECT id, geom FROM sites', 20) $$, '22023', 'geometry of point 1 has no z, but the octree has dimension 3', 'of space they have a z')
FROM abacus_octree_create('octree_solid', 3, '{0,0,0}', '{128,128,128}');
SELECT throws_ok($$ SELECT abacus_octree_from_rows('octree_mixed', 'SELECT 0, geom FROM sites') $$, '42804', 'column 2 (level) of the source query has type geometry', 'a geometry is no level');
SELECT abacus_create('staged', 2);
SELECT abacus_stage('staged', 'SELECT id, geom FROM sites WHERE id <= 3');
SELECT is(abacus_srid('staged'), 2154, 'staged points give the mesh an SRID, too');
SELECT is(abacus_load('loaded', 'SELECT id, geom, height FROM sites', 'SELECT v0, v1, v2 FROM abacus_simplices(''plain'')'), abacus_triangulate('terrain'), 'a triangulation with geometries is loaded');
SELECT is(abacus_srid('loaded'), 2154, 'with their SRID');
SELECT set_eq($$ SELECT id, v0 FROM abacus_locate('terrain', 'SELECT id, ST_Translate(geom, 0.01, 0.02) FROM sites') $$,
              $$ SELECT id, v0 FROM abacus_locate('terrain', 'SELECT id, ST_X(geom) + 0.01, ST_Y(geom) + 0.02 FROM sites') $$, 'places of a query are geometries');
SELECT is((SELECT count(*) FROM abacus_interpolate('terrain', 'SELECT id, geom FROM sites') AS i JOIN sites USING (id) WHERE "values"[1] = height), 2000::bigint, 'for values as well');

SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''SRID=4326;POINT(1 2)''::geometry, 3') $$, '22023', 'geometry of point 7 has SRID 4326, but the mesh has SRID 2154', 'another SRID');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''POINT(1 2)''::geometry, 3') $$, '22023', 'geometry of point 7 has no SRID, but the mesh has SRID 2154', 'none');
SELECT throws_ok($$ SELECT abacus_delete('plain', 'SELECT 7, ''SRID=4326;POINT(1 2)''::geometry') $$, '22023', 'geometry of point 7 has SRID 4326, but the mesh has none', 'one where the mesh has none');
SELECT throws_ok($$ SELECT abacus_locate('plain', 'SELECT 7, ''SRID=4326;POINT(1 2)''::geometry') $$, '22023', 'geometry of point 7 has SRID 4326, but the mesh has none', 'also of places');
SELECT throws_ok($$ SELECT abacus_triangulate('mixed', 'VALUES (1, ''SRID=4326;POINT(1 2)''::geometry), (8, ''SRID=3857;POINT(1 3)'')') $$, '22023', 'geometry of point 8 has SRID 3857, but earlier geometries have SRID 4326', 'mixed SRIDs');
SELECT throws_ok($$ SELECT abacus_triangulate('mixed', 'VALUES (1, ''POINT(1 2)''::geometry), (8, ''SRID=3857;POINT(1 3)'')') $$, '22023', 'geometry of point 8 has SRID 3857, but earlier geometries have SRID 0', 'none first, and then one');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''SRID=2154;POINT EMPTY''::geometry, 3') $$, '22023', 'geometry of point 7 is empty', 'an empty point');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''SRID=2154;LINESTRING(1 2, 3 4)''::geometry, 3') $$, '22023', 'geometry of point 7 is a LineString, not a Point', 'no point');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''SRID=2154;MULTIPOINT(1 2)''::geometry, 3') $$, '22023', 'geometry of point 7 is a MultiPoint, not a Point', 'several');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ''SRID=2154;CIRCULARSTRING(0 0, 1 1, 2 0)''::geometry, 3') $$, '22023', 'geometry of point 7 is a CircularString, not a Point', 'a curve');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, NULL::geometry, 3') $$, '22004', 'geometry of point 7 is NULL', 'NULL');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, ST_SetSRID(ST_MakePoint(1, ''Infinity''), 2154), 3') $$, '22023', 'geometry of point 7 is not finite', 'infinity');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, 1, 2, geom FROM sites') $$, '42804', 'column 4 (height) of the source query has type geometry', 'a geometry elsewhere');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, geom FROM sites') $$, '42804', 'source query returns 2 columns, but the mesh takes 3', 'an attribute is missing');
SELECT throws_ok($$ SELECT abacus_insert('terrain', 'SELECT 7, geom::geography, 3, 4 FROM sites') $$, '42804', 'column 2 (x) of the source query has type geography', 'geography is not planar');
SELECT is((SELECT count(*) FROM abacus_vertices('terrain')), 2000::bigint, 'errors change nothing');

-- ---- Places ----------------------------------------------------------------

CREATE TABLE places AS SELECT i AS id, ST_SetSRID(ST_MakePoint((i * 37) % 127 + 0.3, (i * 53) % 125 + 0.7), 2154) AS geom FROM generate_series(1, 200) AS i;
CREATE VIEW cells AS SELECT * FROM abacus_cells_geom('terrain', attribute => 'height');
SELECT is((SELECT count(*) FROM places WHERE (abacus_locate('terrain', geom)).code IS NOT NULL), (SELECT count(*) FROM places, (SELECT abacus_hull_geom('terrain') AS hull) AS h WHERE ST_Intersects(places.geom, hull)), 'as many places are located as the hull has');
SELECT is_empty($$ SELECT FROM places AS p WHERE (abacus_locate('terrain', geom)).code IS NOT NULL AND NOT EXISTS (SELECT FROM cells AS c WHERE c.code = (abacus_locate('terrain', p.geom)).code
                   AND (c.v0, c.v1, c.v2) = ((abacus_locate('terrain', p.geom)).v0, (abacus_locate('terrain', p.geom)).v1, (abacus_locate('terrain', p.geom)).v2) AND ST_Intersects(c.geom, p.geom)) $$,
                'each in the triangle that covers it');
SELECT results_eq($$ SELECT id, abacus_interpolate('terrain', geom), abacus_interpolate('terrain', geom, 'height', 'natural'), abacus_gradient('terrain', geom), abacus_slope('terrain', geom) FROM places ORDER BY id $$,
                  $$ SELECT id, abacus_interpolate('terrain', ST_X(geom), ST_Y(geom)), abacus_interpolate('terrain', ST_X(geom), ST_Y(geom), 'height', 'natural'), abacus_gradient('terrain', ST_X(geom), ST_Y(geom)), abacus_slope('terrain', ST_X(geom), ST_Y(geom)) FROM places ORDER BY id $$,
                  'values, gradients and slopes');
SELECT results_eq($$ SELECT p.id, n.* FROM places AS p, abacus_nearest('terrain', geom, 3) AS n ORDER BY p.id, distance $$,
                  $$ SELECT p.id, n.* FROM places AS p, abacus_nearest('terrain', ST_X(geom), ST_Y(geom), 3) AS n ORDER BY p.id, distance $$, 'nearest vertices');
SELECT results_eq($$ SELECT vertex FROM abacus_nearest('terrain', 'SRID=2154;POINT(50.1 50.2)'::geometry, 10) $$,
                  $$ SELECT id FROM sites ORDER BY ST_Distance(geom, 'SRID=2154;POINT(50.1 50.2)') LIMIT 10 $$, 'those that PostGIS finds');
SELECT set_eq($$ SELECT p.id, w.* FROM places AS p, abacus_weights('terrain', geom) AS w $$, $$ SELECT p.id, w.* FROM places AS p, abacus_weights('terrain', ST_X(geom), ST_Y(geom)) AS w $$, 'weights');
SELECT set_eq($$ SELECT p.id, s.* FROM sites AS p, abacus_star('terrain', geom) AS s WHERE p.id < 50 $$, $$ SELECT p.id, s.* FROM sites AS p, abacus_star('terrain', ST_X(geom), ST_Y(geom)) AS s WHERE p.id < 50 $$, 'stars');
SELECT results_eq($$ SELECT a.id, s.* FROM places AS a, places AS b, abacus_visible('terrain', a.geom, b.geom, observer_height => 2) AS s WHERE b.id = 5 ORDER BY a.id $$,
                  $$ SELECT a.id, s.* FROM places AS a, places AS b, abacus_visible('terrain', ARRAY[ST_X(a.geom), ST_Y(a.geom)], ARRAY[ST_X(b.geom), ST_Y(b.geom)], observer_height => 2) AS s WHERE b.id = 5 ORDER BY a.id $$, 'lines of sight');
SELECT lives_ok($$ SELECT abacus_visible('terrain', '{50, 50}', '{60, 60}') $$, 'arrays in quotes are still arrays');

SELECT is(abacus_locate('terrain', NULL::geometry), NULL, 'NULL is nowhere');
SELECT is(abacus_locate('terrain', 'SRID=2154;POINT EMPTY'::geometry), NULL, 'an empty point as well');
SELECT is(abacus_interpolate('terrain', 'SRID=2154;POINT EMPTY'::geometry), NULL, 'it has no value');
SELECT is((SELECT count(*) FROM abacus_nearest('terrain', 'SRID=2154;POINT EMPTY'::geometry)) + (SELECT count(*) FROM abacus_star('terrain', 'SRID=2154;POINT EMPTY'::geometry)) +
          (SELECT count(*) FROM abacus_weights('terrain', NULL::geometry)), 0::numeric::bigint, 'and no rows');
SELECT is((abacus_visible('terrain', 'SRID=2154;POINT EMPTY'::geometry, 'SRID=2154;POINT(1 1)')).visible, NULL, 'nothing is seen from it');
SELECT throws_ok($$ SELECT abacus_locate('terrain', 'SRID=4326;POINT(1 1)'::geometry) $$, '22023', 'the geometry has SRID 4326, but the mesh has SRID 2154', 'another SRID');
SELECT throws_ok($$ SELECT abacus_locate('terrain', 'POINT(1 1)'::geometry) $$, '22023', 'the geometry has no SRID, but the mesh has SRID 2154', 'none');
SELECT throws_ok($$ SELECT abacus_interpolate('plain', 'SRID=4326;POINT(1 1)'::geometry, 'h') $$, '22023', 'the geometry has SRID 4326, but the mesh has none', 'one where the mesh has none');
SELECT throws_ok($$ SELECT abacus_nearest('terrain', 'SRID=2154;POLYGON((0 0, 1 0, 0 1, 0 0))'::geometry) $$, '22023', 'the geometry is a Polygon, not a Point', 'no point');
SELECT is(abacus_locate('terrain', 'SRID=2154;POINT ZM (50 50 7 8)'::geometry), abacus_locate('terrain', 50, 50), 'z and m are passed over in the plane');

-- ---- Results ---------------------------------------------------------------

SELECT is((SELECT ST_Area(abacus_hull_geom('terrain'))), (SELECT ST_Area(ST_ConvexHull(ST_Collect(geom))) FROM sites), 'the hull is that of PostGIS');
SELECT ok(ST_Equals(abacus_hull_geom('terrain'), ST_ConvexHull(ST_Collect(geom))), 'everywhere') FROM sites;
SELECT is((SELECT sum(ST_Area(geom)) FROM cells), ST_Area(abacus_hull_geom('terrain')), 'the areas of the cells are that of the hull');
SELECT is((SELECT count(*) FROM cells WHERE ST_IsValid(geom) AND ST_SRID(geom) = 2154 AND GeometryType(geom) = 'POLYGON' AND ST_ZMFlag(geom) = 2), (SELECT count(*) FROM abacus_simplices('terrain')), 'cells are valid polygons with z');
SELECT is_empty($$ SELECT FROM cells, ST_DumpPoints(geom) AS d WHERE NOT EXISTS (SELECT FROM sites AS s WHERE ST_X(s.geom) = ST_X(d.geom) AND ST_Y(s.geom) = ST_Y(d.geom) AND height = ST_Z(d.geom)) $$, 'with the points and heights of the table');
CREATE TABLE few AS SELECT id, ST_SetSRID(ST_MakePoint(sin(id), cos(id * 1.7)), 2154) AS geom FROM generate_series(1, 300) AS id
UNION ALL SELECT 1000 + i, ST_SetSRID(ST_MakePoint(4 - i % 2 * 8, 4 - i / 2 * 8), 2154) FROM generate_series(0, 3) AS i;
SELECT abacus_triangulate('small', 'TABLE few');
SELECT set_eq($$ SELECT ST_Normalize(geom) FROM abacus_cells_geom('small') $$, $$ SELECT ST_Normalize(d.geom) FROM (SELECT ST_DelaunayTriangles(ST_Collect(geom)) AS g FROM few) AS t, ST_Dump(g) AS d $$, 'the triangles that PostGIS finds');
SELECT is((SELECT count(*) FROM abacus_cells_geom('terrain', 'SRID=2154;POLYGON EMPTY')), 0::bigint, 'an empty window has nothing');
SELECT is((SELECT count(*) FROM abacus_cells_geom('terrain', ST_MakeEnvelope(9000, 9000, 9001, 9001, 2154))), 0::bigint, 'nor has one far outside');
SELECT set_eq($$ SELECT v0, v1, v2 FROM abacus_cells_geom('terrain', ST_MakeEnvelope(30, 30, 40, 35, 2154)) $$, $$ SELECT v0, v1, v2 FROM cells WHERE ST_Intersects(geom, ST_MakeEnvelope(30, 30, 40, 35, 2154)) $$, 'a window has what PostGIS finds in it');
SELECT throws_ok($$ SELECT * FROM abacus_cells_geom('terrain', ST_MakeEnvelope(30, 30, 40, 35, 4326)) $$, '22023', 'the geometry has SRID 4326, but the mesh has SRID 2154', 'a window of another SRID');
SELECT throws_ok($$ SELECT * FROM abacus_cells_geom('terrain', attribute => 'depth') $$, '42703', NULL, 'no such attribute');
SELECT is((SELECT count(*) FROM abacus_cells_geom(NULL)), 0::bigint, 'no mesh, no cells');
SELECT set_eq($$ SELECT id, geom FROM abacus_vertices_geom('terrain') $$, 'SELECT id, geom FROM sites', 'the points as geometries');
SELECT set_eq($$ SELECT id FROM abacus_vertices_geom('terrain', ST_MakeEnvelope(30, 30, 40, 35, 2154)) $$, $$ SELECT id FROM sites WHERE geom && ST_MakeEnvelope(30, 30, 40, 35, 2154) $$, 'those of a window');
SELECT set_eq($$ SELECT v0, v1, ST_Length(geom) FROM abacus_edges_geom('terrain') $$, $$ SELECT v0, v1, length FROM abacus_edges('terrain') $$, 'edges are as long as they are');
SELECT is_empty($$ SELECT FROM abacus_edges_geom('terrain') AS e JOIN sites AS a ON a.id = v0 JOIN sites AS b ON b.id = v1 WHERE NOT ST_OrderingEquals(e.geom, ST_MakeLine(a.geom, b.geom)) $$, 'and go from the lesser id to the greater');
SELECT results_eq($$ SELECT id, value, ST_NPoints(geom), ST_IsClosed(geom) FROM abacus_contours_geom('terrain', 10) ORDER BY id $$, $$ SELECT id, value, cardinality(path) / 2, closed FROM abacus_contours('terrain', 10) ORDER BY id $$, 'contours');
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 6) FROM abacus_contours_geom('terrain', 10, polygonize => true)), round(ST_Area(abacus_hull_geom('terrain'))::numeric, 6), 'bands fill the hull');
SELECT is((SELECT count(*) FROM abacus_contours_geom('terrain', 10, polygonize => true) WHERE ST_IsValid(geom) AND GeometryType(geom) = 'MULTIPOLYGON'), (SELECT count(DISTINCT value) FROM abacus_contours('terrain', 10, polygonize => true)), 'and are valid, one a value');
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 6) FROM abacus_contours_geom('terrain', 10, polygonize => true, bounds => ST_MakeEnvelope(20, 20, 80, 70, 2154))), 3000.000000, 'those of a window fill it');
SELECT abacus_levels('terrain', '{20}');
SELECT results_eq($$ SELECT id, value, geom FROM abacus_contours_geom('terrain', 10, polygonize => false, max_error => 20) ORDER BY id $$, $$ SELECT id, value, geom FROM abacus_contours_geom('terrain_level_1', 10, polygonize => false) ORDER BY id $$, 'lines of a level');
SELECT results_eq($$ SELECT id, value, geom FROM abacus_contours_geom('terrain', 10, polygonize => true, max_error => 20) ORDER BY id $$, $$ SELECT id, value, geom FROM abacus_contours_geom('terrain_level_1', 10, polygonize => true) ORDER BY id $$, 'bands of a level');
SELECT is(abacus_levels_drop('terrain'), 1, 'which goes');
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 6) FROM abacus_voronoi_geom('terrain', ST_MakeEnvelope(20, 20, 80, 70, 2154)) WHERE ST_IsValid(geom)), 3000.000000, 'so do Voronoi cells');
SELECT is_empty($$ SELECT FROM abacus_voronoi_geom('terrain', ST_MakeEnvelope(40, 40, 60, 60, 2154)) AS v JOIN sites AS s ON s.id = v.vertex WHERE bounded AND ST_Within(s.geom, ST_MakeEnvelope(40, 40, 60, 60, 2154)) AND NOT ST_Contains(v.geom, s.geom) $$, 'each around its point');
SELECT results_eq($$ SELECT vertex, neighbour, round(ST_Length(geom)::numeric, 9) FROM abacus_voronoi_facets_geom('terrain', ST_MakeEnvelope(40, 40, 45, 45, 2154)) ORDER BY 1, 2, 3 $$,
                  $$ SELECT vertex, neighbour, round(size::numeric, 9) FROM abacus_voronoi_facets('terrain', '{40,40}', '{45,45}') ORDER BY 1, 2, 3 $$, 'and between them lines');
SELECT results_eq($$ SELECT distance, value, ST_X(geom), ST_Y(geom) FROM abacus_profile_geom('terrain', 'SRID=2154;LINESTRING(-5 20, 60 70, 140 30)') $$,
                  $$ SELECT distance, value, x, y FROM abacus_profile('terrain', '{-5, 20, 60, 70, 140, 30}') $$, 'a profile');
SELECT results_eq($$ SELECT distance, value, ST_X(geom), ST_Y(geom) FROM abacus_profile_geom('terrain', 'SRID=2154;LINESTRING(-5 20, 60 70, 140 30)', max_edge => 14) $$,
                  $$ SELECT distance, value, x, y FROM abacus_profile('terrain', '{-5, 20, 60, 70, 140, 30}', max_edge => 14) $$, 'a profile without long triangles');
SELECT is(ST_Z(ST_GeometryN(abacus_drape('terrain', 'SRID=2154;MULTIPOINT(50 50, 60 60)', max_edge => 1e-6), 1)), 'NaN'::float8, 'nothing is draped over long triangles');
SELECT is((abacus_visible('terrain', 'SRID=2154;POINT(50 50)'::geometry, 'SRID=2154;POINT(60 60)', max_edge => 1e-6)).visible, NULL, 'nor does one stand on them');
SELECT is((SELECT count(*) FROM abacus_profile_geom('terrain', 'SRID=2154;LINESTRING EMPTY')), 0::bigint, 'of no line');
SELECT throws_ok($$ SELECT * FROM abacus_profile_geom('terrain', 'SRID=2154;MULTILINESTRING((0 0, 1 1))') $$, '22023', 'the geometry is a MultiLineString, not a LineString', 'of several');
SELECT is(ST_Area(abacus_hull_geom('terrain', 4)), (SELECT sum(ST_Area(geom)) FROM abacus_cells_geom('terrain', max_edge => 4)), 'an outline has the area of the cells in it');
SELECT ok(ST_IsValid(abacus_hull_geom('small', 0.26)) AND ST_NRings(abacus_hull_geom('small', 0.26)) > ST_NumGeometries(abacus_hull_geom('small', 0.26)), 'it is valid, and has holes');
SELECT ok(ST_Equals(abacus_hull_geom('small', 0.26), (SELECT ST_Union(geom) FROM abacus_cells_geom('small', max_edge => 0.26))), 'it is their union');
CREATE FUNCTION squared_radius(triangle geometry) RETURNS float8 LANGUAGE sql AS
$$ SELECT (ST_Distance(a, b) * ST_Distance(b, c) * ST_Distance(c, a) / (4 * ST_Area(triangle))) ^ 2 FROM (SELECT ST_PointN(r, 1) AS a, ST_PointN(r, 2) AS b, ST_PointN(r, 3) AS c FROM ST_ExteriorRing(triangle) AS r) AS corners $$;
SELECT ok(ST_Equals(abacus_alpha_shape_geom('small', 0.01, true), (SELECT ST_Union(geom) FROM abacus_cells_geom('small') WHERE squared_radius(geom) <= 0.01)), 'an alpha shape has the triangles with small circumcircles');
SELECT ok(ST_Equals(abacus_alpha_shape_geom('small', 'Infinity'), abacus_hull_geom('small')), 'or all of them');

-- holes that touch each other and the outline, islands in them, vertical edges, holes with one least place
CREATE TABLE puzzle AS SELECT 'POLYGON((0 0, 30 0, 30 30, 0 30, 0 20, 0 10, 0 0), (0 10, 0.5 20, 5 15, 0 10), (10 10, 10 20, 20 20, 20 10, 10 10), (20 20, 21 25, 25 21, 20 20), (20 20, 25 19, 22 15, 20 20), (20 10, 28 5, 20 2, 20 10))'::geometry AS land,
    'POLYGON((11 11, 19 11, 19 19, 11 19, 11 11), (12 12, 12 18, 18 18, 18 12, 12 12))'::geometry AS island, 'POLYGON((13 13, 17 13, 17 17, 13 17, 13 13), (13 13, 15 15, 14 13.5, 13 13), (13 13, 13.5 14, 15 16, 13 13))'::geometry AS inner_island,
    'POLYGON((40 0, 50 0, 50 10, 40 10, 40 0))'::geometry AS elsewhere;
CREATE VIEW puzzle_rings AS SELECT ST_Collect(d.geom ORDER BY md5(ST_AsText(d.geom))) AS rings, ST_Collect(ARRAY[land, island, inner_island, elsewhere]) AS solved
FROM puzzle, LATERAL (SELECT ST_Boundary(ST_ForcePolygonCCW(p)) AS lines FROM unnest(ARRAY[land, island, inner_island, elsewhere]) AS p) AS b, ST_Dump(ST_Multi(lines)) AS d GROUP BY land, island, inner_island, elsewhere;
SELECT ok(ST_IsValid(solved), 'a puzzle of rings') FROM puzzle_rings;
SELECT is(ST_AsText(ST_Normalize(_abacus_nest(rings))), ST_AsText(ST_Normalize(solved)), 'is put together') FROM puzzle_rings;
SELECT is(ST_AsText(ST_Normalize(_abacus_nest(ST_Affine(rings, a, b, -b, a, 0, 0)))), ST_AsText(ST_Normalize(ST_Affine(solved, a, b, -b, a, 0, 0))), format('turned by %s, %s', a, b))
FROM puzzle_rings, (VALUES (-1, 0), (0, 1), (0, -1), (2, 1), (-3, 1), (1, -5)) AS turns (a, b);

-- many rings that touch one another, and edges exactly at a level
CREATE TABLE crowd (seed int, what text, valid boolean, area float8, wanted float8);
DO $$
BEGIN
    FOR seed IN 1..6 LOOP
        DROP TABLE IF EXISTS steps, step_points;
        CREATE TABLE step_points AS SELECT x * 100 + y AS id, ST_MakePoint(x, y) AS geom, (x * 37 + y * 53 + x * y * seed) % 6 AS h
        FROM generate_series(0, 30) AS x, generate_series(0, 30) AS y WHERE (x * x + 3 * y + x * y * seed) % 3 > 0;
        PERFORM abacus_triangulate('steps', 'TABLE step_points');
        INSERT INTO crowd SELECT seed, 'outline', ST_IsValid(g), ST_Area(g), (SELECT sum(ST_Area(geom)) FROM abacus_cells_geom('steps', max_edge => 2)) FROM abacus_hull_geom('steps', 2) AS g;
        INSERT INTO crowd SELECT seed, 'bands', bool_and(ST_IsValid(geom)), sum(ST_Area(geom)), ST_Area(abacus_hull_geom('steps')) FROM abacus_contours_geom('steps', 1, polygonize => true);
        INSERT INTO crowd SELECT seed, 'band', ST_IsValid(geom), ST_Area(geom), (SELECT sum(ST_Area(ST_MakePolygon(line)) * CASE WHEN ST_IsPolygonCCW(ST_MakePolygon(line)) THEN 1 ELSE -1 END)
            FROM (SELECT _abacus_line(path, 2, 0) AS line FROM abacus_contours('steps', 1, polygonize => true) AS r WHERE r.value = b.value) AS l) FROM abacus_contours_geom('steps', 1, polygonize => true) AS b;
    END LOOP;
END $$;
SELECT cmp_ok((SELECT count(*) FROM crowd), '>', 36::bigint, 'outlines and bands whose rings touch');
SELECT is_empty($$ SELECT * FROM crowd WHERE NOT valid $$, 'are valid');
SELECT is_empty($$ SELECT * FROM crowd WHERE abs(area - wanted) > 1e-6 $$, 'and have the areas of their cells and rings');

-- ---- Drape and clip --------------------------------------------------------

CREATE TABLE road AS SELECT 'SRID=2154;LINESTRING(10 10, 60 70, 110 30)'::geometry AS geom;
SELECT is(ST_NPoints(abacus_drape('terrain', geom)), 3, 'a draped line has its own places') FROM road;
SELECT ok(ST_Force2D(abacus_drape('terrain', geom)) = geom AND ST_SRID(abacus_drape('terrain', geom)) = 2154, 'where they were') FROM road;
SELECT is_empty($$ SELECT FROM road, ST_DumpPoints(abacus_drape('terrain', geom, densify => true)) AS d WHERE abs(ST_Z(d.geom) - abacus_interpolate('terrain', ST_Force2D(d.geom))) > 1e-6 $$, 'z is the height of the terrain');
SELECT is(ST_NPoints(abacus_drape('terrain', geom, 'height', true)), (SELECT count(*)::int FROM abacus_profile_geom('terrain', geom)), 'densified it has a place at each edge') FROM road;
SELECT is(ST_NPoints(abacus_drape('terrain', geom, 'height', true)), 2 + (SELECT count(*)::int FROM abacus_edges_geom('terrain') AS e WHERE ST_Crosses(e.geom, road.geom)), 'that PostGIS finds') FROM (SELECT 'SRID=2154;LINESTRING(10.03 10.07, 60.01 70.09)'::geometry AS geom) AS road;
SELECT is(ST_AsText(abacus_drape('terrain', 'SRID=2154;POINT(-50 -50)')), 'POINT Z (-50 -50 NaN)', 'outside there is no z');
SELECT is(ST_Z(abacus_drape('terrain', 'SRID=2154;POINT(-50 -50)', outside => 'nearest')), (SELECT attributes[1] FROM abacus_nearest('terrain', -50, -50)), 'or that of the nearest point');
SELECT is((SELECT count(*) FROM ST_DumpPoints(abacus_drape('terrain', 'SRID=2154;LINESTRING(-20 50, 50 50)', densify => true)) AS d WHERE ST_Z(d.geom) = 'NaN'), 1::bigint, 'a line that comes in has a z from the border on');
SELECT is(ST_AsText(abacus_drape('terrain', 'SRID=2154;LINESTRING M (50 50 10, 50 50 20)', densify => true), 0), format('LINESTRING ZM (50 50 %1$s 10,50 50 %1$s 20)', round(abacus_interpolate('terrain', 50, 50)::numeric)), 'm is kept, and lines of no length are');
SELECT ok(ST_IsValid(abacus_drape('terrain', ST_Buffer('SRID=2154;POINT(60 60)', 20), densify => true)) AND ST_IsClosed(ST_ExteriorRing(abacus_drape('terrain', ST_Buffer('SRID=2154;POINT(60 60)', 20), densify => true))), 'polygons stay closed and valid');
SELECT is(ST_AsText(abacus_drape('terrain', 'SRID=2154;GEOMETRYCOLLECTION(POINT EMPTY, MULTILINESTRING EMPTY, POLYGON EMPTY)')), 'GEOMETRYCOLLECTION Z (POINT Z EMPTY,MULTILINESTRING Z EMPTY,POLYGON Z EMPTY)', 'empty geometries stay so');
SELECT throws_ok($$ SELECT abacus_drape('terrain', 'SRID=2154;CIRCULARSTRING(0 0, 1 1, 2 0)') $$, '22023', 'the geometry is a CircularString, not made of points, lines or polygons', 'curves are refused');
SELECT throws_ok($$ SELECT abacus_drape('terrain', 'SRID=4326;POINT(1 1)') $$, '22023', 'the geometry has SRID 4326, but the mesh has SRID 2154', 'another SRID');

CREATE TABLE field AS SELECT ST_Difference(ST_Buffer('SRID=2154;POINT(60 60)', 30), ST_Buffer('SRID=2154;POINT(70 60)', 9)) AS geom;
SELECT is((SELECT round(sum(ST_Area(c.geom))::numeric, 6) FROM field, abacus_clip('terrain', field.geom) AS c), (SELECT round(ST_Area(geom)::numeric, 6) FROM field), 'clipped cells fill the area');
SELECT is_empty($$ SELECT FROM field, abacus_clip('terrain', field.geom) AS c WHERE NOT ST_IsValid(c.geom) OR ST_Dimension(c.geom) <> 2 OR ST_SRID(c.geom) <> 2154 $$, 'and are valid');
SELECT set_eq($$ SELECT v0, v1, v2 FROM field, abacus_clip('terrain', field.geom) AS c WHERE whole $$, $$ SELECT v0, v1, v2 FROM field, cells AS c WHERE ST_Contains(field.geom, c.geom) $$, 'those wholly inside are whole');
SELECT is_empty($$ SELECT FROM field, abacus_clip('terrain', field.geom, 'height') AS c JOIN cells USING (v0, v1, v2) WHERE whole AND NOT ST_OrderingEquals(c.geom, cells.geom) $$, 'as they are');
SELECT is_empty($$ SELECT FROM field, abacus_clip('terrain', field.geom, 'height') AS c, ST_DumpPoints(c.geom) AS d WHERE abs(ST_Z(d.geom) - abacus_interpolate('terrain', ST_Force2D(d.geom), outside => 'nearest')) > 1e-6 $$, 'all with the height of the terrain');
-- Places on slanting edges of the hull are rounded to the inside or the outside.
SELECT abacus_triangulate('slant', 'VALUES (1, 0, 0, 10), (2, 70, 10, 20), (3, 10, 90, 30)', '{height}');
SELECT results_eq($$ SELECT count(*) > 200, max(abs(ST_Z(d.geom) - 10 - ST_X(d.geom) * 70 / 620 - ST_Y(d.geom) * 130 / 620)) < 1e-9
    FROM generate_series(0.37, 60, 0.37) AS x, abacus_clip('slant', ST_MakeEnvelope(-1, -1, x, 91), 'height') AS c, ST_DumpPoints(c.geom) AS d $$,
    'VALUES (true, true)', 'a cut place on the hull has the height of its triangle');
SELECT is((SELECT count(*) FROM abacus_clip('terrain', 'SRID=2154;POLYGON EMPTY')), 0::bigint, 'an empty area has none');
SELECT is((SELECT count(*) FROM abacus_clip('terrain', ST_MakeEnvelope(9000, 9000, 9001, 9001, 2154))), 0::bigint, 'nor has one far outside');
SELECT is((SELECT count(*) FROM abacus_clip('terrain', NULL)), 0::bigint, 'nor has NULL');
SELECT throws_ok($$ SELECT * FROM abacus_clip('terrain', 'SRID=2154;LINESTRING(0 0, 1 1)') $$, '22023', 'the geometry is a LineString, not a Polygon or MultiPolygon', 'a line is no area');
SELECT throws_ok($$ SELECT * FROM abacus_clip('terrain', ST_MakeEnvelope(0, 0, 1, 1, 4326)) $$, '22023', 'the geometry has SRID 4326, but the mesh has SRID 2154', 'another SRID');
SELECT throws_ok(format('SELECT * FROM abacus_clip(%L, %L)', 'terrain', 'SRID=2154;' || area), '22023', 'area is not a polygon that can be used', 'invalid: ' || area)
    FROM (VALUES ('POLYGON((0 0, 5 5, 0 5, 5 0, 0 0))'), ('POLYGON Z((0 0 1, 5 5 1, 0 5 1, 5 0 1, 0 0 1))'), ('POLYGON M((0 0 1, 5 5 1, 0 5 1, 5 0 1, 0 0 1))'),
        ('MULTIPOLYGON(((1 1, 50 1, 50 50, 1 1)), ((20 20, 90 60, 90 90, 20 20)))'), ('POLYGON((1 1, 20 1, 20 NaN, 1 1))')) AS v(area);
SELECT throws_ok(format('SELECT * FROM abacus_clip(%L, ST_MakeEnvelope(1, 1, 20, 20, 2154), within => %L)', 'terrain', within), '22023', 'within is not a polygon that can be used', 'invalid: ' || within)
    FROM (VALUES ('POLYGON((0 0, 5 5, 0 5, 5 0, 0 0))'), ('POLYGON((1 1, 20 1, 20 20, 1 20))'), ('POINT(1 1)')) AS v(within);
SELECT ok((SELECT count(*) FROM abacus_clip('terrain', ST_Force4D(ST_MakeEnvelope(1, 1, 20, 20, 2154)))) > 0, 'an area may have z and m');
SELECT throws_ok($$ SELECT * FROM abacus_edges_geom('terrain', 'SRID=2154;LINESTRING(0 0, NaN 5)'::geometry) $$, '22023', 'a coordinate of the geometry is not finite', 'bounds are finite');
SELECT throws_ok($$ SELECT * FROM abacus_profile_geom('terrain', 'SRID=2154;LINESTRING(0 0, NaN 5)'::geometry) $$, '22023', 'a coordinate of the geometry is not finite', 'and so is a path');

-- ---- In space --------------------------------------------------------------

CREATE TABLE rock AS SELECT 100 * x + 10 * y + z AS id, ST_MakePoint(x, y, -z) AS geom, 300 + 40 * z + 10 * x AS vs FROM generate_series(0, 8) AS x, generate_series(0, 8) AS y, generate_series(0, 4) AS z;
SELECT is(abacus_triangulate('rocks', 'TABLE rock', dimension => 3), 1536::bigint, 'points with z make tetrahedra');
SELECT is((SELECT count(*) FROM abacus_cells_geom('rocks') WHERE GeometryType(geom) = 'POLYHEDRALSURFACE' AND (SELECT count(*) FROM ST_Dump(geom)) = 4 AND ST_IsClosed(geom)), 1536::bigint, 'which are closed surfaces');
SELECT is(abacus_interpolate('rocks', ST_MakePoint(1.25, 2, -0.5)), 332.5::float8, 'a value in space');
SELECT is(abacus_locate('rocks', ST_MakePoint(1.25, 2.3, -0.4)), abacus_locate('rocks', 1.25, 2.3, -0.4), 'a tetrahedron');
SELECT is((SELECT count(*) FROM abacus_cells_geom('rocks', ST_MakeEnvelope(1.2, 1.2, 1.4, 1.4))), (SELECT count(*) FROM abacus_cells('rocks', ARRAY[1.2, 1.2, -1000], ARRAY[1.4, 1.4, 1000])), 'a window without z goes from the bottom to the top');
SELECT is((SELECT count(*) FROM abacus_cells_geom('rocks', 'LINESTRING Z (1.2 1.2 -0.6, 1.4 1.4 -0.4)')), (SELECT count(*) FROM abacus_cells('rocks', ARRAY[1.2, 1.2, -0.6], ARRAY[1.4, 1.4, -0.4])), 'one with z is a box');
-- foreign tables have the same geometries, bit by bit
SELECT abacus_publish('rocks'), abacus_publish('terrain', z => 'height');
SELECT set_eq('SELECT v0, v1, v2, v3, ST_AsEWKB(geom) FROM rocks_cells', 'SELECT v0, v1, v2, v3, ST_AsEWKB(geom) FROM abacus_cells_geom(''rocks'')', 'a foreign table has these tetrahedra');
SELECT set_eq('SELECT v0, v1, v2, ST_AsEWKB(geom) FROM terrain_cells', 'SELECT v0, v1, v2, ST_AsEWKB(geom) FROM cells', 'and triangles');
SELECT set_eq('SELECT id, ST_AsEWKB(geom) FROM rocks_points', 'SELECT id, ST_AsEWKB(geom) FROM abacus_vertices_geom(''rocks'')', 'and points');
SELECT abacus_unpublish('rocks'), abacus_unpublish('terrain');
SELECT is((SELECT count(*) FROM ST_Dump(abacus_hull_geom('rocks'))), (SELECT count(DISTINCT ring) FROM abacus_hull('rocks')), 'the hull is a TIN');
SELECT ok(ST_IsClosed(abacus_hull_geom('rocks')) AND GeometryType(abacus_hull_geom('rocks')) = 'TIN', 'closed');
SELECT is((SELECT count(*) FROM abacus_isosurface_geom('rocks', 345) WHERE GeometryType(geom) = 'TRIANGLE'), (SELECT count(*) FROM abacus_isosurface('rocks', 345)), 'an isosurface');
SELECT is((SELECT round(sum(ST_Area(ST_MakePolygon(ST_MakeLine(ARRAY(SELECT ST_MakePoint(ST_Y(d.geom), ST_Z(d.geom)) FROM ST_DumpPoints(s.geom) AS d)))))::numeric, 9) FROM abacus_section_geom('rocks', 'POINT Z (0.5 0 0)', '{1,0,0}') AS s), 32.000000000, 'a section');
SELECT throws_ok($$ SELECT * FROM abacus_section_geom('rocks', 'POINT(0.5 0)', '{0,0,1}') $$, '22023', 'the geometry has no z, but the mesh has dimension 3', 'a section through a point without z');
SELECT throws_ok($$ SELECT * FROM abacus_section_geom('rocks', 'LINESTRING Z (0.5 0 0, 1 1 1)', '{0,0,1}') $$, '22023', 'the geometry is a LineString, not a Point', 'a section through a line');
SELECT is_empty($$ SELECT * FROM abacus_section_geom('rocks', 'POINT Z EMPTY', '{0,0,1}') $$, 'a section through nothing');
SELECT is((SELECT count(*) FROM abacus_voronoi_facets_geom('rocks') WHERE vertex = 111 AND GeometryType(geom) = 'POLYGON' AND ST_ZMFlag(geom) = 2), 6::bigint, 'facets of Voronoi cells');
SELECT throws_ok($$ SELECT abacus_locate('rocks', ST_MakePoint(1, 2)) $$, '22023', 'the geometry has no z, but the mesh has dimension 3', 'z is missing');
SELECT throws_ok($$ SELECT abacus_insert('rocks', 'SELECT 9, ST_MakePoint(1, 2), 300') $$, '22023', 'geometry of point 9 has no z, but the mesh has dimension 3', 'of a point as well');
SELECT throws_ok($$ SELECT abacus_drape('rocks', ST_MakePoint(1, 2)) $$, '22023', 'mesh has dimension 3, not 2', 'nothing is draped in space');
SELECT throws_ok($$ SELECT * FROM abacus_clip('rocks', ST_MakeEnvelope(0, 0, 1, 1)) $$, '22023', 'mesh has dimension 3, not 2', 'nor clipped');

-- ---- Tables that a mesh follows --------------------------------------------

CREATE FUNCTION differences(mesh regclass, "table" regclass) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    here text := format('SELECT id, ST_X(geom), ST_Y(geom), height FROM %s WHERE geom IS NOT NULL', "table");
    there text := format('SELECT id, x, y, attributes[1] FROM abacus_vertices(%L)', mesh);
    n bigint;
BEGIN
    EXECUTE format('SELECT (SELECT count(*) FROM (%1$s EXCEPT ALL %2$s) a) + (SELECT count(*) FROM (%2$s EXCEPT ALL %1$s) b) + (SELECT count(*) FROM abacus_check(%3$L))', here, there, mesh) INTO n;
    RETURN n;
END $$;
CREATE TABLE wells (id int PRIMARY KEY, name text, geom geometry, height float8);
INSERT INTO wells SELECT i, 'well', ST_SetSRID(ST_MakePoint((i * 37) % 101, (i * 53) % 97), 2154), i FROM generate_series(1, 300) AS i;
INSERT INTO wells VALUES (1000, 'nowhere', NULL, 5);
SELECT abacus_create('followed', 2, '{height}');
SELECT is(abacus_track('followed', 'wells'), 300::bigint, 'a table with one geometry is tracked');
SELECT is(abacus_srid('followed'), 2154, 'and its SRID taken');
SELECT is(differences('followed', 'wells'), 0::bigint, 'with all its points');
INSERT INTO wells SELECT i, 'new', ST_SetSRID(ST_MakePoint(i * 0.7, i * 0.3), 2154), i FROM generate_series(2000, 2100) AS i;
SELECT is(differences('followed', 'wells'), 0::bigint, 'INSERT');
UPDATE wells SET geom = ST_Translate(geom, 0.1, 0.2) WHERE id % 7 = 0;
SELECT is(differences('followed', 'wells'), 0::bigint, 'UPDATE of geometries');
UPDATE wells SET geom = NULL WHERE id % 11 = 0;
UPDATE wells SET geom = 'SRID=2154;POINT(3 4)', height = 6 WHERE id = 1000;
UPDATE wells SET height = height + 1 WHERE id % 5 = 0;
SELECT is(differences('followed', 'wells'), 0::bigint, 'points lose and get their place, and other heights');
UPDATE wells SET name = 'old', geom = geom;
DELETE FROM wells WHERE id % 3 = 0;
SELECT is(differences('followed', 'wells'), 0::bigint, 'DELETE');
SELECT throws_ok($$ INSERT INTO wells VALUES (3000, 'far', 'SRID=4326;POINT(5 43)', 1) $$, '22023', 'geometry of point 3000 has SRID 4326, but the mesh has SRID 2154', 'another SRID');
SELECT throws_ok($$ INSERT INTO wells VALUES (3000, 'empty', 'SRID=2154;POINT EMPTY', 1) $$, '22023', 'geometry of point 3000 is empty', 'an empty point');
SELECT throws_ok($$ UPDATE wells SET geom = ST_Buffer(geom, 1) WHERE id = 1000 $$, '22023', 'geometry of point 1000 is a Polygon, not a Point', 'no point');
SELECT abacus_untrack('followed', 'wells');
DELETE FROM wells WHERE id % 4 = 0;
SELECT throws_like($$ SELECT abacus_track('followed', 'wells') $$, '%does not hold the points of table%', 'a mesh that is not in step');
SELECT lives_ok($$ SELECT abacus_track('followed', 'wells', '{id,geom,height}', synchronize => true) $$, 'is brought in step');
SELECT is(differences('followed', 'wells'), 0::bigint, 'by the coordinates');
SELECT abacus_untrack('followed', 'wells');
INSERT INTO wells VALUES (3000, 'far', 'SRID=4326;POINT(5 43)', 1);
SELECT throws_ok($$ SELECT abacus_track('followed', 'wells', synchronize => true) $$, '22023', 'geometry of point 3000 has SRID 4326, but the mesh has SRID 2154', 'unless it is of another SRID');
DELETE FROM wells WHERE id = 3000;
SELECT abacus_track('followed', 'wells', '{id,geom,height}', synchronize => true);
TRUNCATE wells;
SELECT is((SELECT count(*) FROM abacus_vertices('followed')), 0::bigint, 'TRUNCATE');
SELECT throws_ok($$ SELECT abacus_track('followed', 'wells', '{id,geom}') $$, '2202E', 'columns has 2 elements, but points of the mesh have 3', 'an attribute is missing');
SELECT throws_ok($$ SELECT abacus_track('followed', 'wells', '{id,height,geom}') $$, '2202E', 'columns has 3 elements, but points of the mesh have 4', 'a geometry elsewhere');
-- The z of a geometry is an attribute: of its own accord where one column is missing, and on wish.
CREATE TABLE lidar (id bigint PRIMARY KEY, geom geometry(PointZ, 2154), class int);
INSERT INTO lidar SELECT i, ST_SetSRID(ST_MakePoint((i * 37) % 101, (i * 53) % 97, i / 4.0), 2154), i % 3 FROM generate_series(1, 200) AS i;
SELECT abacus_create('ground', 2, '{height,class}'), abacus_create('heights', 2, '{z}'), abacus_create('two', 2, '{height,depth}'), abacus_create('flat_heights', 2, '{z}');
SELECT is(abacus_track('ground', 'lidar'), 200::bigint, 'a table with PointZ is tracked');
SELECT is(abacus_track('heights', 'lidar', '{id,geom,geom}', deferred => true), 200::bigint, 'its z by name');
CREATE FUNCTION pg_temp.z_agree(what text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    SET CONSTRAINTS ALL IMMEDIATE;
    RETURN NEXT is_empty('SELECT id, ST_X(geom), ST_Y(geom), ARRAY[ST_Z(geom), class] FROM lidar WHERE geom IS NOT NULL EXCEPT SELECT id, x, y, attributes FROM abacus_vertices(''ground'')', 'z and class: ' || what);
    RETURN NEXT is_empty('SELECT id, ST_X(geom), ST_Y(geom), ARRAY[ST_Z(geom)] FROM lidar WHERE geom IS NOT NULL EXCEPT SELECT id, x, y, attributes FROM abacus_vertices(''heights'')', 'z: ' || what);
    RETURN NEXT is((SELECT count(*) FROM abacus_vertices('ground')), (SELECT count(*) FROM lidar WHERE geom IS NOT NULL), 'no more: ' || what);
    SET CONSTRAINTS ALL DEFERRED;
END $$;
SELECT * FROM pg_temp.z_agree('at first');
UPDATE lidar SET geom = ST_Translate(geom, 0, 0, 5) WHERE id % 3 = 0;
SELECT * FROM pg_temp.z_agree('z alone changes');
UPDATE lidar SET class = 9 WHERE id % 5 = 0;
SELECT * FROM pg_temp.z_agree('another attribute');
UPDATE lidar SET geom = NULL WHERE id % 7 = 0;
DELETE FROM lidar WHERE id % 11 = 0;
INSERT INTO lidar SELECT i, ST_SetSRID(ST_MakePoint(i * 0.1, i * 0.03, -i), 2154), 2 FROM generate_series(1001, 1050) AS i;
SELECT * FROM pg_temp.z_agree('rows come and go');
SELECT is(abacus_track('ground', 'lidar', synchronize => true), (SELECT count(*) FROM lidar WHERE geom IS NOT NULL), 'it is in step with the table');
SELECT throws_ok($$ SELECT abacus_track('two', 'lidar') $$, '42703', 'column "height" of table "lidar" does not exist', 'one z does not make two attributes');
SELECT throws_ok($$ SELECT abacus_track('heights', 'lidar', '{id,geom,ST_Z(geom)}') $$, '42703', 'column "ST_Z(geom)" of table "lidar" does not exist', 'an expression is no column');
SELECT throws_ok($$ SELECT abacus_insert('flat_heights', 'SELECT id, geom, geom FROM lidar') $$, '42804', 'column 3 (z) of the source query has type geometry', 'queries have expressions for that');
CREATE TABLE pairs (id int, a geometry, b geometry);
SELECT abacus_create('paired', 2);
SELECT throws_ok($$ SELECT abacus_track('paired', 'pairs') $$, '42703', 'column "x" of table "pairs" does not exist', 'of two geometries one must be named');
SELECT is(abacus_track('paired', 'pairs', '{id,b}'), 0::bigint, 'which can be done');
INSERT INTO pairs SELECT i, NULL, ST_SetSRID(ST_MakePoint(i, i * i), 3857) FROM generate_series(1, 9) AS i;
SELECT is(abacus_srid('paired'), 3857, 'the SRID of the first statement is taken');
SELECT throws_ok($$ INSERT INTO pairs VALUES (10, NULL, 'SRID=4326;POINT(5 43)') $$, '22023', 'geometry of point 10 has SRID 4326, but the mesh has SRID 3857', 'and holds for the next');

-- at commit, and with partitions
CREATE TABLE parts (id int, geom geometry, height float8) PARTITION BY RANGE (id);
CREATE TABLE parts_low PARTITION OF parts FOR VALUES FROM (0) TO (100);
CREATE TABLE parts_high PARTITION OF parts FOR VALUES FROM (100) TO (1000);
SELECT abacus_create('late', 2, '{height}');
SELECT abacus_track('late', 'parts', deferred => true);
INSERT INTO parts SELECT i, ST_SetSRID(ST_MakePoint((i * 37) % 101, (i * 53) % 97), 2154), i FROM generate_series(1, 300) AS i;
SELECT throws_ok($$ INSERT INTO parts VALUES (301, 'SRID=4326;POINT(5 43)', 1) $$, '22023', 'geometry of point 301 has SRID 4326, but the mesh has SRID 2154', 'geometries that wait for the commit have one SRID');
UPDATE parts SET geom = ST_Translate(geom, 0.5, 0.5), id = id + 90 WHERE id < 50;
DELETE FROM parts WHERE id % 9 = 0;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is(differences('late', 'parts'), 0::bigint, 'a mesh that follows partitions at commit');
SELECT is(abacus_srid('late'), 2154, 'takes their SRID');
TRUNCATE parts_low;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is(differences('late', 'parts'), 0::bigint, 'and follows when one is emptied');
CREATE TABLE caves (id int, geom geometry(PointZ, 2154));
SELECT abacus_create('deep', 3);
SELECT abacus_track('deep', 'caves');
INSERT INTO caves SELECT i, ST_SetSRID(ST_MakePoint((i * 37) % 101, (i * 53) % 97, i % 89), 2154) FROM generate_series(1, 100) AS i;
DELETE FROM caves WHERE id = 50;
SELECT is((SELECT count(*) FROM (SELECT id, ST_X(geom), ST_Y(geom), ST_Z(geom) FROM caves EXCEPT SELECT id, x, y, z FROM abacus_vertices('deep')) AS d), 0::bigint, 'in space');
SELECT is(abacus_track('deep', 'caves'), 99::bigint, 'tracked again it is in step');

-- ---- Rasters ---------------------------------------------------------------

SELECT EXISTS (SELECT FROM pg_available_extensions WHERE name = 'postgis_raster') AS rasters \gset
\if :rasters
CREATE EXTENSION postgis_raster SCHEMA gis;
CREATE EXTENSION abacus_postgis_raster;
CREATE TABLE pictures AS SELECT * FROM (VALUES ('north up', ST_MakeEmptyRaster(40, 25, -3, 120, 3, -2.5, 0, 0, 2154)), ('upside down', ST_MakeEmptyRaster(40, 25, -3, 20, 3, 2.5, 0, 0, 2154)), ('turned', ST_MakeEmptyRaster(40, 25, 20, 60, 2, 1.5, 0.5, -0.75, 2154))) AS p (name, rast);
CREATE VIEW pixels AS SELECT name, p.* FROM (SELECT name, abacus_raster('terrain', rast) AS rast FROM pictures) AS r, ST_PixelAsCentroids(rast, 1, true) AS p;
SELECT is((SELECT count(*) FROM pixels WHERE name = 'north up' AND abs(val - abacus_interpolate('terrain', geom)) < 1e-9), (SELECT count(*) FROM pictures, ST_PixelAsCentroids(ST_AddBand(rast, '8BUI'), 1, false) WHERE name = 'north up' AND abacus_interpolate('terrain', geom) IS NOT NULL), 'a raster has the values of the mesh');
SELECT is((SELECT count(*) FROM pixels WHERE val = abacus_interpolate('terrain', geom)), (SELECT count(*) FROM pictures, ST_PixelAsCentroids(ST_AddBand(rast, '8BUI'), 1, false) WHERE abacus_interpolate('terrain', geom) IS NOT NULL), 'whichever way it is turned');
SELECT is((SELECT count(*) FROM pixels), (SELECT count(*) FROM pixels WHERE abacus_interpolate('terrain', geom) IS NOT NULL), 'and no data outside');
SELECT is_empty($$ SELECT FROM pictures WHERE (ST_Width(rast), ST_Height(rast), ST_GeoReference(rast), ST_SRID(rast)) <> (SELECT ST_Width(r), ST_Height(r), ST_GeoReference(r), ST_SRID(r) FROM abacus_raster('terrain', rast) AS r) $$, 'it lies where the other one does');
SELECT is((SELECT ST_Count(abacus_raster('terrain', rast, 'height', outside => 'nearest')) FROM pictures WHERE name = 'north up'), 1000::bigint, 'with outside => nearest all pixels have a value');
SELECT is(abacus_raster('terrain', NULL::raster), NULL, 'of no raster');
SELECT is(abacus_raster('terrain', ST_MakeEmptyRaster(0, 0, 0, 0, 1, -1, 0, 0, 2154)), NULL, 'of an empty one');
SELECT throws_ok($$ SELECT abacus_raster('terrain', ST_MakeEmptyRaster(4, 4, 0, 0, 1, -1, 0, 0, 4326)) $$, '22023', 'the geometry has SRID 4326, but the mesh has SRID 2154', 'of one of another SRID');
SELECT throws_ok($$ SELECT abacus_raster('rocks', ST_MakeEmptyRaster(4, 4, 0, 0, 1, -1, 0, 0, 0)) $$, '22023', 'mesh has dimension 3, not 2', 'of a mesh in space');
SELECT is((SELECT count(*) FROM abacus_raster('terrain', '{0,0}', '{4,3}', 2, 2)), 2::bigint, 'rows of arrays are still there');
\endif

-- ---- Schemas and privileges ------------------------------------------------

SET LOCAL search_path = pg_catalog;
SELECT count(*) AS clipped FROM public.abacus_clip('public.terrain', 'SRID=2154;POLYGON((50 50, 60 50, 60 60, 50 50))'::gis.geometry, 'height') \gset
SET LOCAL search_path = public, gis;
SELECT is(:clipped::bigint, (SELECT count(*) FROM cells WHERE ST_Area(ST_Intersection(geom, 'SRID=2154;POLYGON((50 50, 60 50, 60 60, 50 50))'::geometry)) > 0), 'no search_path is needed');
CREATE SCHEMA elsewhere;
ALTER EXTENSION abacus_postgis SET SCHEMA elsewhere;
SELECT is((SELECT count(*) FROM elsewhere.abacus_edges_geom('small')), (SELECT count(*) FROM abacus_edges('small')), 'nor when it has moved');
ALTER EXTENSION abacus_postgis SET SCHEMA public;
CREATE ROLE abacus_gis_user;
GRANT USAGE ON SCHEMA gis TO abacus_gis_user;
SET ROLE abacus_gis_user;
SELECT throws_ok($$ SELECT abacus_locate('terrain', 'SRID=2154;POINT(1 1)'::geometry) $$, '42501', 'permission denied for table terrain', 'without SELECT a mesh is not asked');
SELECT throws_ok($$ SELECT * FROM abacus_cells_geom('terrain') $$, '42501', 'permission denied for table terrain', 'nor are its cells');
SELECT throws_ok($$ SELECT abacus_drape('terrain', 'SRID=2154;POINT(1 1)') $$, '42501', 'permission denied for table terrain', 'nor its heights');
SELECT throws_ok($$ SELECT abacus_cells_geom('terrain', ST_MakeEnvelope(0, 0, 1, 1, 4326)) $$, '42501', 'permission denied for table terrain', 'nor its SRID');
RESET ROLE;

-- wrong arguments of internal functions
SELECT throws_ok($$ SELECT _abacus_nest('LINESTRING(0 0, 1 1)') $$, '22023', NULL, 'no rings');
SELECT throws_ok($$ SELECT _abacus_nest('MULTILINESTRING((0 0, 0 9, 9 0, 0 0))') $$, '22023', 'a hole does not lie in an outline', 'a hole alone');
SELECT is(ST_AsText(_abacus_nest('MULTILINESTRING((0 0, 9 0, 9 0, 0 9, 0 0, 0 0))')), 'POLYGON((0 0,9 0,0 9,0 0))', 'places that are repeated');
SELECT throws_ok($$ SELECT _abacus_nest('MULTILINESTRING Z ((0 0 0, 0 9 0, 9 0 0, 0 0 0))') $$, '22023', NULL, 'rings in space');
SELECT is(ST_AsText(_abacus_nest('MULTILINESTRING((0 0, 0 0, 0 0), (0 0, 1 1, 0 0, 0 0), EMPTY)')), 'MULTIPOLYGON EMPTY', 'a ring without area');
SELECT throws_ok($$ SELECT _abacus_line('{1,2,3}', 2, 0) $$, '2202E', NULL, 'half a place');
SELECT throws_ok($$ SELECT _abacus_line('{1,2,3,NULL}', 2, 0) $$, '2202E', NULL, 'a NULL');
SELECT throws_ok($$ SELECT _abacus_cell('{1,2,3}', '{}', NULL, 0) $$, '2202E', NULL, 'half a cell');
SELECT throws_ok($$ SELECT _abacus_cell('{1,2,3,4,5,6}', '{1,2,3}', 2, 0) $$, '2202E', NULL, 'no such attribute');
SELECT throws_ok($$ SELECT _abacus_corner('terrain', 2154, '{1}') $$, '2202E', NULL, 'half a corner');
SELECT throws_ok($$ SELECT _abacus_triangles('{1,2}', 0) $$, '2202E', NULL, 'half a triangle');

SELECT * FROM finish();
ROLLBACK;

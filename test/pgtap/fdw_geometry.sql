-- A mesh as foreign tables with geometries of PostGIS. A condition IS TRUE does not choose pages, so it gives
-- the expected rows.
BEGIN;
SELECT count(*) > 0 AS has_postgis FROM pg_available_extensions WHERE name = 'postgis' \gset
\if :has_postgis
SELECT no_plan();
SET client_min_messages = warning;
CREATE EXTENSION IF NOT EXISTS postgis;
RESET client_min_messages;

CREATE FUNCTION pg_temp.points(first int, last int)
    RETURNS TABLE (id int, x float8, y float8, z float8) LANGUAGE sql AS
    $$ SELECT i, i::bigint * 7919 % 100003 / 1e3, i::bigint * 104729 % 100019 / 1e3, i::bigint * 1299709 % 100043 / 1e3
       FROM generate_series(first, last) AS i $$;
CREATE FUNCTION pg_temp.plan_of(query text, key text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    plan jsonb;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON, ANALYZE, TIMING OFF) ' || query INTO plan;
    RETURN jsonb_path_query_first(plan, format('lax $.**."%s"', key)::jsonpath) #>> '{}';
END $$;
-- The rows of a table that meet a condition are those found among all rows.
CREATE FUNCTION pg_temp.finds(source text, condition text, what text) RETURNS text LANGUAGE sql AS $$
    SELECT set_eq(format('SELECT * FROM %s WHERE %s', source, condition), format('SELECT * FROM %s WHERE (%s) IS TRUE', source, condition), what)
$$;

-- A mesh with a slanted side of the hull, along which its triangles are long and fill little of their boxes.
SELECT abacus_triangulate('slanted', 'SELECT id, x, CASE WHEN id % 2 = 0 THEN x * (y / 100) ^ 4 ELSE y END AS y, z AS height, id AS number
    FROM (SELECT id, greatest(x, y) AS x, least(x, y) AS y, z FROM pg_temp.points(1, 6000)) AS p');
SELECT is(abacus_publish('slanted', srid => 25832, z => 'height')::text, '{slanted_cells,slanted_points,slanted_fixed_edges,slanted_breaklines}', 'published');
SELECT set_eq($$ SELECT f_table_name::text, f_geometry_column::text, coord_dimension, srid, type::text FROM geometry_columns WHERE f_table_name LIKE 'slanted%' $$,
    $$ VALUES ('slanted_cells', 'geom', 3, 25832, 'POLYGON'), ('slanted_points', 'geom', 3, 25832, 'POINT'),
       ('slanted_fixed_edges', 'geom', 3, 25832, 'LINESTRING'), ('slanted_breaklines', 'geom', 3, 25832, 'MULTILINESTRING') $$, 'geometry_columns has all');
SELECT is(count(*), 0::bigint, 'points are what their columns say') FROM slanted_points
WHERE NOT (ST_X(geom), ST_Y(geom), ST_Z(geom), ST_SRID(geom)) = (x, y, height, 25832);
SELECT is(count(*), 0::bigint, 'cells are the polygons of their corners') FROM slanted_cells
WHERE ST_AsBinary(geom) <> ST_AsBinary(ST_MakePolygon(ST_MakeLine(ARRAY(
    SELECT ST_MakePoint(corners[i % 3 + 1][1], corners[i % 3 + 1][2], "values"[i % 3 + 1][1]) FROM generate_series(0, 3) AS i))));
SELECT cmp_ok(abs(sum(ST_Area(geom)) / (SELECT ST_Area(ST_ConvexHull(ST_Collect(geom))) FROM slanted_points) - 1), '<', 1e-12::float8, 'they cover the hull once')
FROM slanted_cells;

-- Windows, as QGIS and GDAL ask for them.
SELECT pg_temp.finds('slanted_cells', format('geom && ST_MakeEnvelope(%s, %s, %s, %s, 25832)', x, y, x + w, y + w), format('cells in a window of %s at %s', w, n))
FROM (SELECT n, n * 37 % 100 AS x, n * 61 % 100 AS y, (n % 4) ^ 3 AS w FROM generate_series(1, 24) AS n) AS p;
SELECT pg_temp.finds('slanted_points', format('geom && ST_SetSRID(''BOX3D(%s %s, %s %s)''::box3d, 25832)', x, y, x + w, y + w), format('points in a window of %s at %s', w, n))
FROM (SELECT n, n * 37 % 100 AS x, n * 61 % 100 AS y, (n % 4) ^ 3 AS w FROM generate_series(1, 8) AS n) AS p;
SELECT cmp_ok(pg_temp.plan_of($$ SELECT * FROM slanted_points WHERE geom && ST_MakeEnvelope(50, 10, 51, 11, 25832) $$, 'Mesh Pages Read')::int, '<', 6, 'few pages are read');
SELECT cmp_ok(pg_temp.plan_of($$ SELECT * FROM slanted_cells WHERE ST_Intersects(geom, ST_MakeEnvelope(50, 10, 51, 11, 25832)) $$, 'Mesh Pages Read')::int, '<', 6, 'of cells as well');
SELECT cmp_ok((SELECT count(*) FROM slanted_cells WHERE geom && ST_MakeEnvelope(50, 50.5, 50.1, 50.6, 25832)), '>',
    (SELECT count(*) FROM abacus_cells('slanted', ARRAY[50, 50.5], ARRAY[50.1, 50.6])), 'some boxes meet a window that their cells do not');

-- Conditions that are true only if geometries meet.
SELECT pg_temp.finds('slanted_cells', format(condition, 'ST_Buffer(ST_SetSRID(ST_MakePoint(60, 20), 25832), 7)'), 'cells: ' || condition)
FROM unnest(ARRAY['ST_Intersects(geom, %s)', 'ST_Intersects(%s, geom)', 'ST_Within(geom, %s)', 'ST_Contains(%s, geom)', 'ST_CoveredBy(geom, %s)',
    'ST_Overlaps(geom, %s)', 'ST_Touches(geom, %s)', 'ST_DWithin(geom, %s, 1.5)', 'geom @ %s', '%s ~ geom', 'geom ~ %s', 'geom ~= %s', 'geom &&& %s',
    'geom && %s AND ST_Intersects(geom, ST_Translate(%1$s, 3, 3))']) AS condition;
SELECT pg_temp.finds('slanted_points', format(condition, 'ST_Buffer(ST_SetSRID(ST_MakePoint(60, 20), 25832), 7)'), 'points: ' || condition)
FROM unnest(ARRAY['ST_Intersects(geom, %s)', 'ST_Within(geom, %s)', 'ST_DWithin(geom, %s, 1.5)', 'geom && %s AND x > 58 AND y < 21 AND number < 3000',
    'geom && %s AND height BETWEEN 10 AND 20', 'NOT geom && %s', 'geom && %s OR x < 3']) AS condition;
SELECT pg_temp.finds('slanted_cells', 'ST_Equals(geom, (SELECT geom FROM slanted_cells ORDER BY v0, v1, v2 LIMIT 1))', 'a cell that is equal');
SELECT pg_temp.finds(source, condition, source || ': ' || condition)
FROM unnest(ARRAY['slanted_cells', 'slanted_points']) AS source, unnest(ARRAY['geom && ''SRID=25832;POINT EMPTY''', 'geom && NULL::geometry',
    'geom && ''SRID=25832;CIRCULARSTRING(40 10, 45 15, 50 10)''::geometry', 'geom && ''SRID=25832;MULTIPOINT(3 1, 5 4)''', 'geom && ''SRID=25832;POINT(-1e300 1e300)''',
    'geom && ''SRID=25832;LINESTRING(-1e300 0, 1e300 1)''', 'geom && ''SRID=25832;GEOMETRYCOLLECTION Z (POINT Z (50 30 1), LINESTRING Z (52 3 0, 56 31 9))''',
    'ST_Intersects(geom, ''SRID=25832;TIN M (((40 10 1, 44 10 1, 44 13 1, 40 10 1)))''::geometry)']) AS condition
WHERE condition !~ 'TIN' OR source = 'slanted_points';
SELECT throws_ok(format('SELECT count(*) FROM slanted_%s WHERE %s', what, condition), '22023', 'the geometry has ' || problem, format('%s: another SRID, %s', what, condition))
FROM unnest(ARRAY['cells', 'points']) AS what, (VALUES ('ST_Intersects(geom, ST_MakeEnvelope(50, 10, 51, 11, 4326))', 'SRID 4326, but the geometries of the foreign table have SRID 25832'),
    ('ST_Intersects(geom, ST_MakeEnvelope(5000, 10, 5100, 11, 4326))', 'SRID 4326, but the geometries of the foreign table have SRID 25832'),
    ('ST_DWithin(ST_MakePoint(-1e4, 5), geom, 2)', 'no SRID, but the geometries of the foreign table have SRID 25832'),
    ('ST_Within(geom, (SELECT ST_MakeEnvelope(5000, 10, 5100, 11, 3857)))', 'SRID 3857, but the geometries of the foreign table have SRID 25832')) AS c (condition, problem);
SELECT throws_ok(format('SELECT count(*) FROM slanted_%s WHERE ST_DWithin(geom, ''SRID=25832;POINT(50 10)'', -1)', what), 'XX000', NULL, what || ': a distance below 0')
FROM unnest(ARRAY['cells', 'points']) AS what;
SELECT pg_temp.finds('slanted_' || what, format('ST_DWithin(geom, ''SRID=25832;POINT(50 10)'', ''%s'')', distance), format('%s: a distance of %s', what, distance))
FROM unnest(ARRAY['cells', 'points']) AS what, unnest(ARRAY['NaN', 'Infinity', '0']) AS distance;
-- values that are known at run time
CREATE TEMP TABLE places AS SELECT n, ST_SetSRID(ST_MakePoint(n * 37 % 100, n * 17 % 50), 25832) AS place FROM generate_series(1, 20) AS n;
ANALYZE places;
SELECT set_eq('SELECT n, code, v0 FROM places JOIN slanted_cells ON ST_Intersects(geom, place)',
    'SELECT n, code, v0 FROM places JOIN slanted_cells ON ST_Intersects(geom, place) IS TRUE', 'a join on places');
SELECT set_eq('SELECT n, id FROM places JOIN slanted_points ON ST_DWithin(geom, place, n)',
    'SELECT n, id FROM places JOIN slanted_points ON ST_DWithin(geom, place, n) IS TRUE', 'a join on distances');
SELECT set_eq('SELECT n, count FROM places, LATERAL (SELECT count(*) FROM slanted_cells WHERE geom && ST_Expand(place, 3)) AS c WHERE count > 0',
    'SELECT n, count(*) FROM places JOIN slanted_cells ON (geom && ST_Expand(place, 3)) IS TRUE GROUP BY n', 'laterally');

-- The nearest to a place.
SELECT results_eq(format('SELECT id FROM slanted_points WHERE %s ORDER BY geom <-> %L LIMIT 50', condition, place),
    format('SELECT id FROM (SELECT id, ST_Distance(geom, %L) AS distance FROM slanted_points WHERE %s OFFSET 0) AS p ORDER BY distance LIMIT 50', place, condition),
    'nearest to ' || ST_AsText(place) || ' where ' || condition)
FROM (SELECT ST_SetSRID(ST_MakePoint(n * 37 % 150, n * 61 % 120), 25832) AS place FROM generate_series(1, 5) AS n) AS p, unnest(ARRAY['true', 'number::int % 7 = 0', 'x < 30', 'x < 1']) AS condition;
SELECT is(pg_temp.plan_of($$ SELECT id FROM slanted_points ORDER BY geom <-> 'SRID=25832;POINT(50 3)' LIMIT 5 $$, 'Nearest to'), '50, 3', 'by the mesh');
SELECT is(pg_temp.plan_of($$ SELECT id FROM slanted_points ORDER BY geom <-> 'SRID=25832;LINESTRING(50 3, 4 5)' LIMIT 5 $$, 'Nearest to'), NULL, 'not to a line');

-- A mesh in space; a missing Z; a mesh with a hole; an empty one.
SELECT abacus_triangulate('rock', 'SELECT *, id AS number FROM pg_temp.points(1, 1500)', dimension => 3);
SELECT abacus_publish('rock');
SELECT is(count(*), 0::bigint, 'facets of tetrahedra close them, outward') FROM rock_cells
WHERE NOT (ST_GeometryType(geom) = 'ST_PolyhedralSurface' AND ST_IsClosed(geom) AND (SELECT count(*) FROM ST_Dump(geom)) = 4);
SELECT pg_temp.finds('rock_cells', 'geom && ST_MakeEnvelope(20, 30, 24, 31)', 'tetrahedra over a window');
SELECT pg_temp.finds('rock_points', 'geom && ST_MakeEnvelope(20, 30, 54, 61) AND z < 30', 'points of a box');
SELECT abacus_triangulate('partial', 'VALUES (1, 0, 0, 1), (2, 4, 0, NULL), (3, 0, 4, 3)', '{height}');
SELECT abacus_publish('partial', z => 'height');
SELECT results_eq('SELECT ST_AsText(geom), height FROM partial_cells', $$ VALUES ('POLYGON Z ((0 0 1,4 0 NaN,0 4 3,0 0 1))', NULL::float8) $$, 'a missing value is no number');
SELECT abacus_load('ring', 'SELECT row_number() OVER () - 1, x, y FROM generate_series(0, 40) AS x, generate_series(0, 40) AS y',
    'SELECT v0, v1, v2 FROM generate_series(0, 39) AS i, generate_series(0, 39) AS j,
        LATERAL (VALUES (i * 41 + j, (i + 1) * 41 + j, i * 41 + j + 1), ((i + 1) * 41 + j + 1, i * 41 + j + 1, (i + 1) * 41 + j)) AS t (v0, v1, v2)
     WHERE NOT (i BETWEEN 10 AND 25 AND j BETWEEN 5 AND 30)');
SELECT abacus_publish('ring', srid => 3857);
SELECT pg_temp.finds('ring_cells', format('geom && ST_MakeEnvelope(%s, 3, %s, 12, 3857)', x, x + 3), 'a mesh with a hole at ' || x) FROM generate_series(-5, 45, 5) AS x;
SELECT pg_temp.finds('ring_points', 'geom && ST_MakeEnvelope(8, 3, 12, 9, 3857)', 'its points');
SELECT is(count(*), 0::bigint, 'nothing in the hole') FROM ring_cells WHERE ST_Intersects(geom, ST_MakeEnvelope(11.5, 6.5, 24, 29, 3857));
SELECT abacus_create('empty', 2);
SELECT abacus_publish('empty');
SELECT is_empty('SELECT FROM empty_cells WHERE geom && ST_MakeEnvelope(0, 0, 1, 1)', 'an empty mesh');
SELECT is_empty('SELECT FROM empty_points WHERE ST_Intersects(geom, ST_MakeEnvelope(0, 0, 1, 1))', 'its points');
SELECT throws_ok($$ SELECT abacus_publish('rock', 'a', 'b', z => 'number') $$, '22023', 'mesh has dimension 3, not 2', 'Z is taken');
SELECT throws_ok($$ SELECT abacus_publish('ring', 'a', 'b', geometry => false, srid => 5) $$, '22023', 'srid and z apply to geometries, but no geometries are published', 'no geometry');
SELECT throws_ok($$ SELECT abacus_publish('partial', 'a', 'b', z => 'depth') $$, '42703', NULL, 'no such attribute');
-- The SRID of the mesh, and one for a mesh without.
SELECT abacus_set_srid('partial', 2154);
SELECT abacus_publish('partial', 'own_cells', 'own_points');
SELECT abacus_publish('partial', 'same_cells', 'same_points', srid => 2154);
SELECT abacus_publish('partial', 'bare_cells', 'bare_points', geometry => false);
SELECT set_eq($$ SELECT f_table_name::text, srid FROM geometry_columns WHERE f_table_name ~ '^(partial|own|same|bare|empty|ring)_(cells|points)$' $$,
    $$ VALUES ('partial_cells', 0), ('partial_points', 0), ('own_cells', 2154), ('own_points', 2154), ('same_cells', 2154), ('same_points', 2154),
        ('empty_cells', 0), ('empty_points', 0), ('ring_cells', 3857), ('ring_points', 3857) $$, 'columns have the SRID of the mesh, or one that is given');
SELECT set_eq('SELECT ST_AsEWKT(geom) FROM own_points', $$ VALUES ('SRID=2154;POINT(0 0)'), ('SRID=2154;POINT(4 0)'), ('SRID=2154;POINT(0 4)') $$, 'points have it');
SELECT results_eq('SELECT ST_SRID(geom) FROM own_cells', 'VALUES (2154)', 'cells have it');
SELECT pg_temp.finds('own_points', 'geom && ST_MakeEnvelope(3, -1, 5, 1, 2154)', 'points in a window of the system');
SELECT throws_ok($$ SELECT abacus_publish('partial', 'a', 'b', srid => 4326) $$, '22023', 'srid is 4326, but the mesh has SRID 2154', 'another SRID');
SELECT throws_ok($$ SELECT abacus_publish('partial', 'a', 'b', srid => 0) $$, '22023', 'srid is 0, but the mesh has SRID 2154', 'none');
SELECT throws_ok($$ SELECT abacus_publish('partial', 'a', 'b', geometry => false, srid => 2154) $$, '22023', 'srid and z apply to geometries, but no geometries are published', 'no geometry to have it');
SELECT lives_ok('ANALYZE slanted_cells, slanted_points, rock_cells', 'ANALYZE');
-- Z is an attribute with a permanent number
SELECT abacus_triangulate('heights', 'VALUES (1, 0, 0, 7, 8, 9), (2, 4, 0, 7, 8, 9), (3, 0, 4, 7, 8, 9)', '{a,b,c}');
SELECT abacus_drop_attribute('heights', 'a');
SELECT abacus_publish('heights', 'c_cells', 'c_points', z => 'c'), abacus_publish('heights', 'b_cells', 'b_points', z => 'b');
CREATE ROLE pgtap_reader;
ALTER TABLE heights OWNER TO pgtap_reader;
ALTER TABLE heights_vertices OWNER TO pgtap_reader;
SET ROLE pgtap_reader;
SELECT abacus_drop_attribute('heights', 'b'), abacus_add_attribute('heights', 'd');
RESET ROLE;
SELECT is((SELECT array_agg(DISTINCT ST_Z(geom)) FROM c_points), '{9}', 'points have it where an attribute before it was dropped');
SELECT is((SELECT array_agg(DISTINCT ST_ZMax(geom)) FROM c_cells), '{9}', 'so have cells');
SELECT throws_ok('SELECT geom FROM ' || name, '42703', format('column "geom" of foreign table "%s" shows an attribute that mesh "heights" no longer has', name), 'one that was dropped is not another') FROM unnest('{b_points,b_cells}'::text[]) AS name;
SELECT is((SELECT array_agg(DISTINCT c) FROM b_points), '{9}', 'the others are there');
SELECT * FROM finish();
\else
SELECT plan(1);
SELECT skip('PostGIS is not installed', 1);
\endif
ROLLBACK;

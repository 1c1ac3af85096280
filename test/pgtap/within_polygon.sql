-- Questions within a polygon: of a mesh on a grid, whose edges and vertices polygons touch, and of one at random; against PostGIS.
BEGIN;
SELECT no_plan();
CREATE EXTENSION IF NOT EXISTS abacus_postgis CASCADE;

CREATE TABLE point AS SELECT (100 * x + y)::bigint AS id, x::float8, y::float8, ((x * 7 + y * 13) % 11)::float8 AS h FROM generate_series(0, 20) AS x, generate_series(0, 20) AS y;
CREATE FUNCTION pg_temp.part(v float8) RETURNS float8 LANGUAGE sql AS 'SELECT v - floor(v)';
SELECT abacus_triangulate('grid', 'TABLE point');
SELECT abacus_triangulate('wild', $$SELECT n::bigint AS id, 20 * pg_temp.part(sin(n) * 1000) AS x, 20 * pg_temp.part(cos(n * 1.7) * 1000) AS y, 11 * pg_temp.part(sin(3 * n) * 1000) AS h FROM generate_series(1, 800) AS n$$);
CREATE TABLE polygon (name text, g geometry);
INSERT INTO polygon VALUES
    ('on edges', 'POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))'),
    ('across', 'POLYGON((1.5 2.25, 17.25 1, 13.5 18.75, 8.125 5, 1.5 2.25))'),
    ('hole', 'POLYGON((0 0, 20 0, 20 20, 0 20, 0 0), (5 5, 5 10, 10 10, 10 5, 5 5))'),
    ('hole that touches', 'POLYGON((0 0, 20 0, 20 20, 0 20, 0 0), (0 10, 10 5, 10 15, 0 10))'),
    ('two parts', 'MULTIPOLYGON(((1 1, 5 1, 5 5, 1 1)), ((5 5, 9 5, 9 9.5, 5 5)), ((15 15, 30 15, 30 30, 15 15)))'),
    ('one triangle', 'POLYGON((3 3, 4 3, 4 4, 3 3))'),
    ('a sliver', 'POLYGON((1 1, 19 3.0001, 1 1.0001, 1 1))'),
    ('within a triangle', 'POLYGON((3.5 3.1, 3.9 3.1, 3.9 3.2, 3.5 3.1))'),
    ('around all', 'POLYGON((-5 -5, 25 -5, 25 25, -5 25, -5 -5))'),
    ('beside', 'POLYGON((-5 -5, -1 -5, -1 25, -5 -5))'),
    ('along the hull', 'POLYGON((20 0, 25 0, 25 20, 20 20, 20 0))'),
    ('empty', 'POLYGON EMPTY');

-- all that follows holds for both meshes
CREATE FUNCTION pg_temp.like(a float8, b float8) RETURNS boolean LANGUAGE sql AS 'SELECT abs(coalesce(a, 0) - coalesce(b, 0)) <= 1e-9 * (1 + abs(coalesce(a, 0)))';
CREATE FUNCTION pg_temp.agree(mesh regclass) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    p record;
    t text;
    cell record;
BEGIN
    CREATE TEMP TABLE cell AS SELECT code, ARRAY[v0, v1, v2] AS v, geom AS g FROM abacus_cells_geom(mesh);
    CREATE TEMP TABLE side AS SELECT e.v0, e.v1, e.geom AS g FROM abacus_edges_geom(mesh) AS e;
    CREATE TEMP TABLE level AS SELECT value, geom AS g FROM abacus_contours_geom(mesh, 2.5);
    FOR p IN TABLE polygon LOOP
        t := p.g::text;
        RETURN NEXT results_eq(format('SELECT code FROM abacus_cells(%L, within => %L) ORDER BY 1', mesh, t),
            format('SELECT code FROM cell WHERE ST_Relate(g, %L, ''T********'') ORDER BY 1', p.g), p.name || ': cells');
        RETURN NEXT results_eq(format('SELECT code FROM abacus_simplices(%L, within => %L) ORDER BY 1', mesh, ST_AsText(p.g)),
            format('SELECT code FROM cell WHERE ST_Relate(g, %L, ''T********'') ORDER BY 1', p.g), p.name || ': simplices');
        RETURN NEXT results_eq(format('SELECT v0, v1 FROM abacus_edges(%L, within => %L) ORDER BY 1, 2', mesh, t),
            format('SELECT v0, v1 FROM side WHERE ST_Length(ST_Intersection(g, %L)) > 0 ORDER BY 1, 2', p.g), p.name || ': edges');
        RETURN NEXT ok(pg_temp.like((SELECT area FROM abacus_volume(mesh, 5, within => t)), (SELECT sum(ST_Area(ST_Intersection(g, p.g))) FROM cell)), p.name || ': area');
        RETURN NEXT ok((SELECT pg_temp.like(v.cut + r.cut, w.cut) AND pg_temp.like(v.fill + r.fill, w.fill) AND pg_temp.like(v.surface + r.surface, w.surface)
            FROM abacus_volume(mesh, 5, within => t) AS v, abacus_volume(mesh, 5, within => ST_Difference('POLYGON((-9 -9, 29 -9, 29 29, -9 29, -9 -9))', p.g)::text) AS r, abacus_volume(mesh, 5) AS w),
            p.name || ': what is in it and what is not make up all');
        RETURN NEXT ok((SELECT pg_temp.like(v.cut, 2 * v.area) AND v.fill = 0 FROM abacus_volume(mesh, mesh || '_lower', within => t) AS v), p.name || ': between two meshes');
        RETURN NEXT ok(pg_temp.like((SELECT sum(ST_Length(geom)) FROM abacus_contours_geom(mesh, 2.5, within => t)),
            (SELECT sum(ST_Length(ST_Intersection(g, p.g))) FROM level)), p.name || ': contours');
        RETURN NEXT ok(pg_temp.like((SELECT sum(ST_Area(geom)) FROM abacus_contours_geom(mesh, 2.5, polygonize => true, within => t)),
            (SELECT area FROM abacus_volume(mesh, 5, within => t))), p.name || ': bands');
        RETURN NEXT ok((SELECT coalesce(ST_Equals(ST_Intersection(abacus_hull_geom(mesh), p.g), h), true) AND pg_temp.like(ST_Area(h), (SELECT area FROM abacus_volume(mesh, 5, within => t)))
            FROM abacus_hull_geom(mesh, within => t) AS h), p.name || ': hull');
        RETURN NEXT is((SELECT count(*) FROM point WHERE abacus_interpolate(mesh, x * 0.97 + 0.1, y * 0.95 + 0.2, within => t) IS NOT NULL),
            (SELECT count(*) FROM point WHERE abacus_interpolate(mesh, x * 0.97 + 0.1, y * 0.95 + 0.2) IS NOT NULL AND ST_Intersects(ST_Point(x * 0.97 + 0.1, y * 0.95 + 0.2), p.g)), p.name || ': values');
        RETURN NEXT is((SELECT count(*) FROM point WHERE abacus_interpolate(mesh, x, y, method => 'natural', within => t) IS NOT NULL),
            (SELECT count(*) FROM point WHERE abacus_interpolate(mesh, x, y) IS NOT NULL AND ST_Intersects(ST_Point(x, y), p.g)), p.name || ': values at corners');
        RETURN NEXT is((SELECT count(*) FROM abacus_interpolate(mesh, 'SELECT id, x, y FROM point', within => t) AS a WHERE a."values"[1] IS NOT NULL),
            (SELECT count(*) FROM point WHERE abacus_interpolate(mesh, x, y, within => t) IS NOT NULL), p.name || ': many places');
        RETURN NEXT is((SELECT count(v) FROM abacus_raster(mesh, '{0,0}', '{20,20}', 40, 40, within => t) AS r, unnest(r."values") AS v),
            (SELECT count(abacus_interpolate(mesh, x / 2.0 + 0.25, y / 2.0 + 0.25, within => t)) FROM generate_series(0, 39) AS x, generate_series(0, 39) AS y), p.name || ': a raster');
        RETURN NEXT ok(pg_temp.like((SELECT sum(d) FROM (SELECT distance - lag(distance) OVER (ORDER BY ordinality) AS d, value IS NOT NULL AND lag(value) OVER (ORDER BY ordinality) IS NOT NULL AS inside
                FROM abacus_profile(mesh, '{{-1, 3.5}, {21, 12}, {4, 12}, {4, -1}}', within => t) WITH ORDINALITY) AS s WHERE inside),
            (SELECT ST_Length(ST_Intersection(ST_Intersection('LINESTRING(-1 3.5, 21 12, 4 12, 4 -1)'::geometry, abacus_hull_geom(mesh)), p.g)))), p.name || ': a profile');
    END LOOP;
    DROP TABLE cell, side, level;
END $$;
SELECT abacus_triangulate('grid_lower', 'SELECT id, x, y, h - 2 AS h FROM point');
SELECT abacus_triangulate('wild_lower', $$SELECT id, x, y, attributes[1] - 2 AS h FROM abacus_vertices('wild')$$);
SELECT pg_temp.agree('grid');
SELECT pg_temp.agree('wild');

-- a text in other forms
CREATE FUNCTION pg_temp.size(within text) RETURNS float8 LANGUAGE sql AS $$SELECT area FROM abacus_volume('grid', 0, within => within)$$;
SELECT is(pg_temp.size('POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))'), 100::float8, 'WKT');
SELECT is(pg_temp.size(' polygon z ((2 2 7, 12 2 7, 12 12 7, 2 12 7, 2 2 7)) '), 100::float8, 'with heights, which do not matter');
SELECT is(pg_temp.size('MultiPolygon(((2 2, 12 2, 12 12, 2 12, 2 2)))'), 100::float8, 'several');
SELECT is(pg_temp.size((SELECT ST_AsHexEWKB(g, 'XDR') FROM polygon WHERE name = 'on edges')), 100::float8, 'hexadecimal EWKB, of the other byte order');
SELECT is(pg_temp.size((SELECT encode(ST_AsBinary(g), 'hex') FROM polygon WHERE name = 'on edges')), 100::float8, 'hexadecimal WKB');
SELECT abacus_set_srid('grid', 25832);
SELECT is(pg_temp.size('SRID=25832;POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))'), 100::float8, 'EWKT');
SELECT is(pg_temp.size('POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))'), 100::float8, 'without a system, coordinates are those of the mesh');
SELECT is(pg_temp.size((SELECT ST_SetSRID(g, 25832)::text FROM polygon WHERE name = 'on edges')), 100::float8, 'a geometry as text');

SELECT is(pg_temp.size('POLYGON((-1e308 -1e308, 1e308 -1e308, 0 1e308, -1e308 -1e308))'), 400::float8, 'corners far away');

-- refused
CREATE FUNCTION pg_temp.refused(within text, state text, message text, detail text DEFAULT NULL, hint text DEFAULT NULL) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    m text; d text; h text;
BEGIN
    PERFORM pg_temp.size(within);
    RETURN fail('not refused: ' || message);
EXCEPTION WHEN OTHERS THEN
    GET STACKED DIAGNOSTICS m = MESSAGE_TEXT, d = PG_EXCEPTION_DETAIL, h = PG_EXCEPTION_HINT;
    RETURN is(concat_ws(' | ', SQLSTATE, m, nullif(d, ''), CASE WHEN hint IS NOT NULL THEN h END), concat_ws(' | ', state, message, detail, hint), message);
END $$;
SELECT pg_temp.refused('SRID=4326;POLYGON((2 2, 12 2, 12 12, 2 2))', '22023', 'within has SRID 4326, but the mesh has SRID 25832', NULL, 'Transform it with ST_Transform(geometry, 25832).');
SELECT pg_temp.refused('POLYGON((0 0, 2 2, 2 0, 0 2, 0 0))', '22023', 'within is not a polygon that can be used', 'Self-intersection[1 1]', 'Make it valid with ST_MakeValid.');
SELECT pg_temp.refused('POLYGON((0 0, 2 2, 2 0))', '22023', 'within is not a polygon that can be used', 'IllegalArgumentException: Points of LinearRing do not form a closed linestring');
SELECT pg_temp.refused('POLYGON((0 0, 2 2', '22023', 'within is not a polygon that can be used', 'ParseException: Expected word but encountered end of stream');
SELECT pg_temp.refused('LINESTRING(0 0, 2 2)', '22023', 'within is not a polygon that can be used', 'It is a LineString.', 'Give the name of a region, a Polygon or a MultiPolygon.');
SELECT pg_temp.refused('POINT EMPTY', '22023', 'within is not a polygon that can be used', 'It is a Point.');
SELECT pg_temp.refused('POLYGON((0 0, inf 0, 1 1, 0 0))', '22023', 'within is not a polygon that can be used', 'A coordinate is not a finite number.');
SELECT pg_temp.refused('0103000000', '42704', 'mesh "grid" has no region "0103000000"', 'It has no regions.');
SELECT pg_temp.refused('010300000001000000ffffff7f', '22023', 'within is not a polygon that can be used', 'It is a geometry that is not made of whole polygons.');
SELECT pg_temp.refused('polygon', '42704', 'mesh "grid" has no region "polygon"', 'It has no regions.');
SELECT abacus_create('solid', 3);
SELECT throws_ok($$SELECT * FROM abacus_cells('solid', within => 'POLYGON((0 0, 1 0, 1 1, 0 0))')$$, '22023', 'within is a polygon, but mesh "solid" has dimension 3');

-- names that look like geometries, and what follows a polygon
SELECT pg_temp.refused(name, '42704', format('mesh "grid" has no region "%s"', name), 'It has no regions.')
    FROM (VALUES ('Point (north)'), ('TIN (existing)'), ('010020003000400050'), ('01030000'), ('polygon ()'), ('POINTER(1)'), ('SRID=1')) AS v (name);
SELECT pg_temp.refused('POLYGON((0 0, 5 0, 5 5, 0 0))' || more, '22023', 'within is not a polygon that can be used', format('It ends before "%s".', ltrim(more)))
    FROM (VALUES (',((10 10, 15 10, 15 15, 10 10))'), (' trailing'), (')'), ('POLYGON((1 1, 2 1, 2 2, 1 1))')) AS v (more);
SELECT pg_temp.refused(g || g, '22023', 'within is not a polygon that can be used', format('It ends before "%s...".', left(g, 77)))
    FROM (SELECT ST_AsEWKT(ST_MakeEnvelope(0, 0, 5, 5)) AS w, 'SRID=25832;POLYGON((0 0, 5 0, 5 5, 0 5, 0 0))'::geometry::text AS g) AS s;
SELECT is((SELECT area FROM abacus_volume('grid', 0, within => g)), 25::float8, left(g, 30)) FROM (SELECT ST_MakeEnvelope(0, 0, 5, 5, 25832) AS e) AS s,
    LATERAL (VALUES (e::text), (ST_Multi(e)::text), (ST_Force3DZ(e)::text), (ST_Force3DM(ST_Multi(e))::text), (ST_Force4D(e)::text), (encode(ST_AsBinary(ST_Force4D(ST_Multi(e)), 'XDR'), 'hex')),
        (ST_AsText(ST_Force3DZ(e))), (ST_AsEWKT(ST_Multi(e))), (ST_AsEWKT(e) || E' \n'), (ST_AsText(e, 1))) AS v (g);
SELECT pg_temp.refused(g, '22023', 'within is not a polygon that can be used', 'It is a CurvePolygon.')
    FROM (VALUES ('CURVEPOLYGON(CIRCULARSTRING(0 0, 4 0, 4 4, 0 4, 0 0))'), ('CURVEPOLYGON(CIRCULARSTRING(0 0, 4 0, 4 4, 0 4, 0 0))'::geometry::text)) AS v (g);

-- collections may nest, so GEOS never sees one
SELECT pg_temp.refused(g, '22023', 'within is not a polygon that can be used', 'It is a GeometryCollection.')
    FROM (VALUES ('GEOMETRYCOLLECTION(POLYGON((0 0, 5 0, 5 5, 0 0)))'), ('GEOMETRYCOLLECTION(GEOMETRYCOLLECTION EMPTY)'), ('GEOMETRYCOLLECTION(POLYGON((0 0, 5 0, 5 5, 0 0)))'::geometry::text)) AS v (g);
SELECT pg_temp.refused(g, '22023', 'within is not a polygon that can be used', 'It is a geometry that is not made of whole polygons.')
    FROM (VALUES ('010600000001000000' || '010600000001000000' || 'POLYGON EMPTY'::geometry::text), ('010600000001000000' || 'POINT(1 1)'::geometry::text),
        (left(ST_MakeEnvelope(0, 0, 5, 5)::text, -2)), (repeat('010600000001000000', 9))) AS v (g);
SELECT pg_temp.refused('Point Empty Quarter', '42704', 'mesh "grid" has no region "Point Empty Quarter"', 'It has no regions.');

-- bands in many boxes, whose corners are no doubles of the decimals that they are written with
SELECT abacus_triangulate('steps', 'SELECT 100 * x + y AS id, x, y, (7 * x + 13 * y) % 11 AS h FROM generate_series(0, 20) AS x, generate_series(0, 20) AS y');
SELECT is((SELECT count(*) FROM (SELECT ST_MakeEnvelope(0.1 * (i * 37 % 150), 0.1 * (i * 53 % 140), 0.1 * (i * 37 % 150) + 4.1, 0.1 * (i * 53 % 140) + 3.3) AS box FROM generate_series(1, 100) AS i) AS s,
        LATERAL (SELECT sum(ST_Area(geom)) AS area, bool_and(ST_IsValid(geom)) AS valid FROM abacus_contours_geom('steps', 2.5, polygonize => true, within => box::text)) AS b
    WHERE abs(b.area - ST_Area(box)) > 1e-9 OR NOT b.valid), 0::bigint, 'bands fill the polygon');
SELECT is((SELECT count(*) FROM (SELECT ST_MakeEnvelope(0.1 * (i * 37 % 150), 0.1 * (i * 53 % 140), 0.1 * (i * 37 % 150) + 4.1, 0.1 * (i * 53 % 140) + 3.3) AS box FROM generate_series(1, 100) AS i) AS s,
        LATERAL (SELECT sum(ST_Area(geom)) AS area, bool_and(ST_IsValid(geom)) AS valid FROM abacus_contours_geom('steps', 2.5, polygonize => true, bounds => box)) AS b
    WHERE abs(b.area - ST_Area(box)) > 1e-9 OR NOT b.valid), 0::bigint, 'and a window');
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 9) FROM abacus_contours_geom('steps', 2.5, polygonize => true, bounds => ST_MakeEnvelope(2.1, 2.1, 7.7, 9.9), within => 'POLYGON((5 0.3, 20 0.3, 20 20, 5 20, 5 0.3))')), round(2.7 * 7.8, 9), 'and both');
SELECT is((SELECT count(*) FROM abacus_contours_geom('steps', 2.5, polygonize => true, bounds => ST_MakeEnvelope(2.1, 2.1, 4.7, 9.9), within => 'POLYGON((5 0.3, 20 0.3, 20 20, 5 20, 5 0.3))')), 0::bigint, 'or none, where they do not meet');
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 9) FROM abacus_clip('steps', ST_MakeEnvelope(2, 2, 8, 8), within => 'POLYGON((3.5 3.1, 3.9 3.1, 3.9 3.2, 3.5 3.1))')), 0.02, 'triangles are clipped by both');
SELECT abacus_constrain('steps', 'VALUES (1, 1, 303), (1, 2, 903), (1, 3, 906), (1, 4, 306), (1, 5, 303)');
SELECT abacus_region('steps', $$VALUES ('field', 1)$$);
SELECT is((SELECT round(sum(ST_Area(geom))::numeric, 9) FROM abacus_clip('steps', ST_MakeEnvelope(2, 2, 8, 8.5), within => 'field')), 15.000000000, 'or by a region');
SELECT throws_ok(format('SELECT * FROM abacus_clip(%L, ST_MakeEnvelope(2, 2, 8, 8), within => %L)', 'steps', within), state, message, message)
    FROM (VALUES ('lake', '42704', 'mesh "steps" has no region "lake"'),
        ('SRID=4326;POLYGON((30 30, 40 30, 40 40, 30 30))', '22023', 'within has SRID 4326, but the mesh has none')) AS v (within, state, message);
-- with arguments that the planner knows
SELECT ok(ST_Equals(_abacus_part_within('steps', ST_MakeEnvelope(2, 2, 8, 8), 'field'), ST_MakeEnvelope(2, 2, 8, 8)), 'a name is no polygon');
SELECT throws_ok(format('SELECT _abacus_part_within(%L, ST_MakeEnvelope(2, 2, 8, 8), %L)', 'steps', within), '22023', 'within is not a polygon that can be used', 'nor is ' || within)
    FROM (VALUES ('POLYGON((0 0, 5 5, 0 5, 5 0, 0 0))'), ('POLYGON((1 1, 20 1, 20 20, 1 20))')) AS v (within);

-- lines of sight, pictures, tiles
SELECT abacus_triangulate('ridge', 'SELECT id, x, y, CASE WHEN x = 10 THEN 9 ELSE 0 END AS h FROM point');
SELECT is((SELECT visible FROM abacus_visible('ridge', '{1, 5, 2}', '{19, 5, 2}')), false, 'a ridge hides what is behind it');
SELECT is((SELECT visible FROM abacus_visible('ridge', '{1, 5, 2}', '{19, 5, 2}', within => 'POLYGON((0 0, 20 0, 20 20, 11 20, 11 1, 8 1, 8 20, 0 20, 0 0))')), true, 'where it is outside it does not');
SELECT is((SELECT visible FROM abacus_visible('ridge', '{1, 5, 2}', '{19, 5, 2}', within => 'POLYGON((0 0, 20 0, 20 20, 9.75 20, 9.75 1, 8 1, 8 20, 0 20, 0 0))')), false, 'a slope of it does');
SELECT isnt(abacus_draw('ridge', 64, within => 'POLYGON((0 0, 20 0, 10 20, 0 0))'), abacus_draw('ridge', 64), 'a picture');
SELECT is(abacus_draw('ridge', 64, lower => '{0,0}', upper => '{20,20}', within => 'POLYGON((-1 -1, 21 -1, 21 21, -1 21, -1 -1))'), abacus_draw('ridge', 64, lower => '{0,0}', upper => '{20,20}'), 'around all it changes nothing');
SELECT isnt(abacus_tile_picture('ridge', 0, 0, 0, world => '{0,0,20}', within => 'POLYGON((0 0, 20 0, 10 20, 0 0))'), abacus_tile_picture('ridge', 0, 0, 0, world => '{0,0,20}'), 'a tile');
SELECT isnt(abacus_tile_vector('ridge', 0, 0, 0, world => '{0,0,20}', within => 'POLYGON((0 0, 20 0, 10 20, 0 0))'), abacus_tile_vector('ridge', 0, 0, 0, world => '{0,0,20}'), 'a tile');
SELECT isnt(abacus_tile_terrain('ridge', 0, 0, 0, world => '{0,0,20}', within => 'POLYGON((0 0, 20 0, 10 20, 0 0))'), abacus_tile_terrain('ridge', 0, 0, 0, world => '{0,0,20}'), 'a tile');

-- with other limits, fixed edges, and a region of the same name
SELECT is((SELECT count(*) FROM abacus_cells('grid', '{0,0}', '{3,3}', within => 'POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))')),
    (SELECT count(*) FROM abacus_cells_geom('grid') AS c WHERE ST_Relate(c.geom, 'SRID=25832;POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))', 'T********') AND ST_Intersects(c.geom, 'SRID=25832;POLYGON((0 0, 3 0, 3 3, 0 3, 0 0))')), 'with a window');
SELECT is((SELECT count(*) FROM abacus_cells('grid', max_edge => 1.2, within => 'POLYGON((2 2, 12 2, 12 12, 2 12, 2 2))')), 0::bigint, 'with max_edge');
SELECT abacus_constrain('grid', 'VALUES (1, 1, 202), (1, 2, 1202)');
SELECT is((SELECT count(*) FROM abacus_edges('grid', fixed => true, within => 'POLYGON((5 0, 8 0, 8 9, 5 9, 5 0))')), 3::bigint, 'fixed edges');
SELECT abacus_unconstrain('grid', 'SELECT 1');

SELECT * FROM finish();
ROLLBACK;

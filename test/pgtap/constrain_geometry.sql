-- Lines given as geometries of PostGIS: parts, rings, Z, SRID, and every error.
BEGIN;
SELECT count(*) > 0 AS has_postgis FROM pg_available_extensions WHERE name = 'postgis' \gset
\if :has_postgis
SELECT no_plan();
SET client_min_messages = warning;
CREATE EXTENSION IF NOT EXISTS postgis;

SELECT abacus_triangulate('field', 'SELECT 10 * x + y, ST_Point(x, y, 2154), x + y AS h, x AS w FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y');
CREATE TABLE shape (line int, geom geometry);
INSERT INTO shape VALUES (1, 'SRID=2154;LINESTRING(0 0, 0.5 3.5, 9 3.5)'),
    (2, 'SRID=2154;POLYGON((1 5, 8 5, 8 8, 1 8, 1 5), (2 6, 2 7, 3 7, 2 6))'),
    (3, 'SRID=2154;MULTILINESTRING((1 0.5, 4 0.5), (6 0.5, 9 0.5))'),
    (4, 'SRID=2154;GEOMETRYCOLLECTION M (LINESTRING M (0 9.5 1, 1 9.5 2), POLYGON M EMPTY, MULTIPOLYGON M (((3 9.5 1, 4 9.5 1, 4 10 3, 3 9.5 1))))'),
    (5, 'SRID=2154;MULTILINESTRING((6 9.5, 7 9.5))');
SELECT is(abacus_constrain('field', 'TABLE shape'), 5::bigint, 'lines, polygons and collections');
SELECT results_eq($$ SELECT line, position, ST_SetSRID(ST_MakePoint(x, y), 2154), part FROM abacus_lines('field') $$,
    $$ SELECT line::bigint, row_number() OVER (PARTITION BY line ORDER BY part, n), ST_Force2D(geom), CASE WHEN parts > 1 THEN part END FROM
       (SELECT line, geom, n, dense_rank() OVER (PARTITION BY line ORDER BY p) AS part, parts FROM
        (SELECT line, d.geom, d.path[cardinality(d.path)] AS n, d.path[:cardinality(d.path) - 1] AS p,
         (SELECT count(DISTINCT e.path[:cardinality(e.path) - 1]) FROM ST_DumpPoints(s.geom) AS e) AS parts FROM shape AS s, ST_DumpPoints(s.geom) AS d) AS a) AS b
       ORDER BY line, part, n $$, 'their points are those that PostGIS finds, each line or ring a part');
SELECT is((SELECT count(*) FROM abacus_lines('field') WHERE point < 100), 10::bigint, 'vertices keep their ids');
SELECT is((SELECT count(DISTINCT point) FROM abacus_lines('field') WHERE point >= 100), 13::bigint, 'others have new ones, rings one for both ends');
SELECT results_eq($$ SELECT lines[1], sum(length) FROM abacus_edges('field', fixed => true) GROUP BY lines ORDER BY lines $$,
    $$ SELECT line::bigint, (SELECT sum(ST_Length(CASE WHEN ST_Dimension(d.geom) = 2 THEN ST_Boundary(d.geom) ELSE d.geom END)) FROM ST_Dump(geom) AS d) FROM shape ORDER BY line $$,
    'parts are not joined');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh is sound');

-- rows with a part are what has been returned
CREATE TABLE line AS SELECT * FROM abacus_lines('field');
CREATE TABLE edge AS SELECT * FROM abacus_edges('field', fixed => true);
CREATE FUNCTION pg_temp.same(what text) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT results_eq('SELECT * FROM abacus_lines(''field'')', 'TABLE line', what) UNION ALL
    SELECT results_eq('SELECT * FROM abacus_edges(''field'', fixed => true)', 'TABLE edge', what || ': edges') UNION ALL
    SELECT is_empty('SELECT * FROM abacus_check(''field'')', what || ': sound') $$;
SELECT is(abacus_unconstrain('field', 'SELECT line FROM shape'), 5::bigint, 'lines with parts go');
SELECT is((SELECT count(*) FROM abacus_edges('field', fixed => true)), 0::bigint, 'with all their edges');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'nothing is left');
SELECT abacus_constrain('field', 'SELECT line, position, point, part FROM line ORDER BY part DESC, position DESC');
SELECT pg_temp.same('points and parts');
SELECT abacus_constrain('field', 'SELECT line, position, point, x, y, part::smallint FROM line', existing => 'replace');
SELECT pg_temp.same('places and parts');
SELECT abacus_constrain('field', 'SELECT line, position, NULL, x, y, h, part, w FROM line, (SELECT NULL AS h, NULL AS w) AS n', existing => 'replace');
SELECT pg_temp.same('a part among attributes');
SELECT abacus_constrain('field', 'SELECT line, position, point, NULL AS part FROM line WHERE line = 1', existing => 'replace');
SELECT pg_temp.same('a bare NULL');
-- between parts, and on them
SELECT abacus_insert('field', 'VALUES (501, 5, 0.5, 1, 1), (502, 2, 0.5, 1, 1)');
SELECT is_empty($$ SELECT FROM abacus_edges('field', fixed => true) WHERE 501 IN (v0, v1) $$, 'a point between two parts is on no line');
SELECT isnt_empty($$ SELECT FROM abacus_edges('field', fixed => true) WHERE 502 IN (v0, v1) $$, 'one on a part is');
SELECT abacus_delete('field', 'VALUES (501, 5, 0.5), (502, 2, 0.5)');
SELECT pg_temp.same('points that go again');
SELECT throws_ok($$ SELECT abacus_delete('field', 'SELECT point, x, y FROM line WHERE line = 3 AND position = 2') $$, NULL, NULL, 'the end of a part stays');

-- parts wait as lines do
SELECT abacus_create('later', 2, '{h}');
SELECT abacus_constrain('later', $$ SELECT 1, 'SRID=2154;MULTILINESTRING Z ((0 0 1, 1 0 2), (2 0 3, 3 0 4))'::geometry $$, z => 'h');
SELECT is(abacus_srid('later'), 2154, 'a mesh takes the SRID');
SELECT abacus_insert('later', 'VALUES (10, 0, 1, 0)');
SELECT results_eq($$ SELECT lines, length FROM abacus_edges('later', fixed => true) $$, $$ VALUES ('{1}'::bigint[], 1::float8), ('{1}', 1) $$, 'they are fixed later');
SELECT results_eq($$ SELECT attributes[1] FROM abacus_vertices('later') WHERE id < 10 ORDER BY id $$, $$ VALUES (1::float8), (2), (3), (4) $$, 'Z is an attribute');

-- Z
SELECT abacus_constrain('field', $$ SELECT 20, 'SRID=2154;LINESTRING Z (0 0 0, -1 -1 7, -2 -1 nan)'::geometry $$, z => 'h');
SELECT results_eq($$ SELECT x, attributes FROM abacus_vertices('field') WHERE x < 0 ORDER BY x DESC $$, $$ VALUES (-1::float8, '{7,NULL}'::float8[]), (-2, '{NULL,NULL}') $$, 'the other attributes are missing');
SELECT abacus_constrain('field', $$ SELECT 21, 'SRID=2154;LINESTRING(-1 -1, -2 -2)'::geometry $$, z => 'h');
SELECT is((SELECT attributes FROM abacus_vertices('field') WHERE x = -2 AND y = -2), '{NULL,NULL}', 'without Z, all of them');

CREATE FUNCTION pg_temp.refused(geom text, state text, message text, more text DEFAULT '') RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    before bigint := (SELECT count(*) FROM abacus_lines('field')) + (SELECT count(*) FROM abacus_vertices('field'));
BEGIN
    RETURN NEXT throws_ok(format('SELECT abacus_constrain(''field'', %L%s)', 'SELECT 30, ' || quote_literal(geom) || '::geometry', more), state, message);
    RETURN NEXT is((SELECT count(*) FROM abacus_lines('field')) + (SELECT count(*) FROM abacus_vertices('field')), before, 'nothing has changed');
END $$;
SELECT pg_temp.refused('SRID=2154;POINT(0 0)', '22023', 'geometry of line 30 is a Point, not a line or polygon');
SELECT pg_temp.refused('SRID=2154;MULTIPOINT(0 0, 1 1)', '22023', 'geometry of line 30 is a MultiPoint, not a line or polygon');
SELECT pg_temp.refused('SRID=2154;GEOMETRYCOLLECTION(LINESTRING(0 0, 1 1), POINT(0 0))', '22023', 'part of the geometry of line 30 is a Point, not a line or polygon');
SELECT pg_temp.refused('SRID=2154;CIRCULARSTRING(0 0, 1 1, 2 0)', '22023', 'geometry of line 30 is a CircularString, not a line or polygon');
SELECT pg_temp.refused('SRID=2154;MULTICURVE((0 0, 1 1), CIRCULARSTRING(0 0, 1 1, 2 0))', '22023', 'geometry of line 30 is a MultiCurve, not a line or polygon');
SELECT pg_temp.refused('SRID=2154;TIN(((0 0, 0 1, 1 1, 0 0)))', '22023', 'geometry of line 30 is a Tin, not a line or polygon');
SELECT pg_temp.refused('SRID=4326;LINESTRING(0 0, 1 1)', '22023', 'geometry of line 30 has SRID 4326, but the mesh has SRID 2154');
SELECT pg_temp.refused('LINESTRING(0 0, 1 1)', '22023', 'geometry of line 30 has no SRID, but the mesh has SRID 2154');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 30, ST_SetSRID(ST_MakeLine(ST_MakePoint(0, 0), ST_MakePoint(1, ''inf'')), 2154)') $$, '22023', 'geometry of line 30 is not finite');
SELECT pg_temp.refused('SRID=2154;LINESTRING(0 0, 0 0, 0 1)', '22023', 'line 30 has a segment of length zero');
SELECT pg_temp.refused('SRID=2154;LINESTRING Z (0 0 0, -1 -1 8)', '22023', 'attribute "h" has two values at (-1, -1)', ', z => ''h''');
SELECT pg_temp.refused('SRID=2154;LINESTRING Z (0 0 0, -1 -1 8)', '42703', 'mesh has no attribute "g"', ', z => ''g''');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 30, NULL::geometry') $$, '22004', 'geometry of line 30 is NULL');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT NULL::int, geom FROM shape') $$, '22004', 'line of row 1 is NULL');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 1.5, geom FROM shape') $$, '42804', 'column 1 of the query of lines has type numeric');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT line, geom::geography FROM shape') $$, '42804', 'the query of lines returns 2 columns');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 30, geom FROM shape') $$, '23505', 'line 30 has two geometries');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'TABLE shape') $$, '23505', 'the mesh already has a line 1');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT line, position, point, 1.5 AS part FROM line') $$, '42804', 'column 4 of the query of lines has type numeric');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 30, position, point, position AS part FROM line WHERE line = 3') $$, '22023', 'part 1 of line 30 has one point alone, or begins twice');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'SELECT 30, position, point, position / 2 % 2 AS part FROM line WHERE line = 2') $$, '22023', 'part 0 of line 30 has one point alone, or begins twice');
SELECT abacus_create('none', 2);
SELECT throws_ok($$ SELECT abacus_constrain('none', 'SELECT line, ST_SetSRID(geom, 2000 + line) FROM shape') $$, '22023', 'geometry of line 2 has SRID 2002, but earlier geometries have SRID 2001', 'mixed SRIDs');

-- published
SELECT is(abacus_publish('field')::text, '{field_cells,field_points,field_fixed_edges,field_breaklines}', 'published');
SELECT is_empty($$ SELECT FROM field_breaklines AS l JOIN shape USING (line) WHERE l.kind <> 'hard' OR ST_SRID(l.geom) <> 2154 OR
    ARRAY(SELECT ST_AsText(geom) FROM ST_DumpPoints(l.geom)) <> ARRAY(SELECT ST_AsText(ST_Force2D(geom)) FROM ST_DumpPoints(shape.geom)) OR
    ST_NumGeometries(l.geom) <> (SELECT count(DISTINCT part) FILTER (WHERE part IS NOT NULL) + count(DISTINCT line) FILTER (WHERE part IS NULL) FROM line AS p WHERE p.line = l.line) $$, 'lines are what was given, part by part');
SELECT is((SELECT count(*) FROM field_breaklines), (SELECT count(DISTINCT line) FROM abacus_lines('field')), 'all of them');
SELECT is_empty($$ SELECT FROM field_fixed_edges WHERE ST_Length(geom) <> length OR ST_SRID(geom) <> 2154 $$, 'edges are as long as they are');
SELECT ok(ST_Equals((SELECT ST_Union(geom) FROM field_fixed_edges), (SELECT ST_Union(geom) FROM field_breaklines)), 'they are where the lines are');
SELECT is(abacus_unpublish('field'), 4, 'and not published any more');

-- an attribute with the name part comes first
SELECT abacus_add_attribute('field', 'part');
SELECT abacus_constrain('field', 'SELECT line, position, point, x, y, NULL::int AS part FROM line WHERE line = 3', existing => 'replace');
SELECT is((SELECT count(part) FROM abacus_lines('field') WHERE line = 3), 0::bigint, 'and joins what were parts');

-- an empty geometry gives no line
SELECT is(abacus_constrain('field', $$ VALUES (40, 'SRID=2154;LINESTRING EMPTY'::geometry), (41, 'SRID=2154;GEOMETRYCOLLECTION EMPTY'), (42, 'SRID=2154;LINESTRING(5 1, 6 1)') $$), 1::bigint, 'empty geometries are left out');
SELECT is(abacus_constrain('field', $$ SELECT 43, 'SRID=2154;POLYGON EMPTY'::geometry $$), 0::bigint, 'nothing else');

SELECT * FROM finish();
\else
SELECT plan(1);
SELECT skip('PostGIS is not installed', 1);
\endif
ROLLBACK;

-- Surfaces through a mesh in space: isosurfaces, sections, pictures of what is inside.
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0, 0, 1), (2, 4, 0, 0, 0, 5), (3, 0, 4, 0, 0, 1), (4, 0, 0, 4, 4, NULL), (5, 1, 1, 1, 8, 2)', '{heat,depth}', dimension => 3);
-- a tetrahedron of heat 4 at one corner; the corners of the surface are numbered and shared
SELECT v0, v1, v2, corners, "values" FROM abacus_isosurface('solid', 6, 'heat', 'depth') ORDER BY v0, v1, v2;
SELECT v0, v1, v2, corners, "values" FROM abacus_isosurface('solid', 2, 'heat') ORDER BY v0, v1, v2;
-- a vertex at the value counts as above it: triangles there shrink to points, and the surface goes on
SELECT v0, v1, v2, corners FROM abacus_isosurface('solid', 4, 'heat') ORDER BY v0, v1, v2;
SELECT count(*) FROM abacus_isosurface('solid', 8, 'heat');
SELECT count(*) FROM abacus_isosurface('solid', 8.5, 'heat');
SELECT count(*) FROM abacus_isosurface('solid', 0, 'heat');
-- where a corner has no value there is none
SELECT count(*) FROM abacus_isosurface('solid', 1.5, 'depth');
-- a window, no long edges
SELECT count(*) FROM abacus_isosurface('solid', 6, 'heat', lower => '{3,0,0}', upper => '{4,0,0}');
SELECT count(*) FROM abacus_isosurface('solid', 6, 'heat', max_edge => 5);
SELECT count(*) FROM abacus_isosurface('solid', 6, 'heat', max_edge => 6);
-- sections: triangles and quadrilaterals
SELECT polygon, "values" FROM abacus_section('solid', '{0,0,2}', '{0,0,1}', 'heat') ORDER BY polygon;
SELECT polygon, "values" FROM abacus_section('solid', '{0.5,0.5,0}', '{1,1,0}', 'depth') ORDER BY polygon;
-- through vertices, facets and edges; the bottom of the mesh from both sides
SELECT polygon FROM abacus_section('solid', '{1,1,1}', '{0,0,-2}', 'heat') ORDER BY polygon;
SELECT polygon FROM abacus_section('solid', '{9,9,0}', '{0,0,1}', 'heat');
SELECT polygon FROM abacus_section('solid', '{9,9,0}', '{0,0,-1}', 'heat');
SELECT count(*) FROM abacus_section('solid', '{0,0,0}', '{1,1,0}', 'heat');
SELECT count(*) FROM abacus_section('solid', '{0,0,4}', '{0,0,1}', 'heat');
SELECT count(*) FROM abacus_section('solid', '{0,0,5}', '{0,0,1}', 'heat');
-- which side a vertex is on is exact: 0.1 + 0.2 is above 0.3
SELECT abacus_triangulate('plain', 'SELECT i, x, y, z FROM (SELECT row_number() OVER () AS i, * FROM generate_series(0, 1) x, generate_series(0, 1) y, (VALUES (0.1::float8 + 0.2::float8), (0.5), (0)) AS z (z)) t', dimension => 3);
SELECT count(*), min(cardinality(polygon)), max(cardinality(polygon)), bool_and("values" IS NULL) AS without_values FROM abacus_section('plain', ARRAY[0, 0, 0.1::float8 + 0.2::float8], '{0,0,1}');
SELECT count(*), max(cardinality(polygon)) > 9 AS quadrilaterals FROM abacus_section('plain', ARRAY[0, 0, 0.3], '{0,0,1}');
-- without long edges
SELECT count(*) FROM abacus_section('plain', '{0,0,0.4}', '{0,0,1}', max_edge => 0.1);
-- a NOTICE where no vertex has a value
SELECT abacus_triangulate('unknown', 'VALUES (1, 0, 0, 0, NULL::float8), (2, 1, 0, 0, NULL), (3, 0, 1, 0, NULL), (4, 0, 0, 1, NULL)', '{heat}', dimension => 3);
SELECT count(*) FROM abacus_isosurface('unknown', 1);
SELECT count(*) FROM abacus_isosurface('solid', 100, 'heat');
DROP TABLE unknown, unknown_vertices;
-- nothing of an empty mesh, and of NULL
SELECT abacus_create('empty', 3, '{a}');
SELECT (SELECT count(*) FROM abacus_isosurface('empty', 1)) AS surface, (SELECT count(*) FROM abacus_section('empty', '{0,0,0}', '{0,0,1}')) AS section,
       (SELECT count(*) FROM abacus_isosurface(NULL, 1)) AS of_null, (SELECT count(*) FROM abacus_isosurface('solid', NULL, 'heat')) AS at_null,
       (SELECT count(*) FROM abacus_section('solid', NULL, '{0,0,1}', 'heat')) AS through_null;
-- a cursor ends early
BEGIN;
DECLARE reader CURSOR FOR SELECT abacus_section('solid', '{0,0,1.5}', '{0,0,1}', 'heat');
MOVE 1 FROM reader;
DECLARE other CURSOR FOR SELECT abacus_isosurface('solid', 6, 'heat');
MOVE 1 FROM other;
COMMIT;
-- what is inside: pictures
CREATE FUNCTION looks(picture bytea) RETURNS text LANGUAGE sql AS $$ SELECT convert_from(substr(picture, 2, 3), 'UTF8') || ' ' || (get_byte(picture, 18) * 256 + get_byte(picture, 19)) || ' x ' || (get_byte(picture, 22) * 256 + get_byte(picture, 23)) $$;
SELECT looks(abacus_draw_volume('solid', width => 80, attribute => 'heat')) AS parallel, looks(abacus_draw_volume('solid', width => 80, attribute => 'heat', field_of_view => 50)) AS perspective,
       looks(abacus_draw_volume('solid', width => 80)) AS without_attribute, looks(abacus_draw_volume('solid', '{2,-5,2}', '{2,0,2}', width => 80, height => 50)) AS from_south;
SELECT count(DISTINCT abacus_draw_volume('solid', '{2,-5,2}', '{2,0,2}', width => 80, attribute => 'heat', mode => mode)) AS different FROM unnest('{mean,max,min,sum}'::text[]) AS mode;
-- the values of a range; as those that are seen if it has them
SELECT abacus_draw_volume('solid', width => 40, attribute => 'heat', mode => 'max') <> abacus_draw_volume('solid', width => 40, attribute => 'heat', mode => 'max', range => '{0,100}') AS differs;
-- other colours, a legend, nothing behind
SELECT count(DISTINCT abacus_draw_volume('solid', width => 120, attribute => 'heat', ramp => ramp, legend => legend, transparent => transparent)) AS different
FROM unnest('{strata,viridis,magma}'::text[]) AS ramp, (VALUES (NULL), ('degrees')) AS l (legend), (VALUES (true), (false)) AS t (transparent);
-- a box of the mesh; the eye amid it; nothing
SELECT looks(abacus_draw_volume('solid', '{1,1,9}', '{1,1,0}', width => 80, lower => '{0,0,0}', upper => '{2,1,1}')) AS box, looks(abacus_draw_volume('solid', '{1,1,1}', '{2,1,1}', field_of_view => 120, width => 80, attribute => 'depth')) AS amid;
SELECT looks(abacus_draw_volume('solid', '{1,1,9}', '{1,1,20}', field_of_view => 50, width => 80)) AS behind;
SELECT looks(abacus_draw_volume('empty', width => 80));
SELECT abacus_draw_volume(NULL) IS NULL AS of_null;
-- what cannot be asked
SELECT abacus_create('flat', 2, '{a}');
SELECT * FROM abacus_isosurface('flat', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('flat', '{0,0}', '{1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 'NaN', 'heat');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1, 'cold');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1, 'heat', 'cold');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('plain', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1, 'heat', lower => '{0,0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1, 'heat', lower => '{0,0,1}', upper => '{1,1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_isosurface('solid', 1, 'heat', max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('solid', '{0,0,0}', '{0,0,0}', 'heat');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('solid', '{0,0,Infinity}', '{0,0,1}', 'heat');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('solid', '{0,0,0}', '{0,NaN,1}', 'heat');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('solid', '{0,0}', '{0,0,1}', 'heat');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_section('solid', '{0,0,0}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('flat');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', mode => 'median');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', ramp => 'rainbow');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', '{1,1,1}', '{1,1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', '{1,1,1}', '{1,1,2}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', '{1,1,NaN}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', field_of_view => 180);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', width => 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_volume('solid', attribute => 'cold');
\echo :LAST_ERROR_SQLSTATE
DROP FUNCTION looks;
DROP TABLE solid, plain, empty, flat;

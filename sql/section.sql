-- Pictures of a mesh of dimension 3: a plane section.
SELECT abacus_triangulate('grid', 'SELECT x * 100 + y * 10 + z, x, y, z, x + y AS vs FROM generate_series(0, 6) x, generate_series(0, 5) y, generate_series(0, 4) z', dimension => 3);
SELECT abacus_triangulate('flat', 'SELECT x * 10 + y, x, y FROM generate_series(0, 5) x, generate_series(0, 5) y');
-- Width and height as the PNG has them.
CREATE FUNCTION size(png bytea) RETURNS text LANGUAGE sql AS $$
    SELECT (get_byte(png, 18) * 256 + get_byte(png, 19)) || ' x ' || (get_byte(png, 22) * 256 + get_byte(png, 23))
    WHERE substr(png, 1, 8) = '\x89504e470d0a1a0a'
$$;

-- the shape is that of the section; up is z, or y on a map
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,0,1}'));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', 60));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{-1,0,0}', 60));
SELECT size(abacus_draw_section('grid', '{3,2.5,2}', '{5,-6,0}', 60, attribute => 'vs'));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', 60, exaggeration => -2.5));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', 60, 30));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', 60, 30, 'vs', false, '{1,0,1}', '{2,4,2}', 1, 3));
SELECT size(abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', 60, lower => '{1,0,1}', upper => '{2,4,2}'));
-- the sign of the normal, and its length, do not matter
SELECT abacus_draw_section('grid', '{3,2.5,2}', '{1,2,3}', 60, attribute => 'vs') =
       abacus_draw_section('grid', '{3,2.5,2}', '{-2,-4,-6}', 60, attribute => 'vs') AS same;
-- an attribute that grows to the right, and one upside down
SELECT abacus_draw_section('grid', '{3,2,2}', '{0,0,1}', 60, attribute => 'vs') <>
       abacus_draw_section('grid', '{3,2,2}', '{0,0,1}', 60, attribute => 'vs', exaggeration => -1) AS turned;
-- every layer is full: pictures of all planes between the same points are the same
SELECT count(DISTINCT abacus_draw_section('grid', ARRAY[0, 0, z], '{0,0,1}', 60, attribute => 'vs', edges => false))
FROM generate_series(0, 4) z;
-- a plane that misses the mesh: an empty square
SELECT size(abacus_draw_section('grid', '{3,2,9}', '{0,0,1}', 60));
SELECT abacus_draw_section('grid', '{3,2,2}', '{0,0,1}', 60, attribute => 'vs', range => '{0,1e6}') =
       abacus_draw_section('grid', '{3,2,2}', '{0,0,1}', 60, attribute => 'vs') AS same_picture;
-- a mesh without tetrahedra
SELECT abacus_create('none', 3);
SELECT size(abacus_draw_section('none', '{0,0,0}', '{0,0,1}', 60));

-- NULL
SELECT abacus_draw_section(NULL, '{0,0,0}', '{0,0,1}') IS NULL AS mesh,
       abacus_draw_section('grid', NULL, '{0,0,1}') IS NULL AS through,
       abacus_draw_section('grid', '{0,0,0}', NULL) IS NULL AS normal;
SELECT abacus_draw_section('grid', '{3,2,2}', '{0,1,0}', NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL) =
       abacus_draw_section('grid', '{3,2,2}', '{0,1,0}') AS defaults;

-- errors
SELECT abacus_draw('grid');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('flat', '{0,0,0}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,NULL}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,NaN}', '{0,0,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,Infinity}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', exaggeration => 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', exaggeration => 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', attribute => 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', 16384, 16384);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', lower => '{0,0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', lower => '{0,0,0}', upper => '{1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', lower => '{0,0,0}', upper => '{1,1,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('grid', '{0,0,0}', '{0,0,1}', lower => '{0,0,1}', upper => '{1,1,2}');
\echo :LAST_ERROR_SQLSTATE
DROP TABLE grid, grid_vertices, flat, flat_vertices, none, none_vertices;
DROP FUNCTION size(bytea);

-- Lines of equal value, and the bands between them.
SELECT abacus_triangulate('pyramid', 'VALUES (1, 0, 0, 0, 1), (2, 4, 0, 0, NULL), (3, 4, 4, 0, 3), (4, 0, 4, 0, 4), (5, 2, 2, 10, 5)', '{height,rock}');
-- from level_base on in both directions; higher ground to the right
SELECT * FROM abacus_contours('pyramid', 2.5, attribute => 'height');
SELECT id, value, closed FROM abacus_contours('pyramid', 4, -30, attribute => 'height');
-- fixed levels in place of them, each once, in order
SELECT * FROM abacus_contours('pyramid', fixed_levels => '{7.5,2.5,7.5,99}', attribute => 'height');
-- NULL is as good as an argument left out
SELECT * FROM abacus_contours('pyramid', NULL, NULL, NULL, NULL, 'height', NULL, NULL, NULL);
-- a peak at a level is a single point, and no line; the foot is not crossed
SELECT value, path FROM abacus_contours('pyramid', fixed_levels => '{0,10}', attribute => 'height');
-- a ridge at a level is led around
SELECT abacus_triangulate('ridge', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 4, 4, 0), (4, 0, 4, 0), (5, 1, 2, 5), (6, 3, 2, 5)', '{height}');
SELECT value, closed, path FROM abacus_contours('ridge', 5);
SELECT id, value, path FROM abacus_contours('ridge', 5, polygonize => true);
-- a saddle exactly at a level: high ground touches
SELECT abacus_triangulate('saddle', 'VALUES (1, 0, 0, 9), (2, 2, 0, 0), (3, 4, 0, 9), (4, 0, 2, 4), (5, 2, 2, 5), (6, 4, 2, 4), (7, 0, 4, 9), (8, 2, 4, 0), (9, 4, 4, 9)', '{height}');
SELECT id, closed, path FROM abacus_contours('saddle', fixed_levels => '{5}');
SELECT id, value, path FROM abacus_contours('saddle', fixed_levels => '{5}', polygonize => true);
-- lines end where a value is missing, at long edges, at the hull
SELECT path FROM abacus_contours('pyramid', 2, 0.5, attribute => 'rock');
SELECT count(*) FROM abacus_contours('pyramid', 2.5, attribute => 'height', max_edge => 3.9);
SELECT count(*) FROM abacus_contours('pyramid', 2.5, attribute => 'height', max_edge => 4);
-- bands: their rings, outlines counter-clockwise and holes clockwise
SELECT * FROM abacus_contours('pyramid', 5, polygonize => true, attribute => 'height');
SELECT * FROM abacus_contours('pyramid', fixed_levels => '{5}', polygonize => true, attribute => 'height');
SELECT * FROM abacus_contours('pyramid', 1000, polygonize => true, attribute => 'height');
SELECT id, value, closed, path FROM abacus_contours('pyramid', 4, polygonize => true, attribute => 'rock');
-- cut exactly at a window
SELECT * FROM abacus_contours('pyramid', 2.5, attribute => 'height', lower => '{0,0}', upper => '{1.25,9}');
SELECT * FROM abacus_contours('pyramid', 5, polygonize => true, attribute => 'height', lower => '{0.5,0.25}', upper => '{1.5,4}');
SELECT count(*) FROM abacus_contours('pyramid', 2.5, polygonize => true, attribute => 'height', lower => '{5,5}', upper => '{6,6}');
SELECT count(*) FROM abacus_contours('pyramid', 2.5, attribute => 'height', lower => '{1,1}', upper => '{1,3}');
-- a line along the border belongs to the window where the ground falls
SELECT (SELECT count(*) FROM abacus_contours('pyramid', 5, attribute => 'height', lower => '{0,0}', upper => '{1,4}')) AS low,
       (SELECT count(*) FROM abacus_contours('pyramid', 5, attribute => 'height', lower => '{1,0}', upper => '{2,4}')) AS high;
-- nothing there
SELECT count(*) FROM abacus_contours(NULL, 1);
SELECT abacus_create('empty', 2, '{height}');
SELECT count(*) FROM abacus_contours('empty', 1);
SELECT count(*) FROM abacus_contours('empty', 1, polygonize => true, lower => '{0,0}', upper => '{1,1}');
SELECT abacus_triangulate('unknown', 'SELECT id, x, y, NULL::float8 FROM (VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)) AS t (id, x, y)', '{height}');
SELECT count(*) FROM abacus_contours('unknown', 1, polygonize => true);
SELECT abacus_triangulate('endless', $$VALUES (1, 0, 0, 'Infinity'::float8), (2, 1, 0, 0), (3, 0, 1, 0), (4, 1, 1, 1)$$, '{height}');
SELECT * FROM abacus_contours('endless', 0.5);
-- values far apart, and near to one another
SELECT abacus_triangulate('far', 'VALUES (1, -1.7e308, -1.7e308, -1.7e308), (2, 1.7e308, -1.7e308, 1.7e308), (3, 0, 1.7e308, 0)', '{height}');
SELECT path FROM abacus_contours('far', fixed_levels => '{0}');
SELECT abacus_triangulate('near', 'VALUES (1, 0, 0, 0), (2, 1, 0, 5e-324), (3, 0, 1, 1e-323)', '{height}');
SELECT value, path FROM abacus_contours('near', fixed_levels => '{5e-324,1e-323}');

-- bad input
\set VERBOSITY default
SELECT * FROM abacus_contours('pyramid', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('pyramid', 1, attribute => 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', -1);
SELECT * FROM abacus_contours('ridge', 'NaN');
SELECT * FROM abacus_contours('ridge', 1, 'Infinity');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', fixed_levels => '{1,NULL}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', fixed_levels => '{{1},{2}}');
SELECT * FROM abacus_contours('ridge', fixed_levels => '{1,NaN}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', 1, lower => '{0,0}');
SELECT * FROM abacus_contours('ridge', 1, lower => '{2,0}', upper => '{1,1}');
SELECT * FROM abacus_contours('ridge', 1, max_edge => 'NaN');
-- too many levels, and levels that are equal in double precision
SELECT * FROM abacus_contours('ridge', 1e-9);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', 1e-20);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', 0.1, 1e17);
-- more lines than temporary files may hold are counted, not written
SET temp_file_limit = '16MB';
SELECT * FROM abacus_contours('ridge', 5e-5);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('ridge', 5e-7, polygonize => true);
SELECT * FROM abacus_contours('ridge', 5e-7, lower => '{0.25,0.25}', upper => '{1,1}');
SELECT * FROM abacus_contours('ridge', fixed_levels => (SELECT array_agg(i * 5e-5) FROM generate_series(0, 1000000) AS i));
RESET temp_file_limit;
-- a million are not too many
SELECT count(*), min(value), max(value) FROM abacus_contours('ridge', 5e-5);
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0, 1), (2, 1, 0, 0, 2), (3, 0, 1, 0, 3), (4, 0, 0, 1, 4)', '{heat}', dimension => 3);
SELECT * FROM abacus_contours('solid', 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_contours('pg_class', 1);
DROP TABLE pyramid, pyramid_vertices, ridge, ridge_vertices, saddle, saddle_vertices, empty, empty_vertices, unknown, unknown_vertices, endless, endless_vertices, far, far_vertices, near, near_vertices, solid, solid_vertices;

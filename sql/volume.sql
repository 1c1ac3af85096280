-- Areas and volumes: over a base, between meshes, in space; bad arguments.
-- a roof of 4 triangles over a square, its top at (2, 2, 3)
SELECT abacus_triangulate('roof', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 4, 4, 0), (4, 0, 4, 0), (5, 2, 2, 3)', '{height}');
SELECT area, round(surface::numeric, 9) AS surface, cut, fill, net FROM abacus_volume('roof', 0);
SELECT area, round(surface::numeric, 9) AS surface, cut, fill, net FROM abacus_volume('roof', 3);
SELECT area, round(surface::numeric, 9) AS surface, cut, fill, net FROM abacus_volume('roof', 1.5);
SELECT area, cut, fill, net FROM abacus_volume('roof', 10);
-- of a window, cut at its border; a window without an area; one beside the mesh
SELECT * FROM abacus_volume('roof', 0, lower => '{0,0}', upper => '{2,2}');
SELECT * FROM abacus_volume('roof', 0, lower => '{-9,1}', upper => '{9,3}');
SELECT * FROM abacus_volume('roof', 0, lower => '{1,0}', upper => '{1,4}');
SELECT * FROM abacus_volume('roof', 0, lower => '{5,5}', upper => '{6,6}');
-- between two meshes; the name as text, as regclass, as an argument with a name
SELECT abacus_triangulate('ground', 'VALUES (1, -1, 1, 1, 7), (2, 9, 1, 1, 7), (3, -1, 9, 1, 7)', '{height,soil}');
SELECT area, round(cut::numeric, 9) AS cut, round(fill::numeric, 9) AS fill, round(net::numeric, 9) AS net FROM abacus_volume('roof', 'ground', 'height');
SELECT area, surface, round(cut::numeric, 9) AS cut, round(fill::numeric, 9) AS fill, round(net::numeric, 9) AS net FROM abacus_volume('ground', 'roof'::regclass, 'height');
SELECT round(net::numeric, 9) AS net FROM abacus_volume('roof', other => 'ground', attribute => 'height', lower => '{0,0}', upper => '{2,2}');
SELECT net FROM abacus_volume('roof', 'ground', other_attribute => 'soil');
SELECT net FROM abacus_volume('ground', 'ground', 'soil', other_attribute => 'height', lower => '{0,2}', upper => '{1,3}');
SELECT area, cut, fill, net FROM abacus_volume('roof', 'roof');
-- triangles with a long edge, or without a height, are left out
SELECT area FROM abacus_volume('roof', 0, max_edge => 3.9);
SELECT area FROM abacus_volume('roof', 0, max_edge => 4);
SELECT area FROM abacus_volume('roof', 'ground', 'height', max_edge => 9);
SELECT abacus_triangulate('gaps', 'VALUES (1, 0, 0, 1), (2, 4, 0, 1), (3, 4, 4, 1), (4, 0, 4, NULL), (5, 2, 2, ''Infinity''::float8), (6, 2, 1, 2)', '{height}');
SELECT area, round(cut::numeric, 9) AS cut FROM abacus_volume('gaps', 0);
SELECT area, round(cut::numeric, 9) AS cut, fill FROM abacus_volume('gaps', 'roof');
SELECT abacus_triangulate('unknown', 'VALUES (1, 0, 0, NULL::float8), (2, 4, 0, NULL), (3, 4, 4, NULL)', '{height}');
SELECT * FROM abacus_volume('unknown', 0);
SELECT * FROM abacus_volume('roof', 'unknown');
-- in space: where a value is at least the base
SELECT abacus_triangulate('rock', 'SELECT 25 * x + 5 * y + z, x, y, z, z AS grade FROM generate_series(0, 4) x, generate_series(0, 4) y, generate_series(0, 4) z', dimension => 3);
SELECT * FROM abacus_volume('rock', 1);
SELECT * FROM abacus_volume('rock', 2.5, lower => '{1,1,0}', upper => '{2,2,4}');
SELECT * FROM abacus_volume('rock', 9);
-- an empty mesh; NULL
SELECT abacus_create('empty', 2, '{height}');
SELECT * FROM abacus_volume('empty', 0);
SELECT * FROM abacus_volume('empty', 'roof');
SELECT * FROM abacus_volume('roof', 'empty');
SELECT abacus_volume(NULL, 0) IS NULL AS of_null, abacus_volume('roof', NULL::float8) IS NULL AS base, abacus_volume('roof', NULL::regclass) IS NULL AS other, abacus_volume('roof', NULL::text) IS NULL AS name;
-- what cannot be asked
SELECT abacus_volume('roof', 'NaN'::float8);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', '-Infinity'::float8);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 0, 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('ground', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('ground', 'roof', 'soil');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 'ground', other_attribute => 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 0, lower => '{1,1}', upper => '{0,2}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 0, lower => '{1,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 0, lower => '{1,1,1}', upper => '{2,2,2}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 'ground', 'height', lower => '{1,NaN}', upper => '{2,2}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 0, max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 'rock', 'height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('rock', 'roof');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 'nowhere');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', 'pg_class'::regclass);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('pg_class', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('bare', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4)');
SELECT abacus_volume('bare', 0);
\echo :LAST_ERROR_SQLSTATE
-- doubles are too small for these
SELECT abacus_triangulate('vast', 'VALUES (1, 0, 0, 1), (2, 1e200, 0, 1), (3, 0, 1e200, 1)', '{height}');
SELECT abacus_volume('vast', 0);
\echo :LAST_ERROR_SQLSTATE
-- what is in quotes is a base, if it is a number
SELECT (SELECT v FROM abacus_volume('roof', '2', 'height') AS v) = (SELECT v FROM abacus_volume('roof', 2, 'height') AS v) AS same,
       (SELECT v FROM abacus_volume('roof', ' -1.5e0 ', 'height') AS v) = (SELECT v FROM abacus_volume('roof', -1.5, 'height') AS v) AS negative;
SELECT abacus_volume('roof', '2', 'height', other_attribute => 'height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('roof', '2 m', 'height');
\echo :LAST_ERROR_SQLSTATE
-- both meshes must be readable
CREATE ROLE abacus_volume_reader;
GRANT SELECT ON roof TO abacus_volume_reader;
SET ROLE abacus_volume_reader;
SELECT area FROM abacus_volume('roof', 0);
SELECT abacus_volume('roof', 'ground', 'height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_volume('ground', 'roof', 'height');
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;
REVOKE SELECT ON roof FROM abacus_volume_reader;
DROP ROLE abacus_volume_reader;
DROP TABLE roof, ground, gaps, unknown, rock, empty, bare, vast;

-- How two meshes differ.
SELECT abacus_triangulate('compare_low', 'VALUES (1, 0, 0, 0.0), (2, 4, 0, 0.0), (3, 4, 4, 0.0), (4, 0, 4, 0.0)', '{h}');
SELECT abacus_triangulate('compare_roof', 'VALUES (1, 0, 0, 0.0), (2, 4, 0, 0.0), (3, 4, 4, 0.0), (4, 0, 4, 0.0), (5, 2, 2, 3.0)', '{h}');
SELECT * FROM abacus_compare('compare_roof', 'compare_low');
SELECT greatest, x, y, mean, mean_absolute FROM abacus_compare('compare_low', 'compare_roof', lower => '{1, 0}', upper => '{1.5, 1}');
SELECT greatest, mean, rms FROM abacus_compare('compare_roof', 'compare_roof');
SELECT greatest, x, y FROM abacus_compare('compare_roof', 'compare_low', within => 'POLYGON((0 0, 1 0, 1 1, 0 1, 0 0))');
SELECT * FROM abacus_compare('compare_roof', 'compare_low', lower => '{8, 8}', upper => '{9, 9}');
SELECT abacus_compare(NULL, 'compare_low');
SELECT abacus_compare('compare_roof', 'compare_low', 'slope');
SELECT abacus_triangulate('compare_solid', 'VALUES (1, 0, 0, 0, 1), (2, 1, 0, 0, 1), (3, 0, 1, 0, 1), (4, 0, 0, 1, 1)', '{h}', dimension => 3);
SELECT abacus_compare('compare_roof', 'compare_solid');
SELECT abacus_compare('compare_solid', 'compare_roof');
DROP TABLE compare_low, compare_roof, compare_solid;
-- in space
SELECT abacus_triangulate('compare_cube', $$SELECT 4 * x + 2 * y + z, x, y, z, x + y FROM generate_series(0, 1) AS x, generate_series(0, 1) AS y, generate_series(0, 1) AS z$$, '{h}', dimension => 3);
SELECT abacus_triangulate('compare_peak', $$SELECT 4 * x + 2 * y + z, x, y, z, x + y FROM generate_series(0, 1) AS x, generate_series(0, 1) AS y, generate_series(0, 1) AS z
    UNION ALL VALUES (9, 0.5, 0.5, 0.5, 5)$$, '{h}', dimension => 3);
SELECT greatest, x, y, z, round(mean::numeric, 12) AS mean, round(mean_absolute::numeric, 12) AS mean_absolute, round((rms * rms)::numeric, 12) AS squares FROM abacus_compare('compare_peak', 'compare_cube');
SELECT greatest, x, y, z, round(mean::numeric, 12) AS mean FROM abacus_compare('compare_cube', 'compare_peak', lower => '{0, 0, 0}', upper => '{0.25, 1, 1}');
SELECT * FROM abacus_compare('compare_peak', 'compare_peak');
SELECT * FROM abacus_compare('compare_peak', 'compare_cube', lower => '{8, 8, 8}', upper => '{9, 9, 9}');
SELECT abacus_compare('compare_peak', 'compare_cube', lower => '{0, 0}', upper => '{1, 1}');
SELECT abacus_compare('compare_peak', 'compare_cube', within => 'POLYGON((0 0, 1 0, 1 1, 0 0))');
DROP TABLE compare_cube, compare_peak;
-- numbers of any size
SELECT abacus_triangulate('compare_large', $$SELECT 4 * x + y, x * 1e170, y * 1e170, 1e200 FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y$$, '{h}');
SELECT abacus_triangulate('compare_huge', $$SELECT x AS id, x * 1e170 AS x, (x % 2) * 2e170 AS y, x * 1e200 AS h FROM generate_series(0, 3) AS x$$, '{h}');
SELECT greatest, x, y, mean, mean_absolute FROM abacus_compare('compare_large', 'compare_huge');
DROP TABLE compare_huge;
SELECT abacus_triangulate('compare_tiny', $$SELECT 4 * x + y, x * 1e-170, y * 1e-170, x * 1e-200 FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y$$, '{h}');
SELECT greatest, x, y, mean, mean_absolute, rms FROM abacus_compare('compare_tiny', 'compare_tiny');
SELECT abacus_compare('compare_tiny', 'compare_large');
DROP TABLE compare_tiny, compare_large;
SELECT abacus_triangulate('compare_high', 'VALUES (1, 0, 0, 1.5e308), (2, 4, 0, 1.5e308), (3, 0, 4, 1.5e308)', '{h}');
SELECT abacus_triangulate('compare_deep', 'VALUES (1, 0, 0, -1.5e308), (2, 4, 0, -1.5e308), (3, 0, 4, -1.5e308)', '{h}');
SELECT greatest, mean, rms FROM abacus_compare('compare_high', 'compare_high');
SELECT abacus_compare('compare_high', 'compare_deep');
DROP TABLE compare_high, compare_deep;

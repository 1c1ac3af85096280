-- Triangulating, and what comes out. Corners are shown from the least id on.
CREATE FUNCTION triangles(mesh regclass) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT CASE least(v0, v1, v2) WHEN v0 THEN format('%s %s %s', v0, v1, v2)
                                  WHEN v1 THEN format('%s %s %s', v1, v2, v0)
                                  ELSE format('%s %s %s', v2, v0, v1) END
    FROM abacus_simplices(mesh) ORDER BY 1
$$;

SELECT abacus_triangulate('square', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 3), (4, 0, 3), (5, 1, 1)');
SELECT triangles('square');
SELECT * FROM abacus_check('square');

-- The four points on which GEOS is wrong (issue 1286 of libgeos).
CREATE TABLE four (id int, x float8, y float8);
INSERT INTO four VALUES
    (1, -1.3890020986020145e-10, 4.860466764224401),
    (2, -1.3889120965221466e-10, -5.531838081766228),
    (3, -1.388852095135568e-10, -12.460041312426647),
    (4, 0.9999999999166641, -3.799787274101123);
SELECT abacus_triangulate('four_mesh', 'TABLE four');
SELECT triangles('four_mesh');
SELECT * FROM abacus_check('four_mesh');

-- A grid: every cell is cocircular, yet the result does not depend on the order.
SELECT abacus_triangulate('grid', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399) i');
SELECT abacus_triangulate('grid_back', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399) i ORDER BY i DESC');
SELECT abacus_triangulate('grid_mixed', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399) i ORDER BY md5(i::text)');
SELECT count(*) FROM triangles('grid');
SELECT (SELECT array_agg(t) FROM triangles('grid') t) = (SELECT array_agg(t) FROM triangles('grid_back') t) AS back,
       (SELECT array_agg(t) FROM triangles('grid') t) = (SELECT array_agg(t) FROM triangles('grid_mixed') t) AS mixed;

-- In steps, and with the smallest cache: the same again.
SET abacus.cache_size = '1MB';
SELECT abacus_create('grid_steps', 2, lower => '{0,0}', upper => '{19,19}');
SELECT abacus_stage('grid_steps', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399, 2) i');
SELECT abacus_triangulate('grid_steps') > 0 AS half;
SELECT abacus_stage('grid_steps', 'SELECT i, i % 20, i / 20 FROM generate_series(1, 399, 2) i');
SELECT abacus_triangulate('grid_steps');
SELECT (SELECT array_agg(t) FROM triangles('grid') t) = (SELECT array_agg(t) FROM triangles('grid_steps') t) AS steps;
SELECT * FROM abacus_check('grid_steps');
RESET abacus.cache_size;
-- nothing staged: nothing to do
SELECT abacus_triangulate('grid_steps');

-- Attributes are named after the columns of the query.
SELECT abacus_triangulate('named', 'SELECT i AS a, i % 3 AS b, i / 3 AS c, i * 10 AS height, -i AS depth FROM generate_series(0, 8) i');
SELECT id, attributes FROM abacus_vertices('named') ORDER BY id LIMIT 3;
SELECT abacus_triangulate('named_given', 'SELECT i, i % 3, i / 3, i * 10, -i FROM generate_series(0, 8) i', '{height,depth}');
SELECT abacus_triangulate('unnamed', 'SELECT i, i % 3, i / 3, i * 10, -i FROM generate_series(0, 8) i');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('unnamed', 'SELECT i, i % 3, i / 3, i * 10, -i FROM generate_series(0, 8) i', '{height}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('unnamed', 'SELECT i, i FROM generate_series(0, 8) i');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('unnamed', 'SELECT 1, 2, 3', dimension => 4);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('unnamed', NULL);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('square', 'SELECT 1, 2, 3');
\echo :LAST_ERROR_SQLSTATE
SELECT to_regclass('unnamed') IS NULL AS nothing_left;

-- A domain that is far too small, or far too large, only costs time.
SELECT abacus_triangulate('small_domain', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399) i', lower => '{8,8}', upper => '{9,9}');
SELECT abacus_triangulate('large_domain', 'SELECT i, i % 20, i / 20 FROM generate_series(0, 399) i', lower => '{-1e300,-1e300}', upper => '{1e300,1e300}');
SELECT (SELECT array_agg(t) FROM triangles('grid') t) = (SELECT array_agg(t) FROM triangles('small_domain') t) AS small,
       (SELECT array_agg(t) FROM triangles('grid') t) = (SELECT array_agg(t) FROM triangles('large_domain') t) AS large;
SELECT * FROM abacus_check('small_domain') UNION ALL SELECT * FROM abacus_check('large_domain');

DROP TABLE square, four, four_mesh, grid, grid_back, grid_mixed, grid_steps, named, named_given,
    small_domain, large_domain;
DROP FUNCTION triangles;

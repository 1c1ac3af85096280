-- Parts of a mesh: windows, stars, neighbours.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10, 1), (2, 4, 0, 20, 2), (3, 4, 4, 30, 3), (4, 0, 4, NULL, 4), (5, 2, 1, 50, 5)', '{height,depth}');
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 0, 4, 0), (4, 0, 0, 4), (5, 1, 1, 1)', dimension => 3);
-- simplices that meet a window: closed, so also those that touch it
SELECT v0, v1, v2 FROM abacus_simplices('field', ARRAY[0.5, 3], ARRAY[1, 3.5]) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_simplices('field', ARRAY[4, 4], ARRAY[9, 9]) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_simplices('field', ARRAY[2, 1], ARRAY[2, 1]) ORDER BY 1, 2, 3;
SELECT count(*) FROM abacus_simplices('field', ARRAY[4.001, 0], ARRAY[9, 9]);
SELECT count(*) FROM abacus_simplices('solid', ARRAY[1, 1, 1], ARRAY[2, 2, 2]);
-- a ball touches what is exactly as far away as its radius
SELECT v0, v1, v2 FROM abacus_simplices('field', ARRAY[7, 8], 5) ORDER BY 1, 2, 3;
SELECT count(*) FROM abacus_simplices('field', ARRAY[7, 8], 4.999999999999999);
SELECT count(*) FROM abacus_simplices('field', ARRAY[2, 6], 2);
SELECT count(*) FROM abacus_simplices('solid', ARRAY[1, 1, 1], 0);
-- cells: corners and attributes come with them
SELECT v0, v1, v2, corners, "values" FROM abacus_cells('field') ORDER BY 1, 2, 3;
SELECT v0, v1, v2, v3, corners, "values" FROM abacus_cells('solid', ARRAY[4, 0, 0], ARRAY[5, 0, 0]) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_cells('field', max_edge => 3.9) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_cells('field', max_edge => 4) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_cells('field', center => '{7, 8}', radius => 5, max_edge => 5) ORDER BY 1, 2, 3;
SELECT bool_and(code IS NOT DISTINCT FROM (abacus_locate('field', (corners[1][1] + corners[2][1] + corners[3][1]) / 3, (corners[1][2] + corners[2][2] + corners[3][2]) / 3)).code) AS same FROM abacus_cells('field');
-- vertices in a window, its border included; none of the points that are equal to one, or wait
SELECT abacus_insert('field', 'VALUES (6, 2, 1, 60, 6)'), abacus_stage('field', 'VALUES (7, 2, 0.5, 70, 7)');
SELECT * FROM abacus_vertices('field', ARRAY[2, 0], ARRAY[4, 1]) ORDER BY id;
SELECT id, x, y FROM abacus_vertices('field', ARRAY[7, 8], 5);
SELECT count(*) FROM abacus_vertices('field', ARRAY[7, 8], 4.999999999999999);
SELECT id, x, y, z FROM abacus_vertices('solid', ARRAY[0, 0, 0], ARRAY[1, 1, 9]) ORDER BY id;
-- those with an attribute in a range; a missing value is in none
SELECT id, attributes FROM abacus_vertices('field', 'height', 20, 30) ORDER BY id;
SELECT id, attributes FROM abacus_vertices('field', 'depth', 3.5, 'Infinity') ORDER BY id;
SELECT id FROM abacus_vertices('field', 'height', '-Infinity', 'Infinity') ORDER BY id;
SELECT id FROM abacus_vertices('field', 'depth', 2, 5, ARRAY[0, 0], ARRAY[3, 9]) ORDER BY id;
SELECT count(*) FROM abacus_vertices('field', 'height', 11, 19);
SELECT id, attributes FROM abacus_vertices('field', attribute => 'height', range => '{20,30}') ORDER BY id;
SELECT id, attributes FROM abacus_vertices('field', '{0,0}', '{3,9}', attribute => 'depth', range => '{2,Infinity}') ORDER BY id;
SELECT id, attributes FROM abacus_vertices('field', '{0,0}', '{3,9}', 'depth', '{2,Infinity}') ORDER BY id;
SELECT (SELECT count(*) FROM abacus_vertices('field', '{0,0}', '{3,9}', 'height')) AS quoted, (SELECT count(*) FROM abacus_vertices('field', ARRAY[0, 0], ARRAY[3, 9], 'height')) AS plain;
SELECT id, attributes FROM abacus_vertices('field', attribute => 'height') ORDER BY id;
-- two texts in quotes are the corners of a window, everywhere; a text and an array are, too
SELECT (SELECT count(*) FROM abacus_cells('field', '{2,1}', '{2,1}')) AS cells, (SELECT count(*) FROM abacus_simplices('field', '{2,1}', '{2,1}')) AS simplices,
       (SELECT count(*) FROM abacus_vertices('field', '{2,1}', '{2,1}')) AS vertices, (SELECT count(*) FROM abacus_edges('field', '{2,1}', '{2,1}')) AS edges,
       (SELECT count(*) FROM abacus_voronoi('field', '{2,1}', '{2,1}')) AS voronoi, (SELECT count(*) FROM abacus_voronoi_facets('field', '{0,0}', '{4,4}')) AS voronoi_facets;
SELECT (SELECT count(*) FROM abacus_cells('field', ARRAY[2, 1], '{2,1}')) AS cells, (SELECT count(*) FROM abacus_simplices('field', '{2,1}', ARRAY[2, 1])) AS simplices,
       (SELECT count(*) FROM abacus_vertices('field', ARRAY[2, 1], '{2,1}')) AS vertices, (SELECT count(*) FROM abacus_edges('field', '{2,1}', ARRAY[2, 1])) AS edges;
SELECT (SELECT count(*) FROM abacus_cells('field', '{2,1}', '{2,1}', 3)) AS cells, (SELECT count(*) FROM abacus_cells('field', '{2,1}', '{2,1}', max_edge => 4)) AS cells_4,
       (SELECT count(*) FROM abacus_edges('field', '{2,1}', '{2,1}', 3)) AS edges, (SELECT count(*) FROM abacus_cells('field', NULL, NULL)) AS whole;
SELECT (SELECT count(*) FROM abacus_cells('field', '{2,1}', 0)) AS cells, (SELECT count(*) FROM abacus_simplices('field', '{2,1}', 0.0)) AS simplices,
       (SELECT count(*) FROM abacus_vertices('field', '{2,1}', 0)) AS vertices, (SELECT count(*) FROM abacus_edges('field', '{2,1}', radius => '0')) AS edges;
PREPARE part AS SELECT count(*) FROM abacus_vertices($1, $2, $3);
EXECUTE part('field', '{0,0}', '{4,4}');
PREPARE ends AS SELECT count(*) FROM abacus_vertices($1, $2, $3, $4);
EXECUTE ends('field', 'height', '20', '30');
DEALLOCATE part;
DEALLOCATE ends;
-- edges, each once
SELECT v0, v1, round(length::numeric, 3) AS length FROM abacus_edges('field') ORDER BY 1, 2;
SELECT v0, v1 FROM abacus_edges('field', max_edge => 3) ORDER BY 1, 2;
SELECT v0, v1 FROM abacus_edges('field', ARRAY[2, -1], ARRAY[3, 0]) ORDER BY 1, 2;
SELECT v0, v1 FROM abacus_edges('field', ARRAY[2, 6], 2);
SELECT v0, v1 FROM abacus_edges('solid') ORDER BY 1, 2;
SELECT v0, v1 FROM abacus_edges('solid', ARRAY[0, 0, 2], 1.5, max_edge => 4) ORDER BY 1, 2;
-- all around a vertex, an edge, a place
SELECT v0, v1, v2 FROM abacus_star('field', 2, 1) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_star('field', 1, 0.5) ORDER BY 1, 2, 3;
SELECT v0, v1, v2 FROM abacus_star('field', 2, 0.5) ORDER BY 1, 2, 3;
SELECT count(*) FROM abacus_star('field', 9, 9);
SELECT count(*) FROM abacus_star('field', 'Infinity', 9);
SELECT count(*) FROM abacus_star('solid', 1, 1, 1);
-- across so many facets
SELECT steps, count(n.*) FROM generate_series(0, 3) AS steps, LATERAL abacus_neighbours('field', abacus_locate('field', 2, 0.5), steps) AS n GROUP BY steps ORDER BY steps;
SELECT v0, v1, v2 FROM abacus_neighbours('field', abacus_locate('field', 2, 0.5), 0);
SELECT count(*) FROM abacus_neighbours('field', abacus_locate('field', 9, 9), 1);
-- an empty mesh, NULL
SELECT abacus_create('empty', 2);
SELECT (SELECT count(*) FROM abacus_cells('empty')) AS cells, (SELECT count(*) FROM abacus_simplices('empty', ARRAY[0, 0], ARRAY[1, 1])) AS simplices,
       (SELECT count(*) FROM abacus_cells(NULL)) AS of_null, (SELECT count(*) FROM abacus_star('empty', 0, 0)) AS star,
       (SELECT count(*) FROM abacus_vertices('empty', ARRAY[0, 0], 1)) AS vertices, (SELECT count(*) FROM abacus_edges('empty')) AS edges;
-- a cursor ends early
BEGIN;
DECLARE reader CURSOR FOR SELECT abacus_cells('field', ARRAY[0, 0], ARRAY[9, 9]);
MOVE 1 FROM reader;
COMMIT;
-- what cannot be asked
SELECT abacus_simplices('field', ARRAY[1, 1], ARRAY[0, 2]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_simplices('field', ARRAY[1, 1], ARRAY['NaN', 2]::float8[]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_simplices('field', ARRAY[1, '-Infinity']::float8[], ARRAY[1, 2]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_simplices('field', ARRAY[1, 1, 1], ARRAY[2, 2, 2]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', lower => ARRAY[1, 1]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', ARRAY[1, 1], -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', ARRAY[1, 1], 'Infinity'::float8);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', ARRAY[1, 'NaN']::float8[], 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', ARRAY[1, 1], NULL::float8);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_cells('field', max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', ARRAY[1, 1], ARRAY[0, 2]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('solid', ARRAY[1, 1], 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', 'width', 1, 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', 'height', 2, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', 'height', 2, 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', 'height', 2, NULL);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', range => '{1,2}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', '{0,0}', '9');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_vertices('field', 'height', 2, 3, upper => ARRAY[1, 1]);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_edges('field', max_edge => 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_star('field', 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_star('field', 1, 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_neighbours('field', abacus_locate('field', 2, 0.5), -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_neighbours('field', (1, 2, 3, 4, NULL), 1);
\echo :LAST_ERROR_SQLSTATE
DROP TABLE field, solid, empty;

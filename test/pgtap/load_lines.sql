-- abacus_load(..., lines => ...): triangulations with fixed edges, loaded as meshes that can be changed.
BEGIN;
SELECT no_plan();

CREATE FUNCTION pg_temp.triangles(mesh regclass) RETURNS TABLE (v0 bigint, v1 bigint, v2 bigint) LANGUAGE sql AS
    $$ SELECT v0, v1, v2 FROM abacus_simplices(mesh) $$;
CREATE FUNCTION pg_temp.fixed(mesh regclass) RETURNS TABLE (v0 bigint, v1 bigint, lines bigint[], kind text) LANGUAGE sql AS
    $$ SELECT v0, v1, lines, kind FROM abacus_edges(mesh, fixed => true) $$;

-- A mesh with lines, out and in again: rows in any order, corners and ends turned.
CREATE TABLE place AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y, i * 0.5 AS height FROM generate_series(1, 4000) AS i;
CREATE TABLE corner AS SELECT line, position, (SELECT id FROM place ORDER BY (x - x0) ^ 2 + (y - y0) ^ 2, id LIMIT 1) AS point
FROM (SELECT 1 AS line, k AS position, 500 + 350 * cos(1.2 * k) AS x0, 500 + 350 * sin(1.2 * k) AS y0 FROM generate_series(0, 4) AS k
      UNION ALL VALUES (2, 1, 10, 15), (2, 2, 40, 900), (3, 1, 60, 20), (3, 2, 90, 950), (4, 1, 950, 30), (4, 2, 960, 990)) AS l;
SELECT abacus_triangulate('fresh', 'TABLE place', lines => 'TABLE corner');
SELECT abacus_constrain('fresh', 'SELECT 10 + 5000 * v0 + v1, i, CASE i WHEN 1 THEN v0 ELSE v1 END FROM abacus_edges(''fresh''), generate_series(1, 2) AS i WHERE (31 * v0 + v1) % 20 = 0');
CREATE TABLE given AS SELECT l.line, e.v0, e.v1 FROM abacus_edges('fresh', fixed => true) AS e, unnest(e.lines) AS l (line);
SELECT cmp_ok((SELECT count(*) FROM given), '>', 100::bigint, 'many edges are fixed');

CREATE FUNCTION pg_temp.compare(mesh text, of text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    RETURN NEXT set_eq(format('SELECT * FROM pg_temp.triangles(%L)', mesh), format('SELECT * FROM pg_temp.triangles(%L)', of), mesh || ' has the triangles of ' || of);
    RETURN NEXT set_eq(format('SELECT * FROM pg_temp.fixed(%L)', mesh), format('SELECT * FROM pg_temp.fixed(%L)', of), mesh || ' has the fixed edges of ' || of);
    RETURN NEXT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), mesh || ' is sound');
END $$;

SELECT is(abacus_load('copy', 'TABLE place', 'SELECT v0, v1, v2 FROM abacus_simplices(''fresh'')', lines => 'TABLE given'),
          (SELECT count(*) FROM abacus_simplices('fresh')), 'all triangles');
SELECT pg_temp.compare('copy', 'fresh');
SELECT is((SELECT value FROM abacus_stats('copy') WHERE name = 'changeable'), 1::float8, 'it can be changed');
SELECT set_eq($$ SELECT line FROM abacus_lines('copy') $$, $$ SELECT line FROM abacus_lines('fresh') $$, 'it has the lines');
SET LOCAL abacus.threads = 2;
SET LOCAL abacus.tiny_intervals = on;
SET LOCAL abacus.cache_size = '1MB';
SET LOCAL maintenance_work_mem = '1MB';
SELECT abacus_load('shuffled', 'SELECT * FROM place ORDER BY hashint4(id)', 'SELECT v2, v0, v1 FROM abacus_simplices(''fresh'') ORDER BY hashint8(v0 + v1 + v2)',
                   lines => 'SELECT line::int, v1, v0::int FROM given ORDER BY hashint8(v0 + v1)');
RESET abacus.tiny_intervals;
SELECT pg_temp.compare('shuffled', 'fresh');
RESET abacus.threads;
RESET abacus.cache_size;
RESET maintenance_work_mem;

-- It changes like any other mesh with lines.
SELECT is(abacus_insert(mesh, 'SELECT -id, x + 0.25, y + 0.25, 0 FROM place WHERE id <= 500'), 500::bigint, 'points can be inserted into ' || mesh)
FROM unnest('{fresh,copy}'::text[]) AS mesh;
SELECT pg_temp.compare('copy', 'fresh');
SELECT is(abacus_delete(mesh, 'SELECT id, x, y FROM place WHERE id > 3000 AND id NOT IN (SELECT point FROM corner) AND id NOT IN (SELECT v0 FROM given UNION SELECT v1 FROM given)'),
          (SELECT count(*) FROM place WHERE id > 3000 AND id NOT IN (SELECT v0 FROM given UNION SELECT v1 FROM given)), 'and deleted from ' || mesh)
FROM unnest('{fresh,copy}'::text[]) AS mesh;
SELECT pg_temp.compare('copy', 'fresh');
SELECT throws_ok($$ SELECT abacus_delete('copy', 'SELECT id, x, y FROM place JOIN given ON id = v0 LIMIT 1') $$, NULL, 'a point that a line names stays');
SELECT is(abacus_unconstrain('copy', 'VALUES (1), (3)'), 2::bigint, 'lines can be removed');
SELECT is(abacus_unconstrain('fresh', 'VALUES (1), (3)'), 2::bigint, 'and in the other mesh');
SELECT pg_temp.compare('copy', 'fresh');
SELECT is(abacus_constrain('copy', 'SELECT * FROM corner WHERE line IN (1, 3)'), 2::bigint, 'and added again');
SELECT is(abacus_constrain('fresh', 'SELECT * FROM corner WHERE line IN (1, 3)'), 2::bigint, 'in both');
SELECT pg_temp.compare('copy', 'fresh');
DROP TABLE copy, shuffled, fresh;

-- A line is the chains of its edges; two lines may have one edge.
CREATE TABLE node AS SELECT 10 * x + y AS id, x, y FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y;
SELECT abacus_triangulate('grid', 'TABLE node');
SELECT abacus_load('chained', 'TABLE node', 'SELECT v0, v1, v2 FROM abacus_simplices(''grid'')',
                   lines => 'VALUES (1, 11, 12), (1, 12, 13), (2, 13, 12), (1, 33, 34), (1, 34, 35), (2, 12, 11), (1, 37, 36), (3, 0, 1)');
SELECT results_eq($$ SELECT line, position, point, part, kind FROM abacus_lines('chained') ORDER BY line, position $$, $$
    VALUES (1::bigint, 1::bigint, 11::bigint, 0::bigint, 'hard'), (1, 2, 12, 0, 'hard'), (1, 3, 13, 0, 'hard'), (1, 4, 33, 1, 'hard'), (1, 5, 34, 1, 'hard'), (1, 6, 35, 1, 'hard'),
           (1, 7, 37, 2, 'hard'), (1, 8, 36, 2, 'hard'), (2, 1, 13, NULL, 'hard'), (2, 2, 12, NULL, 'hard'), (2, 3, 11, NULL, 'hard'), (3, 1, 0, NULL, 'hard'), (3, 2, 1, NULL, 'hard') $$,
    'chains are parts');
SELECT set_eq($$ SELECT v0, v1, lines FROM abacus_edges('chained', fixed => true) $$, $$
    VALUES (11::bigint, 12::bigint, '{1,2}'::bigint[]), (12, 13, '{1,2}'), (33, 34, '{1}'), (34, 35, '{1}'), (36, 37, '{1}'), (0, 1, '{3}') $$, 'their edges are fixed');
DROP TABLE chained;

-- The square's other diagonals: ties, which are flipped unless they are on lines. Triangles inherit labels there.
CREATE TABLE other AS
SELECT a AS v0, c AS v1, d AS v2, 10 * x + y + 0.5 AS cell, a, b, c, d FROM generate_series(0, 8) AS x, generate_series(0, 8) AS y,
    LATERAL (VALUES (10 * x + y, 10 * x + 10 + y, 10 * x + 11 + y, 10 * x + y + 1)) AS s (a, b, c, d)
UNION ALL SELECT a, b, c, 10 * x + y, a, b, c, d FROM generate_series(0, 8) AS x, generate_series(0, 8) AS y,
    LATERAL (VALUES (10 * x + y, 10 * x + 10 + y, 10 * x + 11 + y, 10 * x + y + 1)) AS s (a, b, c, d);
CREATE TABLE diagonal AS SELECT a % 7 AS line, a AS v0, c AS v1 FROM other WHERE a % 3 = 0 AND v1 = c;
SELECT abacus_triangulate('lined', 'TABLE node', lines => 'SELECT v0, 1, v0 FROM diagonal UNION ALL SELECT v0, 2, v1 FROM diagonal');
SELECT abacus_load('flipped', 'TABLE node', 'SELECT v0, v1, v2, floor(cell) FROM other', labels => '{cell}', lines => 'SELECT v0, v0, v1 FROM diagonal',
                   facets => 'SELECT v0, v1, 7 FROM diagonal UNION ALL SELECT a, c, 8 FROM other WHERE a % 3 <> 0 AND v1 = c UNION ALL VALUES (0, 1, 9)');
SELECT pg_temp.compare('flipped', 'lined');
SELECT results_eq($$ SELECT count(*), count(DISTINCT labels), count(labels[1]) FROM abacus_cells('flipped') $$, $$ VALUES (162::bigint, 81::bigint, 162::bigint) $$,
                  'each square still has its label');
SELECT results_eq($$ SELECT marker, count(*) FROM abacus_facets('flipped') GROUP BY marker ORDER BY marker $$,
                  $$ VALUES (7, (SELECT count(*) FROM diagonal)), (9, 1::bigint) $$, 'edges that are there have their markers');
SELECT throws_ok($$ SELECT abacus_load('loud', 'TABLE node', 'SELECT v0, v1, v2 FROM other', lines => 'VALUES (1, 0, 10, 4)') $$, '42804', NULL, 'four columns');
SELECT is((SELECT count(*) FROM abacus_stats('flipped') WHERE name = 'labels_inherited' AND value > 0), 0::bigint, 'later triangles inherit nothing');
SELECT abacus_insert('flipped', 'SELECT 1000, 0.5, 0.25');
SELECT is((SELECT count(labels[1]) FROM abacus_cells('flipped')), 161::bigint, 'those around a new point have no label');

-- Also without any line.
SELECT abacus_load('unlined', 'TABLE node', 'SELECT v0, v1, v2 FROM other', lines => 'SELECT 1, 2, 3 WHERE false');
SELECT pg_temp.compare('unlined', 'grid');
SELECT is(to_regclass('unlined_lines'), NULL, 'there is no table of lines');
SELECT is(abacus_insert('unlined', 'SELECT 1000, 0.5, 0.25'), 1::bigint, 'it can be changed');
DROP TABLE unlined;
SELECT abacus_load('weak', 'TABLE node', 'SELECT v0, v1, v2 FROM other');
SELECT throws_ok($$ SELECT abacus_insert('weak', 'SELECT 1000, 0.5, 0.25') $$, '55000', NULL, 'without lines it is as it was given');

-- All edges can be lines, and then all triangulations of a convex hull are constrained ones.
CREATE TABLE strip (id int, x float8, y float8);
INSERT INTO strip VALUES (1, 0, 0), (2, 2, 0), (3, 5, 0), (4, 0, 2), (5, 2, 2), (6, 4, 2);
CREATE TABLE triangle (v0 int, v1 int, v2 int);
INSERT INTO triangle VALUES (1, 2, 4), (2, 5, 4), (2, 3, 5), (6, 5, 3);
SELECT abacus_load('wrong', 'TABLE strip', 'TABLE triangle', lines => 'VALUES (1, 3, 5)');
SELECT set_eq($$ SELECT * FROM pg_temp.triangles('wrong') $$, $$ VALUES (1::bigint, 2::bigint, 4::bigint), (2, 5, 4), (2, 3, 5), (3, 6, 5) $$, 'as given');
SELECT throws_ok($$ SELECT abacus_region('wrong', 'VALUES (''open'', 1)') $$, '22023', NULL, 'a line that is not closed is no outline');
SELECT abacus_load('outlined', 'TABLE strip', 'TABLE triangle', lines => 'VALUES (1, 5, 3), (1, 3, 6), (1, 5, 6)');
SELECT is(abacus_region('outlined', $$ VALUES ('end', 1) $$), 1::bigint, 'a ring of edges is an outline');
SELECT results_eq($$ SELECT region, triangles, area FROM abacus_regions('outlined') $$, $$ VALUES ('end', 1::bigint, 2::float8) $$, 'of a region');

-- What cannot be changed is as it is without lines.
SELECT abacus_load('crooked', 'TABLE strip', 'TABLE triangle', lines => 'VALUES (1, 1, 2)');
SELECT throws_ok($$ SELECT abacus_insert('crooked', 'SELECT 7, 1, 1') $$, '55000', 'the mesh is not a Delaunay triangulation', 'a free edge fails the test');
SELECT is(to_regclass('crooked_lines'), NULL, 'so it has no lines');
SELECT is_empty($$ SELECT * FROM abacus_check('crooked') $$, 'it is sound');
SELECT abacus_load('notched', 'SELECT * FROM strip UNION ALL VALUES (7, 2, 5)', 'TABLE triangle UNION ALL VALUES (4, 5, 7)', lines => 'VALUES (1, 5, 3)');
SELECT is((SELECT value FROM abacus_stats('notched') WHERE name = 'changeable'), 0::float8, 'it has a notch');
SELECT is_empty($$ SELECT * FROM abacus_check('notched') $$, 'sound, though an edge on a line fails the test');

-- Triangulated anew, it has the lines.
SELECT abacus_load('mended', 'SELECT * FROM strip UNION ALL VALUES (7, 2, 5)', 'TABLE triangle UNION ALL VALUES (4, 5, 7)', lines => 'VALUES (1, 5, 3)', retriangulate => true);
SELECT abacus_triangulate('whole', 'SELECT * FROM strip UNION ALL VALUES (7, 2, 5)', lines => 'VALUES (1, 1, 5), (1, 2, 3)');
SELECT pg_temp.compare('mended', 'whole');
SELECT abacus_load('rebuilt', 'TABLE strip', 'TABLE triangle', lines => 'VALUES (1, 1, 2)', retriangulate => true);
SELECT abacus_triangulate('anew', 'TABLE strip', lines => 'VALUES (1, 1, 1), (1, 2, 2)');
SELECT pg_temp.compare('rebuilt', 'anew');
SELECT abacus_load('joined', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1), (15, 2, 2, 1)',
                   'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 15)', lines => 'VALUES (1, 2, 5), (2, 15, 12)', split_nodes => true, retriangulate => true);
SELECT results_eq($$ SELECT lines FROM abacus_edges('joined', fixed => true) $$, $$ VALUES ('{1,2}'::bigint[]) $$, 'both sides of a fault become one edge');
SELECT is_empty($$ SELECT * FROM abacus_check('joined') $$, 'sound');

-- What is wrong.
CREATE FUNCTION pg_temp.load(lines text) RETURNS bigint LANGUAGE sql AS $$ SELECT abacus_load('faulty', 'TABLE strip', 'TABLE triangle', lines => lines) $$;
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (7, 6, 1)') $$, '22023', 'line 7 names edge (1, 6), which no simplex has', 'no edge');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (-7, 6, 99)') $$, '22023', 'line -7 names vertex 99, which no simplex has', 'no vertex');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (7, 6, 6)') $$, '22023', 'line 7 has an edge from vertex 6 to itself', 'one vertex');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (7, 6, NULL::int)') $$, '22004', 'v1 is NULL in row 1 of the query of lines', 'NULL vertex');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (NULL::int, 6, 5)') $$, '22004', 'line is NULL in row 1 of the query of lines', 'NULL line');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (7, 6)') $$, '42804', NULL, 'two columns');
SELECT throws_ok($$ SELECT pg_temp.load('VALUES (7, 6, 5.0)') $$, '42804', 'column 3 (v1) of the query of lines has type numeric', 'no integer');
SELECT throws_ok($$ SELECT pg_temp.load('DELETE FROM strip RETURNING 1, 2, 3') $$, '22023', NULL, 'a query that changes something');
SELECT throws_ok($$ SELECT abacus_load('solid', 'VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 0, 0, 1)', 'VALUES (1, 2, 3, 4)', lines => 'VALUES (1, 1, 2)') $$,
                 '55000', 'mesh "solid" has dimension 3', 'in space');
SELECT throws_ok($$ SELECT abacus_load('faulty', 'TABLE strip', 'SELECT 1, 2, 3 WHERE false', lines => 'VALUES (1, 1, 2)') $$, '22023',
                 'line 1 names vertex 1, which no simplex has', 'a line without triangles');
SELECT is(abacus_load('empty', 'TABLE strip', 'SELECT 1, 2, 3 WHERE false', lines => 'SELECT 1, 2, 3 WHERE false'), 0::bigint, 'nothing at all');
SELECT is_empty($$ SELECT * FROM abacus_check('empty') $$, 'sound');
SELECT is(to_regclass('faulty'), NULL, 'nothing is left');
SELECT is(to_regclass('faulty_lines'), NULL, 'nor lines');

SELECT finish();
ROLLBACK;

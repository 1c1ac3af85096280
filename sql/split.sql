-- Split nodes: vertices at one place, told apart by their ids, on the two sides of a fault.
CREATE SCHEMA split;
SET search_path = split, public;

-- Sixteen squares. The fault x = 2 goes from a tip in the middle up to the border; its left side has
-- the ids 20 to 24, its right side 120 and so on. Across it the slip jumps from 0 to 10.
CREATE TABLE node AS
SELECT 10 * x + y AS id, x::float8, y::float8, CASE WHEN x > 2 THEN 10 WHEN (x, y) = (2, 2) THEN 5 ELSE 0 END::float8 AS slip
FROM generate_series(0, 4) AS x, generate_series(0, 4) AS y
UNION ALL SELECT 123, 2, 3, 10 UNION ALL SELECT 124, 2, 4, 10;
CREATE FUNCTION node_at(x int, y int, is_right boolean) RETURNS int LANGUAGE sql AS
    $$ SELECT 10 * x + y + CASE WHEN is_right AND x = 2 AND y > 2 THEN 100 ELSE 0 END $$;
CREATE TABLE triangle AS
SELECT t.*, x >= 2 AS is_right FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y,
    LATERAL (VALUES (node_at(x, y, x >= 2), node_at(x + 1, y, x >= 2), node_at(x + 1, y + 1, x >= 2)),
                    (node_at(x, y, x >= 2), node_at(x + 1, y + 1, x >= 2), node_at(x, y + 1, x >= 2))) AS t (v0, v1, v2);

SELECT abacus_load('refused', 'TABLE node', 'SELECT v0, v1, v2 FROM triangle');
SELECT abacus_load('fault', 'TABLE node', 'SELECT v0, v1, v2, is_right::int FROM triangle', labels => '{is_right}',
                   facets => 'VALUES (22, 23, 7), (23, 24, 7), (22, 123, 8), (123, 124, 7), (12, 22, 9)', split_nodes => true);
SELECT * FROM abacus_check('fault');
SELECT name, value FROM abacus_stats('fault') WHERE name IN ('vertices', 'simplices', 'hull_facets', 'delaunay', 'changeable', 'split_nodes') ORDER BY name;
SELECT id, x, y, attributes FROM abacus_vertices('fault') WHERE x = 2 ORDER BY y, id;

-- A place is on one side; on the fault itself it is the first simplex of both.
SELECT x, v0, v1, v2, abacus_interpolate('fault', x, 3.25) AS slip
FROM unnest('{1.75, 2, 2.25}'::float8[]) AS x, abacus_locate('fault', x, 3.25);
SELECT abacus_interpolate('fault', 2, 3) AS at_a_vertex, abacus_interpolate('fault', 2, 2) AS at_the_tip;
-- No walk crosses it.
SELECT count(*) AS ends FROM abacus_simplices('fault') AS s, generate_series(0, 2) AS facet, abacus_walk('fault', s, facet) AS n
WHERE n.v0 IS NULL;
-- Both sides are there: nearest vertices, those of a window, edges, the star.
SELECT vertex, attributes, distance FROM abacus_nearest('fault', 2.0, 3.0, 3);
SELECT vertex FROM abacus_nearest('fault', 2.5, 3.0, 1);
SELECT id, attributes FROM abacus_vertices('fault', '{2, 2}'::float8[], '{2, 4}'::float8[]) ORDER BY id;
SELECT v0, v1, length FROM abacus_edges('fault', '{2, 2.5}'::float8[], '{2, 2.5}'::float8[]);
SELECT count(*), count(DISTINCT (v0, v1)) FROM abacus_edges('fault');
SELECT count(*) FROM abacus_star('fault', 2, 3);
SELECT array_agg(DISTINCT n0 ORDER BY n0) = ARRAY(SELECT number FROM abacus_numbered_vertices('fault') WHERE number IN (SELECT n0 FROM abacus_numbered_simplices('fault')) ORDER BY 1) AS numbered,
       (SELECT count(*) FROM abacus_numbered_vertices('fault')) AS vertices
FROM abacus_numbered_simplices('fault');
-- Along a line the value jumps.
SELECT distance, x, value FROM abacus_profile('fault', '{{1.5, 3.5}, {2.5, 3.5}}');
SELECT enters, leaves, v0, v1, v2, labels FROM abacus_ray('fault', '{1.5, 3.25}', '{1, 0}');
-- A cliff hides what is behind it.
SELECT visible, x, y FROM abacus_visible('fault', '{1, 3.5}', '{3, 3.5}', observer_height => 1, target_height => 1);
SELECT "row", "values" FROM abacus_raster('fault', '{1.5, 2.5}', '{2.5, 3.5}', 2, 2);
SELECT "row", "values" FROM abacus_raster('fault', '{1, 2}', '{3, 4}', 1, 1);
-- Contours end at the fault, bands on each of its sides.
SELECT id, value, closed, path FROM abacus_contours('fault', fixed_levels => '{4}');
SELECT id, value, path FROM abacus_contours('fault', fixed_levels => '{4}', polygonize => true);
-- A fault that ends within the mesh leaves no trace in the border.
SELECT ring, array_agg(vertex ORDER BY position) FROM abacus_hull('fault') GROUP BY ring ORDER BY ring;
SELECT count(*) FROM abacus_spanning_tree('fault');
-- Each side is a facet of its own, with a marker of its own.
SELECT marker, v0, v1, corners FROM abacus_facets('fault');
SELECT abacus_mark('fault', 'SELECT s.code, s.v0, s.v1, s.v2, facet, 3 FROM abacus_simplices(''fault'') AS s, generate_series(0, 2) AS facet
    WHERE (SELECT array_agg(v ORDER BY v) FROM unnest(ARRAY[s.v0, s.v1, s.v2]) WITH ORDINALITY AS u (v, n) WHERE n <> facet + 1) IN (''{23, 24}'')');
SELECT marker, v0, v1 FROM abacus_facets('fault');
SELECT * FROM abacus_check('fault');
SELECT labels, count(*) FROM abacus_cells('fault') GROUP BY labels ORDER BY labels;
SELECT length(abacus_draw('fault', attribute => 'slip', width => 40)) > 100 AS drawn;
-- Its attributes can change, its points cannot.
SELECT abacus_insert('fault', 'SELECT 5, 2.5, 2.5, 1');
SELECT abacus_delete('fault', 'SELECT 23, 2, 3');
SELECT abacus_update('fault', 'SELECT 23 AS id, 2 AS x, 3 AS y, 4 AS slip');
SELECT abacus_add_attribute('fault', 'more');
CALL abacus_build('fault');
VACUUM fault;
SELECT * FROM abacus_check('fault');
-- A restored mesh is the same.
CREATE TABLE restored OF abacus_simplex_page (PRIMARY KEY (code, part));
CREATE TABLE restored_vertices OF abacus_vertex_page (PRIMARY KEY (first, part));
INSERT INTO restored TABLE fault;
INSERT INTO restored_vertices TABLE fault_vertices;
CALL abacus_build('restored');
SELECT * FROM abacus_check('restored');
SELECT vertex, attributes FROM abacus_nearest('restored', 2.0, 4.0, 2);
SELECT marker, v0, v1 FROM abacus_facets('restored', 7);
-- The pages do not depend on the order of rows.
SELECT abacus_load('fault_again', 'SELECT * FROM node ORDER BY random()', 'SELECT v0, v1, v2 FROM triangle ORDER BY random()', split_nodes => true);
SELECT abacus_load('fault_sorted', 'SELECT * FROM node ORDER BY id', 'SELECT v0, v1, v2 FROM triangle ORDER BY v2, v0', split_nodes => true);
SELECT count(*) FROM (SELECT code, part, abacus_page_to_bytea(page) FROM fault_again WHERE code >= 0 EXCEPT SELECT code, part, abacus_page_to_bytea(page) FROM fault_sorted) AS other;
-- With one vertex for each place it is what it would be without faults.
SELECT abacus_load('merged', 'TABLE node', 'SELECT v0, v1, v2 FROM triangle', split_nodes => true, retriangulate => true);
SELECT id, vertex, attributes FROM abacus_vertices('merged') WHERE x = 2 AND y > 2 ORDER BY id;
SELECT * FROM abacus_check('merged');
-- Many attributes stay with their vertices, too.
SELECT abacus_load('many', 'SELECT id, x, y, ' || string_agg(format('slip + %s AS a%s', i, i), ', ' ORDER BY i) || ' FROM node',
                   'SELECT v0, v1, v2 FROM triangle', split_nodes => true) FROM generate_series(1, 40) AS i;
SELECT id, attributes[40] FROM abacus_vertices('many') WHERE x = 2 ORDER BY id;
SELECT abacus_interpolate('many', 1.75, 3.25, attribute => 'a40'), abacus_interpolate('many', 2.25, 3.25, attribute => 'a40');
SELECT abacus_load('more', (SELECT format('SELECT id, x, y, %s FROM node', string_agg(format('x + %s AS a%1$s', n), ', ')) FROM generate_series(1, 101) AS n), 'SELECT v0, v1, v2 FROM triangle', split_nodes => true);
SELECT * FROM abacus_check('many');
-- The option alone changes nothing.
SELECT abacus_load('whole', 'SELECT * FROM node WHERE id < 100', 'SELECT v0 % 100, v1 % 100, v2 % 100 FROM triangle', split_nodes => true);
SELECT value FROM abacus_stats('whole') WHERE name = 'delaunay';
SELECT count(*) FROM abacus_vertices('whole');

-- What overlaps is refused: on one side, and within.
SELECT abacus_load('wrong', 'TABLE node UNION ALL VALUES (99, 1, 1, 0)', 'SELECT v0, v1, v2 FROM triangle UNION ALL VALUES (0, 99, 1)', split_nodes => true);
SELECT abacus_load('wrong', 'TABLE node UNION ALL VALUES (99, 2, 3, 0), (98, 3, 4, 0)', 'SELECT v0, v1, v2 FROM triangle UNION ALL VALUES (99, 98, 124)', split_nodes => true);
SELECT abacus_load('wrong', 'TABLE node', 'TABLE triangle', split_nodes => NULL);

-- A cube of tetrahedra, cut by the planes x = 1 and y = 1, which cross.
CREATE TABLE point AS SELECT 100 * x + 10 * y + z AS id, x, y, z FROM generate_series(0, 2) AS x, generate_series(0, 2) AS y, generate_series(0, 2) AS z;
SELECT abacus_triangulate('solid', 'TABLE point', dimension => 3);
-- of a corner: which quarter its tetrahedron is in
CREATE TABLE tetrahedron AS
SELECT row_number() OVER () AS n, s.v0, s.v1, s.v2, s.v3,
       1 + (m.x > 1)::int + 2 * (m.y > 1)::int AS quarter
FROM abacus_simplices('solid') AS s, LATERAL (SELECT avg(x) AS x, avg(y) AS y FROM point WHERE id IN (s.v0, s.v1, s.v2, s.v3)) AS m;
CREATE VIEW split_tetrahedron AS
SELECT v0 + 1000 * quarter AS v0, v1 + 1000 * quarter AS v1, v2 + 1000 * quarter AS v2, v3 + 1000 * quarter AS v3, quarter FROM tetrahedron;
CREATE VIEW split_point AS
SELECT DISTINCT id + 1000 * quarter AS id, x, y, z, 10.0 * quarter + z AS speed, z AS level
FROM tetrahedron, point WHERE id IN (v0, v1, v2, v3);
SELECT abacus_load('crossed', 'TABLE split_point', 'TABLE split_tetrahedron', labels => '{quarter}', split_nodes => true) = (SELECT count(*) FROM tetrahedron) AS all_loaded;
SELECT * FROM abacus_check('crossed');
SELECT count(*), count(DISTINCT (x, y, z)) FROM abacus_vertices('crossed');
SELECT x, y, round(abacus_interpolate('crossed', x, y, 0.5, attribute => 'speed')::numeric, 9) AS speed FROM (VALUES (0.9, 0.9), (1.1, 0.9), (0.9, 1.1), (1.1, 1.1)) AS place (x, y);
SELECT vertex, attributes FROM abacus_nearest('crossed', 1.0, 1.0, 1.0, 4);
SELECT count(*), count(DISTINCT v0), round(sum(leaves - enters)::numeric, 9) AS length FROM abacus_ray('crossed', '{-1, 0.3, 0.4}', '{1, 0, 0}');
SELECT distance, value FROM abacus_profile('crossed', '{{0.5, 0.25, 0.5}, {1.5, 0.25, 0.5}}', 'speed') WHERE x = 1;
-- a plane at half height in each quarter: at the faults corners of their own
SELECT count(DISTINCT c.number) AS corners, count(DISTINCT c.place) AS places
FROM abacus_isosurface('crossed', 0.5, attribute => 'level') AS s,
    LATERAL (VALUES (s.v0, s.corners[1:1]), (s.v1, s.corners[2:2]), (s.v2, s.corners[3:3])) AS c (number, place);
SELECT sum(labels[1]) / count(*) AS quarter, count(*) > 0 AS has_some FROM abacus_section('crossed', '{0.5, 0.5, 0.5}', '{0, 0, 1}', attribute => 'speed') WHERE labels = '{4}' GROUP BY labels;
-- at the bottom the simplices behind the facets of the border
SELECT labels, count(*) FROM abacus_section('crossed', '{0.5, 0.5, 0}', '{0, 0, 1}', attribute => 'speed') GROUP BY labels ORDER BY labels;
SELECT count(*) = (SELECT value FROM abacus_stats('crossed') WHERE name = 'hull_facets') AS border FROM (SELECT DISTINCT ring FROM abacus_hull('crossed')) AS ring;
SELECT count(*), count(DISTINCT v0 || ' ' || v1) FROM abacus_edges('crossed', '{1, 1, 0.5}'::float8[], '{1, 1, 0.5}'::float8[]);
SELECT id FROM abacus_vertices('crossed', '{1, 1, 1}'::float8[], '{1, 1, 1}'::float8[]) ORDER BY id;
SET client_min_messages = warning;
DROP SCHEMA split CASCADE;

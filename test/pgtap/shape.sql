-- Voronoi cells, outlines and spanning trees of larger meshes: identities, and comparison with SQL over all
-- simplices.
BEGIN;
SELECT no_plan();
SELECT setseed(0.5);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 6000) AS id;
-- repeated places and ids, a far one
INSERT INTO points SELECT id, x + (id % 2), y, z FROM points WHERE id <= 20;
INSERT INTO points VALUES (0, 1e6, 1e6, 1e6);
SELECT isnt(abacus_triangulate('field', 'SELECT id, x, y FROM points'), NULL, 'a mesh in the plane');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z FROM points WHERE id <= 1500', dimension => 3), NULL, 'one in space');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('field') WHERE (v0 + v1 + v2) % 9 > 0 AND least(v0, v1, v2) > 20;
CREATE TABLE corners AS SELECT id, x, y FROM points WHERE id IN (SELECT v0 FROM triangles UNION SELECT v1 FROM triangles UNION SELECT v2 FROM triangles);
SELECT isnt(abacus_load('holes', 'TABLE corners', 'TABLE triangles'), NULL, 'one with holes');

-- cells
SELECT is((SELECT count(*) FROM abacus_voronoi('field')), (SELECT count(DISTINCT (x, y)) FROM points), 'a cell for each place');
SELECT is((SELECT count(*) FROM abacus_voronoi('field') WHERE NOT bounded), (SELECT count(*) FROM abacus_hull('field')), 'those of the hull have no end');
SELECT is((SELECT count(*) FROM abacus_voronoi('solid') WHERE NOT bounded), (SELECT count(DISTINCT (x, y, z)) FROM abacus_hull('solid')), 'in space, too');
SELECT is_empty($$ SELECT i, j FROM generate_series(-1, 9) i, generate_series(-1, 9) j, LATERAL abacus_voronoi('field', ARRAY[i / 8.0, j / 8.0], ARRAY[(i + 1) / 8.0, (j + 1) / 8.0])
                   GROUP BY i, j HAVING abs(sum(area) * 64 - 1) > 1e-9 $$, 'the parts within each of many windows fill it');
SELECT is_empty($$ SELECT i FROM generate_series(0, 7) i, LATERAL abacus_voronoi('solid', ARRAY[i % 2 / 2.0, i / 2 % 2 / 2.0, i / 4 / 2.0], ARRAY[i % 2 / 2.0 + 0.5, i / 2 % 2 / 2.0 + 0.5, i / 4 / 2.0 + 0.5])
                   GROUP BY i HAVING abs(sum(volume) * 8 - 1) > 1e-9 $$, 'in space, too');
CREATE TEMP TABLE parts AS SELECT vertex, sum(area) AS area FROM generate_series(0, 9) i, generate_series(0, 9) j, LATERAL abacus_voronoi('field', ARRAY[i / 10.0, j / 10.0], ARRAY[(i + 1) / 10.0, (j + 1) / 10.0]) GROUP BY 1;
SELECT is((SELECT count(*) FROM parts p JOIN (SELECT vertex, sum(area) AS area FROM abacus_voronoi('field', '{0,0}', '{1,1}') GROUP BY 1) w USING (vertex) WHERE abs(p.area - w.area) < 1e-12),
          (SELECT count(*) FROM parts), 'a cell is the sum of its parts');
SELECT is_empty($$ SELECT a.vertex, a.neighbour FROM abacus_voronoi_facets('field') a LEFT JOIN abacus_voronoi_facets('field') b ON a.vertex = b.neighbour AND a.neighbour = b.vertex AND a.size = b.size
                   WHERE b.vertex IS NULL $$, 'a facet has one size from both sides');
SELECT is((SELECT max(abs(v.area - f.area) / v.area) < 1e-9 FROM abacus_voronoi('solid') v JOIN (SELECT vertex, sum(size) AS area FROM abacus_voronoi_facets('solid') GROUP BY 1) f USING (vertex)
           WHERE v.bounded AND vertex > 20), true, 'the facets are the surface');
SELECT bag_eq($$ SELECT least(vertex, neighbour), greatest(vertex, neighbour) FROM abacus_voronoi_facets('field') WHERE vertex > 20 AND neighbour > vertex $$,
              $$ SELECT v0, v1 FROM abacus_edges('field') WHERE v0 > 20 $$, 'neighbours are the ends of edges');

-- outlines
CREATE FUNCTION pg_temp.enclosed(query text) RETURNS numeric LANGUAGE plpgsql AS $$
DECLARE
    area numeric;
BEGIN
    EXECUTE format('SELECT round(sum(x::numeric * next_y::numeric - next_x::numeric * y::numeric) / 2, 9) FROM (SELECT *, coalesce(lead(x) OVER r, first_value(x) OVER r) AS next_x,
        coalesce(lead(y) OVER r, first_value(y) OVER r) AS next_y FROM %s WINDOW r AS (PARTITION BY ring ORDER BY "position")) t', query) INTO area;
    RETURN area;
END $$;
CREATE FUNCTION pg_temp.covered(mesh regclass, longest float8) RETURNS numeric LANGUAGE sql AS $$
    SELECT round(sum((c[2][1]::numeric - c[1][1]::numeric) * (c[3][2]::numeric - c[1][2]::numeric) - (c[3][1]::numeric - c[1][1]::numeric) * (c[2][2]::numeric - c[1][2]::numeric)) / 2, 9)
    FROM abacus_cells(mesh, max_edge => longest), LATERAL (VALUES (corners)) v (c) $$;
SELECT is(pg_temp.enclosed('abacus_hull(''field'')'), pg_temp.covered('field', NULL), 'the hull encloses the mesh');
SELECT is(pg_temp.enclosed('abacus_hull(''holes'')'), pg_temp.covered('holes', NULL), 'of a mesh with holes its border does');
SELECT is(pg_temp.enclosed('abacus_hull(''field'', 0.02)'), pg_temp.covered('field', 0.02), 'without long edges');
SELECT is(pg_temp.enclosed('abacus_hull(''holes'', 0.02)'), pg_temp.covered('holes', 0.02), 'both');
SELECT is_empty($$ SELECT FROM abacus_hull('holes', 0.02) GROUP BY ring, x, y HAVING count(*) > 1 $$, 'each vertex comes once in a ring');
SELECT cmp_ok(pg_temp.enclosed('abacus_alpha_shape(''field'', 1e-4)'), '>', pg_temp.enclosed('abacus_alpha_shape(''field'', 1e-4, true)'), 'holes are filled');
CREATE TEMP TABLE rows AS SELECT * FROM abacus_alpha_shape('field', 1e-4, true);
SET LOCAL work_mem = '64kB';
SET LOCAL abacus.cache_size = '1MB';
SELECT results_eq($$ SELECT * FROM abacus_alpha_shape('field', 1e-4, true) $$, 'TABLE rows', 'the same rows in little memory');
CREATE TEMP TABLE tree AS SELECT * FROM abacus_spanning_tree('field');
RESET work_mem;
RESET abacus.cache_size;

-- the tree
SELECT results_eq($$ SELECT * FROM abacus_spanning_tree('field') $$, 'TABLE tree', 'and the same tree');
SELECT is((SELECT count(*) FROM tree), (SELECT count(DISTINCT (x, y)) - 1 FROM points), 'one edge fewer than vertices');
SELECT is((SELECT count(*) FROM tree WHERE v0 > 20 AND v1 > 20 AND NOT EXISTS (SELECT FROM abacus_edges('field') e WHERE (e.v0, e.v1) = (tree.v0, tree.v1))), 0::bigint, 'all of the mesh');
-- the nearest neighbour of each vertex is a neighbour in the tree
SELECT is_empty($$ SELECT p.id FROM (SELECT * FROM points WHERE id BETWEEN 21 AND 420) p, LATERAL (SELECT vertex FROM abacus_nearest('field', x, y, 2) OFFSET 1) n
                   WHERE vertex > 20 AND NOT EXISTS (SELECT FROM tree WHERE (v0, v1) = (least(id, vertex), greatest(id, vertex))) $$, 'nearest neighbours are joined');

SELECT * FROM finish();
ROLLBACK;

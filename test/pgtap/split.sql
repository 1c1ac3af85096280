-- Split nodes: the interface; queries on random meshes cut by faults, compared with brute force; many
-- attributes; meshes out and in again.
BEGIN;
SELECT no_plan();

-- A plane of triangles and a cube of tetrahedra, cut along x = 50 up to y = 60, and along y = 50. The part of
-- each simplex shows which of its vertices it shares.
CREATE FUNCTION pg_temp.cut(name text, dimension int) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE format('CREATE TABLE %I_whole AS SELECT row_number() OVER () AS n, ARRAY[v0, v1, v2, v3] AS ids FROM abacus_simplices(%L)', name, name || '_mesh');
    -- on which side of each fault a simplex is; a vertex on a fault is one of that side
    EXECUTE format($q$
        CREATE TABLE %1$I_corner AS
        SELECT w.n, c.i, v.id AS old, v.x, v.y, v.z,
               v.id + CASE WHEN v.x = 50 AND v.y < 60 AND m.x > 50 THEN 1000000 ELSE 0 END
                    + CASE WHEN v.y = 50 AND m.y > 50 THEN 2000000 ELSE 0 END AS id
        FROM %1$I_whole AS w, unnest(w.ids) WITH ORDINALITY AS c (id, i), abacus_vertices(%2$L) AS v,
             LATERAL (SELECT avg(u.x) AS x, avg(u.y) AS y FROM abacus_vertices(%2$L) AS u WHERE u.id = ANY (w.ids)) AS m
        WHERE c.id = v.id
    $q$, name, name || '_mesh');
    EXECUTE format('CREATE TABLE %1$I_node AS SELECT DISTINCT id, x, y, z, sqrt(id)::float8 AS value FROM %1$I_corner', name);
    EXECUTE format('CREATE TABLE %1$I_element AS SELECT array_agg(id ORDER BY i) AS v FROM %1$I_corner GROUP BY n', name);
END $$;

CREATE TABLE plane AS SELECT DISTINCT ON (x, y) row_number() OVER () AS id, x, y
FROM (SELECT (i * 37) % 101 AS x, (i * 59) % 103 AS y FROM generate_series(1, 400) AS i
      UNION ALL SELECT 50, 5 * i FROM generate_series(0, 20) AS i UNION ALL SELECT 5 * i, 50 FROM generate_series(0, 20) AS i) AS p;
SELECT abacus_triangulate('plane_mesh', 'TABLE plane');
SELECT pg_temp.cut('plane', 2);
CREATE TABLE cube AS SELECT row_number() OVER () AS id, 25 * x AS x, 25 * y AS y, 25 * z AS z
FROM generate_series(0, 4) AS x, generate_series(0, 4) AS y, generate_series(0, 4) AS z;
SELECT abacus_triangulate('cube_mesh', 'TABLE cube', dimension => 3);
SELECT pg_temp.cut('cube', 3);

SELECT throws_ok($$ SELECT abacus_load('none', 'SELECT id, x, y FROM plane_node', 'SELECT v[1], v[2], v[3] FROM plane_element') $$, '22023', NULL, 'refused without split_nodes');
SELECT is(abacus_load('plane_split', 'SELECT id, x, y, value FROM plane_node ORDER BY random()', 'SELECT v[1], v[2], v[3] FROM plane_element ORDER BY random()', split_nodes => true),
          (SELECT count(*) FROM plane_element), 'all triangles');
SELECT is(abacus_load('cube_split', 'SELECT id, x, y, z, value FROM cube_node', 'SELECT v[1], v[2], v[3], v[4] FROM cube_element', split_nodes => true),
          (SELECT count(*) FROM cube_element), 'all tetrahedra');
SELECT is_empty($$ SELECT * FROM abacus_check('plane_split') $$, 'the plane is sound');
SELECT is_empty($$ SELECT * FROM abacus_check('cube_split') $$, 'the cube is sound');
SELECT is((SELECT value FROM abacus_stats('plane_split') WHERE name = 'split_nodes'),
          (SELECT sum(n)::float8 FROM (SELECT count(*) AS n FROM plane_node GROUP BY x, y HAVING count(*) > 1) AS place), 'so many share their places');
SELECT cmp_ok((SELECT count(*) FROM plane_node), '>', (SELECT count(*) + 30 FROM plane), 'vertices are split');

SELECT set_eq($$ SELECT id, x, y, attributes[1] FROM abacus_vertices('plane_split') $$, $$ SELECT id, x, y, value FROM plane_node $$, 'the vertices of the plane');
SELECT set_eq($$ SELECT id, x, y, z, attributes[1] FROM abacus_vertices('cube_split') $$, $$ SELECT id, x, y, z, value FROM cube_node $$, 'those of the cube');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('plane_split', '{10, 10}'::float8[], '{50, 50}'::float8[]) $$, $$ SELECT id FROM plane_node WHERE x BETWEEN 10 AND 50 AND y BETWEEN 10 AND 50 $$, 'those of a window');
SELECT bag_eq($$ SELECT id FROM abacus_vertices('cube_split', '{10, 10, 10}'::float8[], '{50, 50, 50}'::float8[]) $$, $$ SELECT id FROM cube_node WHERE x BETWEEN 10 AND 50 AND y BETWEEN 10 AND 50 AND z BETWEEN 10 AND 50 $$, 'in space, too');
SELECT set_eq($$ SELECT ARRAY(SELECT u FROM unnest(ARRAY[v0, v1, v2]) AS u ORDER BY 1) FROM abacus_simplices('plane_split') $$,
              $$ SELECT ARRAY(SELECT u FROM unnest(v[1:3]) AS u ORDER BY 1) FROM plane_element $$, 'the triangles');
SELECT bag_eq($$ SELECT least(v0, v1), greatest(v0, v1) FROM abacus_edges('plane_split') $$,
              $$ SELECT DISTINCT least(a, b), greatest(a, b) FROM plane_element, unnest(v[1:3]) AS a, unnest(v[1:3]) AS b WHERE a < b $$, 'each edge once');
SELECT bag_eq($$ SELECT least(v0, v1), greatest(v0, v1) FROM abacus_edges('cube_split') $$,
              $$ SELECT DISTINCT least(a, b), greatest(a, b) FROM cube_element, unnest(v) AS a, unnest(v) AS b WHERE a < b $$, 'in space, too');
SELECT is((SELECT count(DISTINCT number) FROM abacus_numbered_vertices('cube_split')), (SELECT count(*) FROM cube_node), 'each vertex has a number');
SELECT bag_eq($$ SELECT ARRAY(SELECT id FROM unnest(ARRAY[n0, n1, n2, n3]) AS n JOIN abacus_numbered_vertices('cube_split') ON n = number ORDER BY 1) FROM abacus_numbered_simplices('cube_split') $$,
              $$ SELECT ARRAY(SELECT u FROM unnest(v) AS u ORDER BY 1) FROM cube_element $$, 'simplices name their vertices by it');
SELECT results_eq(format($$ SELECT vertex, attributes[1] FROM abacus_nearest('plane_split', %s, %s, 12) $$, x, y),
                  format($$ SELECT id, value FROM plane_node ORDER BY (x - %1$s) ^ 2 + (y - %2$s) ^ 2, x, y, id LIMIT 12 $$, x, y), 'nearest at ' || x || ', ' || y)
FROM (VALUES (50.0, 50.0), (49.0, 10.0), (51.0, 55.0), (0.0, 0.0), (20.5, 50.0)) AS place (x, y);
-- A walk crosses only facets that both simplices name.
SELECT is((SELECT count(n.v0) FROM abacus_simplices('cube_split') AS s, generate_series(0, 3) AS f, abacus_walk('cube_split', s, f) AS n),
          (SELECT sum(sides)::bigint FROM (SELECT count(*) AS sides FROM cube_element, generate_series(1, 4) AS f,
               LATERAL (SELECT array_agg(u ORDER BY u) AS facet FROM unnest(v) WITH ORDINALITY AS c (u, i) WHERE i <> f) AS x GROUP BY facet HAVING count(*) = 2) AS s), 'walks');
-- Values come from the side that contains the place.
SELECT is_empty($$
    SELECT x, y FROM generate_series(46.25, 54, 1.5) AS x, generate_series(40.25, 70, 2.5) AS y, abacus_locate('plane_split', x, y) AS t
    WHERE abacus_interpolate('plane_split', x, y) NOT BETWEEN sqrt(least(t.v0, t.v1, t.v2)) AND sqrt(greatest(t.v0, t.v1, t.v2))
       OR (t.v0 / 2000000 = 1 OR t.v1 / 2000000 = 1 OR t.v2 / 2000000 = 1) AND y < 50 $$, 'interpolation on the right side');
SELECT is((SELECT count(*) FROM abacus_locate('cube_split', 'SELECT row_number() OVER (), x, y, z FROM cube_node') AS l WHERE v0 IS NOT NULL), (SELECT count(*) FROM cube_node), 'many places');
SELECT is((SELECT round(sum(leaves - enters)::numeric, 9) FROM abacus_ray('cube_split', '{-10, 33, 37}', '{1, 0, 0}')), 100::numeric, 'a ray has no gap at a fault');
-- Contours cross levels on each side, and never follow the fault to the other side.
SELECT cmp_ok((SELECT count(*) FROM abacus_contours('plane_split', level_interval => 100)), '>', 2::bigint, 'contours');
SELECT is_empty($$ SELECT * FROM (SELECT path[i] AS x, path[i + 1] AS y, path[i + 2] AS next_x, path[i + 3] AS next_y
    FROM abacus_contours('plane_split', level_interval => 3.7), generate_series(1, array_length(path, 1) - 2, 2) AS i) AS s
    WHERE (x = 50 AND next_x = 50 AND least(y, next_y) < 60) OR (y = 50 AND next_y = 50) $$, 'no contour runs along a fault');
SELECT is((SELECT round(sum(area)::numeric, 6) FROM (SELECT abs(sum(path[i] * path[i + 3] - path[i + 2] * path[i + 1]) / 2) * sign(sum(path[i] * path[i + 3] - path[i + 2] * path[i + 1])) AS area
    FROM (SELECT row_number() OVER () AS n, path FROM abacus_contours('plane_split', level_interval => 7, polygonize => true)) AS band, generate_series(1, array_length(path, 1) - 3, 2) AS i GROUP BY n) AS ring),
    (SELECT round(sum(abs(x1 * y2 - x2 * y1 + x2 * y3 - x3 * y2 + x3 * y1 - x1 * y3) / 2)::numeric, 6) FROM
        (SELECT a.x AS x1, a.y AS y1, b.x AS x2, b.y AS y2, c.x AS x3, c.y AS y3 FROM plane_element, plane_node AS a, plane_node AS b, plane_node AS c WHERE a.id = v[1] AND b.id = v[2] AND c.id = v[3]) AS t), 'bands fill the mesh');
SELECT lives_ok($$ SELECT * FROM abacus_isosurface('cube_split', 900) $$, 'isosurfaces');
SELECT results_eq(format($$ SELECT count(*), count(DISTINCT polygon) FROM abacus_section('cube_split', '{50, 50, 50}', %L) $$, normal),
                  format($$ SELECT count(*), count(*) FROM abacus_section('cube_mesh', '{50, 50, 50}', %L) $$, normal), 'a section in a fault, along ' || normal)
FROM unnest('{"{1,0,0}", "{-1,0,0}", "{0,1,0}", "{0,0,1}"}'::text[]) AS normal;
SELECT is((SELECT count(*) FROM abacus_spanning_tree('plane_split')), (SELECT count(*) - 1 FROM plane), 'the spanning tree of the places');
SELECT lives_ok($$ SELECT abacus_draw_section('cube_split', '{50, 50, 50}', '{0, 1, 0}', 40), abacus_draw('plane_split', attribute => 'value', width => 40) $$, 'pictures');

-- Markers: each facet of a fault has two.
SELECT abacus_mark('cube_split', 'SELECT s.code, s.v0, s.v1, s.v2, s.v3, f, s.v0 % 1000 FROM abacus_simplices(''cube_split'') AS s, generate_series(0, 3) AS f
    WHERE abacus_walk(''cube_split'', s, f) IS NULL');
SELECT is((SELECT count(DISTINCT (v0, v1, v2)) FROM abacus_facets('cube_split'))::float8, (SELECT value FROM abacus_stats('cube_split') WHERE name = 'hull_facets'), 'a marker for each facet of the border');
SELECT is_empty($$ SELECT * FROM abacus_facets('cube_split') AS f WHERE NOT EXISTS (SELECT FROM cube_element WHERE v @> ARRAY[f.v0, f.v1, f.v2]) $$, 'each names vertices of one side');
SELECT is_empty($$ SELECT * FROM abacus_check('cube_split') $$, 'sound with markers');
SELECT lives_ok($$ SELECT abacus_label('cube_split', 'SELECT code, v0, v1, v2, v3, v0 AS x FROM abacus_simplices(''cube_split'')') WHERE false $$, 'labels');

-- Out and in again; the copy of its pages is the mesh.
SELECT is(abacus_load('plane_again', 'SELECT id, x, y, attributes[1] AS value FROM abacus_vertices(''plane_split'')', 'SELECT v0, v1, v2 FROM abacus_simplices(''plane_split'')', split_nodes => true),
          (SELECT count(*) FROM plane_element), 'out and in again');
SELECT set_eq($$ SELECT code, v0, v1, v2 FROM abacus_simplices('plane_again') $$, $$ SELECT code, v0, v1, v2 FROM abacus_simplices('plane_split') $$, 'the same');
SELECT throws_ok($$ SELECT abacus_insert('plane_split', 'SELECT 1, 2, 3, 4') $$, '55000', NULL, 'it cannot be changed');
SELECT is(abacus_update('plane_split', 'SELECT id, x, y, value FROM plane_node'), (SELECT count(*) FROM plane_node), 'but it takes values');
SELECT is_empty($$ SELECT * FROM abacus_check('plane_split') $$, 'and is sound');
SELECT throws_ok($$ SELECT abacus_voronoi('plane_split') $$, '55000', NULL, 'it has no Voronoi cells');
-- If a header counts another number of split nodes, it is damaged: the word before the name of the attribute.
UPDATE plane_again SET page = abacus_page_from_bytea(set_byte(b, at, get_byte(b, at) - 1))
FROM (SELECT abacus_page_to_bytea(page) AS b, length(abacus_page_to_bytea(page)) - 72 AS at FROM plane_again WHERE code < 0) AS h WHERE code < 0;
SELECT isnt_empty($$ SELECT * FROM abacus_check('plane_again') $$, 'the count is checked');

-- Few attributes and many.
SELECT is(abacus_load('wide', 'SELECT id, x, y, z, ' || string_agg(format('value + %1$s AS a%1$s', i), ', ' ORDER BY i) || ' FROM cube_node',
                      'SELECT v[1], v[2], v[3], v[4] FROM cube_element', split_nodes => true), (SELECT count(*) FROM cube_element), 'many attributes')
FROM generate_series(1, 60) AS i;
SELECT is_empty($$ SELECT * FROM abacus_check('wide') $$, 'sound with many attributes');
SELECT set_eq($$ SELECT id, attributes[60] FROM abacus_vertices('wide') $$, $$ SELECT id, value + 60 FROM cube_node $$, 'each vertex has its own');
-- Together again.
SELECT lives_ok($$ SELECT abacus_load('merged', 'SELECT id, x, y, value FROM plane_node', 'SELECT v[1], v[2], v[3] FROM plane_element', split_nodes => true, retriangulate => true) $$, 'triangulated anew');
SELECT is((SELECT count(*) FROM abacus_vertices('merged')), (SELECT count(*) FROM plane_node), 'all are points');
SELECT is((SELECT count(DISTINCT vertex) FROM abacus_vertices('merged')), (SELECT count(*) FROM plane), 'at one place they are one vertex');
SELECT is_empty($$ SELECT * FROM abacus_check('merged') $$, 'sound');

SELECT * FROM finish();
ROLLBACK;

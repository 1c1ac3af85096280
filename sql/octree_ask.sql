-- Octrees asked what is where: leaves of a ball, nearest leaves, values between leaves, many places; drawn; cut into triangles and tetrahedra.
SELECT abacus_octree_create('quad', 2, '{0,0}', '{8,8}', '{v,w}');
SELECT abacus_octree_refine('quad', 'VALUES (3, 1, 1), (2, 7, 1)');
SELECT abacus_octree_update('quad', 'SELECT code, lower[1] + 10 * lower[2], CASE WHEN lower[1] < 4 THEN 1 END FROM abacus_octants(''quad'')');

-- a ball: closed, of leaves without their upper sides
SELECT level, lower, upper FROM abacus_octants('quad', ARRAY[4, 4], 0);
SELECT level, lower, upper FROM abacus_octants('quad', ARRAY[1.5, 1.5], 0.5);
SELECT level, lower, upper FROM abacus_octants('quad', ARRAY[1.5, 1.5], 0.51);
SELECT level, lower FROM abacus_octants('quad', center => '{9,8}', radius => 1);
SELECT count(*) FROM abacus_octants('quad', ARRAY[9.01, 8], 1);
SELECT count(*) FROM abacus_octants('quad', ARRAY[4, 4], 100);
SELECT count(*) FROM abacus_octants('quad', NULL::float8[], 1);
SELECT * FROM abacus_octants('quad', ARRAY[4, 4], -1);
SELECT * FROM abacus_octants('quad', ARRAY[4, 4, 4], 1);
SELECT * FROM abacus_octants('quad', ARRAY['NaN'::float8, 4], 1);

-- nearest leaves: of those equally far the first along the curve comes first
SELECT level, lower, attributes, distance FROM abacus_octree_nearest('quad', 2, 2, 5);
SELECT level, lower, distance FROM abacus_octree_nearest('quad', 11, 12);
SELECT count(*), max(distance) FROM abacus_octree_nearest('quad', 0, 0, 1000);
SELECT n.* FROM abacus_octree_nearest('quad', 'VALUES (1, 2, 2), (2, -3, 9)', 2) n;
SELECT count(*) FROM (SELECT p.id, n.code, n.distance, row_number() OVER (PARTITION BY p.id) AS rank FROM (VALUES (1, 0.3, 7.9), (2, 5.5, 5.5), (3, -1, 4)) AS p (id, x, y), LATERAL abacus_octree_nearest('quad', p.x, p.y, 7) n
    EXCEPT SELECT id, code, distance, rank FROM abacus_octree_nearest('quad', 'VALUES (1, 0.3, 7.9), (2, 5.5, 5.5), (3, -1, 4)', 7)) d;
SELECT * FROM abacus_octree_nearest('quad', 1, 1, 0);
SELECT * FROM abacus_octree_nearest('quad', 1, 1, z => 1);
SELECT * FROM abacus_octree_nearest('quad', 'Infinity'::float8, 1);
SELECT * FROM abacus_octree_nearest('quad', 'NaN'::float8, 1);
SELECT count(*) FROM abacus_octree_nearest('quad', NULL, 1);

-- many places at once
SELECT id, level, lower, attributes FROM abacus_octree_locate('quad', 'VALUES (1, 1, 1), (2, 7.9, 7.9), (3, 9, 9), (4, 8, 8)');
SELECT * FROM abacus_octree_locate('quad', 'SELECT 1, 1');
SELECT * FROM abacus_octree_locate('quad', 'SELECT 1, 1, ''NaN''::float8');

-- values: what is linear comes back where leaves are of one size; at a corner the mean of those around; at the border those within
SELECT x, abacus_octree_interpolate('quad', x, 1.5, 'v') AS v FROM (VALUES (0.0), (0.5), (1), (1.25), (2), (3), (4), (8)) AS p (x);
SELECT abacus_octree_interpolate('quad', 4, 1, 'v') AS hanging, (abacus_octree_interpolate('quad', 4, 0, 'v') + abacus_octree_interpolate('quad', 4, 2, 'v')) / 2 AS mean_of_anchors;
SELECT bool_and(abs(abacus_octree_interpolate('quad', x, y, 'v') - abacus_octree_interpolate('quad', x - 1e-9, y - 1e-9, 'v')) < 1e-6) AS no_step FROM generate_series(1, 8) x, generate_series(0.25, 8, 0.25) y;
SELECT abacus_octree_interpolate('quad', 1, 1, 'w') AS known, abacus_octree_interpolate('quad', 4, 1, 'w') IS NULL AS unknown, abacus_octree_interpolate('quad', 9, 1, 'w') IS NULL AS outside, abacus_octree_interpolate('quad', 'Infinity', 1, 'w') IS NULL AS far, abacus_octree_interpolate('quad', NULL, 1, 'w') IS NULL AS none;
SELECT * FROM abacus_octree_interpolate('quad', 'VALUES (1, 1, 1), (2, 4, 1), (3, 9, 1)');
SELECT * FROM abacus_octree_interpolate('quad', 'VALUES (1, 1, 1), (2, 4, 1), (3, 9, 1)', attributes => '{w,v,w}');
SELECT * FROM abacus_octree_interpolate('quad', 'SELECT 1, 4, 4', '{v}') EXCEPT SELECT * FROM abacus_octree_interpolate('quad', 'SELECT 1, 4, 4', ARRAY['v']);
SELECT count(*) FROM (SELECT id, ARRAY[abacus_octree_interpolate('quad', x, y, 'v')] FROM (SELECT i AS id, (i * 0.618) % 8 AS x, (i * 0.414) % 8 AS y FROM generate_series(1, 500) i) p
    EXCEPT SELECT id, "values" FROM abacus_octree_interpolate('quad', 'SELECT i, (i * 0.618) % 8, (i * 0.414) % 8 FROM generate_series(1, 500) i', attributes => '{v}')) d;
SELECT abacus_octree_interpolate('quad', 1, 1);
SELECT abacus_octree_interpolate('quad', 1, 1, 'z');
SELECT abacus_octree_interpolate('quad', 1, 1, 1, 'v');
SELECT abacus_octree_interpolate('quad', 'NaN', 1, 'v');
SELECT * FROM abacus_octree_interpolate('quad', NULL::text);

-- triangles: of hanging nodes, too; all areas add up
SELECT * FROM abacus_octree_tetrahedra('quad') WHERE element IN (4, 12);
SELECT abacus_octree_refine('quad', 'SELECT 5, 3.9, 3.9');
SELECT count(*) FROM abacus_octree_tetrahedra('quad');
SELECT abacus_octree_balance('quad', 'faces');
WITH t AS (SELECT p.point AS p, q.point AS q, r.point AS r FROM abacus_octree_tetrahedra('quad') t JOIN abacus_octree_nodes('quad') p ON p.node = t.nodes[1] JOIN abacus_octree_nodes('quad') q ON q.node = t.nodes[2] JOIN abacus_octree_nodes('quad') r ON r.node = t.nodes[3])
SELECT count(*), sum(area), min(area) FROM (SELECT ((q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])) / 2 AS area FROM t) a;
-- tetrahedra: each inner face is one of two
SELECT abacus_octree_create('cube', 3, '{0,0,0}', '{2,4,8}', '{vs}');
SELECT abacus_octree_refine('cube', 'VALUES (4, 0.99, 1.99, 3.99), (3, 1.9, 3.9, 7.9), (2, 1.1, 1.1, 1.1)');
SELECT * FROM abacus_octree_tetrahedra('cube') LIMIT 1;
SELECT abacus_octree_balance('cube', 'edges');
SELECT abacus_octree_update('cube', 'SELECT code, lower[1] + upper[3] FROM abacus_octants(''cube'')');
SELECT * FROM abacus_octree_tetrahedra('cube') LIMIT 3;
CREATE TABLE tetrahedra AS SELECT row_number() OVER () AS id, * FROM abacus_octree_tetrahedra('cube');
CREATE TABLE nodes AS SELECT * FROM abacus_octree_nodes('cube');
SELECT count(*), count(DISTINCT element) AS elements, (SELECT count(*) FROM abacus_octants('cube')) AS leaves FROM tetrahedra;
SELECT round(sum(volume)::numeric, 9) AS sum, min(volume) > 0 AS positive FROM (SELECT t.id, (b[1] * (c[2] * d[3] - c[3] * d[2]) - b[2] * (c[1] * d[3] - c[3] * d[1]) + b[3] * (c[1] * d[2] - c[2] * d[1])) / 6 AS volume
    FROM tetrahedra t JOIN nodes n0 ON n0.node = nodes[1] JOIN nodes n1 ON n1.node = nodes[2] JOIN nodes n2 ON n2.node = nodes[3] JOIN nodes n3 ON n3.node = nodes[4],
    LATERAL (SELECT ARRAY[n1.point[1] - n0.point[1], n1.point[2] - n0.point[2], n1.point[3] - n0.point[3]] AS b, ARRAY[n2.point[1] - n0.point[1], n2.point[2] - n0.point[2], n2.point[3] - n0.point[3]] AS c,
                    ARRAY[n3.point[1] - n0.point[1], n3.point[2] - n0.point[2], n3.point[3] - n0.point[3]] AS d) e) v;
WITH faces AS (SELECT (SELECT array_agg(n ORDER BY n) FROM unnest(nodes) WITH ORDINALITY AS u (n, i) WHERE i <> k) AS face FROM tetrahedra, generate_series(1, 4) k),
    counted AS (SELECT face, count(*) AS n FROM faces GROUP BY face),
    placed AS (SELECT n, (SELECT bool_or(least = most AND (least = 0 OR least = (ARRAY[2, 4, 8])[axis])) FROM (SELECT axis, min(point[axis]) AS least, max(point[axis]) AS most FROM nodes, generate_series(1, 3) axis WHERE node = ANY (face) GROUP BY axis) s) AS outer_face FROM counted)
SELECT n, outer_face, count(*) > 0 AS some FROM placed GROUP BY 1, 2 ORDER BY 1, 2;
-- the nodes as points of a mesh
SELECT abacus_triangulate('delaunay', 'SELECT node, point[1], point[2], point[3] FROM abacus_octree_nodes(''cube'')', dimension => 3);
SELECT (SELECT count(*) FROM abacus_vertices('delaunay')) = (SELECT count(*) FROM nodes) AS all_nodes, (SELECT count(*) FROM abacus_check('delaunay')) AS faults;

-- values in space
SELECT abacus_octree_interpolate('cube', 1, 2, 4, 'vs') > 0 AS inside, abacus_octree_interpolate('cube', 1, 2, 9.0) IS NULL AS outside;
SELECT level, lower, distance FROM abacus_octree_nearest('cube', 1, 2, z => 4, k => 3);
SELECT count(*) FROM abacus_octants('cube', ARRAY[1, 2, 4], 0.25);
SELECT abacus_octree_interpolate('cube', 1, 2);
SELECT * FROM abacus_octree_nearest('cube', 1, 2, 3);

-- pictures
CREATE FUNCTION png(bytea) RETURNS boolean RETURN substr($1, 2, 3) = 'PNG';
SELECT png(abacus_draw('quad', 64)) AS mesh, png(abacus_draw('quad', 64, attribute => 'v', legend => 'm', scale_bar => 'm', ramp => 'viridis')) AS map, png(abacus_draw('quad', 64, lower => '{0,0}', upper => '{3,3}', attribute => 'w', exaggeration => 1)) AS part,
       png(abacus_draw_section('cube', '{1,2,4}', '{0,1,0}', 64, attribute => 'vs')) AS section, png(abacus_draw_section('cube', '{1,2,4}', '{1,1,1}', 64, lower => '{0,0,2}', upper => '{2,4,6}')) AS slanted;
SELECT count(DISTINCT picture) FROM (VALUES (abacus_draw('quad', 64)), (abacus_draw('quad', 64, attribute => 'v')), (abacus_draw('quad', 64, attribute => 'w')), (abacus_draw('quad', 64, attribute => 'v', edges => false)),
    (abacus_draw('quad', 64, attribute => 'v', max_edge => 1))) AS pictures (picture);
-- coloured as two triangles of each leaf would be
SELECT abacus_octree_create('four', 2, '{0,0}', '{2,2}', '{v}');
SELECT abacus_octree_refine('four', 'SELECT 1, 0, 0');
SELECT abacus_octree_update('four', 'SELECT code, 7 FROM abacus_octants(''four'')');
SELECT abacus_triangulate('flat', 'SELECT x + 3 * y, x, y, 7 AS v FROM generate_series(0, 2) x, generate_series(0, 2) y');
SELECT abacus_draw('four', 50, attribute => 'v', edges => false, range => '{0,10}') = abacus_draw('flat', 50, attribute => 'v', edges => false, range => '{0,10}') AS same;
SELECT abacus_draw('quad', 32, attribute => 'v', contours => 2) = abacus_draw('quad', 32, attribute => 'v') AS same;
SELECT png(abacus_draw('quad', 32, lower => '{20,20}', upper => '{30,30}'));
SELECT png(abacus_draw('quad', 32, max_edge => 0.1));
SELECT png(abacus_draw_section('cube', '{1,2,-4}', '{0,0,1}', 32));
SELECT abacus_draw('quad', attribute => 'z');
SELECT abacus_draw('cube');
SELECT abacus_draw_section('quad', '{1,2,4}', '{0,1,0}');
SELECT abacus_draw_volume('cube', width => 32);

DROP FUNCTION png;
DROP TABLE quad, cube, delaunay, tetrahedra, nodes, flat, four;

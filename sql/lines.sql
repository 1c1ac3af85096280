-- A mesh along lines, and as a raster.
SET extra_float_digits = 0;
SELECT abacus_triangulate('hill', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 4, 4, 0), (4, 0, 4, 0), (5, 2, 2, 8)', '{height}');
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0, 1), (2, 4, 0, 0, 2), (3, 0, 4, 0, 3), (4, 0, 0, 4, 4), (5, 1, 1, 1, 5)', '{t}', dimension => 3);
SELECT abacus_create('empty', 2, '{height}');
-- a square with a hole, and a piece apart
CREATE TABLE corners (id bigint, x float8, y float8, height float8);
INSERT INTO corners SELECT y * 10 + x, x, y, x FROM generate_series(0, 3) x, generate_series(0, 3) y;
INSERT INTO corners VALUES (90, 6, 1, 60), (91, 8, 1, 80), (92, 7, 2, 70);
CREATE TABLE faces (a bigint, b bigint, c bigint);
INSERT INTO faces SELECT y * 10 + x, y * 10 + x + 1, y * 10 + x + 11 FROM generate_series(0, 2) x, generate_series(0, 2) y WHERE (x, y) <> (1, 1);
INSERT INTO faces SELECT y * 10 + x, y * 10 + x + 11, y * 10 + x + 10 FROM generate_series(0, 2) x, generate_series(0, 2) y WHERE (x, y) <> (1, 1);
INSERT INTO faces VALUES (90, 91, 92);
SELECT abacus_load('ring', 'TABLE corners', 'TABLE faces');

-- rays: through triangles, from inside, along an edge, along the border, through a vertex, past the mesh
SELECT enters, leaves, v0, v1, v2, v3 FROM abacus_ray('hill', '{-1, 1}', '{1, 0}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{1, 0.5}', '{0, 0.25}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{-2, -2}', '{1, 1}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{6, 6}', '{-1, -1}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{4, -1}', '{0, 1}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{-2, 2}', '{1, 0}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('hill', '{4, 4}', '{-0.5, -1}');
SELECT count(*) FROM abacus_ray('hill', '{-1, 0}', '{1, -1}');
SELECT count(*) FROM abacus_ray('hill', '{-1, 1}', '{1, -1}');
SELECT enters, leaves, v0, v1, v2, v3 FROM abacus_ray('solid', '{-1, 0.5, 0.25}', '{2, 0, 0}');
SELECT enters, leaves, v0, v1, v2, v3 FROM abacus_ray('solid', '{0, 0, 0}', '{1, 0, 0}');
-- the hole is left and entered again, and so is the outside; both ways
SELECT round(enters::numeric, 3) AS enters, round(leaves::numeric, 3) AS leaves, v0, v1, v2 FROM abacus_ray('ring', '{-1, 1.25}', '{1, 0}');
SELECT round(enters::numeric, 3) AS enters, round(leaves::numeric, 3) AS leaves, v0, v1, v2 FROM abacus_ray('ring', '{9, 1.25}', '{-1, 0}');
SELECT enters, leaves, v0, v1, v2 FROM abacus_ray('ring', '{1.5, 1}', '{1, 0}');
SELECT count(*) FROM abacus_ray('empty', '{0, 0}', '{1, 0}');
SELECT count(*) FROM abacus_ray('hill', NULL, '{1, 0}');

-- profiles: over edges, over a vertex, with corners, from outside, over holes
SELECT * FROM abacus_profile('hill', '{0, 1, 4, 1}');
SELECT * FROM abacus_profile('hill', '{-1, 2, 5, 2}');
SELECT * FROM abacus_profile('hill', '{{1, 0.5}, {3, 0.5}, {3, 0.5}, {3, 1.5}}', 'height');
SELECT * FROM abacus_profile('solid', '{0, 0.5, 0.5, 4, 0.5, 0.5}');
SELECT * FROM abacus_profile('ring', '{0, 1, 8, 1}');
SELECT * FROM abacus_profile('ring', '{1.5, 1.5, 2.5, 1.5}');
SELECT * FROM abacus_profile('empty', '{0, 0, 1, 0}');
SELECT * FROM abacus_profile('hill', NULL);

-- lines of sight: over the hill, against it, on it, under it
SELECT * FROM abacus_visible('hill', '{0, 2}', '{4, 2}');
SELECT * FROM abacus_visible('hill', '{0, 2}', '{4, 2}', observer_height => 8, target_height => 8);
SELECT * FROM abacus_visible('hill', '{0, 2}', '{4, 2}', observer_height => 7, target_height => 8);
SELECT * FROM abacus_visible('hill', '{0, 2, 8}', '{4, 2, 7}', 'height');
SELECT * FROM abacus_visible('hill', '{0, 2}', '{2, 2}');
SELECT * FROM abacus_visible('hill', '{0, 2}', '{4, 2}', observer_height => 1);
SELECT * FROM abacus_visible('hill', '{1, 2}', '{1, 2, 9}');
SELECT * FROM abacus_visible('hill', '{2, 2, 7}', '{5, 2, 9}');
SELECT * FROM abacus_visible('hill', '{-1, 2}', '{4, 2}');
SELECT * FROM abacus_visible('ring', '{0, 1.5, 2.5}', '{3, 1.5, 2.5}');
SELECT * FROM abacus_visible('ring', '{0, 1.5, 1.5}', '{3, 1.5, 1.5}');
SELECT * FROM abacus_visible('hill', NULL, '{4, 2}');

-- rasters: row 0 is the upper one
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 4, 4);
SELECT * FROM abacus_raster('hill', '{-2, 0}', '{6, 4}', 4, 2, outside => 'nearest');
SELECT * FROM abacus_raster('hill', '{-0.5, -0.5}', '{4.5, 4.5}', 5, 5, 'height');
SELECT * FROM abacus_raster('hill', '{-0.5, -0.5}', '{4.5, 4.5}', 5, 5, method => 'nearest');
SELECT "row", (SELECT array_agg(round(v::numeric, 3)) FROM unnest("values") v) FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 4, 4, method => 'natural');
SELECT count(*), count(v) FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 4, 4, max_edge => 3) r, unnest(r."values") v;
SELECT * FROM abacus_raster('ring', '{0, 0}', '{8, 3}', 8, 3);
SELECT * FROM abacus_raster('solid', '{0, 0, 0.5}', '{4, 4, 0.5}', 4, 4);
SELECT * FROM abacus_raster('empty', '{0, 0}', '{4, 4}', 2, 2);
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 4}', NULL, 4);
SELECT abacus_raster('hill', '{0, 0}', '{4, 4}', 4, 2000000000) LIMIT 1;
-- every value is that of abacus_interpolate
SELECT abacus_triangulate('wide', 'SELECT i, (i * 7919) % 1009, (i * 104729) % 997, sin(i) FROM generate_series(1, 3000) i', '{v}');
SELECT count(*), count(v), sum((v IS DISTINCT FROM abacus_interpolate('wide', (i - 0.5)::float8 * 1010 / 97, 1000 - ("row" + 0.5)::float8 * 1000 / 89))::int) AS different
FROM abacus_raster('wide', '{0, 0}', '{1010, 1000}', 97, 89) r, unnest(r."values") WITH ORDINALITY AS u (v, i);
SET work_mem = 64;
SELECT count(*), count(v), sum((v IS DISTINCT FROM abacus_interpolate('wide', (i - 0.5)::float8 * 1010 / 1010, 1000 - ("row" + 0.5)::float8 * 1000 / 20))::int) AS different
FROM abacus_raster('wide', '{0, 0}', '{1010, 1000}', 1010, 20) r, unnest(r."values") WITH ORDINALITY AS u (v, i);
RESET work_mem;

-- what cannot be asked
SELECT * FROM abacus_ray('hill', '{0, 0}', '{0, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_ray('hill', '{0, 0, 0}', '{1, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_ray('hill', '{0, NaN}', '{1, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_ray('hill', '{0, 0}', '{Infinity, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_ray('hill', '{0, NULL}', '{1, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_profile('hill', '{0, 0}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_profile('hill', '{0, 0, 1}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_profile('hill', '{0, 0, 1, NaN}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_profile('hill', '{0, 0, 1, 1}', 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_visible('solid', '{0, 0}', '{1, 1}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_visible('hill', '{0}', '{1, 1}');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_visible('hill', '{0, 0, 1}', '{1, 1}', observer_height => 2);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_visible('hill', '{0, 0}', '{1, 1}', target_height => 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 0, 4);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 2000000000, 4);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 0}', 4, 4);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('hill', '{-1e308, 0}', '{1e308, 4}', 4, 4);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('solid', '{0, 0, 0}', '{4, 4, 4}', 4, 4);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('hill', '{0, 0}', '{4, 4}', 4, 4, method => 'cubic');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_raster('ring', '{0, 0}', '{4, 4}', 4, 4, method => 'natural');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_profile('hill', '{0, 0, 1, 1}', max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_visible('hill', '{0, 0}', '{1, 1}', max_edge => 'Infinity');
\echo :LAST_ERROR_SQLSTATE
-- triangles with a longer edge count as outside: between two islands, and beside a rock there
CREATE TABLE islands AS SELECT 100 * x + y AS id, x::float8 AS x, y::float8 AS y, x + y::float8 AS height FROM generate_series(0, 13) x, generate_series(0, 3) y WHERE x < 4 OR x > 9;
INSERT INTO islands VALUES (7, 6.5, 1.5, 100);
SELECT abacus_triangulate('sea', 'TABLE islands');
SELECT abacus_load('sea_loaded', 'TABLE islands', 'SELECT v0, v1, v2 FROM abacus_cells(''sea'', max_edge => 1.5)');
SELECT abacus_triangulate('deep_sea', 'SELECT 100 * x + 10 * y + z, x, y, z, x + y + z AS height FROM generate_series(0, 9) x, generate_series(0, 2) y, generate_series(0, 2) z WHERE x < 3 OR x > 6', dimension => 3);
SELECT * FROM abacus_profile('sea', '{2.5, 1.25, 10.5, 1.25}', max_edge => 1.5);
SELECT * FROM abacus_profile('sea', '{2, 1, 11, 1}', max_edge => 1.5);
SELECT * FROM abacus_profile('sea', '{3, 1, 3, 2, 6, 2}', max_edge => 1.5);
SELECT count(*) FROM abacus_profile('sea', '{4, 1, 9, 2}', max_edge => 1.5) WHERE value IS NOT NULL;
CREATE TABLE paths AS SELECT i, ARRAY[-1 + i % 5, i % 4, 14 - i % 7, i % 3, i % 9 + 0.5, 3.5, 6.5, 1.5] AS path FROM generate_series(0, 59) i;
SELECT count(*) AS loaded_alike FROM paths WHERE NOT EXISTS ((SELECT * FROM abacus_profile('sea', path, max_edge => 1.5)) EXCEPT ALL (SELECT * FROM abacus_profile('sea_loaded', path)));
SELECT count(*) AS as_without FROM paths WHERE (SELECT array_agg(p ORDER BY n) FROM abacus_profile('sea', path, max_edge => 0) WITH ORDINALITY p (a, b, c, d, e, n)) = (SELECT array_agg(p ORDER BY n) FROM abacus_profile('sea', path) WITH ORDINALITY p (a, b, c, d, e, n));
WITH pieces AS (SELECT i, p.x, p.y, p.value, lead(p.x) OVER w AS x1, lead(p.y) OVER w AS y1, lead(p.value) OVER w AS value1, lead(p.distance) OVER w - p.distance AS length
                FROM paths, abacus_profile('sea', path, max_edge => 1.5) WITH ORDINALITY AS p (distance, x, y, z, value, n) WINDOW w AS (PARTITION BY i ORDER BY n))
SELECT count(*) > 300 AS many, count(*) FILTER (WHERE ((value + value1) / 2 IS NULL) <> (v IS NULL) OR abs((value + value1) / 2 - v) > 1e-9) AS wrong
FROM (SELECT *, abacus_interpolate('sea', (x + x1) / 2, (y + y1) / 2, max_edge => 1.5) AS v FROM pieces WHERE length > 1e-6) AS middles;
WITH pieces AS (SELECT i, p.x, p.y, p.z, p.value, lead(p.x) OVER w AS x1, lead(p.y) OVER w AS y1, lead(p.z) OVER w AS z1, lead(p.value) OVER w AS value1, lead(p.distance) OVER w - p.distance AS length
                FROM generate_series(0, 19) i, abacus_profile('deep_sea', ARRAY[-1, i % 3, 0.3, 10, 0.4, i % 5 / 2.0], max_edge => 1.8) WITH ORDINALITY AS p (distance, x, y, z, value, n) WINDOW w AS (PARTITION BY i ORDER BY n))
SELECT count(*) > 100 AS many, count(v) > 50 AS inside, count(*) FILTER (WHERE ((value + value1) / 2 IS NULL) <> (v IS NULL) OR abs((value + value1) / 2 - v) > 1e-9) AS wrong
FROM (SELECT *, abacus_interpolate('deep_sea', (x + x1) / 2, (y + y1) / 2, (z + z1) / 2, max_edge => 1.8) AS v FROM pieces WHERE length > 1e-6) AS middles;
SELECT visible, x < 6.5 AS before FROM abacus_visible('sea', '{1, 1}', '{12, 2}', observer_height => 20, target_height => 20);
SELECT visible FROM abacus_visible('sea', '{1, 1}', '{12, 2}', observer_height => 20, target_height => 20, max_edge => 1.5);
SELECT visible FROM abacus_visible('sea_loaded', '{1, 1}', '{12, 2}', observer_height => 20, target_height => 20);
SELECT visible FROM abacus_visible('sea', '{5, 1}', '{12, 2}', observer_height => 20, max_edge => 1.5);
SELECT visible FROM abacus_visible('sea', '{1, 1, 0}', '{12, 2, 0}', max_edge => 1.5);
DROP TABLE islands, sea, sea_vertices, sea_loaded, sea_loaded_vertices, deep_sea, deep_sea_vertices, paths;
DROP TABLE hill, hill_vertices, solid, solid_vertices, empty, empty_vertices, ring, ring_vertices, wide, wide_vertices, corners, faces;

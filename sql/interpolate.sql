-- Values between the vertices: abacus_interpolate, abacus_weights, abacus_gradient, abacus_slope.
CREATE SCHEMA regress_interpolate;
SET search_path = regress_interpolate, public;
SELECT abacus_triangulate('hill', 'VALUES (1, 0, 0, 10, 1), (2, 4, 0, 14, NULL), (3, 4, 4, 18, 3), (4, 0, 4, 14, 4), (5, 2, 1, 20, 5)', '{height,rock}');

-- inside, on an edge, on a vertex, on the hull, outside
CREATE VIEW places AS SELECT * FROM (VALUES (1, 'inside', 2, 0.5), (2, 'edge', 1, 0.5), (3, 'vertex', 2, 1), (4, 'hull', 2, 0), (5, 'corner', 4, 4),
    (6, 'outside', 5, 5), (7, 'just outside', 2, -1e-300), (8, 'far', 1e308, 0)) AS t (id, place, x, y);
SELECT place, abacus_interpolate('hill', x, y, 'height') AS linear, round(abacus_interpolate('hill', x, y, 'height', 'natural')::numeric, 10) AS natural,
       abacus_interpolate('hill', x, y, 'height', 'nearest') AS nearest, abacus_interpolate('hill', x, y, 'height', outside => 'nearest') AS filled
FROM places ORDER BY id;
-- a value that is missing counts only where its vertex has a weight
SELECT place, abacus_interpolate('hill', x, y, 'rock') AS linear, abacus_interpolate('hill', x, y, 'rock', 'nearest') AS nearest,
       abacus_interpolate('hill', x, y, 'rock', outside => 'nearest') AS filled FROM places ORDER BY id;
-- all places of a query at once
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places') ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places', attributes => '{rock,height,rock}', method => 'nearest', outside => 'nearest') ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places', attributes => '{height}', max_edge => 4) ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places', attributes => '{}', max_edge => 0) ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places WHERE id < 3', '{rock,height}') ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places WHERE id < 3', 'height', 'nearest') ORDER BY id;
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places WHERE id < 3', ARRAY['height']) ORDER BY id;
SELECT count("values") FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places', NULL, 'nearest');
SELECT * FROM abacus_interpolate('hill', 'SELECT id, x, y FROM places', 'depth');

-- what the values are made of
SELECT place, w.* FROM places, abacus_weights('hill', x, y) AS w ORDER BY id, vertex;
SELECT w.* FROM abacus_weights('hill', 'SELECT id, x, y FROM places WHERE id IN (1, 3, 6)', outside => 'nearest') AS w ORDER BY id, vertex;
SELECT place, round(sum(weight)::numeric, 12) AS sum, round((sum(weight * v.x) - p.x)::numeric, 12) AS off_x, round((sum(weight * v.y) - p.y)::numeric, 12) AS off_y
FROM places p, abacus_weights('hill', p.x, p.y, 'natural') w JOIN abacus_vertices('hill') v ON v.id = w.vertex GROUP BY p.id, place, p.x, p.y ORDER BY p.id;

-- how they change
SELECT place, abacus_gradient('hill', x, y, 'height') AS gradient, round(slope::numeric, 10) AS slope, round(aspect::numeric, 10) AS aspect FROM places, abacus_slope('hill', x, y, 'height') ORDER BY id;
SELECT abacus_triangulate('plane', 'SELECT id, x, y, 0 FROM (VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)) AS t (id, x, y)', '{height}');
SELECT abacus_gradient('plane', 0.2, 0.2), abacus_slope('plane', 0.2, 0.2);
-- down to the north, the east, the south, the west
CREATE VIEW sides AS SELECT * FROM (VALUES (1, 'north', 0, -1), (2, 'east', -1, 0), (3, 'south', 0, 1), (4, 'west', 1, 0)) AS t (n, side, gx, gy);
SELECT side, abacus_triangulate('slope_' || side, format('SELECT id, x, y, %s * x + %s * y FROM (VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)) AS t (id, x, y)', gx, gy), '{height}') FROM sides ORDER BY n;
SELECT side, round(slope::numeric, 10) AS slope, round(aspect::numeric, 10) AS aspect FROM sides, abacus_slope(('slope_' || side)::regclass, 0.2, 0.2) ORDER BY n;

-- in space
SELECT abacus_triangulate('cube', 'SELECT 100 * x + 10 * y + z, x, y, z, x + 2 * y + 3 * z FROM generate_series(0, 2) x, generate_series(0, 2) y, generate_series(0, 2) z', '{sum}', dimension => 3);
SELECT round(abacus_interpolate('cube', x, y, z)::numeric, 12) AS linear, round(abacus_interpolate('cube', x, y, z, method => 'natural')::numeric, 12) AS natural,
       abacus_interpolate('cube', x, y, z, method => 'nearest') AS nearest, abacus_gradient('cube', x, y, z) AS gradient
FROM (VALUES (0.7, 0.4, 1.2), (1, 1, 1), (0.5, 0.5, 0), (0, 0, 0.3), (3, 0, 0)) AS t (x, y, z);
SELECT * FROM abacus_weights('cube', 0.5, 0.5, 0.5, 'natural') ORDER BY 1;
SELECT * FROM abacus_weights('cube', 'SELECT 7, 0.5, 0, 0') ORDER BY 2;
SELECT id, round(values[1]::numeric, 12) FROM abacus_interpolate('cube', 'SELECT 1, 0.7, 0.4, 1.2 UNION ALL SELECT 2, 9, 9, 9', outside => 'nearest') ORDER BY id;

-- triangles so flat that their area is lost in rounding
SELECT abacus_triangulate('flat', 'SELECT * FROM (VALUES (1, 0::float8, 0::float8, 0, 7), (2, 0.1, 0.3, 1, NULL), (3, 0.5, 1.5, 5, 3)) AS p (id, x, y, height, rock)', '{height,rock}');
SELECT x, y, abacus_interpolate('flat', x, y, 'height') AS height, abacus_interpolate('flat', x, y, 'rock') AS rock, abacus_gradient('flat', x, y, 'height') AS gradient,
       (SELECT array_agg(w::text ORDER BY vertex) FROM abacus_weights('flat', x, y) AS w) AS weights
FROM (VALUES (0, 0), (0.1, 0.3), (0.5, 1.5), (0.25, 0.75), (0.05, 0.15), (0.3, 0.9)) AS t (x, y);
SELECT * FROM abacus_profile('flat', '{0.1,0.3,0.5,1.5}', 'height');
SELECT * FROM abacus_raster('flat', '{0,1}', '{1,2}', 1, 1, 'height');
SELECT * FROM abacus_check('flat');
CREATE TABLE turned AS SELECT 40 * i + j AS id, i * c - j * s AS x, i * s + j * c AS y, (40 * i + j)::float8 AS height FROM generate_series(0, 39) AS i, generate_series(0, 39) AS j, (VALUES (0.8775825618903728::float8, 0.479425538604203::float8)) AS turn (c, s);
SELECT abacus_triangulate('turned_mesh', 'TABLE turned');
SELECT id, height, abacus_interpolate('turned_mesh', x, y) AS value FROM turned WHERE abacus_interpolate('turned_mesh', x, y) IS DISTINCT FROM height;
CREATE TABLE sheared AS SELECT 100 * i + 10 * j + k AS id, i + 0.1 * j + 0.3 * k AS x, j + 0.7 * k AS y, k * 0.9::float8 AS z, (100 * i + 10 * j + k)::float8 AS height
FROM generate_series(0, 4) AS i, generate_series(0, 4) AS j, generate_series(0, 4) AS k;
SELECT abacus_triangulate('sheared_mesh', 'TABLE sheared', dimension => 3);
SELECT id, height, value.values[1] FROM sheared JOIN abacus_interpolate('sheared_mesh', 'SELECT id, x, y, z FROM sheared') AS value USING (id) WHERE value.values[1] IS DISTINCT FROM height;
SELECT count(*) FROM abacus_check('turned_mesh');
SELECT count(*) FROM abacus_check('sheared_mesh');

-- NULL and infinite places
SELECT abacus_interpolate(NULL, 1, 1) IS NULL, abacus_interpolate('hill', NULL, 1, 'height') IS NULL, abacus_interpolate('hill', 1, 1, NULL::float8, 'height') IS NULL,
       abacus_interpolate('hill', 1, 'Infinity', 'height', outside => 'nearest') IS NULL, abacus_gradient('hill', NULL, 1) IS NULL, abacus_slope('hill', 9, 9, 'height') IS NULL;
SELECT abacus_interpolate('hill', 2, 0.5, attribute => 'height', method => NULL, outside => NULL, max_edge => NULL);
SELECT count(*) FROM abacus_interpolate('hill', NULL::text);
SELECT count(*) FROM abacus_weights('hill', NULL, 1);

-- bad input
SELECT abacus_interpolate('hill', 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 'heights');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 'height', 'cubic');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 'height', outside => 'zero');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 'height', max_edge => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 'height', max_edge => 'NaN');
SELECT abacus_interpolate('hill', 1, 'NaN', 'height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 1, 1, 1, 'height');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('cube', 1, 1);
SELECT abacus_interpolate('hill', 'SELECT 1, 1, 1', attributes => '{height,none}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 'SELECT 1, 1, 1', attributes => '{NULL}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('hill', 'SELECT 1, NULL, 1');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_weights('hill', 1, 1, 'cubic');
SELECT abacus_slope('cube', 1, 1);
SELECT abacus_create('bare', 2);
SELECT abacus_interpolate('bare', 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_interpolate('bare', 'SELECT 1, 1, 1');
SELECT count(*) FROM abacus_weights('bare', 1, 1, outside => 'nearest');
SELECT abacus_interpolate('pg_class', 1, 1);

-- a loaded mesh that is not Delaunay
CREATE TABLE corners AS SELECT * FROM (VALUES (1, 0, 0, 1), (2, 4, 0, 2), (3, 4, 1, 3), (4, 0, 1, 4), (5, 2, 3, 5)) AS t (id, x, y, height);
SELECT abacus_load('kite', 'TABLE corners', 'VALUES (1, 2, 5), (2, 3, 5), (4, 1, 5)');
SELECT abacus_interpolate('kite', 2, 1), abacus_interpolate('kite', 2, 9), abacus_interpolate('kite', 2, 9, outside => 'nearest'), abacus_interpolate('kite', 0.5, 1.2, method => 'nearest');
SELECT abacus_interpolate('kite', 2, 1, method => 'natural');
\echo :LAST_ERROR_SQLSTATE

-- after errors the session reads on; a change of the mesh is seen
SELECT abacus_insert('hill', 'SELECT 6, 2, 0.5, 100, 6');
SELECT abacus_interpolate('hill', 2, 0.5, 'height');
SELECT abacus_rename_attribute('hill', 'height', 'h');
SELECT abacus_interpolate('hill', 2, 0.5, 'h'), abacus_interpolate('hill', 2, 0.5, 'height');
SET client_min_messages = warning;
DROP SCHEMA regress_interpolate CASCADE;

-- Contours of larger meshes, for any memory and order of points; with holes; windows of a mesh.
BEGIN;
SELECT no_plan();
SELECT setseed(0.5);
CREATE TABLE points AS SELECT id, x, y, CASE WHEN id % 7 = 0 THEN 30 * random() ELSE 10 * sin(x / 9) + y / 4 END AS height
FROM (SELECT id, 100 * random() AS x, 100 * random() AS y FROM generate_series(1, 12000) AS id) AS p;
SELECT isnt(abacus_triangulate('field', 'TABLE points'), NULL, 'a mesh');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_simplices('field') WHERE (v0 + v1 + v2) % 9 > 0;
CREATE TABLE corners AS SELECT * FROM points WHERE id IN (SELECT v0 FROM triangles UNION SELECT v1 FROM triangles UNION SELECT v2 FROM triangles);
SELECT isnt(abacus_load('holes', 'TABLE corners', 'TABLE triangles'), NULL, 'one with holes');
CREATE FUNCTION pg_temp.area(path float8[]) RETURNS float8 LANGUAGE sql AS $$
    SELECT sum((path[i] - path[1]) * (path[i + 3] - path[2]) - (path[i + 2] - path[1]) * (path[i + 1] - path[2])) / 2 FROM generate_series(1, cardinality(path) - 3, 2) AS i $$;
CREATE FUNCTION pg_temp.mesh_area(mesh regclass) RETURNS float8 LANGUAGE sql AS $$
    SELECT sum((corners[2][1] - corners[1][1]) * (corners[3][2] - corners[1][2]) - (corners[3][1] - corners[1][1]) * (corners[2][2] - corners[1][2])) / 2 FROM abacus_cells(mesh) $$;

-- rows are the same, in the same order
CREATE TABLE lines AS SELECT row_number() OVER () AS n, c.* FROM abacus_contours('field', 0.5) c;
CREATE TABLE rings AS SELECT row_number() OVER () AS n, c.* FROM abacus_contours('field', 0.5, polygonize => true) c;
CREATE TABLE ring_holes AS SELECT row_number() OVER () AS n, c.* FROM abacus_contours('holes', 0.5, polygonize => true) c;
SELECT cmp_ok((SELECT count(*) FROM lines), '>', 1000::bigint, 'many lines');
SELECT results_eq('SELECT id FROM lines ORDER BY n', 'SELECT n FROM lines ORDER BY n', 'lines are numbered in their order');
SELECT is_empty('SELECT FROM (SELECT value, lag(value) OVER (ORDER BY n) AS before FROM lines) AS v WHERE before > value', 'by value first');
SET LOCAL work_mem = '64kB';
SET LOCAL abacus.cache_size = '1MB';
SELECT results_eq($$ SELECT * FROM abacus_contours('field', 0.5) $$, 'SELECT id, value, closed, path FROM lines ORDER BY n', 'with little memory');
SELECT results_eq($$ SELECT * FROM abacus_contours('field', 0.5, polygonize => true) $$, 'SELECT id, value, closed, path FROM rings ORDER BY n', 'bands with little memory');
RESET work_mem;
RESET abacus.cache_size;
SELECT isnt(abacus_triangulate('turned', 'SELECT * FROM points ORDER BY height'), NULL, 'the same points in another order');
SELECT isnt(abacus_insert('turned', 'SELECT id + 100000, x + 200, y, height FROM points LIMIT 300'), NULL, 'more');
SELECT isnt(abacus_delete('turned', 'SELECT id + 100000, x + 200, y FROM points LIMIT 300'), NULL, 'and fewer');
SELECT results_eq($$ SELECT * FROM abacus_contours('turned', 0.5) $$, 'SELECT id, value, closed, path FROM lines ORDER BY n', 'give the same lines');
SELECT results_eq($$ SELECT * FROM abacus_contours('turned', 0.5, polygonize => true) $$, 'SELECT id, value, closed, path FROM rings ORDER BY n', 'and bands');

-- properties of lines
SELECT is_empty('SELECT FROM lines WHERE closed <> (path[1:2] = path[cardinality(path) - 1:])', 'closed lines end where they begin');
SELECT is_empty($$ SELECT FROM lines l, LATERAL abacus_interpolate('field', path[3], path[4]) AS found WHERE abs(found - l.value) > 1e-6 $$, 'their points have the value');

-- bands cover the whole mesh, once
SELECT is((SELECT round(sum(pg_temp.area(path))::numeric, 6) FROM rings), round(pg_temp.mesh_area('field')::numeric, 6), 'bands have the area of the mesh');
SELECT is((SELECT round(sum(pg_temp.area(path))::numeric, 6) FROM ring_holes), round(pg_temp.mesh_area('holes')::numeric, 6), 'with holes');
SELECT is_empty('SELECT FROM (SELECT DISTINCT ON (id) path FROM rings ORDER BY id, n) AS first WHERE pg_temp.area(path) <= 0', 'the first ring of a band is an outline');
SELECT is((SELECT count(DISTINCT value) = max(id) AND bool_and(closed) FROM rings), true, 'a band has one id');
SELECT is((SELECT count(*) FROM (SELECT DISTINCT ON (id) id FROM abacus_contours('field', 5, polygonize => true)) AS b), (SELECT count(DISTINCT floor(height / 5)) FROM points), 'there is a band for each value');

-- windows: bands have their area, and lines of adjacent windows end at the same points
CREATE TABLE windows AS SELECT i, j, ARRAY[20 * i, 20 * j] AS low, ARRAY[20 * i + 20, 20 * j + 20] AS high FROM generate_series(1, 3) AS i, generate_series(1, 3) AS j;
SELECT is((SELECT round(sum(pg_temp.area(path))::numeric, 6) FROM windows, abacus_contours('field', 3, polygonize => true, lower => low, upper => high)), 3600::numeric, 'bands of windows have their area');
CREATE TABLE ends AS SELECT i, value, p.x, p.y FROM windows, abacus_contours('field', 3, lower => low, upper => high),
    LATERAL (VALUES (path[1], path[2]), (path[cardinality(path) - 1], path[cardinality(path)])) AS p (x, y) WHERE NOT closed;
SELECT bag_eq('SELECT value, x, y FROM ends WHERE i = 1 AND x = 40', 'SELECT value, x, y FROM ends WHERE i = 2 AND x = 40', 'lines go on in the next window');
SELECT isnt_empty('SELECT FROM ends WHERE x = 40', 'which they reach');
SELECT is_empty('SELECT FROM (SELECT unnest(path) AS at FROM windows, abacus_contours(''field'', 3, lower => low, upper => high) WHERE i = 2 AND j = 2) AS p WHERE at < 40 OR at > 60', 'and stay in their window');

-- estimates: by the number of levels
CREATE FUNCTION pg_temp.expected(query text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan json;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
    RETURN plan -> 0 -> 'Plan' ->> 'Plan Rows';
END $$;
SELECT is(round(pg_temp.expected($$ SELECT * FROM abacus_contours('field', fixed_levels => '{1,2,3,4,5,6,7,8}') $$)
                / pg_temp.expected($$ SELECT * FROM abacus_contours('field', fixed_levels => '{1,2}') $$)), 4::float8, 'four times as many levels have four times as many lines');
SELECT cmp_ok(pg_temp.expected($$ SELECT * FROM abacus_contours('field') $$), '>', pg_temp.expected($$ SELECT * FROM abacus_contours('field', fixed_levels => '{1,2}') $$), 'levels that are not given are some');
SELECT is(pg_temp.expected($$ SELECT * FROM abacus_contours(NULL) $$), 1::float8, 'of no mesh none');

SELECT * FROM finish();
ROLLBACK;

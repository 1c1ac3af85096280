-- abacus_load with retriangulate: labels and markers of what is in both triangulations stay, and others are inherited.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;

-- a leaning grid, whose diagonals are not all Delaunay
CREATE TABLE point AS SELECT (10 * i + j)::bigint AS id, i::float8 AS x, j + 0.3 * ((i * 7 + j * 3) % 5) AS y, (i + j)::float8 AS h FROM generate_series(0, 9) AS i, generate_series(0, 9) AS j;
CREATE TABLE given AS SELECT v[1]::bigint AS v0, v[2]::bigint AS v1, v[3]::bigint AS v2, (v[1] / 30)::float8 AS soil, nullif(v[2] % 4, 0)::float8 AS crop
    FROM (SELECT 10 * i + j AS c FROM generate_series(0, 8) AS i, generate_series(0, 8) AS j) AS s, LATERAL (VALUES (ARRAY[c, c + 10, c + 11]), (ARRAY[c, c + 11, c + 1])) AS t (v);
CREATE TABLE side AS SELECT 10 * i AS v0, 10 * (i + 1) AS v1, 7 AS marker FROM generate_series(0, 8) AS i UNION ALL SELECT 10 * i + 4, 10 * i + 15, i FROM generate_series(0, 8) AS i;
CREATE FUNCTION pg_temp.made(mesh text, options text) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE made bigint;
BEGIN
    EXECUTE format($q$ SELECT abacus_load(%L, 'TABLE point', 'TABLE given', labels => '{soil,crop}', facets => 'TABLE side', retriangulate => true %s) $q$, mesh, options) INTO made;
    RETURN made;
END $$;
CREATE FUNCTION pg_temp.ids(VARIADIC v bigint[]) RETURNS bigint[] LANGUAGE sql IMMUTABLE AS $$ SELECT array_agg(n ORDER BY n) FROM unnest(v) AS n $$;
-- many centroids lie on a diagonal of the grid
CREATE FUNCTION pg_temp.inside(a point, b point, c point, p float8[]) RETURNS boolean LANGUAGE sql IMMUTABLE AS $$
    SELECT (b[0] - a[0]) * (p[2] - a[1]) >= (b[1] - a[1]) * (p[1] - a[0]) - 1e-9 AND (c[0] - b[0]) * (p[2] - b[1]) >= (c[1] - b[1]) * (p[1] - b[0]) - 1e-9
       AND (a[0] - c[0]) * (p[2] - c[1]) >= (a[1] - c[1]) * (p[1] - c[0]) - 1e-9 $$;

SELECT abacus_triangulate('own', 'TABLE point');
SELECT is(pg_temp.made('anew', ''), (SELECT count(*) FROM abacus_simplices('own')), 'made anew');
SELECT set_eq($$SELECT v0, v1, v2 FROM abacus_simplices('anew')$$, $$SELECT v0, v1, v2 FROM abacus_simplices('own')$$, 'the triangulation of the points');
SELECT is(abacus_labels('anew'), '{soil,crop}', 'labels by their names');
SELECT set_eq($$SELECT pg_temp.ids(v0, v1, v2), labels FROM abacus_cells('anew')$$,
    $$SELECT pg_temp.ids(o.v0, o.v1, o.v2), ARRAY[g.soil, g.crop]
      FROM abacus_simplices('own') AS o LEFT JOIN given AS g ON pg_temp.ids(g.v0, g.v1, g.v2) = pg_temp.ids(o.v0, o.v1, o.v2)$$, 'triangles that stay keep them');
SELECT cmp_ok((SELECT count(*) FROM abacus_cells('anew') WHERE labels[1] IS NULL), '>', 20::bigint, 'some are new');
SELECT set_eq($$SELECT marker, pg_temp.ids(v0, v1) FROM abacus_facets('anew')$$,
    $$SELECT s.marker, pg_temp.ids(s.v0, s.v1) FROM side AS s WHERE EXISTS (SELECT FROM abacus_simplices('own') AS o WHERE ARRAY[s.v0, s.v1]::bigint[] <@ ARRAY[o.v0, o.v1, o.v2])$$, 'edges too');
SELECT cmp_ok((SELECT count(*) FROM abacus_facets('anew')), '<', (SELECT count(*) FROM side), 'some edges are gone');
SELECT is((SELECT count(*) FROM abacus_check('anew')), 0::bigint, 'sound');
SELECT is(abacus_insert('anew', 'VALUES (500, 4.4, 4.4, 1)'), 1::bigint, 'it can be changed');
SELECT is((SELECT count(*) FROM abacus_cells('anew') WHERE 500 IN (v0, v1, v2) AND labels[1] IS NOT NULL), 0::bigint, 'and does not inherit');

SELECT pg_temp.made('heir', ', inherit => true');
SELECT is((SELECT count(*) FROM abacus_cells('heir') AS o WHERE NOT EXISTS (
        SELECT FROM given AS g JOIN point AS a ON a.id = g.v0 JOIN point AS b ON b.id = g.v1 JOIN point AS c ON c.id = g.v2
        WHERE o.labels IS NOT DISTINCT FROM ARRAY[g.soil, g.crop] AND pg_temp.inside(point(a.x, a.y), point(b.x, b.y), point(c.x, c.y),
            ARRAY[(o.corners[1][1] + o.corners[2][1] + o.corners[3][1]) / 3, (o.corners[1][2] + o.corners[2][2] + o.corners[3][2]) / 3]))),
    (SELECT count(*) FROM abacus_cells('heir') WHERE labels[1] IS NULL), 'new triangles inherit from those that their centroids lay in');
SELECT cmp_ok((SELECT count(*) FROM abacus_cells('heir') WHERE labels[1] IS NULL), '<', 20::bigint, 'others were outside, at the notched border');
SELECT is((SELECT count(*) FROM abacus_check('heir')), 0::bigint, 'sound');

-- with lines all edges on them stay, and their markers
SELECT pg_temp.made('lined', $$, inherit => true, lines => 'SELECT marker, v0, v1 FROM side'$$);
SELECT is((SELECT count(*) FROM abacus_facets('lined')), (SELECT count(*) FROM side), 'lines keep their markers');
SELECT is((SELECT count(*) FROM abacus_check('lined')), 0::bigint, 'sound');

-- a triangulation that is Abacus' own already, and one without any labels
SELECT lives_ok($$SELECT abacus_load('kept', 'TABLE point', 'SELECT v0, v1, v2, v0 AS soil FROM abacus_simplices(''own'')', labels => '{soil}', retriangulate => true, inherit => true)$$);
SELECT is((SELECT count(*) FROM abacus_cells('kept') WHERE labels[1] = v0), (SELECT count(*) FROM abacus_simplices('own')), 'all labels stay');
SELECT lives_ok($$SELECT abacus_load('none', 'TABLE point', 'SELECT v0, v1, v2, NULL::float8 AS soil FROM given', labels => '{soil}', retriangulate => true, inherit => true)$$, 'labels that are all NULL');
SELECT throws_ok($$SELECT abacus_load('bad', 'TABLE point', 'TABLE given', labels => '{soil,crop}', retriangulate => true, inherit => NULL)$$, '22004');

-- nodes that were split at a fault become one vertex
CREATE TABLE split AS SELECT id, x, y FROM point UNION ALL SELECT id + 1000, x, y FROM point WHERE id / 10 = 5;
SELECT lives_ok($$SELECT abacus_load('fault', 'TABLE split', 'SELECT CASE WHEN g.v0 / 10 = 5 THEN g.v0 + 1000 ELSE g.v0 END, CASE WHEN g.v0 / 10 = 5 AND g.v1 / 10 = 5 THEN g.v1 + 1000 ELSE g.v1 END,
    CASE WHEN g.v0 / 10 = 5 AND g.v2 / 10 = 5 THEN g.v2 + 1000 ELSE g.v2 END, soil FROM given AS g', labels => '{soil}', split_nodes => true, retriangulate => true)$$, 'split nodes');
SELECT is((SELECT count(labels[1]) FROM abacus_cells('fault')), (SELECT count(*) FROM given AS g JOIN abacus_simplices('own') AS o ON pg_temp.ids(g.v0, g.v1, g.v2) = pg_temp.ids(o.v0, o.v1, o.v2)), 'triangles at the fault keep their labels');
SELECT is((SELECT count(*) FROM abacus_check('fault')), 0::bigint, 'sound');

-- in space: cubes cut into six
CREATE TABLE node AS SELECT (100 * i + 10 * j + k)::bigint AS id, i + 0.1 * ((j * k) % 3) AS x, j + 0.1 * ((i * k) % 3) AS y, k + 0.1 * ((i + j) % 4) AS z
    FROM generate_series(0, 4) AS i, generate_series(0, 4) AS j, generate_series(0, 4) AS k;
CREATE TABLE body AS SELECT c + t[1] AS v0, c + t[2] AS v1, c + t[3] AS v2, c + t[4] AS v3, (c / 200)::float8 AS rock
    FROM (SELECT (100 * i + 10 * j + k)::bigint AS c FROM generate_series(0, 3) AS i, generate_series(0, 3) AS j, generate_series(0, 3) AS k) AS s,
    LATERAL (VALUES (ARRAY[0, 100, 110, 111]), (ARRAY[0, 110, 10, 111]), (ARRAY[0, 10, 11, 111]), (ARRAY[0, 11, 1, 111]), (ARRAY[0, 1, 101, 111]), (ARRAY[0, 101, 100, 111])) AS q (t);
CREATE TABLE face AS SELECT v0, v1, v2, 3 AS marker FROM body WHERE v0 % 10 = 0 AND v1 % 10 = 0 AND v2 % 10 = 0 UNION ALL SELECT v0, v1, v3, 4 FROM body WHERE v0 = 222;
SELECT abacus_triangulate('own3', 'TABLE node', dimension => 3);
SELECT is(abacus_load('anew3', 'TABLE node', 'TABLE body', labels => '{rock}', facets => 'TABLE face', retriangulate => true), (SELECT count(*) FROM abacus_simplices('own3')), 'in space');
SELECT set_eq($$SELECT pg_temp.ids(v0, v1, v2, v3), labels[1] FROM abacus_cells('anew3') WHERE labels[1] IS NOT NULL$$,
    $$SELECT pg_temp.ids(g.v0, g.v1, g.v2, g.v3), g.rock FROM body AS g JOIN abacus_simplices('own3') AS o ON pg_temp.ids(g.v0, g.v1, g.v2, g.v3) = pg_temp.ids(o.v0, o.v1, o.v2, o.v3)$$, 'tetrahedra that stay keep their labels');
SELECT set_eq($$SELECT marker, pg_temp.ids(v0, v1, v2) FROM abacus_facets('anew3')$$,
    $$SELECT s.marker, pg_temp.ids(s.v0, s.v1, s.v2) FROM face AS s WHERE EXISTS (SELECT FROM abacus_simplices('own3') AS o WHERE ARRAY[s.v0, s.v1, s.v2]::bigint[] <@ ARRAY[o.v0, o.v1, o.v2, o.v3])$$, 'and facets their markers');
SELECT is((SELECT count(*) FROM abacus_check('anew3')), 0::bigint, 'sound');
SELECT abacus_load('heir3', 'TABLE node', 'TABLE body', labels => '{rock}', facets => 'TABLE face', retriangulate => true, inherit => true);
SELECT is((SELECT count(*) FROM abacus_check('heir3')), 0::bigint, 'sound');
SELECT cmp_ok((SELECT count(labels[1]) FROM abacus_cells('heir3')), '>', (SELECT count(labels[1]) FROM abacus_cells('anew3')), 'tetrahedra inherit');

SELECT * FROM finish();
ROLLBACK;

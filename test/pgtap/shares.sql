-- Parts of a mesh and shares of them: weights, labels, markers, little memory, edits and errors. test/oracle/shares_test.py compares shares with brute force.
BEGIN;
SELECT no_plan();

CREATE TABLE points AS SELECT i AS id, i * 0.7548776662466927 % 1 AS x, i * 0.5698402909980532 % 1 AS y, i * 0.4301597090019468 % 1 AS z FROM generate_series(1, 1200) AS i;
SELECT isnt(abacus_triangulate('plane', 'SELECT id, x, y, 10 * z, x FROM points', '{z,x}'), NULL, 'a plane');
SELECT isnt(abacus_triangulate('space', 'SELECT id, x, y, z, y FROM points WHERE id <= 500', '{y}', dimension => 3), NULL, 'a space');

-- more parts than simplices
SELECT isnt(abacus_triangulate('small', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4), (5, 2, 1)'), NULL, 'four triangles');
SELECT results_eq($$ SELECT sum(simplices)::bigint, max(simplices), count(*) FROM abacus_partition('small', 100000) $$, $$ VALUES (4::bigint, 1::bigint, 100000::bigint) $$, 'many parts');
SELECT is_empty($$ SELECT * FROM abacus_share_simplices('small', 100000, 0, 3) UNION ALL SELECT * FROM abacus_share_simplices('small', 100000, 99999, 3) $$, 'an empty share');

SELECT is_empty($$ SELECT * FROM abacus_share_vertices('small', 2147483647, 2147483646, 1000000) $$, 'as many as there can be');
-- a layer that adds nothing is the last one
SELECT set_eq($$ SELECT code, owner FROM abacus_share_simplices('space', 7, 3, 2147483647) $$, $$ SELECT s.code, s.owner FROM generate_series(0, 6) AS p, abacus_share_simplices('space', 7, p, 0) AS s $$, 'a halo without end');
SELECT is((SELECT count(*) FROM abacus_share_vertices('space', 7, 3, 1000000)), 500::bigint, 'has all vertices');

-- weights: each part's sum is the mean, to half a simplex at each end
CREATE FUNCTION pg_temp.far(mesh regclass, parts int, weight text, number int) RETURNS TABLE (part int, far float8) LANGUAGE sql AS $$
    WITH w AS (SELECT s.owner, (SELECT sum(coalesce(n.attributes[number], 0)) FROM abacus_share_vertices(mesh, parts, p, 0, weight) AS n WHERE n.local IN (v0, v1, v2, v3)) / CASE WHEN v3 IS NULL THEN 3 ELSE 4 END AS w
               FROM generate_series(0, parts - 1) AS p, abacus_share_simplices(mesh, parts, p, 0, weight) AS s)
    SELECT owner, abs(sum(w) - (SELECT sum(w) FROM w) / parts) - (SELECT max(w) FROM w) FROM w GROUP BY owner $$;
SELECT is_empty($$ SELECT * FROM pg_temp.far('plane', 3, 'z', 1) WHERE far > 1e-9 $$, 'equal sums of an attribute');
SELECT is_empty($$ SELECT * FROM pg_temp.far('space', 3, 'y', 1) WHERE far > 1e-9 $$, 'in space');
SELECT isnt(abacus_label('plane', 'SELECT code, v0, v1, v2, CASE WHEN code % 3 = 0 THEN 1e300 WHEN code % 3 = 1 THEN 1e-300 END AS work FROM abacus_simplices(''plane'')'), NULL, 'labels far apart, and without');
SELECT cmp_ok((SELECT max(n) - min(n) FROM (SELECT count(*) FILTER (WHERE labels[1] > 1) AS n FROM generate_series(0, 3) AS p, abacus_share_simplices('plane', 4, p, 0, 'work') GROUP BY p) AS s), '<=', 1::bigint, 'equal numbers of the great ones');
SELECT isnt(abacus_label('space', 'SELECT code, v0, v1, v2, v3, 0 AS nothing FROM abacus_simplices(''space'')'), NULL, 'no weight at all');
SELECT set_eq($$ SELECT * FROM abacus_partition('space', 4, 'nothing') $$, $$ SELECT * FROM abacus_partition('space', 4) $$, 'simplices count');

-- labels and markers, of each facet
SELECT isnt(abacus_mark('plane', 'SELECT s.code, s.v0, s.v1, s.v2, f, s.v0 % 7 FROM abacus_simplices(''plane'') AS s, generate_series(0, 2) AS f WHERE f = s.v1 % 3 AND s.v0 % 2 = 0'), NULL, 'markers');
CREATE TABLE marked AS SELECT least(v0, v1) AS a, greatest(v0, v1) AS b, marker FROM abacus_facets('plane');
SELECT set_eq($$ WITH n AS MATERIALIZED (SELECT local, id FROM abacus_share_vertices('plane', 3, 1, 1)), s AS MATERIALIZED (SELECT * FROM abacus_share_simplices('plane', 3, 1, 1)),
                      f AS (SELECT CASE i WHEN 0 THEN v1 ELSE v0 END AS p, CASE i WHEN 2 THEN v1 ELSE v2 END AS q, markers[i + 1] AS marker FROM s, generate_series(0, 2) AS i)
                 SELECT least(a.id, b.id), greatest(a.id, b.id), marker FROM f JOIN n AS a ON a.local = p JOIN n AS b ON b.local = q $$,
              $$ WITH n AS MATERIALIZED (SELECT local, id FROM abacus_share_vertices('plane', 3, 1, 1)), s AS MATERIALIZED (SELECT * FROM abacus_share_simplices('plane', 3, 1, 1)),
                      f AS (SELECT CASE i WHEN 0 THEN v1 ELSE v0 END AS p, CASE i WHEN 2 THEN v1 ELSE v2 END AS q FROM s, generate_series(0, 2) AS i),
                      e AS (SELECT DISTINCT least(a.id, b.id) AS a, greatest(a.id, b.id) AS b FROM f JOIN n AS a ON a.local = p JOIN n AS b ON b.local = q)
                 SELECT e.a, e.b, m.marker::float8 FROM e LEFT JOIN marked AS m ON m.a = e.a AND m.b = e.b $$, 'the markers of edges');
SELECT set_eq($$ SELECT s.code, s.labels FROM generate_series(0, 2) AS p, abacus_share_simplices('plane', 3, p, 0) AS s $$, $$ SELECT code, labels FROM abacus_cells('plane') $$, 'labels');

-- the same whatever the memory, the cache and the threads
CREATE TABLE share AS SELECT * FROM abacus_share_simplices('space', 3, 1, 2);
CREATE TABLE node AS SELECT * FROM abacus_share_vertices('space', 3, 1, 2);
SET LOCAL work_mem = '64kB';
SET LOCAL abacus.cache_size = '1MB';
SET LOCAL abacus.threads = 1;
SELECT bag_eq('TABLE share', $$ SELECT * FROM abacus_share_simplices('space', 3, 1, 2) $$, 'simplices with little memory');
SELECT results_eq('TABLE node', $$ SELECT * FROM abacus_share_vertices('space', 3, 1, 2) $$, 'vertices with little memory');
RESET work_mem;
RESET abacus.cache_size;
RESET abacus.threads;
-- and however the mesh came about
SELECT isnt(abacus_create('steps', 3, lower => '{0,0,0}', upper => '{1,1,1}'), NULL, 'the same domain');
SELECT isnt(abacus_create('at_once', 3, lower => '{0,0,0}', upper => '{1,1,1}'), NULL, 'for both');
SELECT isnt(abacus_insert('at_once', 'SELECT id, x, y, z FROM points'), NULL, 'in one step');
SELECT isnt(abacus_insert('steps', format('SELECT id, x, y, z FROM points WHERE id %% 4 = %s', i)), NULL, 'in four') FROM generate_series(0, 3) AS i;
SELECT results_eq($$ SELECT * FROM abacus_share_vertices('steps', 5, 2, 1) $$, $$ SELECT * FROM abacus_share_vertices('at_once', 5, 2, 1) $$, 'the same vertices');
SELECT bag_eq($$ SELECT code, v0, v1, v2, v3, owner FROM abacus_share_simplices('steps', 5, 2, 1) $$, $$ SELECT code, v0, v1, v2, v3, owner FROM abacus_share_simplices('at_once', 5, 2, 1) $$, 'the same simplices');

-- an edit is seen by the next statement, and cut anew
SELECT isnt(abacus_insert('small', 'VALUES (6, 2, 3)'), NULL, 'one more point');

-- empty, NULL and wrong arguments
SELECT isnt(abacus_create('empty', 2), NULL, 'an empty mesh');
SELECT results_eq($$ SELECT * FROM abacus_partition('empty', 2) $$, $$ VALUES (0, 0::bigint, 0::bigint, 0::bigint, 0::bigint), (1, 0, 0, 0, 0) $$, 'has empty parts');
SELECT is_empty($$ SELECT id FROM abacus_share_vertices('empty', 2, 1) UNION ALL SELECT code FROM abacus_share_simplices('empty', 2, 1) $$, 'and empty shares');
SELECT is_empty($$ SELECT 1 FROM abacus_partition(NULL, 2) UNION ALL SELECT 1 FROM abacus_partition('plane', NULL) UNION ALL SELECT 1 FROM abacus_share_vertices('plane', 2, NULL) UNION ALL SELECT 1 FROM abacus_share_simplices('plane', 2, 1, NULL) $$, 'NULL');
SELECT throws_ok($$ SELECT abacus_partition('plane', 0) $$, '22023', 'parts must be at least 1, not 0', 'no parts');
SELECT throws_ok($$ SELECT abacus_share_vertices('plane', -3, 0) $$, '22023', 'parts must be at least 1, not -3', 'fewer');
SELECT throws_ok($$ SELECT abacus_share_vertices('plane', 4, 4) $$, '22023', 'part must be between 0 and 3, not 4', 'a part too far');
SELECT throws_ok($$ SELECT abacus_share_simplices('plane', 4, -1) $$, '22023', 'part must be between 0 and 3, not -1', 'a negative one');
SELECT throws_ok($$ SELECT abacus_share_simplices('plane', 4, 1, -1) $$, '22023', 'halo must be at least 0, not -1', 'a negative halo');
SELECT throws_ok($$ SELECT abacus_partition('plane', 4, 'soil') $$, '42703', 'mesh has no attribute or label "soil"', 'another weight');
SELECT throws_ok($$ SELECT abacus_partition('points', 4) $$, '42809', NULL, 'not a mesh');
SELECT isnt(abacus_label('small', 'SELECT code, v0, v1, v2, -1 AS debt FROM abacus_simplices(''small'')'), NULL, 'less than nothing');
SELECT throws_like($$ SELECT abacus_partition('small', 2, 'debt') $$, 'the simplex (%) has the weight (-1)', 'a negative weight');
SELECT isnt_empty($$ SELECT abacus_partition('small', 2) $$, 'the mesh is as it was');
-- the sign of a mean is exact: thirds of 1, 2 and -3 do not sum to 0 as doubles
SELECT isnt(abacus_triangulate('signs', 'VALUES (1, 0, 0, 1, 1e308, 1e-300, ''Infinity''::float8), (2, 1, 0, 2, 1e308, -1e300, 1), (3, 0, 1, -3, 1e308, 1e300, 1)', '{zero,huge,little,infinite}', dimension => 2), NULL, 'a triangle');
SELECT is((SELECT sum(simplices)::bigint FROM abacus_partition('signs', 2, weight)), 1::bigint, weight) FROM unnest('{zero,huge,little}'::text[]) AS weight;
SELECT throws_like($$ SELECT abacus_partition('signs', 2, 'infinite') $$, 'the simplex (1, 2, 3) has the weight (%)', 'an infinite weight');
SELECT is(abacus_update('signs', 'SELECT id, x, y, zero, little FROM (VALUES (3, 0, 1, -3.0000000000000004::float8, -1e300::float8), (2, 1, 0, 2, 1e300), (1, 0, 0, 1, -1e-300)) AS v (id, x, y, zero, little)'), 3::bigint, 'a little less');
SELECT throws_like(format('SELECT abacus_partition(''signs'', 2, %L)', weight), 'the simplex (1, 2, 3) has the weight (-%)', weight) FROM unnest('{zero,little}'::text[]) AS weight;
SELECT * FROM finish();
ROLLBACK;

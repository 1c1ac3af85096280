-- The points of the earthquake data sets.
CREATE EXTENSION abacus_lab;
SELECT count(*), min(id), max(id), count(DISTINCT (x, y, z)) AS places,
       min(x), max(x), min(y), max(y), min(z), max(z) FROM abacus_quake(0.02);
SELECT id, x, y, z, round(vs::numeric, 6) AS vs, round(vp::numeric, 6) AS vp, round(density::numeric, 6) AS density
FROM abacus_quake(0.02) WHERE id <= 5 OR id % 1000 = 0;
-- coordinates are exact multiples of 100 km / 2^20
SELECT bool_and(c * 1048576 / 100000 = floor(c * 1048576 / 100000)) AS exact
FROM abacus_quake(0.05), LATERAL (VALUES (x), (y), (z + 37500)) AS v (c);
-- the ground: soft and slow above, hard and fast below
SELECT z, round(min(vs)) AS slowest, round(max(vs)) AS fastest, round(min(density)) AS lightest
FROM abacus_quake(0.02) WHERE z IN (0, -6250, -37500) GROUP BY z ORDER BY z DESC;
-- more points per wavelength, more points; the same as a higher frequency
SELECT (SELECT count(*) FROM abacus_quake(0.01, 16)) AS finer,
       (SELECT count(*) FROM abacus_quake(0.02)) = (SELECT count(*) FROM abacus_quake(0.01, 16)) AS same;
-- the coarsest
SELECT count(*) FROM abacus_quake(1e-300);
SELECT count(*) FROM abacus_quake(1e305, 1e-308);
SELECT count(*) FROM abacus_quake(1e-308, 1e305);
SELECT count(*) FROM abacus_quake(NULL);
-- streams in the select list: an endless set, stopped early
SELECT (abacus_quake(200)).* LIMIT 3;
SELECT max(id) FROM (SELECT (abacus_quake(200)).id LIMIT 100000) AS quake;
-- and is called once, however many columns are taken
EXPLAIN (COSTS OFF, VERBOSE) SELECT (abacus_quake(0.1)).id, (abacus_quake(0.1)).z;
BEGIN;
DECLARE quake CURSOR FOR SELECT abacus_quake(200);
FETCH 2 FROM quake;
FETCH 1 FROM quake;
CLOSE quake;
COMMIT;
-- two at a time
SELECT (a).id, (a).x - (b).x AS difference
FROM (SELECT abacus_quake(0.02) AS a, abacus_quake(0.02) AS b LIMIT 2) AS quake;
-- a cancel ends it
SET statement_timeout = '200ms';
SELECT count(*) FROM (SELECT abacus_quake(200)) AS quake;
\echo :LAST_ERROR_SQLSTATE
RESET statement_timeout;
-- arguments
SELECT abacus_quake(0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_quake(-1);
SELECT abacus_quake('NaN');
SELECT abacus_quake('Infinity');
SELECT abacus_quake(1, 0);
SELECT abacus_quake(1, 'NaN');
SELECT abacus_quake(1000);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_quake(1e300, 1e300);
-- a mesh of it
SELECT abacus_triangulate('basin', 'SELECT (abacus_quake(0.02)).*', dimension => 3);
SELECT * FROM abacus_check('basin');
SELECT name, value FROM abacus_stats('basin') WHERE name IN ('points', 'vertices', 'duplicates', 'simplices') ORDER BY 1;
SELECT count(*) FROM abacus_vertices('basin') v JOIN abacus_quake(0.02) p USING (id)
WHERE ARRAY[v.x, v.y, v.z] = ARRAY[p.x, p.y, p.z] AND v.attributes = ARRAY[p.vs, p.vp, p.density];
DROP EXTENSION abacus_lab;

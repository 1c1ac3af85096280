-- Sources of points: what is taken, what is refused.
SELECT abacus_create('staged', 2, '{height,weight}');

-- every numeric type, by position; NULL attributes are kept as NULL
CREATE DOMAIN metres AS real;
SELECT abacus_stage('staged', 'SELECT 1::int2, 0::int2, 0::int4, 7::int8, 0.5::numeric');
SELECT abacus_stage('staged', 'SELECT 2::int4, 1::float4, 0::float8, NULL::float8, 1.5::metres');
SELECT abacus_stage('staged', 'SELECT 3::int8, 0.25::numeric, 1::metres, ''NaN''::float8, NULL::int2');
SELECT abacus_stage('staged', 'TABLE nothing');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'WITH p(i, a, b) AS (VALUES (4, -1, -1)) SELECT i, a, b, 1, 2 FROM p ORDER BY a * 2');
SELECT id, x, y, z, attributes, vertex FROM abacus_vertices('staged') ORDER BY id;
SELECT abacus_triangulate('staged');
SELECT id, vertex FROM abacus_vertices('staged') ORDER BY id;

-- the wrong number of columns
SELECT abacus_stage('staged', 'SELECT 1, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 1, 0, 0, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
-- wrong types
SELECT abacus_stage('staged', 'SELECT 1.5, 0, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 1, 0, ''0''::text, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 1, 0, 0, true, 0');
\echo :LAST_ERROR_SQLSTATE
-- values that cannot be placed
SELECT abacus_stage('staged', 'SELECT NULL::int, 0, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 8, 0, NULL::int, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 9, ''NaN''::float8, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 9, 0, ''-Infinity''::float8, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 9, 1e400::numeric, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
-- queries that are none
SELECT abacus_stage('staged', '');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT 1, 0, 0, 0, 0; SELECT 1, 0, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT id, x, FROM points');
\echo :LAST_ERROR_SQLSTATE
CREATE TABLE points (id int, x float8, y float8);
INSERT INTO points SELECT i, i, i * i FROM generate_series(1, 100) i;
SELECT abacus_stage('staged', 'DELETE FROM points RETURNING id, x, y, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'WITH gone AS (DELETE FROM points RETURNING *) SELECT id, x, y, 0, 0 FROM gone');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT id, x, y, 0, 0 FROM points FOR UPDATE');
SELECT abacus_stage('staged', 'SELECT * FROM (SELECT id, x, y, 0, 0 FROM points FOR UPDATE) AS locked');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'WITH locked AS (SELECT id FROM points FOR KEY SHARE) SELECT id, (SELECT max(id) FROM locked), 0, 0, 0 FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'EXPLAIN SELECT 1');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', 'SELECT $1, 0, 0, 0, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('staged', NULL) IS NULL AS strict;
-- an error in the middle changes nothing
SELECT abacus_stage('staged', 'SELECT id, x, 1 / (100 - id), 0, 0 FROM points');
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM abacus_vertices('staged');

-- queries that call Abacus themselves
SELECT abacus_create('inner_mesh', 2);
SELECT abacus_triangulate('outer_mesh',
    'SELECT v.id, v.x, v.y, (abacus_locate(''staged'', v.x, v.y)).v0 AS corner, attributes[1] AS height
     FROM abacus_vertices(''staged'') v');
SELECT id, attributes FROM abacus_vertices('outer_mesh') ORDER BY id;
SELECT abacus_stage('outer_mesh', 'SELECT 100 + v.id, v.x + 10, v.y, 0, (s).v0 FROM abacus_vertices(''outer_mesh'') v, abacus_simplices(''outer_mesh'') s');
SELECT abacus_stage('outer_mesh', 'SELECT 9, 9, 9, 9, abacus_stage(''inner_mesh'', ''SELECT 1, 2, 3'')');
SELECT abacus_stage('outer_mesh', 'SELECT 9, 9, 9, 9, abacus_stage(''outer_mesh'', ''SELECT 1, 2, 3, 4, 5'')');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('outer_mesh') > 0 AS grown;
SELECT * FROM abacus_check('outer_mesh');

-- many rows, more than one batch and one page
SELECT abacus_create('many', 2);
SELECT abacus_stage('many', 'SELECT i, i % 100, i / 100 FROM generate_series(0, 9999) i');
SELECT count(*), count(DISTINCT id), sum(id), min(sequence), max(sequence) FROM abacus_vertices('many');
-- beyond maintenance_work_mem: the same order
SET maintenance_work_mem = '1MB';
SELECT abacus_create('many_spilled', 2);
SELECT abacus_stage('many_spilled', 'SELECT i, i % 1000, i / 1000 FROM generate_series(0, 199999) i');
SELECT abacus_create('many_sorted', 2);
RESET maintenance_work_mem;
SELECT abacus_stage('many_sorted', 'SELECT i, i % 1000, i / 1000 FROM generate_series(0, 199999) i');
SELECT count(*) AS differences
FROM abacus_vertices('many_spilled') a FULL JOIN abacus_vertices('many_sorted') b USING (sequence)
WHERE a.id IS DISTINCT FROM b.id;

DROP TABLE staged, inner_mesh, outer_mesh, many, many_spilled, many_sorted, points;
DROP DOMAIN metres;

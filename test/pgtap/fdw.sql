-- A mesh as foreign tables: rows compared with those of the functions, estimates, pages, snapshots.
BEGIN;
SELECT no_plan();
CREATE FUNCTION pg_temp.points(first int, last int)
    RETURNS TABLE (id int, x float8, y float8, z float8, level int) LANGUAGE sql AS
    $$ SELECT i, i::bigint * 7919 % 100003 / 1e3, i::bigint * 104729 % 100019 / 1e3, i::bigint * 1299709 % 100043 / 1e3, NULLIF(i / 100, 7)
       FROM generate_series(first, last) AS i $$;
CREATE FUNCTION pg_temp.plan_of(query text, key text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan jsonb;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON, ANALYZE, TIMING OFF) ' || query INTO plan;
    RETURN jsonb_path_query_first(plan, format('lax $.**."%s"', key)::jsonpath) #>> '{}';
END $$;

SELECT abacus_triangulate('flat', 'SELECT id, x, y, z AS height, level FROM pg_temp.points(1, 20000)');
SELECT abacus_triangulate('solid', 'SELECT id, x, y, z, level FROM pg_temp.points(1, 4000)', dimension => 3);
SELECT abacus_insert('flat', 'SELECT -id, x, y, z, level FROM pg_temp.points(1, 10)'), abacus_stage('flat', 'SELECT 30000, 1, 1, 1, 1');
SELECT abacus_publish('flat', geometry => false), abacus_publish('solid', geometry => false);

-- all rows equal those of the functions; a missing value is NaN in "values", since GDAL reads NULL within an
-- array as 0
SELECT set_eq('SELECT code, v0, v1, v2, corners, "values" FROM flat_cells',
    $$ SELECT code, v0, v1, v2, corners, array_replace("values", NULL, 'NaN') FROM abacus_cells('flat') $$, 'triangles');
SELECT set_eq('SELECT code, v0, v1, v2, v3, corners, "values" FROM solid_cells',
    $$ SELECT code, v0, v1, v2, v3, corners, array_replace("values", NULL, 'NaN') FROM abacus_cells('solid') $$, 'tetrahedra');
SELECT isnt_empty($$ SELECT FROM flat_cells WHERE 'NaN' = ANY ("values") $$, 'there are missing values of triangles');
SELECT is_empty($$ SELECT FROM flat_cells WHERE "values"::text LIKE '%NULL%' $$, 'no NULL is within an array of triangles');
SELECT is_empty($$ SELECT FROM solid_cells WHERE "values"::text LIKE '%NULL%' $$, 'nor of tetrahedra');
SELECT set_eq('TABLE flat_points', $$ SELECT id, x, y, attributes[1] AS height, attributes[2] AS level FROM abacus_vertices('flat') WHERE vertex = id $$,
    'vertices: not what equals one, or waits');
SELECT set_eq('TABLE solid_points', $$ SELECT id, x, y, z, attributes[1] FROM abacus_vertices('solid') $$, 'vertices in space');
SELECT set_eq('SELECT code, v0, level FROM flat_cells', $$ SELECT code, v0, ("values"[1][2] + "values"[2][2] + "values"[3][2]) / 3 FROM abacus_cells('flat') $$, 'means of triangles');
SELECT set_eq('SELECT code, v0, level FROM solid_cells',
    $$ SELECT code, v0, ("values"[1][1] + "values"[2][1] + "values"[3][1] + "values"[4][1]) / 4 FROM abacus_cells('solid') $$, 'means of tetrahedra');
-- windows and ranges
SELECT set_eq(format('SELECT * FROM flat_points WHERE %s', condition), format('SELECT * FROM flat_points WHERE (%s) IS TRUE', condition), condition)
FROM unnest(ARRAY['x BETWEEN 10 AND 20 AND y BETWEEN 30 AND 31', 'x < 3', 'y >= 99.5', 'x > 99 AND x < 98', 'x = 7.919', '7.919 = x AND 104.729 > y', 'height < 2', 'level = 12',
    'level BETWEEN 3 AND 4 AND x > 50', 'height > 99 AND level > 150', 'level IS NULL AND x < 50', 'x > -1e308 AND y < 1e308 AND x < 1e-300', 'x > 1e300', 'id < 10 AND x < 50',
    'x BETWEEN 1000 AND 2000 AND y BETWEEN 1000 AND 2000', 'x < y AND x < 10', 'x IN (7.919, 15.838)', 'NOT x < 90']) AS condition;
SELECT set_eq(format('SELECT * FROM solid_points WHERE %s', condition), format('SELECT * FROM solid_points WHERE (%s) IS TRUE', condition), 'in space: ' || condition)
FROM unnest(ARRAY['z < 4', 'x BETWEEN 10 AND 20 AND y BETWEEN 30 AND 51 AND z > 70', 'x > 1e300', 'level > 38', 'level > 38 AND z < 10']) AS condition;
-- stretches of the curve
SELECT set_eq(format('SELECT * FROM %s_cells WHERE %s', mesh, condition), format('SELECT * FROM %s_cells WHERE (%s) IS TRUE', mesh, condition), mesh || ': ' || condition)
FROM (SELECT 'flat' AS mesh, code, n FROM (SELECT code, row_number() OVER (ORDER BY code, v0, v1) AS n FROM flat_cells) AS c WHERE n % 9000 = 1
      UNION ALL SELECT 'solid', code, n FROM (SELECT code, row_number() OVER (ORDER BY code, v0, v1) AS n FROM solid_cells) AS c WHERE n % 9000 = 1) AS c,
    unnest(ARRAY[format('code = %s', code), format('code BETWEEN %s AND %s', code, code + 10000000000000000), format('code > %s', code), format('%s > code', code + 1)]) AS condition;
SELECT cmp_ok(pg_temp.plan_of(format('SELECT * FROM flat_cells WHERE code = %s', max(code)), 'Mesh Pages Read'), '<=', 2::float8, 'pages of a code') FROM flat_cells;
SELECT is(sum(n), (SELECT count(*) FROM flat_cells)::numeric, 'slices make the whole')
FROM generate_series(0, 3) AS i, LATERAL (SELECT count(*) AS n FROM flat_cells WHERE code BETWEEN i * (1::bigint << 60) AND (i + 1) * (1::bigint << 60) - 1) AS c;
-- only the pages of a window are read; after the first rows none
SELECT cmp_ok(pg_temp.plan_of('SELECT * FROM flat_points WHERE x BETWEEN 50 AND 51 AND y BETWEEN 50 AND 51', 'Mesh Pages Read'), '<', 6::float8, 'pages of a window');
SELECT cmp_ok(pg_temp.plan_of('SELECT * FROM flat_points', 'Mesh Pages Read'), '>', 25::float8, 'all pages');
SELECT is(pg_temp.plan_of('SELECT * FROM flat_cells LIMIT 3', 'Mesh Pages Read'), 1::float8, 'a limit');
SELECT is(pg_temp.plan_of('SELECT 1 FROM flat_points WHERE x > 3 AND x < 2', 'Mesh Pages Read'), 0::float8, 'none for nothing');
-- estimates: near the actual numbers, by these factors
CREATE FUNCTION pg_temp.is_near(query text, factor float8) RETURNS text LANGUAGE sql AS $$
    SELECT cmp_ok(greatest(planned / actual, actual / planned), '<', factor, 'estimate of ' || query)
    FROM (SELECT pg_temp.plan_of(query, 'Plan Rows') AS planned, greatest(1, pg_temp.plan_of(query, 'Actual Rows')) AS actual) AS p
$$;
SELECT pg_temp.is_near('SELECT 1 FROM ' || query, factor)
FROM (VALUES ('flat_cells', 1.01), ('flat_points', 1.01), ('flat_points WHERE x BETWEEN 20 AND 40', 1.2), ('flat_points WHERE x BETWEEN 20 AND 40 AND y > 50', 1.2),
    ('flat_points WHERE x < -3', 2), ('solid_points WHERE x < 20 AND y < 50 AND z < 50', 1.5)) AS q (query, factor);
-- a join looks for the pages of each row
CREATE TEMP TABLE wells AS SELECT i * 20 AS x FROM generate_series(1, 4) AS i;
ANALYZE wells;
SELECT cmp_ok(pg_temp.plan_of('SELECT * FROM wells AS w JOIN flat_points AS p ON p.x BETWEEN w.x - 0.1 AND w.x + 0.1 AND p.y BETWEEN w.x - 0.1 AND w.x + 0.1', 'Mesh Pages Read'), '<', 16::float8, 'pages of a join');
SELECT set_eq('SELECT w.x, p.id FROM wells AS w JOIN flat_points AS p ON p.x BETWEEN w.x - 1 AND w.x + 1 AND p.y BETWEEN w.x - 1 AND w.x + 1',
    'SELECT w.x, p.id FROM wells AS w JOIN flat_points AS p ON (p.x BETWEEN w.x - 1 AND w.x + 1 AND p.y BETWEEN w.x - 1 AND w.x + 1) IS TRUE', 'its rows');
CREATE TEMP TABLE codes AS SELECT code, v0, v1 FROM abacus_simplices('flat') WHERE v0 % 900 = 1;
ANALYZE codes;
SELECT set_eq('SELECT code, v0, v1 FROM codes JOIN flat_cells USING (code, v0, v1)', 'TABLE codes', 'a join on codes');
SELECT cmp_ok(pg_temp.plan_of('SELECT code FROM codes JOIN flat_cells USING (code) LIMIT 1', 'Mesh Pages Read'), '<=', 2::float8, 'its pages');
-- a cursor keeps what it saw while the mesh changes; a rollback restores the rows
SAVEPOINT before;
DECLARE reader CURSOR FOR SELECT id FROM flat_points;
FETCH 1 FROM reader;
SELECT abacus_insert('flat', 'SELECT id, x, y, z, level FROM pg_temp.points(40000, 60000)');
SELECT is((SELECT count(*) FROM flat_points), 40002::bigint, 'a new query sees the change');
CREATE TEMP TABLE seen AS SELECT 0 AS n;
DO $$
DECLARE
    c refcursor := 'reader';
    r record;
    n int := 1;
BEGIN
    LOOP
        FETCH c INTO r;
        EXIT WHEN NOT FOUND;
        n := n + 1;
    END LOOP;
    UPDATE seen SET n = n.n FROM (SELECT n AS n) AS n;
END $$;
SELECT is((SELECT n FROM seen), 20000, 'a cursor does not');
ROLLBACK TO before;
SELECT is((SELECT count(*) FROM flat_points), 20000::bigint, 'as before');
-- workers may scan, but not a temporary mesh
SELECT abacus_triangulate('pg_temp.brief', 'SELECT id, x, y FROM pg_temp.points(1, 100)');
SELECT abacus_publish('pg_temp.brief', geometry => false);
SELECT is((SELECT count(*) FROM pg_temp.brief_points), 100::bigint, 'a temporary mesh');
SELECT is(relpersistence, 't', 'its tables are temporary') FROM pg_class WHERE relname = 'brief_points';
-- failures in the core's calls leave nothing behind
DO $$
BEGIN
    FOR n IN 1 .. 60 LOOP
        BEGIN
            EXECUTE format('SET LOCAL abacus.fail_host_call = %s', n);
            PERFORM count(*) FROM flat_cells WHERE v0 > 100;
            PERFORM count(*) FROM flat_points WHERE x BETWEEN 20 AND 21;
            EXIT;
        EXCEPTION WHEN OTHERS THEN
            NULL;
        END;
    END LOOP;
END $$;
SET LOCAL abacus.fail_host_call = 0;
SELECT is((SELECT count(*) FROM flat_cells), (SELECT count(*) FROM abacus_simplices('flat')), 'after failures');
SELECT * FROM finish();
ROLLBACK;

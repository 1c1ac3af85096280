-- The planner's estimates for abacus_simplices and abacus_vertices.
BEGIN;
SELECT plan(16);

CREATE FUNCTION pg_temp.expected(query text) RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    plan json;
BEGIN
    EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
    RETURN plan -> 0 -> 'Plan' ->> 'Plan Rows';
END $$;
-- The estimated rows of a mesh differ from the actual ones by less than this factor.
CREATE FUNCTION pg_temp.is_near(set text, mesh regclass, factor float8, what text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    ratio float8;
BEGIN
    EXECUTE format('SELECT $1 / count(*) FROM %s(%L)', set, mesh) INTO ratio
        USING pg_temp.expected(format('SELECT * FROM %s(%L)', set, mesh));
    RETURN cmp_ok(greatest(ratio, 1 / ratio), '<', factor, format('%s: %s', what, round(ratio::numeric, 2)));
END $$;
-- Deterministic, all different.
CREATE FUNCTION pg_temp.points(first int, last int)
    RETURNS TABLE (id int, x float8, y float8, z float8) LANGUAGE sql AS
    $$ SELECT i, i::bigint * 7919 % 100003 / 1e3, i::bigint * 104729 % 100019 / 1e3, i::bigint * 1299709 % 100043 / 1e3
       FROM generate_series(first, last) AS i $$;

-- Nothing has been analyzed.
SELECT abacus_triangulate('flat', 'SELECT id, x, y FROM pg_temp.points(1, 40000)');
SELECT abacus_triangulate('solid', 'SELECT * FROM pg_temp.points(1, 10000)', dimension => 3);
SELECT pg_temp.is_near('abacus_simplices', 'flat', 1.5, 'triangles');
SELECT pg_temp.is_near('abacus_vertices', 'flat', 1.5, 'vertices of triangles');
SELECT pg_temp.is_near('abacus_simplices', 'solid', 1.5, 'tetrahedra');
SELECT pg_temp.is_near('abacus_vertices', 'solid', 5, 'vertices of tetrahedra');

-- Old versions of pages are not counted twice once rows have been counted.
SELECT abacus_insert('flat', 'SELECT id, x, y FROM pg_temp.points(40001, 80000)');
SELECT pg_temp.is_near('abacus_simplices', 'flat', 2.5, 'after an insertion');
ANALYZE flat;
SELECT pg_temp.is_near('abacus_simplices', 'flat', 1.5, 'after ANALYZE');

-- Points that wait.
SELECT abacus_create('waits', 2);
SELECT abacus_stage('waits', 'SELECT id, x, y FROM pg_temp.points(1, 40000)');
SELECT pg_temp.is_near('abacus_vertices', 'waits', 1.5, 'waiting points');
SELECT cmp_ok(pg_temp.expected('SELECT * FROM abacus_simplices(''waits'')'), '<', 1000::float8, 'no simplices yet');

-- In other places.
SELECT is(pg_temp.expected('SELECT abacus_simplices(''flat'')'), pg_temp.expected('SELECT * FROM abacus_simplices(''flat'')'), 'in a select list');
PREPARE content(regclass) AS SELECT * FROM abacus_simplices($1);
SELECT is(pg_temp.expected('EXECUTE content(''flat'')'), pg_temp.expected('SELECT * FROM abacus_simplices(''flat'')'), 'a parameter');
SET LOCAL plan_cache_mode = force_generic_plan;
SELECT is(pg_temp.expected('EXECUTE content(''flat'')'), 100000::float8, 'a parameter that is not known');
RESET plan_cache_mode;
SELECT lives_ok('EXPLAIN SELECT s FROM pg_class, abacus_simplices(oid) s', 'a column');
SELECT cmp_ok(pg_temp.expected('SELECT * FROM abacus_simplices(NULL)'), '<=', 1::float8, 'no mesh');
SELECT is(pg_temp.expected('SELECT * FROM abacus_simplices(''pg_class'')'), 100000::float8, 'another table');
SELECT is(pg_temp.expected('SELECT * FROM abacus_simplices(''flat_vertices'')'), 100000::float8, 'the vertex table');
SELECT is(pg_temp.expected('SELECT * FROM abacus_vertices(1::oid::regclass)'), 100000::float8, 'no relation');

SELECT * FROM finish();
ROLLBACK;

-- Values between the vertices: for many places as for each, with little memory, while the mesh changes,
-- without a privilege.
BEGIN;
SELECT no_plan();
SELECT setseed(0.5);
CREATE TABLE points AS SELECT id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 10000) AS id;
SELECT isnt(abacus_triangulate('field', 'SELECT id, x, y, 3 * x - 2 * y + 1 AS plane, CASE WHEN id % 50 > 0 THEN x END AS gaps FROM points'), NULL, 'a mesh in the plane');
SELECT isnt(abacus_triangulate('solid', 'SELECT id, x, y, z, x + y + z AS sum FROM points LIMIT 2000', dimension => 3), NULL, 'one in space');
CREATE TABLE places AS
    SELECT id, 1.2 * random() - 0.1 AS x, 1.2 * random() - 0.1 AS y, 1.2 * random() - 0.1 AS z FROM generate_series(1, 3000) AS id
    UNION ALL SELECT 10000 + id, x, y, z FROM points WHERE id % 20 = 0;

CREATE FUNCTION pg_temp.each(method text, outside text) RETURNS TABLE (id bigint, plane numeric, gaps numeric) LANGUAGE sql AS
    $$ SELECT id, round(abacus_interpolate('field', x, y, 'plane', method, outside)::numeric, 9), round(abacus_interpolate('field', x, y, 'gaps', method, outside)::numeric, 9) FROM places $$;
CREATE FUNCTION pg_temp.together(method text, outside text) RETURNS TABLE (id bigint, plane numeric, gaps numeric) LANGUAGE sql AS
    $$ SELECT id, round("values"[1]::numeric, 9), round("values"[2]::numeric, 9) FROM abacus_interpolate('field', 'SELECT id, x, y FROM places', method => method, outside => outside) $$;
SELECT bag_eq(format('SELECT * FROM pg_temp.together(%L, %L)', method, outside), format('SELECT * FROM pg_temp.each(%L, %L)', method, outside), format('together as each: %s, outside %s', method, outside))
FROM unnest('{linear,natural,nearest}'::text[]) AS method, unnest('{null,nearest}'::text[]) AS outside;
SET LOCAL work_mem = '64kB';
SET LOCAL abacus.cache_size = '1MB';
SELECT bag_eq(format('SELECT * FROM pg_temp.together(%L, %L)', method, 'null'), format('SELECT * FROM pg_temp.each(%L, %L)', method, 'null'), format('with little memory: %s', method))
FROM unnest('{linear,natural,nearest}'::text[]) AS method;
RESET work_mem;
RESET abacus.cache_size;

-- linear functions come back
SELECT cmp_ok((SELECT max(abs(abacus_interpolate('field', x, y, 'plane', method) - (3 * x - 2 * y + 1))) FROM places), '<', 1e-12::float8, method || ' in the plane') FROM unnest('{linear,natural}'::text[]) AS method;
SELECT cmp_ok((SELECT max(abs(abacus_interpolate('solid', x, y, z, method => method) - (x + y + z))) FROM places), '<', 1e-11::float8, method || ' in space') FROM unnest('{linear,natural}'::text[]) AS method;
-- the nearest vertex is that of a table, inside and outside
SELECT is((SELECT count(*) FROM (SELECT * FROM places ORDER BY id LIMIT 200) AS p
           WHERE abacus_interpolate('field', x, y, 'plane', 'nearest', 'nearest') <> (SELECT 3 * x - 2 * y + 1 FROM points ORDER BY point(x, y) <-> point(p.x, p.y) LIMIT 1)), 0::bigint, 'nearest');
-- weights are the sparse matrix of values: any time step needs only one join
CREATE TABLE matrix AS SELECT * FROM abacus_weights('field', 'SELECT id, x, y FROM places', 'natural');
SELECT results_eq($$ SELECT m.id, round(sum(weight * (3 * v.x - 2 * v.y + 1))::numeric, 9) FROM matrix m JOIN points v ON v.id = vertex GROUP BY m.id ORDER BY 1 $$,
                  $$ SELECT id, plane FROM pg_temp.each('natural', 'null') WHERE plane IS NOT NULL ORDER BY 1 $$, 'values from weights');
SELECT is((SELECT count(*) FROM matrix WHERE weight <= 0), 0::bigint, 'no weight is 0');
SELECT bag_eq($$ SELECT vertex, round(weight::numeric, 9) FROM abacus_weights('field', 0.5, 0.5, 'natural') $$,
              $$ SELECT vertex, round(weight::numeric, 9) FROM abacus_weights('field', 'SELECT 1, 0.5, 0.5', 'natural') $$, 'weights of one place');
-- a triangle that is too long is not part of the mesh; its corners are, if other triangles have them
SELECT is((SELECT count(*) FROM points WHERE abacus_interpolate('field', x, y, 'plane', max_edge => 0.03) IS NOT NULL),
          (SELECT count(DISTINCT v) FROM abacus_simplices('field') JOIN points a ON a.id = v0 JOIN points b ON b.id = v1 JOIN points c ON c.id = v2, unnest(ARRAY[v0, v1, v2]) AS v
           WHERE greatest(point(a.x, a.y) <-> point(b.x, b.y), point(b.x, b.y) <-> point(c.x, c.y), point(c.x, c.y) <-> point(a.x, a.y)) <= 0.03), 'max_edge');
-- the mesh does not change while the places are read
CREATE FUNCTION pg_temp.shrink(n int) RETURNS int LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 2 = 0');
    RETURN n;
END $$;
SELECT throws_ok($$ SELECT * FROM abacus_interpolate('field', 'SELECT pg_temp.shrink(1), 0.5, 0.5') $$, '55006', NULL, 'a query that changes the mesh');
SELECT throws_ok($$ SELECT * FROM abacus_weights('field', 'SELECT pg_temp.shrink(1), 0.5, 0.5') $$, '55006', NULL, 'the same of weights');
SAVEPOINT changed;
SELECT is(pg_temp.shrink(1), 1, 'the mesh changes');
SELECT is((SELECT count(*) FROM abacus_weights('field', 'SELECT id, x, y FROM places') WHERE vertex % 2 = 0), 0::bigint, 'which the next call sees');
SELECT is((SELECT count(*) FROM places, abacus_weights('field', x, y) WHERE vertex % 2 = 0), 0::bigint, 'of one place, too');
ROLLBACK TO changed;
SELECT cmp_ok((SELECT count(*) FROM places, abacus_weights('field', x, y) WHERE vertex % 2 = 0), '>', 1000::bigint, 'unless it is rolled back');
-- near the least and the greatest doubles, natural neighbours reproduce linear functions as they do near 1
CREATE FUNCTION pg_temp.natural_of(scale float8) RETURNS float8[] LANGUAGE plpgsql AS $$
DECLARE found float8[];
BEGIN
    EXECUTE format('SELECT abacus_triangulate(''scaled'', $q$ SELECT i, (ARRAY[0,8,1,9,4,5])[i] * %1$s::float8, (ARRAY[0,1,8,9,3,7])[i] * %1$s::float8, (ARRAY[0,8,1,9,4,5])[i]::float8 FROM generate_series(1, 6) i $q$)', scale);
    EXECUTE format('SELECT abacus_triangulate(''scaled_solid'', $q$ SELECT i, (ARRAY[0,8,0,0,7,3,5])[i] * %1$s::float8, (ARRAY[0,0,8,0,7,4,1])[i] * %1$s::float8, (ARRAY[0,0,0,8,6,3,2])[i] * %1$s::float8, (ARRAY[0,8,0,0,7,3,5])[i]::float8 FROM generate_series(1, 7) i $q$, dimension => 3)', scale);
    found := ARRAY[abacus_interpolate('scaled', 3 * scale, 4 * scale, method => 'natural'), abacus_interpolate('scaled_solid', 2 * scale, 3 * scale, 2 * scale, method => 'natural')];
    DROP TABLE scaled, scaled_vertices, scaled_solid, scaled_solid_vertices;
    RETURN found;
END $$;
SELECT ok(abs(found[1] - 3) < 1e-9 AND abs(found[2] - 2) < 1e-9, 'natural neighbours where all is a multiple of ' || scale || ': ' || found::text)
FROM (SELECT scale, pg_temp.natural_of(scale) AS found FROM unnest('{1,5e-324,1e-320,1e-310,1e-300,1e300,1e307}'::float8[]) AS scale OFFSET 0) AS scales;

-- privileges
CREATE ROLE abacus_reader;
SET LOCAL ROLE abacus_reader;
SELECT throws_ok($$ SELECT abacus_interpolate('field', 0.5, 0.5, 'plane') $$, '42501', NULL, 'a value that one may not read');
SELECT throws_ok($$ SELECT * FROM abacus_interpolate('field', 'SELECT 1, 0.5, 0.5') $$, '42501', NULL, 'values');
SELECT throws_ok($$ SELECT * FROM abacus_weights('field', 0.5, 0.5) $$, '42501', NULL, 'weights');
SELECT throws_ok($$ SELECT abacus_slope('field', 0.5, 0.5, 'plane') $$, '42501', NULL, 'a slope');
RESET ROLE;

SELECT * FROM finish();
ROLLBACK;

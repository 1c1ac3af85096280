-- The same mesh from any number of threads; with tiny intervals even of few points.
CREATE TABLE points AS
SELECT i AS id, (i * 7919 % 1009)::float8 AS x, (i * 104729 % 997)::float8 AS y, (i * 37 % 101)::float8 AS z
FROM generate_series(1, 1500) i;
CREATE FUNCTION corners(mesh regclass) RETURNS SETOF bigint[] LANGUAGE sql AS $$
    SELECT array(SELECT unnest(ARRAY[v0, v1, v2, v3]) v ORDER BY v) FROM abacus_simplices(mesh)
$$;
CREATE FUNCTION differ(a regclass, b regclass) RETURNS bigint LANGUAGE sql AS $$
    SELECT (SELECT count(*) FROM (SELECT corners(a) EXCEPT ALL SELECT corners(b)) s)
         + (SELECT count(*) FROM (SELECT corners(b) EXCEPT ALL SELECT corners(a)) s)
         + (SELECT count(*) FROM (SELECT * FROM abacus_vertices(a) EXCEPT ALL SELECT * FROM abacus_vertices(b)) v)
         + (SELECT count(*) FROM (SELECT * FROM abacus_vertices(b) EXCEPT ALL SELECT * FROM abacus_vertices(a)) v)
$$;

SET abacus.threads = 1;
SELECT abacus_triangulate('plane', 'SELECT id, x, y, z AS height FROM points');
SELECT abacus_triangulate('space', 'SELECT id, x, y, z FROM points', dimension => 3);
SELECT abacus_create('stepwise', 2, '{height}');
SELECT abacus_insert('stepwise', 'SELECT id, x, y, z FROM points WHERE id % 3 = 0');
SELECT abacus_insert('stepwise', 'SELECT id + 5000, x, y, z + 1 FROM points', on_duplicate => 'replace');
SELECT abacus_insert('stepwise', 'SELECT id + 9000, x, y, z FROM points WHERE id % 7 = 0');

SET abacus.tiny_intervals = on;
SET abacus.cache_size = '1MB';
DO $$
DECLARE n int;
BEGIN
    FOREACH n IN ARRAY ARRAY[2, 3, 4, 7] LOOP
        PERFORM set_config('abacus.threads', n::text, false);
        PERFORM abacus_triangulate('plane' || n, 'SELECT id, x, y, z AS height FROM points');
        PERFORM abacus_triangulate('space' || n, 'SELECT id, x, y, z FROM points', dimension => 3);
        PERFORM abacus_create('stepwise' || n, 2, '{height}');
        PERFORM abacus_insert(('stepwise' || n)::regclass, 'SELECT id, x, y, z FROM points WHERE id % 3 = 0');
        PERFORM abacus_insert(('stepwise' || n)::regclass, 'SELECT id + 5000, x, y, z + 1 FROM points', on_duplicate => 'replace');
        PERFORM abacus_insert(('stepwise' || n)::regclass, 'SELECT id + 9000, x, y, z FROM points WHERE id % 7 = 0');
    END LOOP;
END $$;
SELECT n, differ('plane', ('plane' || n)::regclass) AS plane, differ('space', ('space' || n)::regclass) AS space,
       differ('stepwise', ('stepwise' || n)::regclass) AS stepwise
FROM unnest(ARRAY[2, 3, 4, 7]) n;
SELECT mesh, f.* FROM unnest(ARRAY[2, 3, 4, 7]) n, LATERAL (VALUES ('plane' || n), ('space' || n), ('stepwise' || n)) m (mesh),
    LATERAL abacus_check(mesh::regclass) f;

-- Waiting points, in batches, each committed.
SELECT abacus_create('batches', 2, '{height}');
SELECT abacus_stage('batches', 'SELECT id, x, y, z FROM points');
CALL abacus_build('batches', 600);
SELECT differ('plane', 'batches');

-- What is wrong is an error of the statement, whichever thread finds it.
SELECT abacus_insert('plane2', 'SELECT id, x, y, z FROM points WHERE id <= 200', on_duplicate => 'error');
\echo :LAST_ERROR_SQLSTATE
SELECT differ('plane', 'plane2');

-- Points leave: vertices, those that others at their place follow, some twice, some that are not there.
DO $$
DECLARE
    n int;
    mesh text;
    deleted bigint;
BEGIN
    FOREACH n IN ARRAY ARRAY[1, 2, 3, 4, 7] LOOP
        PERFORM set_config('abacus.threads', n::text, false);
        FOREACH mesh IN ARRAY ARRAY['plane', 'space', 'stepwise'] LOOP
            deleted := abacus_delete(concat(mesh, nullif(n, 1))::regclass, 'SELECT id, x, y, z FROM points WHERE id % 3 > 0
                UNION ALL SELECT id + 9000, x, y, z FROM points WHERE id % 4 = 0 UNION ALL SELECT id, x + 0.5, y, z FROM points');
            ASSERT deleted = CASE mesh WHEN 'stepwise' THEN 1161 ELSE 1125 END, format('%s: %s', mesh, deleted);
        END LOOP;
    END LOOP;
END $$;
SELECT n, differ('plane', ('plane' || n)::regclass) AS plane, differ('space', ('space' || n)::regclass) AS space,
       differ('stepwise', ('stepwise' || n)::regclass) AS stepwise
FROM unnest(ARRAY[2, 3, 4, 7]) n;
SELECT mesh, f.* FROM unnest(ARRAY[2, 3, 4, 7]) n, LATERAL (VALUES ('plane' || n), ('space' || n), ('stepwise' || n)) m (mesh),
    LATERAL abacus_check(mesh::regclass) f;
SELECT abacus_delete('space4', 'SELECT id, x, y, z FROM points');
SELECT count(*) FROM abacus_simplices('space4');

-- The settings.
SET abacus.threads = -1;
SET abacus.threads = 2000;
CREATE ROLE plain;
SET ROLE plain;
SET abacus.threads = 0;
SET abacus.tiny_intervals = off;
RESET ROLE;
DROP ROLE plain;

DROP FUNCTION differ;
DROP FUNCTION corners;
DROP TABLE points, plane, space, stepwise, batches;
DO $$
DECLARE n int;
BEGIN
    FOREACH n IN ARRAY ARRAY[2, 3, 4, 7] LOOP
        EXECUTE format('DROP TABLE plane%1$s, space%1$s, stepwise%1$s', n);
    END LOOP;
END $$;

-- What a statement sees of a mesh that its own transaction changes: the state
-- of its snapshot, whatever the session has in its cache.
SELECT abacus_triangulate('field', 'SELECT i, i % 4, i / 4 FROM generate_series(0, 15) i');
-- the greatest vertex at a place that every change below alters
CREATE FUNCTION greatest_at(x float8, y float8) RETURNS bigint LANGUAGE sql STABLE AS
    $$ SELECT greatest(v0, v1, v2) FROM abacus_locate('field', x, y) $$;
CREATE FUNCTION seen_stable() RETURNS text LANGUAGE plpgsql STABLE AS
    $$ BEGIN RETURN greatest_at(1.4, 1.3) || ' of ' || (SELECT count(*) FROM abacus_simplices('field')); END $$;
CREATE FUNCTION seen_volatile() RETURNS text LANGUAGE plpgsql VOLATILE AS
    $$ BEGIN RETURN greatest_at(1.4, 1.3) || ' of ' || (SELECT count(*) FROM abacus_simplices('field')); END $$;
CREATE FUNCTION add(id bigint, x float8, y float8) RETURNS bigint LANGUAGE plpgsql VOLATILE AS $$
BEGIN
    PERFORM abacus_stage('field', format('SELECT %s, %s, %s', id, x, y));
    RETURN abacus_triangulate('field');
END $$;

-- a statement, and the STABLE functions in it, keep the state it began with;
-- VOLATILE functions see what has been done meanwhile
SELECT greatest_at(1.4, 1.3) AS before, seen_stable(), seen_volatile(), add(100, 1.5, 1.25) AS simplices,
       greatest_at(1.4, 1.3), seen_stable(), seen_volatile(), seen_stable();
SELECT seen_stable(), seen_volatile();
-- ... row by row
SELECT i, add(200 + i, 1.45 - i * 0.02, 1.25) AS simplices, seen_stable(), seen_volatile() FROM generate_series(1, 3) i;
SELECT seen_stable();

-- a loop goes on through the mesh as it was, while its body changes it and looks
DO $$
DECLARE
    before bigint := (SELECT count(*) FROM abacus_simplices('field'));
    looped bigint := 0;
    s abacus_simplex;
    changed bigint;
BEGIN
    FOR s IN SELECT (t.s).* FROM (SELECT abacus_simplices('field') s OFFSET 0) t LOOP
        looped := looped + 1;
        IF looped <= 5 THEN
            changed := add(300 + looped, 2.5 + looped / 20.0, 2.3);
            ASSERT (SELECT count(*) FROM abacus_simplices('field')) = changed;
            ASSERT greatest_at(2.5 + looped / 20.0, 2.31) >= 300;
        END IF;
    END LOOP;
    RAISE NOTICE '% of % triangles', looped, before;
END $$;
SELECT * FROM abacus_check('field');

-- blocks that fail, one in another: each look is at the state that is left
DO $$
BEGIN
    RAISE NOTICE 'outside: %', seen_volatile();
    PERFORM add(400, 1.41, 1.31);
    RAISE NOTICE 'changed: %', seen_volatile();
    BEGIN
        PERFORM add(401, 1.405, 1.305);
        RAISE NOTICE 'in the block: %', seen_volatile();
        BEGIN
            PERFORM add(402, 1.402, 1.302);
            RAISE NOTICE 'in the inner block: %', seen_volatile();
            PERFORM 1 / 0;
        EXCEPTION WHEN division_by_zero THEN
            RAISE NOTICE 'inner block undone: %', seen_volatile();
        END;
        BEGIN
            PERFORM add(403, 1.403, 1.303);
        EXCEPTION WHEN division_by_zero THEN
            NULL;
        END;
        RAISE NOTICE 'another kept: %', seen_volatile();
        PERFORM abacus_locate('field', 'NaN', 0);
    EXCEPTION WHEN invalid_parameter_value THEN
        RAISE NOTICE 'block undone: %', seen_volatile();
    END;
END $$;
SELECT seen_stable();

-- a build that fails half-way in a block leaves the cache of the session right
DO $$
BEGIN
    PERFORM seen_volatile();
    BEGIN
        PERFORM abacus_stage('field', 'SELECT 500, 1.4, 1.29');
        PERFORM set_config('abacus.fail_host_call', '5', true);
        PERFORM abacus_triangulate('field');
    EXCEPTION WHEN io_error OR out_of_memory THEN
        RAISE NOTICE 'failed: %', seen_volatile();
    END;
END $$;
SELECT count(*) FROM abacus_vertices('field') WHERE id >= 500;

-- triggers that change the mesh, and queries that look at it in the same statement
CREATE TABLE sites (id bigint, x float8, y float8);
CREATE FUNCTION follow() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_stage('field', 'SELECT id, x, y FROM sites WHERE id >= ' || (SELECT min(id) FROM added));
    PERFORM abacus_triangulate('field');
    RETURN NULL;
END $$;
CREATE TRIGGER follow AFTER INSERT ON sites REFERENCING NEW TABLE AS added
    FOR EACH STATEMENT EXECUTE FUNCTION follow();
INSERT INTO sites VALUES (600, 1.401, 1.301), (601, 0.2, 0.9) RETURNING id, seen_stable(), seen_volatile();
SELECT seen_stable();
BEGIN;
INSERT INTO sites VALUES (700, 1.4005, 1.3005);
SELECT seen_stable();
SAVEPOINT before;
INSERT INTO sites VALUES (800, 1.4003, 1.3003);
SELECT seen_stable();
ROLLBACK TO before;
SELECT seen_stable();
ROLLBACK;
SELECT seen_stable();
SELECT * FROM abacus_check('field');

-- under one snapshot for all: rolled back to a savepoint, nothing else tells the states apart
BEGIN ISOLATION LEVEL REPEATABLE READ;
SELECT seen_stable();
SAVEPOINT before;
SELECT add(900, 1.4003, 1.3003);
SELECT seen_stable();
ROLLBACK TO before;
SELECT seen_stable();
SELECT add(901, 1.4003, 1.3003);
SELECT seen_stable();
ROLLBACK TO before;
SELECT seen_stable();
COMMIT;

-- more meshes than the session keeps, turn by turn, changed and rolled back
SELECT abacus_triangulate('field' || i, 'SELECT i, i % 4, i / 4 FROM generate_series(0, 15) i') FROM generate_series(1, 5) i;
CREATE FUNCTION all_seen() RETURNS text LANGUAGE sql STABLE AS $$
    SELECT string_agg(greatest(v0, v1, v2)::text, ' ' ORDER BY i, turn)
    FROM generate_series(1, 2) turn, generate_series(1, 5) i, abacus_locate(('field' || i)::regclass, 1.4, 1.3) $$;
SELECT all_seen();
BEGIN;
SELECT abacus_stage(('field' || i)::regclass, 'SELECT 100, 1.5, 1.25'), abacus_triangulate(('field' || i)::regclass) FROM generate_series(1, 5, 2) i;
SELECT all_seen();
ROLLBACK;
SELECT all_seen();

-- a mesh that is rewritten under a query which reads it: an error, and not what is left in a new file
CREATE FUNCTION rewrite(query text, command text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    row record;
    rows int := 0;
BEGIN
    FOR row IN EXECUTE query LOOP
        rows := rows + 1;
        IF rows = 10 THEN
            EXECUTE command;
        END IF;
    END LOOP;
    RAISE SQLSTATE 'UNDO1' USING MESSAGE = rows || ' rows';
EXCEPTION WHEN object_in_use OR SQLSTATE 'UNDO1' THEN
    RETURN SQLERRM;
END $$;
SELECT abacus_triangulate('large', 'SELECT i, i % 50, i / 50 FROM generate_series(0, 2499) i');
SELECT abacus_insert('large', 'SELECT 5000 + i, i % 50, i / 50 FROM generate_series(0, 2499) i');
SELECT query, command, rewrite(query, command)
FROM (VALUES ('SELECT abacus_simplices(''large'')'), ('SELECT abacus_vertices(''large'')'),
             ('SELECT abacus_locate(''large'', i % 50, i / 50) FROM generate_series(0, 2499) i')) AS q (query),
     (VALUES ('ALTER TABLE large SET UNLOGGED'), ('TRUNCATE large'), ('ALTER TABLE large_vertices SET UNLOGGED'),
             ('DROP TABLE large'), ('DROP TABLE large_vertices')) AS c (command);
SELECT * FROM abacus_check('large');

DROP TABLE field, field1, field2, field3, field4, field5, sites, large;
DROP FUNCTION greatest_at, seen_stable, seen_volatile, add, follow, all_seen, rewrite;

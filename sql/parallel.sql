-- Functions that read run in parallel workers, with the state of the mesh that
-- the leader's query sees.
SELECT proname, pronargs, provolatile FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.classid = 'pg_proc'::regclass AND d.deptype = 'e'
WHERE d.refobjid = (SELECT oid FROM pg_extension WHERE extname = 'abacus') AND proparallel = 's' AND proname !~ 'page' ORDER BY 1, 2;

SELECT abacus_triangulate('field', 'SELECT i, i % 100, i / 100 FROM generate_series(0, 9999) i');
CREATE TABLE places (x float8, y float8);
INSERT INTO places SELECT x + 0.25, y + 0.5 FROM generate_series(0, 98) x, generate_series(0, 98) y;
ANALYZE places;
CREATE VIEW located AS SELECT count(*) AS places, count(DISTINCT (s).code) AS codes, sum((s).v0) AS ids FROM (SELECT abacus_locate('field', x, y) s FROM places OFFSET 0) t;
CREATE TABLE serial AS TABLE located;

-- a plan as it was run, without what versions of PostgreSQL show in different ways
CREATE FUNCTION plan(query text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE line text;
BEGIN
    FOR line IN EXECUTE 'EXPLAIN (ANALYZE, COSTS OFF, TIMING OFF, SUMMARY OFF, BUFFERS OFF) ' || query LOOP
        RETURN NEXT regexp_replace(line, '(rows=\d+)\.\d+', '\1');
    END LOOP;
END $$;
-- workers do all of it
SET parallel_setup_cost = 0;
SET parallel_tuple_cost = 0;
SET min_parallel_table_scan_size = 0;
SET max_parallel_workers_per_gather = 2;
SET parallel_leader_participation = off;
SELECT plan($$ SELECT count((abacus_locate('field', x, y)).v0) FROM places $$);
SELECT count(*), sum((abacus_locate('field', x, y)).v0), sum((abacus_walk('field', abacus_locate('field', x, y), 0)).v0) FROM places;
TABLE located EXCEPT TABLE serial;
-- sets, pictures and the check: here in each row, in a worker
CREATE FUNCTION look(lowest float8) RETURNS text LANGUAGE plpgsql STABLE PARALLEL SAFE AS $$
BEGIN
    RETURN (SELECT count(*) FROM abacus_simplices('field') WHERE v0 >= lowest) || ' triangles, ' ||
           (SELECT count(*) FROM abacus_vertices('field') WHERE id >= lowest) || ' points, ' ||
           (SELECT count(*) FROM abacus_check('field')) || ' faults, picture ' ||
           md5(abacus_draw('field', 64, lower => ARRAY[0, 0], upper => ARRAY[lowest + 10, 10]));
END $$;
CREATE VIEW looked AS SELECT count(*) AS looks, string_agg(look, E'\n' ORDER BY look) AS looks_like
FROM (SELECT look(x) FROM places WHERE y = 0.5 AND x < 4) t;
SET max_parallel_workers_per_gather = 0;
CREATE TABLE serial_look AS TABLE looked;
SELECT looks, regexp_replace(looks_like, 'picture \w+', 'picture', 'g') AS looks_like FROM serial_look;
SET max_parallel_workers_per_gather = 2;
SELECT plan($$ SELECT count(look(x)) FROM places WHERE y = 0.5 AND x < 4 $$);
TABLE looked EXCEPT TABLE serial_look;

-- foreign tables of a mesh
SELECT abacus_publish('field', geometry => false);
SELECT set_config(name, 'on', false) FROM pg_settings WHERE name IN ('force_parallel_mode', 'debug_parallel_query'); -- before 16, and since
SELECT (SELECT count(*) FROM field_cells) = (SELECT count(*) FROM abacus_simplices('field')) AS cells, (SELECT count(*) FROM field_points WHERE x BETWEEN 3 AND 5) > 0 AS points;
SELECT set_config(name, 'off', false) FROM pg_settings WHERE name IN ('force_parallel_mode', 'debug_parallel_query');
-- changes of the own transaction, uncommitted and rolled back, are those of the workers too
SELECT set_config(name, 'on', false) FROM pg_settings WHERE name IN ('force_parallel_mode', 'debug_parallel_query'); -- before 16, and since
BEGIN;
SELECT abacus_stage('field', 'SELECT 20000 + i, i % 99 + 0.3, i / 99 + 0.6 FROM generate_series(0, 9800) i'), abacus_triangulate('field');
SELECT count(*), count((abacus_locate('field', x, y)).v0) = count(*) AS located, max(greatest((abacus_locate('field', x, y)).v1, (abacus_locate('field', x, y)).v2)) >= 20000 AS changed FROM places;
SELECT count(*) FROM abacus_simplices('field');
SAVEPOINT before;
SELECT abacus_stage('field', 'SELECT 40000, 50.2, 50.4'), abacus_triangulate('field');
SELECT count(*) FROM abacus_simplices('field');
ROLLBACK TO before;
SELECT count(*) FROM abacus_simplices('field');
SELECT count(*) FROM abacus_check('field');
ROLLBACK;
TABLE located EXCEPT TABLE serial;
BEGIN ISOLATION LEVEL SERIALIZABLE;
TABLE located EXCEPT TABLE serial;
COMMIT;

-- errors come through, and the session works on
SELECT count(abacus_locate('field', x, 'NaN')) FROM places;
\echo :LAST_ERROR_SQLSTATE
SELECT count(abacus_walk('field', ROW(1, 1, 2, 3, NULL)::abacus_simplex, 0)) FROM places;
TABLE located EXCEPT TABLE serial;

-- temporary meshes lie in the leader's memory: workers say so
SELECT abacus_triangulate('pg_temp.passing', 'SELECT i, i % 10, i / 10 FROM generate_series(0, 99) i');
SELECT count(abacus_locate('passing', x, y)) FROM places;
\echo :LAST_ERROR_SQLSTATE
SET max_parallel_workers_per_gather = 0;
SELECT count(abacus_locate('passing', x, y)) FROM places;
SET max_parallel_workers_per_gather = 2;

-- what changes a mesh, or tells about the session, stays with the leader
SELECT count(*) > 0 AS figures FROM abacus_stats('field');
SELECT abacus_stage('field', 'SELECT 50000, 50.2, 50.4'), abacus_triangulate('field');
SELECT count(*) FROM abacus_check('field');

DROP VIEW located, looked;
DROP TABLE field, passing, places, serial, serial_look;
DROP FUNCTION look, plan;

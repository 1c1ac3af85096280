-- A mesh as foreign tables, without PostGIS: the geometries are tested in test/pgtap/fdw_geometry.sql.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10, 1), (2, 4, 0, 20, 2), (3, 4, 4, 30, 3), (4, 0, 4, NULL, 4), (5, 2, 1, 50, 5)', '{height,depth}');
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0, 7), (2, 4, 0, 0, 8), (3, 0, 4, 0, 9), (4, 0, 0, 4, 10), (5, 1, 1, 1, 11)', '{x}', dimension => 3);
SELECT abacus_publish('field', geometry => false);
SELECT abacus_publish('solid', 'tetrahedra', 'Corner Points', geometry => false);
\d field_cells
\d "Corner Points"
SELECT v0, v1, v2, corners, "values", height, depth FROM field_cells ORDER BY 1, 2, 3;
SELECT * FROM field_points ORDER BY id;
SELECT v0, v1, v2, v3, x FROM tetrahedra ORDER BY 1, 2, 3, 4;
SELECT id, x, y, z, x_2 FROM "Corner Points" ORDER BY id;
SELECT count(*) AS differ FROM (SELECT code, v0, v1, v2, corners, "values" FROM field_cells
    EXCEPT SELECT code, v0, v1, v2, corners, array_replace("values", NULL, 'NaN') FROM abacus_cells('field')) AS f;
SELECT p, tableoid::regclass FROM field_points AS p ORDER BY id LIMIT 1;
-- conditions lead to pages
EXPLAIN (COSTS OFF) SELECT id FROM field_points WHERE x BETWEEN 1 AND 3 AND 2 > y;
EXPLAIN (COSTS OFF) SELECT id FROM field_points WHERE x = 2 AND height > 15;
EXPLAIN (COSTS OFF) SELECT id FROM field_points WHERE depth >= 2 AND depth < 4;
EXPLAIN (COSTS OFF) SELECT id FROM field_points WHERE x > 3 AND x < 2;
EXPLAIN (COSTS OFF) SELECT id FROM field_points WHERE x + 1 > 3 OR y < 2;
EXPLAIN (COSTS OFF, VERBOSE) SELECT height FROM field_cells WHERE v0 = 1;
EXPLAIN (COSTS OFF) SELECT v0 FROM field_cells WHERE code BETWEEN 5 AND 5000000000000;
EXPLAIN (COSTS OFF) SELECT v0 FROM field_cells WHERE 5::smallint <= code;
SELECT count(*) FROM field_cells WHERE code < 0;
SELECT count(*) FROM field_cells WHERE code > -2 AND code <= 9223372036854775807;
SELECT count(*) FROM field_cells WHERE code = NULL;
SELECT count(*) FROM field_cells AS c JOIN abacus_simplices('field') AS s ON s.code = c.code AND (s.v0, s.v1, s.v2) = (c.v0, c.v1, c.v2);
SELECT id FROM field_points WHERE x BETWEEN 2 AND 4 AND y <= 1 ORDER BY id;
SELECT id FROM field_points WHERE x > 2 AND 4 >= x AND y < 1 ORDER BY id;
SELECT id FROM field_points WHERE height > 20 ORDER BY id;
SELECT id FROM field_points WHERE height >= 20 AND depth < 5 AND x = 4 ORDER BY id;
SELECT id FROM field_points WHERE height IS NULL;
SELECT count(*) FROM field_points WHERE x > 100;
SELECT count(*) FROM field_points WHERE x > 'NaN' OR y < '-Infinity';
SELECT count(*) FROM field_points WHERE x < 'NaN' AND y > '-Infinity' AND x < 'Infinity';
SELECT count(*) FROM field_points WHERE x = NULL::float8;
SELECT id FROM "Corner Points" WHERE z >= 1 AND x_2 < 11;
-- values that are known at run time: parameters, joins, subqueries
PREPARE near(float8) AS SELECT id FROM field_points WHERE x BETWEEN $1 - 1 AND $1 + 1 ORDER BY id;
SET plan_cache_mode = force_generic_plan;
EXPLAIN (COSTS OFF) EXECUTE near(0);
EXECUTE near(0);
EXECUTE near(4);
EXECUTE near(NULL);
RESET plan_cache_mode;
CREATE TABLE wells AS SELECT i AS id, i::float8 AS x FROM generate_series(0, 4) AS i;
ANALYZE wells;
SELECT abacus_triangulate('large', 'SELECT i, i % 100, i / 100, i % 7 FROM generate_series(0, 9999) AS i', '{level}');
SELECT abacus_publish('large', geometry => false);
EXPLAIN (COSTS OFF) SELECT w.id, p.id FROM wells AS w JOIN large_points AS p ON p.x BETWEEN w.x - 1 AND w.x + 1 AND p.y < 2;
SELECT w.id, p.id FROM wells AS w JOIN large_points AS p ON p.x BETWEEN w.x - 1 AND w.x + 1 AND p.y < 2 ORDER BY 1, 2;
EXPLAIN (COSTS OFF) SELECT w.id, p.id FROM wells AS w JOIN large_points AS p ON p.x BETWEEN w.x AND w.x AND p.y BETWEEN w.id::float8 AND w.id::float8;
SELECT w.id, p.id FROM wells AS w JOIN large_points AS p ON p.x = w.x AND p.y = w.id::float8 ORDER BY 1, 2;
SELECT w.id, p.n FROM wells AS w, LATERAL (SELECT count(*) AS n FROM field_points AS p WHERE p.x <= w.x) AS p ORDER BY 1;
SELECT id FROM field_points WHERE x > (SELECT avg(x) FROM wells) ORDER BY id;
-- the nearest to a place
EXPLAIN (COSTS OFF) SELECT id FROM large_points ORDER BY point(x, y) <-> point '(50.2,50.4)' LIMIT 3;
SELECT id FROM large_points ORDER BY point(x, y) <-> point '(50.2,50.4)' LIMIT 3;
SELECT id, level FROM large_points WHERE level = 3 ORDER BY '(50.2,50.4)' <-> point(x, y) LIMIT 4;
EXPLAIN (COSTS OFF) SELECT id FROM large_points ORDER BY point(x, y) <-> '(50,50)', id LIMIT 5;
SELECT id FROM large_points ORDER BY point(x, y) <-> '(50,50)', id LIMIT 5;
SELECT w.id, p.id FROM wells AS w, LATERAL (SELECT id FROM large_points ORDER BY point(x, y) <-> '(9.2,9.3)', id LIMIT w.id) AS p ORDER BY 1, 2;
SELECT count(*) FROM (SELECT id FROM large_points ORDER BY point(x, y) <-> '(-7,1e9)' LIMIT 20000) AS p;
EXPLAIN (COSTS OFF) SELECT id FROM large_points ORDER BY point(y, x) <-> point '(50.2,50.4)' LIMIT 3;
EXPLAIN (COSTS OFF) SELECT id FROM large_points ORDER BY point(x, y) <-> point '(50.2,50.4)' DESC LIMIT 3;
EXPLAIN (COSTS OFF) SELECT id FROM large_points ORDER BY point(x, y) <-> point '(50.2,Infinity)' LIMIT 3;
-- a cursor, backward too; it keeps what it saw
BEGIN;
DECLARE c SCROLL CURSOR FOR SELECT id FROM field_points WHERE x >= 0 ORDER BY id;
FETCH 2 FROM c;
FETCH BACKWARD 1 FROM c;
DECLARE d CURSOR FOR SELECT count(*) OVER () FROM field_points;
DECLARE e CURSOR FOR SELECT 1 FROM field_points;
FETCH 1 FROM e;
SELECT abacus_insert('field', 'VALUES (6, 1, 3, 60, 6)');
FETCH 1 FROM d;
MOVE ALL FROM e;
SELECT count(*) FROM field_points;
DECLARE f CURSOR FOR SELECT 1 FROM field_points;
FETCH 1 FROM f;
DROP TABLE field;
ROLLBACK;
-- rows are locked, or not written
SELECT id FROM field_points WHERE id = 1 FOR UPDATE;
INSERT INTO field_points (id) VALUES (1);
\echo :LAST_ERROR_SQLSTATE
UPDATE field_points SET id = 1;
DELETE FROM field_cells;
COPY field_points FROM '/dev/null';
TRUNCATE field_points;
-- as the planner expects it, and ANALYZE
ANALYZE field_points, field_cells;
SELECT relname, reltuples FROM pg_class WHERE relname IN ('field_points', 'field_cells') ORDER BY 1;
SELECT null_frac FROM pg_stats WHERE tablename = 'field_points' AND attname = 'height';
-- columns and tables may be renamed, and so may the mesh
ALTER FOREIGN TABLE field_points RENAME COLUMN height TO altitude;
ALTER FOREIGN TABLE field_points DROP COLUMN depth;
SELECT abacus_rename_attribute('field', 'height', 'elevation');
CREATE SCHEMA elsewhere;
ALTER TABLE field SET SCHEMA elsewhere;
ALTER TABLE elsewhere.field RENAME TO "The Field";
SELECT * FROM field_points WHERE altitude > 20 ORDER BY id;
EXPLAIN (COSTS OFF) SELECT FROM field_points;
SELECT abacus_publish('elsewhere."The Field"', geometry => false, cells => 'c');
SELECT pg_describe_object(classid, objid, 0), deptype FROM pg_depend WHERE refobjid = 'elsewhere."The Field"'::regclass AND classid = 'pg_class'::regclass AND deptype = 'a' ORDER BY 1;
SELECT abacus_unpublish('elsewhere."The Field"');
SELECT abacus_unpublish('elsewhere."The Field"');
SELECT to_regclass('field_points'), to_regclass('elsewhere.c');
-- what is not as it was made says so
SELECT abacus_publish('elsewhere."The Field"', 'c', 'p', 'public', false);
ALTER FOREIGN TABLE p ADD COLUMN more int;
SELECT id FROM p;
\echo :LAST_ERROR_SQLSTATE
ALTER FOREIGN TABLE p DROP COLUMN more, ALTER COLUMN x TYPE text;
SELECT id FROM p;
ALTER FOREIGN TABLE p ALTER COLUMN x TYPE float8, ALTER COLUMN x OPTIONS (SET holds 'attribute 9');
SELECT id FROM p ORDER BY id LIMIT 1;
SELECT x FROM p;
\echo :LAST_ERROR_SQLSTATE
ALTER FOREIGN TABLE p ALTER COLUMN x OPTIONS (SET holds 'w');
ALTER FOREIGN TABLE p OPTIONS (SET content 'edges');
ALTER FOREIGN TABLE p DROP CONSTRAINT mesh;
SELECT id FROM p;
\echo :LAST_ERROR_SQLSTATE
-- the tables go with the mesh
DROP TABLE elsewhere."The Field";
SELECT to_regclass('c'), to_regclass('p');
CREATE VIEW seen AS SELECT * FROM tetrahedra;
DROP TABLE solid;
DROP TABLE solid CASCADE;
SELECT count(*) FROM pg_foreign_table;
-- arguments
SELECT abacus_publish(NULL);
SELECT abacus_create('empty', 2, '{a}');
SELECT abacus_publish('wells');
SELECT abacus_unpublish('wells');
SELECT abacus_publish('empty', '', geometry => false);
SELECT abacus_publish('empty', schema => 'nowhere', geometry => false);
SELECT abacus_publish('empty', geometry => false, srid => 25832);
SELECT abacus_publish('empty', geometry => false, z => 'a');
SELECT abacus_publish('empty', geometry => false, z => 'b');
SELECT abacus_publish('empty', geometry => false);
SELECT abacus_publish('empty', geometry => false);
SELECT (SELECT count(*) FROM empty_cells) AS cells, (SELECT count(*) FROM empty_points WHERE x > 0 AND a < 3) AS points;
ANALYZE empty_points;
-- attributes have numbers that never come again: also where one is dropped and another gets its name
SELECT abacus_triangulate('plot', 'SELECT i, i % 7, i / 7, 4 AS g, 100 AS h FROM generate_series(0, 27) AS i');
SELECT abacus_publish('plot', geometry => false);
SELECT abacus_drop_attribute('plot', 'g');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_unpublish('plot'), abacus_drop_attribute('plot', 'g'), abacus_publish('plot', geometry => false);
SELECT g FROM plot_points;
\echo :LAST_ERROR_SQLSTATE
SELECT attname, attfdwoptions FROM pg_attribute WHERE attrelid = 'plot_cells'::regclass AND attnum > 4 ORDER BY attnum;
SELECT DISTINCT h, "values" FROM plot_cells;
SELECT abacus_rename_attribute('plot', 'h', 'g'), abacus_add_attribute('plot', 'h');
SELECT abacus_update('plot', 'SELECT id, x, y, id AS h FROM abacus_vertices(''plot'')');
SELECT DISTINCT h FROM plot_points;
EXPLAIN (COSTS OFF) SELECT id FROM plot_points WHERE h > 99;
SELECT count(*), min(h) FROM plot_points WHERE h > 99;
SELECT DISTINCT h FROM (SELECT h FROM plot_points ORDER BY point(x, y) <-> point '(2,2)' LIMIT 9) AS p;
SELECT abacus_publish('plot', 'more_cells', 'more_points', geometry => false);
SELECT DISTINCT g FROM more_points WHERE h < 3 AND g > 99;
SELECT sum(h), count(DISTINCT id) FROM more_points WHERE h < 3;
SELECT * FROM abacus_check('plot');
-- a table that still names it, as one of somebody else does
ALTER FOREIGN TABLE more_points ALTER COLUMN g OPTIONS (SET holds 'attribute 1');
ALTER FOREIGN TABLE more_cells ALTER COLUMN "values" OPTIONS (SET dropped '0');
SELECT g FROM more_points;
\echo :LAST_ERROR_SQLSTATE
SELECT id FROM more_points WHERE g = 4;
SELECT count(*), sum(h) FROM more_points;
SELECT "values" FROM more_cells;
\echo :LAST_ERROR_SQLSTATE
SELECT count(corners) FROM more_cells;
ANALYZE more_points, more_cells;
ALTER FOREIGN TABLE more_cells ALTER COLUMN "values" OPTIONS (SET dropped '-1');
-- damaged numbers
UPDATE plot SET page = (SELECT page FROM plot WHERE code = -1 AND part = 0) WHERE code = -1 AND part = 1000;
SELECT h FROM plot_points;
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_add_attribute('plot', 'k');
SELECT fault, code, part, message FROM abacus_check('plot');
-- labels of simplices are columns of cells, with their names
SELECT abacus_triangulate('soils', 'VALUES (1, 0, 0, 1), (2, 4, 0, 2), (3, 4, 4, 3), (4, 0, 4, 4)', '{code}');
SELECT abacus_label('soils', 'SELECT code, v0, v1, v2, 7 AS soil, NULL::float8 AS x FROM abacus_simplices(''soils'') WHERE 1 IN (v0, v1, v2)');
SELECT abacus_publish('soils', geometry => false);
SELECT v0, v1, v2, code_2, soil, x FROM soils_cells ORDER BY v0, v1, v2;
SELECT count(*) FROM soils_cells WHERE soil = 7;
SELECT * FROM soils_points LIMIT 0;
-- a label that comes later is not shown; a number that no label has is an error
SELECT abacus_label('soils', 'SELECT code, v0, v1, v2, 8 AS later FROM abacus_simplices(''soils'')');
SELECT * FROM soils_cells LIMIT 0;
ALTER FOREIGN TABLE soils_cells ALTER COLUMN soil OPTIONS (SET holds 'label 4');
SELECT soil FROM soils_cells;
\echo :LAST_ERROR_SQLSTATE
ALTER FOREIGN TABLE soils_points ALTER COLUMN x OPTIONS (SET holds 'label 1');
SELECT x FROM soils_points;
\echo :LAST_ERROR_SQLSTATE
DROP TABLE soils;
DROP SCHEMA elsewhere;
DROP TABLE wells, large, empty, plot CASCADE;

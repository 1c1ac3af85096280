-- Who reads a foreign table of a mesh needs SELECT on both.
CREATE ROLE regress_abacus_owner;
CREATE ROLE regress_abacus_reader;
CREATE SCHEMA regress_abacus AUTHORIZATION regress_abacus_owner;
GRANT USAGE ON SCHEMA regress_abacus TO regress_abacus_reader;
SET search_path = regress_abacus, public;
SET ROLE regress_abacus_owner;
SELECT abacus_triangulate('field', 'SELECT i AS id, i % 5 AS x, i / 5 AS y FROM generate_series(0, 24) AS i');
SELECT abacus_publish('field', geometry => false);
CREATE VIEW of_owner AS SELECT * FROM field_points;
GRANT SELECT ON of_owner, field_cells TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT abacus_publish('field', schema => 'public', geometry => false);
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM field_points;
\echo :LAST_ERROR_SQLSTATE
SELECT count(*) FROM field_cells;
\echo :LAST_ERROR_SQLSTATE
-- nor does the planner tell
EXPLAIN SELECT 1 FROM field_cells;
-- a view reads with the rights of its owner
SELECT count(*) FROM of_owner WHERE x < 2;
SET ROLE regress_abacus_owner;
GRANT SELECT ON field TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT count(*) FROM field_cells;
-- a prepared plan, and the right taken away
PREPARE cells AS SELECT count(*) FROM field_cells;
EXECUTE cells;
SET ROLE regress_abacus_owner;
REVOKE SELECT ON field FROM regress_abacus_reader;
SET ROLE regress_abacus_reader;
EXECUTE cells;
-- the reader's own view does not help, nor do others of the reader's own tables
SET ROLE regress_abacus_owner;
GRANT CREATE ON SCHEMA regress_abacus TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
CREATE VIEW of_reader AS SELECT * FROM field_cells;
GRANT SELECT ON of_reader TO regress_abacus_owner;
CREATE FOREIGN TABLE mine (id bigint OPTIONS (holds 'id'), CONSTRAINT mesh CHECK (abacus_published('field')))
    SERVER abacus OPTIONS (content 'points');
SELECT * FROM mine;
SET ROLE regress_abacus_owner;
SELECT count(*) FROM of_reader;
\echo :LAST_ERROR_SQLSTATE
-- row-level security has no meaning on pages
ALTER TABLE field ENABLE ROW LEVEL SECURITY;
GRANT SELECT ON field TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT count(*) FROM field_cells;
\echo :LAST_ERROR_SQLSTATE
EXPLAIN SELECT 1 FROM field_cells;
-- ANALYZE passes over what its owner may not read
RESET ROLE;
ALTER TABLE field DISABLE ROW LEVEL SECURITY;
REVOKE SELECT ON field FROM regress_abacus_reader;
ANALYZE mine;
ANALYZE field_points;
SELECT relname, reltuples FROM pg_class WHERE relname IN ('mine', 'field_points') ORDER BY 1;
SET ROLE regress_abacus_reader;
-- who reads a mesh does not keep its owner from changing it, and is told
RESET ROLE;
CREATE SCHEMA regress_abacus_of_reader AUTHORIZATION regress_abacus_reader;
SET ROLE regress_abacus_owner;
SELECT abacus_triangulate('plot', 'SELECT i, i % 7, i / 7, 4 AS g, 100 AS h FROM generate_series(0, 27) AS i');
SELECT abacus_publish('plot', geometry => false);
GRANT SELECT ON plot, plot_vertices TO regress_abacus_reader;
SET ROLE regress_abacus_reader;
SELECT abacus_publish('plot', schema => 'regress_abacus_of_reader', geometry => false);
SET ROLE regress_abacus_owner;
SELECT abacus_drop_attribute('plot', 'g');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_unpublish('plot');
SELECT abacus_drop_attribute('plot', 'g');
SELECT abacus_publish('plot', geometry => false);
SELECT DISTINCT h FROM plot_points;
SET ROLE regress_abacus_reader;
SELECT DISTINCT g FROM regress_abacus_of_reader.plot_points;
\echo :LAST_ERROR_SQLSTATE
SELECT "values" FROM regress_abacus_of_reader.plot_cells;
SELECT DISTINCT h FROM regress_abacus_of_reader.plot_points;
SELECT abacus_unpublish('plot');
SELECT abacus_publish('plot', schema => 'regress_abacus_of_reader', geometry => false);
SELECT DISTINCT h, "values" FROM regress_abacus_of_reader.plot_cells;
SELECT abacus_unpublish('plot');
-- everyone drops their own
DROP VIEW of_reader;
SELECT abacus_unpublish('field');
SELECT abacus_unpublish('field');
SET ROLE regress_abacus_owner;
DROP VIEW of_owner;
SELECT abacus_unpublish('field');
RESET ROLE;
DROP SCHEMA regress_abacus, regress_abacus_of_reader CASCADE;
DROP ROLE regress_abacus_owner, regress_abacus_reader;

-- What is no query, where one is wanted; and a geometry where a query yields one.
CREATE SCHEMA regress_no_query;
SET search_path = regress_no_query, public;
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0), (2, 10, 0), (3, 0, 10)');

-- a type that is cast to text without being asked, as a geometry is
CREATE TYPE geometry AS (x float8, y float8);
CREATE CAST (geometry AS text) WITH INOUT AS IMPLICIT;
SELECT abacus_locate('field', ROW(1, 1)::geometry);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', '0101000000000000000000F03F000000000000F03F');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_delete('field', 'SRID=21781;POINT(1 1)');
SELECT abacus_stage('field', 'POINT Z (1 1 1)');
SELECT abacus_triangulate('other', '{"type": "Point", "coordinates": [1, 1]}');
SELECT abacus_load('other', 'points', 'SELECT 1, 2, 3');
SELECT abacus_load('other', 'TABLE points', '0101');
SELECT abacus_insert('field', 'SELEC 1, 2, 3');
SELECT abacus_insert('field', '"SELECT"');
SELECT abacus_insert('field', E'  -- nothing\n SELECTED 1');

-- a query, however it begins
SELECT abacus_locate('field', E' -- a place\n /* with /* a remark */ in it */ ( (VALUES (1, 1, 1)))');
SELECT abacus_locate('field', E'--\rselect 1, 1, 1');
SELECT abacus_locate('field', 'with place AS (SELECT 1, 1, 1) TABLE place');
-- what is none for another reason says its own
SELECT abacus_locate('field', '');
SELECT abacus_locate('field', ' /* SELECT 1, 1, 1');
SELECT abacus_locate('field', 'SELECT ROW(1, 1)');
SELECT abacus_locate('field', 'row(1, 1)');

-- a geometry among the columns
CREATE TABLE places (id int, "Geom" geometry);
SELECT abacus_locate('field', 'TABLE places');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('field', 'SELECT id, "Geom", 0 FROM places');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('other', 'SELECT id, "Geom" AS geom FROM places', dimension => 3);
SELECT abacus_triangulate('other', 'SELECT id, 0, 0, "Geom" AS geom FROM places');
SELECT abacus_load('other', 'VALUES (1, 0, 0), (2, 10, 0), (3, 0, 10)', 'SELECT 1, 2, "Geom" FROM places');
CREATE TABLE spots (id int, x geometry, y float8);
SELECT abacus_create('spotted', 2);
SELECT abacus_track('spotted', 'spots');

-- places are found whatever else their rows have
SELECT abacus_locate('field', 'SELECT 1, 1, 1, ''a name'', "Geom" FROM (VALUES (NULL::geometry)) AS t ("Geom")');
SELECT abacus_locate('field', 'SELECT 1, 1');

-- a bare NULL is a value that an attribute has not
SELECT abacus_triangulate('nulls', 'VALUES (1, 0, 0, NULL), (2, 10, 0, NULL), (3, 0, 10, NULL)', '{height}');
SELECT abacus_insert('nulls', 'SELECT 4, 9, 9, NULL UNION ALL SELECT 5, 3, 3, NULL');
SELECT id, attributes FROM abacus_vertices('nulls') ORDER BY id;
SELECT abacus_insert('nulls', $$ VALUES (6, 1, 1, NULL), (7, 1, 2, '3') $$);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('nulls', 'SELECT 6, 1, NULL, 3');
SELECT abacus_insert('nulls', 'SELECT NULL, 1, 1, 3');
SELECT count(*) FROM abacus_vertices('nulls');

-- names
SELECT abacus_create('TIN North', 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('"TIN North"', 2);
SELECT abacus_triangulate('gis.TIN North', 'VALUES (1, 0, 0)');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('field', 2);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_create('places', 2);
\echo :LAST_ERROR_SQLSTATE
CREATE TYPE taken AS ENUM ();
SELECT abacus_create('taken', 2);
\echo :LAST_ERROR_SQLSTATE
-- what stands on the tables of a mesh
\d field
\d field_vertices
SELECT attrelid::regclass AS "table", attname, attstorage, col_description(attrelid, attnum) FROM pg_attribute
WHERE attrelid IN ('field'::regclass, 'field_vertices'::regclass) AND attnum > 0 ORDER BY attrelid::regclass::text, attnum;
SELECT obj_description('field'::regclass), obj_description('field_vertices'::regclass);

SET client_min_messages = warning;
DROP SCHEMA regress_no_query CASCADE;

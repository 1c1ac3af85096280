-- Regions of a mesh: privileges on their table alone, policies on its rows, other names and schemas, savepoints, snapshots of cursors.
BEGIN;
SELECT no_plan();

CREATE ROLE pgtap_region_reader;
CREATE ROLE pgtap_region_writer;
CREATE SCHEMA own;
GRANT USAGE ON SCHEMA own TO pgtap_region_reader, pgtap_region_writer;
CREATE TABLE own.point AS SELECT (10 * x + y)::bigint AS id, x::float8, y::float8, (x + 2 * y)::float8 AS h FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y;
SELECT abacus_triangulate('own.field', 'TABLE own.point');
SELECT abacus_constrain('own.field', 'VALUES (1, 1, 11), (1, 2, 61), (1, 3, 66), (1, 4, 16), (1, 5, 11), (2, 1, 71), (2, 2, 81), (2, 3, 88), (2, 4, 78), (2, 5, 71)');
SELECT abacus_region('own.field', $$VALUES ('outlined', 1)$$);
SELECT abacus_region('own.field', $$VALUES ('seeded', 7.5, 2.25)$$);
CREATE FUNCTION pg_temp.regions() RETURNS text LANGUAGE sql AS $$ SELECT string_agg(concat_ws(' ', region, triangles, area), ', ') FROM abacus_regions('own.field') $$;
CREATE TABLE question AS SELECT * FROM (VALUES
    ($$SELECT abacus_interpolate('own.field', 2.5, 2.25, within => 'outlined')$$), ($$SELECT * FROM abacus_regions('own.field')$$), ($$SELECT * FROM abacus_check('own.field')$$),
    ($$SELECT * FROM abacus_simplices('own.field', 'outlined')$$), ($$SELECT * FROM abacus_contours('own.field', 1, within => 'outlined')$$),
    ($$SELECT abacus_draw('own.field', 64, within => 'outlined')$$), ($$SELECT * FROM abacus_volume('own.field', 0, within => 'outlined')$$)) AS q (sql);
CREATE TABLE change AS SELECT * FROM (VALUES
    ($$SELECT abacus_region('own.field', 'VALUES (''new'', 2)')$$), ($$SELECT abacus_unregion('own.field', 'outlined')$$), ($$SELECT abacus_unconstrain('own.field', 'VALUES (1)')$$),
    ($$SELECT abacus_constrain('own.field', 'VALUES (3, 1, 71), (3, 2, 82)')$$)) AS c (sql);  -- within the region of a seed
GRANT SELECT ON question, change TO pgtap_region_reader, pgtap_region_writer;

-- a reader of the mesh who may not read its regions
GRANT SELECT ON own.field, own.field_vertices, own.field_lines, own.point TO pgtap_region_reader;
SET ROLE pgtap_region_reader;
SELECT is(abacus_interpolate('own.field', 2.5, 2.25), 7::float8, 'questions of the whole mesh need no privilege on its regions');
SELECT throws_ok(sql, '42501', 'permission denied for table field_regions', 'a reader without regions: ' || sql) FROM question;
RESET ROLE;
GRANT SELECT ON own.field_regions TO pgtap_region_reader;
SET ROLE pgtap_region_reader;
SELECT lives_ok(sql, 'a reader with them: ' || sql) FROM question;
SELECT throws_ok(sql, '42501', NULL, 'who may change nothing: ' || sql) FROM change;
RESET ROLE;
-- of the table of regions alone
REVOKE SELECT ON own.field FROM pgtap_region_reader;
SET ROLE pgtap_region_reader;
SELECT throws_ok(sql, '42501', 'permission denied for table field', 'a reader of regions alone: ' || sql) FROM question;
RESET ROLE;
GRANT SELECT ON own.field TO pgtap_region_reader;

-- a writer of the mesh who may not read, or not change, its regions
GRANT SELECT, INSERT, UPDATE, DELETE ON own.field, own.field_vertices, own.field_lines TO pgtap_region_writer;
GRANT SELECT ON own.point TO pgtap_region_writer;
SET ROLE pgtap_region_writer;
SELECT is(abacus_insert('own.field', 'VALUES (1001, 2.5, 2.25, 7)'), 1::bigint, 'points need no privilege on regions');
SELECT throws_ok(sql, '42501', 'permission denied for table field_regions', 'a writer without regions: ' || sql) FROM change;
RESET ROLE;
SELECT is(pg_temp.regions(), 'outlined 52 25, seeded 14 7', 'nothing has changed but for the point');
GRANT SELECT ON own.field_regions TO pgtap_region_writer;
SET ROLE pgtap_region_writer;
SELECT throws_ok(sql, '42501', 'permission denied for table field_regions', 'a writer who may read regions: ' || sql) FROM change;
RESET ROLE;
GRANT INSERT, DELETE ON own.field_regions TO pgtap_region_writer;
SET ROLE pgtap_region_writer;
SELECT throws_ok(sql, '42501', 'permission denied for table field_regions', 'UPDATE is lacking: ' || sql) FROM change;
RESET ROLE;
GRANT UPDATE ON own.field_regions TO pgtap_region_writer;
SET ROLE pgtap_region_writer;
SELECT lives_ok(sql, 'the same privileges as on the other tables are enough: ' || sql) FROM change WHERE sql !~ 'new';
SELECT is(abacus_constrain('own.field', 'VALUES (1, 1, 11), (1, 2, 61), (1, 3, 66), (1, 4, 16), (1, 5, 11)'), 1::bigint, 'the line and');
SELECT is(abacus_region('own.field', 'VALUES (''outlined'', 1)'), 1::bigint, 'the region come back');
RESET ROLE;
SELECT is(pg_temp.regions(), 'outlined 52 25, seeded 13 6.5', 'and the other region has lost what a line cut off');

-- policies hide rows, so they are refused
ALTER TABLE own.field_regions ENABLE ROW LEVEL SECURITY;
CREATE POLICY few ON own.field_regions USING (region <> 'outlined');
SET ROLE pgtap_region_writer;
SELECT throws_ok(sql, '0A000', 'row-level security on mesh table "field_regions" applies to user "pgtap_region_writer"', 'policies: ' || sql)
FROM (TABLE question UNION ALL SELECT sql FROM change WHERE sql !~ '82') AS s;
SELECT is(abacus_interpolate('own.field', 2.5, 2.25), 7::float8, 'questions of the whole mesh do not care');
RESET ROLE;
SELECT is(pg_temp.regions(), 'outlined 52 25, seeded 13 6.5', 'nor does the owner');
DROP POLICY few ON own.field_regions;
ALTER TABLE own.field_regions DISABLE ROW LEVEL SECURITY;

-- in a transaction: savepoints, a cursor, and what only reads
CREATE FUNCTION pg_temp.undone() RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    within text;
BEGIN
    PERFORM abacus_unregion('own.field', 'outlined');
    PERFORM abacus_region('own.field', 'VALUES (''other'', 1)');
    PERFORM abacus_insert('own.field', 'VALUES (1002, 4.5, 4.25, 13)');
    within := pg_temp.regions();
    RAISE 'undone' USING DETAIL = within;
EXCEPTION WHEN raise_exception THEN
    RETURN within;
END $$;
SELECT is(pg_temp.undone(), 'other 54 25, seeded 13 6.5', 'within a savepoint');
SELECT is(pg_temp.regions(), 'outlined 52 25, seeded 13 6.5', 'rolled back to it');
SELECT is((SELECT count(*) FROM abacus_simplices('own.field', 'outlined')), 52::bigint, 'its triangles as well');
DECLARE earlier CURSOR FOR SELECT v0 FROM abacus_simplices('own.field', 'outlined');
MOVE 1 IN earlier;
SAVEPOINT before;
SELECT abacus_unregion('own.field', 'outlined');
CREATE FUNCTION pg_temp.fetch_all(c refcursor) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    n bigint := 0;
    v bigint;
BEGIN
    LOOP
        FETCH c INTO v;
        EXIT WHEN NOT FOUND;
        n := n + 1;
    END LOOP;
    RETURN n;
END $$;
SELECT is(pg_temp.fetch_all('earlier'), 51::bigint, 'a cursor returns the region as it was when the cursor was opened');
ROLLBACK TO before;
SET transaction_read_only = on;
SELECT is(abacus_interpolate('own.field', 2.5, 2.25, within => 'outlined'), 7::float8, 'a transaction that only reads');
SELECT throws_ok(sql, '25006', NULL, 'changes nothing: ' || sql) FROM change;
ROLLBACK TO before;

-- tables with other names, elsewhere, and of another owner
ALTER TABLE own.field RENAME TO "Pré ""neuf""";
ALTER TABLE own.field_regions RENAME TO "Parts";
SELECT is((SELECT string_agg(region, ' ') FROM abacus_regions('own."Pré ""neuf"""')), 'outlined seeded', 'a mesh with another name, and regions with theirs');
ALTER TABLE own."Pré ""neuf""" SET SCHEMA public;
SELECT is((SELECT string_agg(region, ' ') FROM abacus_regions('"Pré ""neuf"""')), 'outlined seeded', 'in another schema');
SELECT abacus_unregion('"Pré ""neuf"""', 'seeded');
SELECT is(abacus_region('"Pré ""neuf"""', $$VALUES (E'l''Étang "\n', 7.5, 2.25)$$), 1::bigint, 'a region with any name');
SELECT is((SELECT count(*) FROM abacus_simplices('"Pré ""neuf"""', E'l''Étang "\n')), 13::bigint, 'which is found by it');
ALTER TABLE "Pré ""neuf""" OWNER TO pgtap_region_writer;
SET ROLE pgtap_region_writer;
SELECT lives_ok($$SELECT * FROM abacus_regions('"Pré ""neuf"""')$$, 'an owner of the mesh alone, who has privileges on the rest');
RESET ROLE;
DROP TABLE "Pré ""neuf""";
SELECT hasnt_table('own', 'Parts', 'all tables go with the mesh');

-- a table with the name is in the way
SELECT abacus_triangulate('own.field', 'TABLE own.point');
SELECT abacus_constrain('own.field', 'VALUES (1, 1, 11), (1, 2, 61), (1, 3, 66), (1, 4, 16), (1, 5, 11)');
CREATE TABLE own.field_regions (i int);
SELECT throws_ok($$SELECT abacus_region('own.field', 'VALUES (''a'', 1)')$$, '42P07', 'relation "field_regions" already exists');
SELECT is((SELECT count(*) FROM abacus_regions('own.field')), 0::bigint, 'and is not taken for the regions');
DROP TABLE own.field_regions;
SELECT is(abacus_region('own.field', 'VALUES (''a'', 1)'), 1::bigint, 'until it is gone');
-- a region that is lost
DROP TABLE own.field_regions;
SELECT throws_ok(sql, '42P01', 'mesh "field" has regions, but no table of regions', 'lost: ' || sql)
FROM (VALUES ($$SELECT * FROM abacus_regions('own.field')$$), ($$SELECT * FROM abacus_check('own.field')$$), ($$SELECT abacus_interpolate('own.field', 2, 2, within => 'a')$$), ($$SELECT abacus_unregion('own.field', 'a')$$)) AS s (sql);
SELECT is(abacus_interpolate('own.field', 2.5, 2.25), 7::float8, 'the mesh answers as a whole');

SELECT * FROM finish();
ROLLBACK;

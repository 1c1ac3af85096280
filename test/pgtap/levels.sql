-- Levels of detail: the same for any order of the points, cache and number of threads; privileges, policies, other schemas, savepoints,
-- temporary meshes, attributes that come and go.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;

CREATE ROLE pgtap_level_owner;
CREATE ROLE pgtap_level_reader;
CREATE SCHEMA "Own place";
GRANT ALL ON SCHEMA "Own place" TO pgtap_level_owner;
GRANT USAGE ON SCHEMA "Own place" TO pgtap_level_reader;
CREATE TABLE ground AS
SELECT 100 * x + y AS id, x::float8 AS x, y::float8 AS y, 10 * sin(x / 15.0) * cos(y / 20.0) + 0.001 * x * y AS height
FROM generate_series(0, 50) AS x, generate_series(0, 50) AS y;
GRANT SELECT ON ground TO pgtap_level_owner;
CREATE FUNCTION pg_temp.levels(levels regclass) RETURNS text[] LANGUAGE plpgsql AS $$
DECLARE
    level record;
    found text[];
    ids text;
BEGIN
    FOR level IN EXECUTE format('SELECT * FROM %s ORDER BY level', levels) LOOP
        SELECT string_agg(v::text, ' ' ORDER BY id) INTO ids FROM abacus_vertices(level.mesh) AS v;
        found := found || concat_ws(' ', level.level, level.attribute, level.max_error, level.greatest, md5(ids));
    END LOOP;
    RETURN found;
END $$;

-- the same whatever the order, the cache and the threads are
SELECT abacus_triangulate('field', 'SELECT * FROM ground ORDER BY id');
SELECT is(array_agg(level), '{1,2,3}', 'three levels') FROM abacus_levels('field', '{0.05,0.2,1}');
CREATE TABLE wanted AS SELECT pg_temp.levels('field_levels') AS levels;
SELECT is((SELECT cardinality(levels) FROM wanted), 3, 'which are described');
CREATE FUNCTION pg_temp.again(cache text, threads int) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    PERFORM set_config('abacus.cache_size', cache, true), set_config('abacus.threads', threads::text, true);
    PERFORM abacus_triangulate('shuffled', 'SELECT * FROM ground ORDER BY (id * 7919) % 5101');
    PERFORM abacus_levels('shuffled', '{0.05,0.2,1}');
    RETURN NEXT is(pg_temp.levels('shuffled_levels'), (SELECT levels FROM wanted), format('the same with a cache of %s and %s threads', cache, threads));
    PERFORM abacus_levels_refresh('shuffled');
    RETURN NEXT is(pg_temp.levels('shuffled_levels'), (SELECT levels FROM wanted), '... and made anew');
    DROP TABLE shuffled;
    RETURN NEXT is(to_regclass('shuffled_levels'), NULL, '... which go with the mesh');
    RESET abacus.cache_size;
    RESET abacus.threads;
END $$;
SELECT pg_temp.again('64MB', 1);
SELECT pg_temp.again('1MB', 1);
SELECT pg_temp.again('1MB', 3);

-- a refresh after changes gives what new levels do
SELECT abacus_delete('field', 'SELECT id, x, y FROM ground WHERE id % 3 = 0');
SELECT abacus_insert('field', 'VALUES (-1, 20.5, 20.25, 30.0)');
SELECT is(abacus_draw('field', 64, max_error => 0.2), abacus_draw('field_level_2', 64), 'a level that is older is read');
SELECT is((SELECT count(*) FROM abacus_vertices('field_level_3') WHERE id = -1), 0::bigint, '... as the mesh was');
SELECT abacus_levels_refresh('field');
CREATE TABLE refreshed AS SELECT pg_temp.levels('field_levels') AS levels;
SELECT is((SELECT count(*) FROM abacus_vertices('field_level_3') WHERE id = -1), 1::bigint, 'a refresh finds a new peak');
SELECT is(abacus_levels_drop('field'), 3, 'levels are dropped');
SELECT abacus_levels('field', '{0.05,0.2,1}');
SELECT is(pg_temp.levels('field_levels'), (SELECT levels FROM refreshed), 'fresh ones are the same');
SAVEPOINT before;
SELECT abacus_delete('field', 'SELECT id, x, y FROM ground WHERE id % 2 = 0');
SELECT abacus_levels_refresh('field');
SELECT isnt(pg_temp.levels('field_levels'), (SELECT levels FROM refreshed), 'others after a change');
ROLLBACK TO before;
SELECT is(pg_temp.levels('field_levels'), (SELECT levels FROM refreshed), 'back with the savepoint');
-- in one statement with the change
SELECT is((SELECT value FROM abacus_stats('field') WHERE name = 'levels_old'), 0::float8, 'no level is older');

-- an attribute that comes: the levels get it with the next refresh; one that goes
SELECT abacus_add_attribute('field', 'other');
SELECT abacus_update('field', 'SELECT id, x, y, 2 * x AS other FROM ground WHERE id % 3 > 0');
SELECT is((SELECT value FROM abacus_stats('field') WHERE name = 'levels_old'), 3::float8, 'levels lack a new attribute');
SELECT abacus_levels_refresh('field');
SELECT is((SELECT count(*) FROM abacus_attributes('field_level_2')), 2::bigint, 'a refresh gives it to them');
SELECT is((SELECT array_agg(c::text) FROM abacus_contours('field', 2, attribute => 'height', max_error => 1) AS c),
          (SELECT array_agg(c::text) FROM abacus_contours('field_level_3', 2, attribute => 'height') AS c), 'contours of a level');
SELECT abacus_drop_attribute('field', 'height');
SELECT throws_ok($$SELECT abacus_levels_refresh('field')$$, '42703', NULL, 'no levels of an attribute that has gone');
SELECT is((SELECT count(*) FROM abacus_vertices('field_level_2')) > 3, true, '... and those there were stay');
SELECT throws_ok($$SELECT abacus_contours('field', attribute => 'other', max_error => 1)$$, '22023', NULL, '... which are none of the other');
SELECT abacus_levels_drop('field');
SELECT abacus_levels('field', '{1}');
SELECT is((SELECT attribute FROM field_levels), 'other', 'levels of the one that is left');

-- privileges: the owner alone makes them, and a superuser does so in his name
SET ROLE pgtap_level_owner;
SELECT abacus_triangulate('"Own place"."The field"', 'TABLE ground');
GRANT SELECT ON "Own place"."The field", "Own place"."The field_vertices" TO pgtap_level_reader;
RESET ROLE;
SET ROLE pgtap_level_reader;
SELECT throws_ok($$SELECT abacus_levels('"Own place"."The field"', '{1}')$$, '42501', 'must be owner of mesh "The field" to make or change its levels', 'a reader makes no levels');
RESET ROLE;
SELECT is(array_agg(level_mesh::text), '{"\"Own place\".\"The field_level_1\"","\"Own place\".\"The field_level_2\""}', 'names are quoted')
FROM abacus_levels('"Own place"."The field"', '{0.2,1}');
SELECT is(array_agg(DISTINCT relowner::regrole::text), '{pgtap_level_owner}', 'all belongs to the owner of the mesh') FROM pg_class WHERE relname LIKE 'The field%' AND relkind = 'r';
CREATE TABLE question AS SELECT * FROM (VALUES
    ($$SELECT abacus_draw('"Own place"."The field"', 64, max_error => 1)$$), ($$SELECT * FROM abacus_contours('"Own place"."The field"', 1, max_error => 1)$$),
    ($$SELECT abacus_tile_terrain('"Own place"."The field"', 0, 0, 0, world => '{0,0,64}', max_error => 1)$$),
    ($$SELECT abacus_tile_vector('"Own place"."The field"', 0, 0, 0, world => '{0,0,64}', pixel_error => 5)$$),
    ($$SELECT abacus_tile_picture('"Own place"."The field"', 0, 0, 0, world => '{0,0,64}', pixel_error => 5)$$)) AS q (sql);
GRANT SELECT ON question TO pgtap_level_reader;
SET ROLE pgtap_level_reader;
SELECT throws_ok(sql, '42501', 'permission denied for table The field_levels', 'a reader of the mesh alone: ' || sql) FROM question;
SELECT throws_ok($$SELECT abacus_levels_refresh('"Own place"."The field"')$$, '42501', NULL, '... makes none anew');
SELECT throws_ok($$SELECT abacus_levels_drop('"Own place"."The field"')$$, '42501', NULL, '... and drops none');
SELECT lives_ok($$SELECT abacus_draw('"Own place"."The field"', 64)$$, '... but reads the full mesh');
SELECT is((SELECT count(*) FROM abacus_stats('"Own place"."The field"') WHERE name LIKE 'levels%'), 0::bigint, '... whose figures do not tell of levels');
SELECT is(length(abacus_tile_etag('"Own place"."The field"')), 16, '... nor do ETags');
RESET ROLE;
GRANT SELECT ON "Own place"."The field_levels" TO pgtap_level_reader;
SET ROLE pgtap_level_reader;
SELECT throws_ok(sql, '42501', 'permission denied for table The field_level_2', 'a reader of the table of levels: ' || sql) FROM question;
RESET ROLE;
GRANT SELECT ON "Own place"."The field_level_2" TO pgtap_level_reader;
SELECT abacus_levels_refresh('"Own place"."The field"');
SET ROLE pgtap_level_reader;
SELECT lives_ok(sql, 'a reader of the level, after a refresh: ' || sql) FROM question;
RESET ROLE;
ALTER TABLE "Own place"."The field_levels" ENABLE ROW LEVEL SECURITY;
SET ROLE pgtap_level_reader;
SELECT throws_ok(sql, '0A000', NULL, 'with policies on the table of levels: ' || sql) FROM question;
RESET ROLE;
ALTER TABLE "Own place"."The field_levels" DISABLE ROW LEVEL SECURITY;

-- what a restore leaves: no binding; the first change by the owner makes it
DELETE FROM pg_depend WHERE refobjid = '"Own place"."The field"'::regclass AND classid = 'pg_class'::regclass AND deptype = 'a' AND objid IN (SELECT oid FROM pg_class WHERE relkind = 'r');
SELECT is(abacus_level('"Own place"."The field"', 1)::text, '"Own place"."The field_level_2"', 'levels are found without a binding');
SET ROLE pgtap_level_owner;
SELECT abacus_delete('"Own place"."The field"', 'SELECT id, x, y FROM ground WHERE id < 100');
RESET ROLE;
DROP TABLE "Own place"."The field";
SELECT is((SELECT array_agg(relname) FROM pg_class WHERE relname LIKE 'The field%'), NULL, 'and go with the mesh after a change');

-- a temporary mesh
CREATE TEMPORARY TABLE nothing ();
SELECT abacus_triangulate('pg_temp.brief', 'TABLE ground');
SELECT abacus_levels('brief', '{0.2,1}');
SELECT is(array_agg(relpersistence), '{t,t}', 'levels of a temporary mesh are temporary') FROM pg_class WHERE relname LIKE 'brief_level__';
SELECT is((SELECT count(*) FROM abacus_levels_refresh('brief')), 2::bigint, '... and made anew');

-- a row of the table that names another relation
UPDATE field_levels SET mesh = 'ground'::regclass;
SELECT throws_ok($$SELECT abacus_draw('field', 64, max_error => 9)$$, '42809', NULL, 'a level that is no mesh');
SELECT throws_ok($$SELECT abacus_levels_refresh('field')$$, '42P01', NULL, '... is not written');
SELECT is((SELECT count(*) FROM ground), 2601::bigint, '... nor lost');

SELECT * FROM finish();
ROLLBACK;

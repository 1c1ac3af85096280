-- Regions and fixed edges seen: the region at a place, a column of published tables, pictures, vector tiles.
BEGIN;
SELECT no_plan();

SELECT abacus_triangulate('field', 'SELECT 10 * x + y AS id, x, y, x + 2 * y AS h FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y');
SELECT abacus_constrain('field', 'SELECT l, n, p FROM (VALUES (1, ARRAY[11, 71, 77, 17, 11]), (2, ARRAY[33, 53, 55, 35, 33])) AS v (l, ids), unnest(ids) WITH ORDINALITY AS u (p, n)');

-- a mesh without regions has no such column
SELECT is(abacus_region_at('field', 2.5, 2.2), NULL, 'no region at a place');
SELECT throws_ok($$SELECT abacus_region_at('pg_class', 0, 0)$$, '42809', NULL, 'not a mesh');
SELECT abacus_create('solid', 3);
SELECT throws_ok($$SELECT abacus_region_at('solid', 0, 0)$$, '22023', NULL, 'a mesh in space');
SELECT throws_ok($$SELECT abacus_region_at('field', 'NaN', 0)$$, '22023', 'x is not a number');
SELECT abacus_publish('field', geometry => false);
SELECT hasnt_column('field_cells', 'region', 'without regions there is no column');
SELECT abacus_unpublish('field');

SELECT abacus_region('field', $$VALUES ('farm', 1), ('farm', 2)$$);
SELECT abacus_region('field', $$VALUES ('lake', 4.5, 4.5)$$);
SELECT abacus_publish('field', geometry => false);
SELECT col_type_is('field_cells', 'region', 'text', 'cells have a region');
SELECT hasnt_column('field_points', 'region', 'points have none');
CREATE FUNCTION pg_temp.is_right(what text) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT set_eq('SELECT code, v0, v1, v2 FROM field_cells WHERE region IS NOT DISTINCT FROM ' || coalesce(quote_literal(region), 'NULL::text'),
        CASE WHEN region IS NULL THEN 'SELECT code, v0, v1, v2 FROM abacus_simplices(''field'') EXCEPT SELECT s.code, s.v0, s.v1, s.v2 FROM abacus_regions(''field'') AS r, abacus_simplices(''field'', within => r.region) AS s'
             ELSE format('SELECT code, v0, v1, v2 FROM abacus_simplices(''field'', within => %L)', region) END, what || ': ' || coalesce(region, 'outside'))
    FROM (SELECT region FROM abacus_regions('field') UNION ALL SELECT NULL) AS r
$$;
SELECT pg_temp.is_right('each cell has its region');
SELECT set_eq('SELECT code, region FROM field_cells WHERE code > 1 << 30', 'SELECT code, region FROM field_cells WHERE (code > 1 << 30) IS TRUE', 'a stretch of the curve has them, too');
SELECT results_eq('SELECT region, count(*) FROM field_cells GROUP BY region ORDER BY region', $$VALUES ('farm', 64::bigint), ('lake', 8), (NULL, 90)$$, 'as many as there are');

-- they follow the mesh
SELECT abacus_insert('field', 'SELECT 1000 + 10 * x + y, x + 0.3, y + 0.4, 0 FROM generate_series(0, 8) AS x, generate_series(0, 8) AS y');
SELECT abacus_delete('field', 'VALUES (44, 4, 4, 12), (22, 2, 2, 6)');
SELECT set_eq($$SELECT code, v0, v1, v2, region FROM field_cells WHERE region IS NOT NULL$$,
    $$SELECT code, v0, v1, v2, abacus_region_at('field', (c[1][1] + c[2][1] + c[3][1]) / 3, (c[1][2] + c[2][2] + c[3][2]) / 3) FROM abacus_cells('field') AS a (code, v0, v1, v2, v3, c)
      WHERE abacus_region_at('field', (c[1][1] + c[2][1] + c[3][1]) / 3, (c[1][2] + c[2][2] + c[3][2]) / 3) IS NOT NULL$$, 'the region at a place');
SELECT is(abacus_region_at('field', x, y), r, format('at %s, %s', x, y)) FROM (VALUES (100, 0, NULL), (0.5, 0.5, NULL), (2.5, 2.2, 'farm'), ('Infinity'::float8, 0, NULL), (NULL, 1, NULL), (4.4, 4.3, 'lake')) AS v (x, y, r);
SELECT pg_temp.is_right('after points have come and gone');
SELECT abacus_unregion('field', 'lake');
SELECT pg_temp.is_right('after a region has gone');
SELECT is(abacus_region_at('field', 4.4, 4.3), NULL, 'no region is there any more');
SELECT abacus_region('field', $$VALUES ('pond', 2)$$);
SELECT is(abacus_region_at('field', 4.4, 4.3), 'pond', 'another one is');
SELECT pg_temp.is_right('after another has come');
ALTER TABLE field RENAME TO heath;
SELECT is((SELECT count(*) FROM field_cells WHERE region = 'pond'), (SELECT triangles FROM abacus_regions('heath') WHERE region = 'pond'), 'when the mesh has another name');
ALTER TABLE heath RENAME TO field;
ANALYZE field_cells;
SELECT is((SELECT n_distinct::int FROM pg_stats WHERE tablename = 'field_cells' AND attname = 'region'), 2, 'ANALYZE counts regions');
SELECT abacus_unregion('field', r) FROM unnest(ARRAY['farm', 'pond']) AS r;
SELECT is((SELECT count(region) FROM field_cells), 0::bigint, 'without regions the column is NULL');

-- tracking: the mesh follows its table, and the column the mesh
CREATE TABLE spot AS SELECT id, x, y FROM field_points;
SELECT abacus_triangulate('kept', 'SELECT * FROM spot', lines => 'SELECT l, n, p FROM (VALUES (1, ARRAY[11, 71, 77, 17, 11])) AS v (l, ids), unnest(ids) WITH ORDINALITY AS u (p, n)');
SELECT abacus_region('kept', $$VALUES ('inside', 1)$$);
SELECT abacus_track('kept', 'spot');
SELECT abacus_publish('kept', geometry => false);
INSERT INTO spot VALUES (2000, 4.1, 4.2), (2001, 0.1, 0.2);
DELETE FROM spot WHERE id BETWEEN 1020 AND 1040;
SELECT set_eq($$SELECT code, v0 FROM kept_cells WHERE region = 'inside'$$, $$SELECT code, v0 FROM abacus_simplices('kept', within => 'inside')$$, 'a tracked mesh');

-- an attribute of the same name gets a number
SELECT abacus_triangulate('named', 'SELECT 10 * x + y AS id, x, y, 7 AS region FROM generate_series(0, 3) AS x, generate_series(0, 3) AS y');
SELECT abacus_constrain('named', 'VALUES (1, 1, 11), (1, 2, 21), (1, 3, 22), (1, 4, 11)');
SELECT abacus_region('named', $$VALUES ('"it''s"', 1)$$);
SELECT abacus_publish('named', geometry => false);
SELECT is((SELECT region || region_2 FROM named_cells WHERE region IS NOT NULL), '"it''s"7', 'the attribute is region_2');

-- a reader of the mesh who may not read its regions
CREATE ROLE region_reader;
GRANT SELECT ON named, named_vertices, named_cells TO region_reader;
SET ROLE region_reader;
SELECT is((SELECT count(*) FROM (SELECT v0, v1, v2, corners FROM named_cells OFFSET 0) AS c), 18::bigint, 'may read all other columns');
SELECT throws_ok('SELECT region FROM named_cells', '42501', 'permission denied for table named_regions');
RESET ROLE;
CREATE VIEW region_view AS SELECT v0, region FROM named_cells;
GRANT SELECT ON region_view TO region_reader;
SET ROLE region_reader;
SELECT is((SELECT count(region) FROM region_view), 1::bigint, 'a view reads with the rights of its owner');
RESET ROLE;
GRANT SELECT ON named_regions TO region_reader;
SET ROLE region_reader;
SELECT is((SELECT count(region) FROM named_cells), 1::bigint, 'with SELECT the reader may');
RESET ROLE;
-- ANALYZE passes over a table whose owner may not read the regions
REVOKE SELECT ON named_regions FROM region_reader;
GRANT USAGE, CREATE ON SCHEMA public TO region_reader;
ALTER FOREIGN TABLE named_cells OWNER TO region_reader;
SELECT lives_ok('ANALYZE named_cells', 'ANALYZE of a table whose owner may not');
SELECT is((SELECT reltuples FROM pg_class WHERE oid = 'named_cells'::regclass), -1::real, 'skips it');

-- damage: a number without a name
DELETE FROM named_regions;
SELECT throws_ok('SELECT region FROM named_cells', 'XX001', NULL, 'a number without a name');

-- pictures
CREATE FUNCTION pg_temp.messages(command text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    plain text;
BEGIN
    SET LOCAL client_min_messages = error;
    EXECUTE command INTO plain;
    RETURN md5(plain);
END $$;
SELECT abacus_triangulate('park', 'SELECT 100 * x + y AS id, x, y, x + 2 * y AS h FROM generate_series(0, 40) AS x, generate_series(0, 40) AS y');
SELECT is(pg_temp.messages(format('SELECT %s', shown)), pg_temp.messages(format('SELECT %s', plain)), 'a mesh without lines and regions: ' || shown)
FROM (VALUES ($$abacus_draw('park', 60, regions => true, lines => true)$$, $$abacus_draw('park', 60)$$),
    ($$abacus_tile_picture('park', 0, 0, 0, world => '{0,0,40}', regions => true, lines => true)$$, $$abacus_tile_picture('park', 0, 0, 0, world => '{0,0,40}')$$)) AS v (shown, plain);
SELECT abacus_constrain('park', 'VALUES (1, 1, 505), (1, 2, 3505), (1, 3, 3535), (1, 4, 535), (1, 5, 505)');
SELECT abacus_constrain('park', 'VALUES (2, 1, 202), (2, 2, 3802)', kind => 'soft');
SELECT abacus_region('park', $$VALUES ('lawn', 1)$$);
CREATE TABLE picture AS SELECT call, wish, pg_temp.messages(format('SELECT %s%s)', call, wish)) AS hash
FROM unnest(ARRAY[$$abacus_draw('park', 60$$, $$abacus_draw('park', 60, attribute => 'h'$$, $$abacus_draw('park', 60, attribute => 'h', exaggeration => 1, edges => false, within => 'lawn'$$,
        $$abacus_draw('park', 60, lower => '{1,1}', upper => '{20,20}'$$, $$abacus_tile_picture('park', 0, 0, 0, world => '{0,0,40}', size => 60$$,
        $$abacus_tile_picture('park', 0, 0, 0, world => '{0,0,40}', size => 12$$, $$abacus_tile_picture('park', 0, 0, 0, world => '{0,0,40}', size => 12, attribute => 'h', range => '{0,120}'$$]) AS call,
    unnest(ARRAY['', ', regions => true', ', lines => true', ', regions => true, lines => true']) AS wish;
SELECT is((SELECT count(DISTINCT hash) FROM picture AS p WHERE p.call = c.call), 4::bigint, 'regions and lines are seen: ' || call) FROM (SELECT DISTINCT call FROM picture) AS c;
SELECT isnt(abacus_draw('park', 60, lines => true, lower => '{0,0}', upper => '{40,4}'), abacus_draw('park', 60, lower => '{0,0}', upper => '{40,4}'), 'a soft line is seen');
SELECT is(abacus_draw('park', 60, lines => NULL, regions => NULL), abacus_draw('park', 60), 'NULL is false');
SELECT is(abacus_draw('park', 60, regions => true, lower => '{36,36}', upper => '{40,40}'), abacus_draw('park', 60, lower => '{36,36}', upper => '{40,40}'), 'outside of regions nothing is tinted');
ALTER TABLE park RENAME TO green;
SELECT is(md5(abacus_draw('green', 60, regions => true)::text), (SELECT hash FROM picture WHERE call = $$abacus_draw('park', 60$$ AND wish = ', regions => true'), 'with another name of the mesh');
GRANT SELECT ON green, park_vertices TO region_reader;
SET ROLE region_reader;
SELECT lives_ok($$SELECT abacus_draw('green', 60, regions => true, lines => true)$$, 'pictures need no right to read the tables of lines and regions');
-- vector tiles have names of regions for those who may read them
SELECT is(position('lawn'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'a vector tile without names');
SELECT isnt(position('soft'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'but with fixed edges');
SELECT is(position('line'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'without their lines, which the reader may not read');
SELECT throws_ok($$SELECT abacus_region_at('green', 20, 20)$$, '42501', 'permission denied for table park_regions');
SELECT is(abacus_region_at('green', 1, 1), NULL, 'nothing is read where no region is');
RESET ROLE;
GRANT SELECT ON park_regions TO region_reader;
SET ROLE region_reader;
SELECT isnt(position('lawn'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'a vector tile names the region');
RESET ROLE;
SELECT is(position('lawn'::bytea IN abacus_tile_vector('green', 4, 0, 0, world => '{0,0,40}')), 0, 'but not where it is not');
SELECT isnt(position('soft'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'and has fixed edges');
SELECT isnt(position('line'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'with their lines for others');
SELECT is(position('hard'::bytea IN abacus_tile_vector('green', 4, 0, 15, world => '{0,0,40}')), 0, 'where they are');
SELECT set_config(name, 'on', true) FROM pg_settings WHERE name IN ('force_parallel_mode', 'debug_parallel_query');
SELECT isnt(position('line'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'in a parallel worker, too');
SELECT is(abacus_region_at('green', 20, 20), 'lawn', 'a region in a parallel worker');
SELECT set_config(name, 'off', true) FROM pg_settings WHERE name IN ('force_parallel_mode', 'debug_parallel_query');
SELECT abacus_unregion('green', 'lawn');
SELECT is(position('lawn'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'a region that has gone is in no tile');
SELECT abacus_unconstrain('green', 'VALUES (1), (2)');
SELECT is(position('fixed'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'nor are lines that have gone');
SELECT abacus_constrain('green', 'SELECT y, x, 100 * x + y FROM generate_series(1, 40) AS x, generate_series(1, 40) AS y');
SELECT isnt(position('line'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'many lines are told apart');
SET LOCAL work_mem = '64kB';
SELECT is(position('line'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'but not without room for them');
SELECT isnt(position('hard'::bytea IN abacus_tile_vector('green', 0, 0, 0, world => '{0,0,40}')), 0, 'when their edges are there all the same');
RESET work_mem;
SELECT is(pg_temp.messages($$SELECT abacus_draw('green', 60, regions => true)$$), md5(abacus_draw('green', 60)::text), 'a region that has gone');
SELECT abacus_octree_create('leaves', 2, '{0,0}', '{8,8}');
SELECT is(pg_temp.messages($$SELECT abacus_draw('leaves', 20, regions => true, lines => true)$$), md5(abacus_draw('leaves', 20)::text), 'an octree has neither');

SELECT finish();
ROLLBACK;

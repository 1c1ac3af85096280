-- Quadtrees and octrees: made, changed, read, extracted; refused where they are not what is asked for.
SELECT abacus_octree_create('quad', 2, '{0,0}', '{8,8}', '{v}', 10);
SELECT obj_description('quad'::regclass), obj_description('quad_vertices'::regclass);
SELECT * FROM abacus_octants('quad');
SELECT abacus_octree_from_points('quad', 'SELECT i, i % 4 + 0.5, i % 3 + 0.25, i FROM generate_series(1, 12) i', 1);
SELECT (abacus_octree_locate('quad', x, y)).* FROM (VALUES (0, 0), (1, 1), (8, 8), (7.999, 0), (-0.001, 0), (0, 8.001)) p(x, y);
SELECT count(*), sum((upper[1] - lower[1]) * (upper[2] - lower[2])) FROM abacus_octants('quad');
SELECT count(*) FROM abacus_check('quad');

-- one deep leaf: balanced, the least that it can be
SELECT abacus_octree_create('deep', 2, '{0,0}', '{1,1}');
SELECT abacus_octree_refine('deep', 'SELECT 6, 0.4999, 0.4999');
SELECT abacus_octree_nodes('deep') LIMIT 1;
BEGIN;
SELECT abacus_octree_balance('deep', 'faces');
ROLLBACK;
SELECT count(*) FROM abacus_octants('deep');
SELECT abacus_octree_balance('deep');
SELECT abacus_octree_balance('deep');
SELECT level, count(*) FROM abacus_octants('deep') GROUP BY level ORDER BY level;
SELECT max(abs(o.level - n.level)) FROM abacus_octants('deep') o, abacus_octree_neighbours('deep', o.code) n;
SELECT count(*) AS nodes, count(anchors) AS hanging FROM abacus_octree_nodes('deep');

-- a small one as a solver sees it
SELECT abacus_octree_create('cube', 3, '{0,0,0}', '{2,4,8}', '{a,b}');
SELECT abacus_octree_refine('cube', 'VALUES (1, 1, 1, 1), (2, 0, 0, 0)');
SELECT abacus_octree_update('cube', 'SELECT code, level, NULL FROM abacus_octants(''cube'')');
SELECT * FROM abacus_octree_nodes('cube') WHERE anchors IS NOT NULL ORDER BY node LIMIT 8;
SELECT count(*), count(anchors) FROM abacus_octree_nodes('cube');
SELECT * FROM abacus_octree_elements('cube') WHERE level = 1 OR element = 0;
SELECT e.element, i FROM abacus_octree_elements('cube') e, unnest(nodes) WITH ORDINALITY AS n(node, i)
JOIN abacus_octree_nodes('cube') p USING (node), abacus_octants('cube') o
WHERE o.code = e.code AND p.point <> ARRAY[CASE WHEN (i - 1) & 1 = 0 THEN o.lower[1] ELSE o.upper[1] END,
    CASE WHEN (i - 1) & 2 = 0 THEN o.lower[2] ELSE o.upper[2] END, CASE WHEN (i - 1) & 4 = 0 THEN o.lower[3] ELSE o.upper[3] END];
SELECT axis, side, level, lower, attributes FROM abacus_octree_neighbours('cube', (abacus_octree_locate('cube', 2, 0, 0)).code) ORDER BY axis, side, code;
SELECT code, level, lower, upper FROM abacus_octants('cube', ARRAY[0.5,1,2], ARRAY[0.5,1,2]);
SELECT count(*) FROM abacus_octants('cube', ARRAY[0.5,1,2], ARRAY[1.5,1.5,2.5]);
SELECT (SELECT count(*) FROM abacus_octants('cube', '{0.5,1,2}', '{1.5,1.5,2.5}')) AS texts, (SELECT count(*) FROM abacus_octants('cube', ARRAY[0.5,1,2], '{1.5,1.5,2.5}')) AS mixed,
       (SELECT count(*) FROM abacus_octants('cube', '{0.5,1,2}', 0)) AS ball;

-- merged again, with the mean of what its leaves had
SELECT abacus_octree_coarsen('cube', 'SELECT 1, 0.1, 0.1, 0.1');
SELECT level, attributes FROM abacus_octants('cube') LIMIT 1;
SELECT abacus_octree_coarsen('cube', 'SELECT 0, 0, 0, 0');
SELECT * FROM abacus_octants('cube');

-- leaf by leaf, in any order
SELECT abacus_octree_create('copy', 2, '{0,0}', '{8,8}', '{v}');
SELECT abacus_octree_update('quad', 'SELECT code, lower[1] + 10 * lower[2] FROM abacus_octants(''quad'')');
SELECT abacus_octree_from_rows('copy', 'SELECT code, level, attributes[1] FROM abacus_octants(''quad'') ORDER BY random()');
SELECT count(*) FROM (SELECT * FROM abacus_octants('quad') EXCEPT SELECT * FROM abacus_octants('copy')) d;
SELECT abacus_octree_from_rows('copy', 'SELECT code, level, attributes[1] FROM abacus_octants(''quad'')');
SELECT abacus_octree_create('gaps', 2, '{0,0}', '{8,8}');
SELECT abacus_octree_from_rows('gaps', 'SELECT code, level FROM abacus_octants(''quad'') OFFSET 1');
SELECT abacus_octree_from_rows('gaps', 'SELECT code, level FROM abacus_octants(''quad'') UNION ALL SELECT 0, 0');
SELECT abacus_octree_from_rows('gaps', 'SELECT 1, 0');
SELECT abacus_octree_from_rows('gaps', 'SELECT 0, 99');
SELECT abacus_octree_from_rows('gaps', 'SELECT 0, 0.5');
SELECT abacus_octree_from_rows('gaps', 'SELECT 0, NULL::int');
SELECT abacus_octree_from_rows('gaps', 'SELECT 0');
SELECT * FROM abacus_octants('gaps');

-- rows come to an octree that was merged into one leaf, over its empty pages, too
SELECT abacus_octree_coarsen('copy', 'SELECT 0, 0, 0');
SELECT abacus_octree_from_rows('copy', 'SELECT code, level, attributes[1] FROM abacus_octants(''quad'')');
SELECT count(*) FROM abacus_check('copy');

-- of several rows for a leaf the last
SELECT abacus_octree_update('copy', format('VALUES (%s, 1), (%s, 2), (%s, 3)', code + 5, code, code + 1)) FROM abacus_octants('copy') WHERE level < 5 LIMIT 1;
SELECT attributes FROM abacus_octants('copy') WHERE level < 5 LIMIT 1;

-- as fine as a query says, asked for many octants at once
SELECT abacus_octree_create('sized', 3, '{0,0,0}', '{1,1,1}', levels => 5);
SELECT abacus_octree_from_size('sized', 'SELECT array_agg(0.05 + x / 3 ORDER BY n) FROM unnest($1, $2, $3) WITH ORDINALITY AS c(x, y, z, n)');
SELECT count(*) FROM abacus_octants('sized') WHERE upper[1] - lower[1] > 0.05 + (lower[1] + upper[1]) / 6;
SELECT level, count(*) FROM abacus_octants('sized') GROUP BY level ORDER BY level;
SELECT abacus_octree_from_size('sized', 'SELECT ''{1,2}''::float8[] WHERE $1[1] + $2[1] + $3[1] > 0');
SELECT abacus_octree_from_size('sized', 'SELECT 1 WHERE $1[1] + $2[1] + $3[1] > 0');
SELECT abacus_octree_from_size('sized', 'SELECT $1[2:] WHERE $2[1] + $3[1] > 0');
SELECT abacus_octree_from_size('sized', 'SELECT array_agg(1 / 0 + x) FROM unnest($1) x WHERE $2[1] + $3[1] > 0');

-- a thin layer: told how long octants are, the query finds it; with samples, and what they miss
SELECT abacus_octree_create('thin', 3, '{0,0,-10000}', '{10000,10000,0}', levels => 6);
SELECT abacus_octree_from_size('thin', 'SELECT array_agg(CASE WHEN z > -50 THEN 300 ELSE 5000 END::float8) FROM unnest($3) z');
BEGIN;
SELECT abacus_octree_from_size('thin', 'SELECT array_agg(CASE WHEN z + edge / 2 > -50 THEN 300 ELSE 5000 END::float8 ORDER BY n) FROM unnest($3, $4) WITH ORDINALITY AS c(z, edge, n)');
SELECT count(*) FROM abacus_octants('thin') WHERE upper[3] > -50 AND upper[1] - lower[1] > 300;
ROLLBACK;
BEGIN;
SELECT abacus_octree_from_size('thin', 'SELECT array_agg(CASE WHEN z > -400 THEN 300 ELSE 5000 END::float8 ORDER BY n) FROM unnest($3) WITH ORDINALITY AS c(z, n)', samples => 8);
SELECT count(*) FROM abacus_octants('thin') WHERE upper[3] > -50 AND upper[1] - lower[1] > 300;
SELECT abacus_octree_from_size('thin', 'SELECT array_agg(100.0::float8 + z - z) FROM unnest($3) z', samples => 2);
ROLLBACK;
-- what a large octant has met is counted, where smaller ones miss it
SELECT abacus_octree_create('missed', 2, '{0,0}', '{1024,1024}');
SELECT abacus_octree_from_size('missed', 'SELECT array_agg(CASE WHEN x = 512 THEN 10 ELSE 600 END::float8 ORDER BY n) FROM unnest($1) WITH ORDINALITY AS c(x, n)');
SELECT abacus_octree_from_size('missed', 'SELECT $1 || $2 || $3', samples => 0);
SELECT abacus_octree_from_size('missed', 'SELECT $1 || $2 || $3', samples => 17);
DROP TABLE thin, missed;

-- memory does not grow with what is asked
CREATE TABLE used (bytes bigint);
CREATE FUNCTION note_use() RETURNS float8 LANGUAGE plpgsql AS $$
BEGIN
    INSERT INTO used SELECT sum(used_bytes) FROM pg_backend_memory_contexts WHERE name = 'SPI Proc';
    RETURN 0.002;
END $$;
SELECT abacus_octree_create('uniform', 2, '{0,0}', '{1,1}', levels => 9);
SELECT abacus_octree_from_size('uniform', 'SELECT array_fill(note_use(), ARRAY[cardinality($1 || $2) / 2])');
SELECT count(*) > 20, max(bytes) - min(bytes) < 100000 FROM used;
DROP TABLE uniform, used;
DROP FUNCTION note_use;

-- what is refused
SELECT abacus_octree_create('bad', 4, '{0,0}', '{1,1}');
SELECT abacus_octree_create('bad', 2, '{0,0}', '{0,1}');
SELECT abacus_octree_create('bad', 2, '{0}', '{1}');
SELECT abacus_octree_create('bad', 2, NULL, '{1,1}');
SELECT abacus_octree_create('bad', 2, '{-1e308,0}', '{1e308,1}');
SELECT abacus_octree_create('bad', 2, '{0,0}', '{1,1}', levels => 32);
SELECT abacus_octree_create('bad', 3, '{0,0,0}', '{1,1,1}', levels => 22);
SELECT abacus_octree_create('bad', 2, '{0,0}', '{1,1}', ARRAY(SELECT 'a' || i FROM generate_series(1, 1000) i));
SELECT abacus_octree_create(repeat('o', 60), 2, '{0,0}', '{1,1}');
SELECT abacus_octree_from_points('quad', 'SELECT 1, 9, 9', 1);
SELECT abacus_octree_from_points('quad', 'SELECT 1, 1, 1', 0);
SELECT abacus_octree_from_points('quad', 'SELECT 1, 1', 1);
SELECT abacus_octree_refine('quad', 'SELECT 11, 1, 1');
SELECT abacus_octree_refine('quad', 'SELECT -1, 1, 1');
SELECT abacus_octree_refine('quad', 'SELECT 1.5, 1, 1');
SELECT abacus_octree_refine('quad', 'SELECT 3, 1, 1, 1');
SELECT abacus_octree_balance('quad', 'edges');
SELECT abacus_octree_balance('sized', 'sides');
SELECT abacus_octree_update('quad', 'SELECT -1, 5');
SELECT abacus_octree_update('deep', 'SELECT 0');
SELECT abacus_octree_update('quad', 'SELECT 0, abacus_octree_balance(''quad'')');
SELECT abacus_octree_locate('quad', 1, 1, 1);
SELECT abacus_octree_locate('quad', 'NaN', 1);
SELECT abacus_octree_locate('quad', 'Infinity', 1) IS NULL;
SELECT * FROM abacus_octree_neighbours('quad', -1);
SELECT abacus_octants('quad', ARRAY[0,0], NULL::float8[]);

-- a mesh is no octree, and an octree no mesh
CREATE TABLE plain (i int);
SELECT abacus_triangulate('mesh', 'SELECT i, i % 3, i / 3 FROM generate_series(0, 8) i');
SELECT abacus_octree_locate('mesh', 1, 1);
SELECT * FROM abacus_octants('mesh');
SELECT abacus_octree_balance('mesh');
SELECT abacus_octree_locate('plain', 1, 1);
SELECT abacus_locate('quad', 1, 1);
SELECT abacus_insert('quad', 'SELECT 1, 1, 1');
SELECT * FROM abacus_simplices('quad');
SELECT * FROM abacus_vertices('quad');
SELECT abacus_draw_volume('quad', width => 100) IS NULL;
CALL abacus_build('quad');
SELECT (abacus_octree_locate('quad', 1, 1)).level, (abacus_locate('mesh', 1, 1)).v0 IS NOT NULL;

SELECT name, least, greatest, nulls FROM abacus_attributes('quad');
SELECT abacus_rename_attribute('quad', 'v', 'w');
SELECT name FROM abacus_attributes('quad');
SELECT abacus_rename_attribute('quad', 'v', 'w');
SELECT abacus_add_attribute('quad', 'u');
SELECT abacus_drop_attribute('quad', 'w');
SELECT abacus_set_srid('quad', 2154);
SELECT abacus_octree_coarsen('quad', 'SELECT 10, 1, 1');
SELECT abacus_srid('quad');
SELECT abacus_set_srid('quad', -1);

-- figures
SELECT name, value, description FROM abacus_stats('quad') WHERE name IN ('dimension', 'attributes', 'levels', 'leaves', 'stores', 'srid');
SELECT abacus_octree_create('counted', 2, '{0,0}', '{8,8}');
SELECT abacus_octree_refine('counted', 'SELECT 3, 1, 1');
SELECT abacus_octree_coarsen('counted', 'SELECT 2, 1, 1');
SELECT abacus_octree_balance('counted');
SELECT name, value, description FROM abacus_stats('counted') WHERE name IN ('created', 'deleted', 'loads', 'stores', 'rewrites');
SELECT sum((value > 0)::int) FROM abacus_stats('counted') WHERE name IN ('bytes_read', 'bytes_written', 'total_ns');
SELECT (SELECT sum(value) FROM abacus_stats('counted') WHERE name = 'created') - (SELECT sum(value) FROM abacus_stats('counted') WHERE name = 'deleted') = count(*) FROM abacus_octants('counted');
SELECT count(*) FROM abacus_stats('quad') WHERE name LIKE 'session_%';

-- damage is found
CREATE TABLE saved AS SELECT * FROM quad;
UPDATE quad SET page = overlay(page::bytea PLACING '\xff'::bytea FROM 60)::abacus_page WHERE code = 0;
SELECT * FROM abacus_check('quad');
SELECT abacus_octree_balance('quad');
SELECT count(*) FROM abacus_octants('quad');
UPDATE quad SET page = s.page FROM saved s WHERE s.code = quad.code;
SELECT count(*) FROM abacus_check('quad');
UPDATE quad SET code = 7 WHERE code = 0;
SELECT * FROM abacus_check('quad');
UPDATE quad SET code = 0 WHERE code = 7;
UPDATE quad SET page = substr(page::bytea, 1, 40)::abacus_page WHERE code = -1;
SELECT abacus_octree_locate('quad', 1, 1);
UPDATE quad SET page = '\x00'::bytea::abacus_page WHERE code = -1;
SELECT * FROM abacus_check('quad');
SELECT abacus_octree_locate('quad', 1, 1);
DELETE FROM quad WHERE code = -1;
SELECT abacus_octree_locate('quad', 1, 1);
INSERT INTO quad SELECT * FROM saved WHERE code = -1;

-- one that changes and is read again; moved by VACUUM; without a right, and with one to read
SELECT abacus_octree_from_points('deep', 'SELECT i, (i * 0.618) % 1, (i * 0.414) % 1 FROM generate_series(1, 20000) i', 5);
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level;
SELECT abacus_octree_coarsen('deep', 'SELECT 2, 0.3, 0.3');
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level;
VACUUM deep;
VACUUM FULL deep;
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level, (SELECT count(*) FROM abacus_check('deep')), (SELECT count(*) FROM abacus_octants('deep'));
CREATE ROLE abacus_octree_reader;
SET ROLE abacus_octree_reader;
SELECT abacus_octree_locate('deep', 0.3, 0.3);
SELECT abacus_octree_balance('deep');
RESET ROLE;
GRANT SELECT ON deep TO abacus_octree_reader;
SET ROLE abacus_octree_reader;
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level;
SELECT abacus_octree_balance('deep');
RESET ROLE;
DROP OWNED BY abacus_octree_reader;
DROP ROLE abacus_octree_reader;
BEGIN;
SAVEPOINT before;
SELECT abacus_octree_coarsen('deep', 'SELECT 0, 0, 0');
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level;
ROLLBACK TO before;
SELECT (abacus_octree_locate('deep', 0.3, 0.3)).level;
COMMIT;

DROP TABLE quad, deep, cube, copy, counted, gaps, sized, mesh, plain, saved;
SELECT count(*) FROM pg_class WHERE relname ~ '_vertices$' AND reloftype <> 0;

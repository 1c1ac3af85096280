-- Which column of a source query is taken for what: by position, and said where names tell otherwise.
CREATE TABLE measured AS SELECT i % 5 * 1.0 AS x, i / 5 * 1.0 AS y, i * 0.1 AS height, i AS id, i % 2 AS zone FROM generate_series(0, 24) i;
-- no id
SELECT abacus_triangulate('none', 'SELECT x, y, height FROM measured');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('none', 'SELECT x, y FROM measured');
SELECT abacus_triangulate('none', 'SELECT height::text AS id, x, y FROM measured');
SELECT abacus_triangulate('numbered', 'SELECT row_number() OVER (), x, y, height FROM measured');
SELECT abacus_insert('numbered', 'SELECT x, y, height FROM measured');
SELECT abacus_insert('numbered', 'SELECT id, x, y FROM measured');
-- another order is obeyed, but said
SELECT abacus_triangulate('early', 'SELECT x::bigint, y, height FROM measured');
SELECT abacus_triangulate('swapped', 'SELECT id, y, x FROM measured');
SELECT abacus_triangulate('globe', 'SELECT id, y AS lat, x AS "Lon" FROM measured');
SELECT abacus_triangulate('behind', 'SELECT id, height, zone, x, y FROM measured');
SELECT abacus_triangulate('high', 'SELECT id, x, height AS z, y FROM measured', dimension => 3);
SELECT count(*) FROM abacus_locate('swapped', 'SELECT id, y, x FROM measured');
SELECT abacus_octree_create('tree', 2, '{0,0}', '{8,8}');
SELECT abacus_octree_refine('tree', 'SELECT 1 AS level, y, x FROM measured LIMIT 1');
-- as it should be, or by names that say nothing
SELECT abacus_triangulate('right', 'SELECT id, x AS "X", y AS "Y", height AS lon FROM measured');
SELECT abacus_triangulate('plain', 'SELECT id, x, y FROM measured');
SELECT abacus_triangulate('other', 'SELECT id, x AS e, y AS n, x AS lon, y AS lat FROM measured');
-- z in the plane
SELECT abacus_triangulate('level', 'SELECT id, x, y, height AS z FROM measured');
SELECT abacus_triangulate('meant', 'SELECT id, x, y, height AS z FROM measured', '{z}');
SELECT abacus_locate('level', 1, 1, 1);
SELECT abacus_insert('plain', 'SELECT id, x, y, height AS z FROM measured');
-- labels that are not named
SELECT abacus_load('rock', 'SELECT id, x, y, height FROM measured', 'SELECT 0, 1, 5, 6, 7 AS material');
SELECT abacus_load('rock', 'SELECT id, x, y, height FROM measured', 'VALUES (0, 1, 5, 6, 7)');
SELECT abacus_load('rock', 'SELECT id, x, y, height FROM measured', 'VALUES (0, 1)');
SELECT abacus_load('rock', 'SELECT id, x, y, height FROM measured', 'SELECT 0, 1, 5, 7 AS material');
SELECT abacus_load('layer', 'SELECT id, x, y, height FROM measured', 'SELECT 0, 1, 5, 7 AS material', labels => '{material}');
DROP TABLE measured, numbered, early, swapped, globe, behind, high, plain, "right", other, level, meant, rock, layer, tree;

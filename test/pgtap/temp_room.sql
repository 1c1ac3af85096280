-- If the size of temporary files can be estimated, too large ones are refused before any is written.
BEGIN;
SELECT plan(22);

SET LOCAL work_mem = '64kB';
SET LOCAL maintenance_work_mem = '1MB';

SELECT setseed(0.25);
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y, random() AS z, random() AS h FROM generate_series(1, 30000) AS i;
SELECT abacus_triangulate('flat', 'SELECT id, x, y FROM points');
SELECT abacus_triangulate('solid', 'SELECT id, x, y, z, h FROM points WHERE id <= 10000', '{h}', dimension => 3);
SELECT abacus_octree_create('squares', 2, '{0,0}', '{1,1}');
SELECT abacus_octree_from_points('squares', 'SELECT id, x, y FROM points', 1);
SELECT abacus_octree_create('cubes', 3, '{0,0,0}', '{1,1,1}');
SELECT abacus_octree_from_points('cubes', 'SELECT id, x, y, z FROM points', 1);
SELECT abacus_octree_balance('cubes');

CREATE TABLE simplices AS SELECT * FROM abacus_simplices('solid') LIMIT 8000;
CREATE TEMP TABLE tried AS SELECT name, query FROM (VALUES
	('an alpha shape in the plane', $$SELECT count(*) FROM abacus_alpha_shape('flat', 1e-5)$$),
	('an outline in the plane', $$SELECT count(*) FROM abacus_hull('flat', max_edge => 0.009)$$),
	('an alpha shape in space', $$SELECT count(*) FROM abacus_alpha_shape('solid', 1e-3)$$),
	('an outline in space', $$SELECT count(*) FROM abacus_hull('solid', max_edge => 0.06)$$),
	('an isosurface', $$SELECT count(*) FROM abacus_isosurface('solid', 0.5, 'h')$$),
	('nodes', $$SELECT count(*) FROM abacus_octree_nodes('cubes')$$),
	('elements', $$SELECT count(*) FROM abacus_octree_elements('cubes')$$),
	('tetrahedra', $$SELECT count(*) FROM abacus_octree_tetrahedra('cubes')$$),
	('markers', $$SELECT count(*) FROM abacus_mark('solid', 'SELECT code, v0, v1, v2, v3, 0, 1 FROM simplices')$$),
	('octants to a level', $$SELECT abacus_octree_refine('squares', 'SELECT 20, x, y FROM points')$$),
	('octants for points', $$SELECT abacus_octree_from_points('squares', 'SELECT id, x + d, y FROM points, (VALUES (0), (1e-9)) AS shift(d) WHERE id <= 10000', 1)$$)) AS t(name, query);

CREATE FUNCTION pg_temp.message(query text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
	EXECUTE query;
	RETURN 'no error';
EXCEPTION WHEN configuration_limit_exceeded THEN RETURN SQLERRM;
END $$;
SET LOCAL temp_file_limit = '1MB';
SELECT is(pg_temp.message(query), 'temporary files would take more than temp_file_limit (1024 kB)', name) FROM tried;
SET LOCAL temp_file_limit = -1;
SELECT is(pg_temp.message(query), 'no error', name || ' where there is room') FROM tried;
SELECT * FROM finish();
ROLLBACK;

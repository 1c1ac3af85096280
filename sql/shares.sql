-- Parts of a mesh along the curve, and the share of a rank.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10), (2, 4, 0, 20), (3, 4, 4, 30), (4, 0, 4, NULL), (5, 2, 1, 50), (6, 1, 3, 5)', '{work}');
SELECT * FROM abacus_partition('field', 2);
SELECT * FROM abacus_partition('field', 2, 'work');
SELECT * FROM abacus_share_vertices('field', 2, 1);
SELECT v0, v1, v2, v3, owner, labels, markers FROM abacus_share_simplices('field', 2, 1) ORDER BY owner, v0, v1;
SELECT local, id, owner FROM abacus_share_vertices('field', 2, 1, 0);
SELECT count(*) FROM abacus_share_simplices('field', 2, 1, 0);
-- a weight by label; labels and markers are in the share
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, v0 AS soil FROM abacus_simplices(''field'')'), abacus_mark('field', 'SELECT code, v0, v1, v2, 0, 7 FROM abacus_simplices(''field'') WHERE v0 = 1');
SELECT * FROM abacus_partition('field', 2, 'soil');
SELECT v0, v1, v2, owner, labels, markers FROM abacus_share_simplices('field', 2, 0, 0, 'soil') ORDER BY v0, v1;
-- what is wrong
SELECT abacus_partition('field', 0);
SELECT abacus_partition('field', 2, 'rain');
SELECT abacus_share_vertices('field', 2, 2);
SELECT abacus_share_simplices('field', 2, 0, -1);
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, -1 AS debt FROM abacus_simplices(''field'')');
SELECT abacus_partition('field', 2, 'debt');
-- a step in place of attributes
SELECT abacus_store('field', 7, 2, p, format('SELECT id, 10 * x FROM abacus_share_vertices(''field'', 2, %s, 0) WHERE owner = %s', p, p)) > 0 AS stored FROM generate_series(0, 1) AS p;
SELECT abacus_interpolate('field', 3, 1, step => 7) AS of_step, id, "values" FROM abacus_interpolate('field', 'SELECT 1, 3, 1', '{1}', step => 7);
SELECT abacus_interpolate('field', 3, 1, '2', step => 7);
SELECT abacus_draw('field', step => 8);
SELECT abacus_store('field', 8, 2, 0, 'SELECT id, 1 FROM abacus_share_vertices(''field'', 2, 0, 0) WHERE owner = 0') > 0 AS half;
SELECT abacus_tile_picture('field', 0, 0, 0, world => '{0,0,4}', range => '{0,1}', step => 8);
DROP TABLE field;

-- Attributes of loaded meshes that are not Delaunay: other values, more and fewer attributes; compared with a
-- table of what each vertex should have.
BEGIN;
SELECT no_plan();
SET client_min_messages = warning;
-- Small pages and a small cache: many pages name one vertex.
SET abacus.cache_size = '1MB';

-- A grid of crooked squares with a hole, and bricks of five tetrahedra each, with a hole as well.
CREATE TABLE plane_node AS
SELECT 100 * i + j AS id, i::float8 AS x, j + 0.01 * i * (i % 3) AS y, (i + j)::float8 AS u
FROM generate_series(0, 60) AS i, generate_series(0, 60) AS j;
CREATE TABLE plane_element AS
SELECT v.*, i % 7 AS rock
FROM generate_series(0, 59) AS i, generate_series(0, 59) AS j,
     LATERAL (VALUES (100 * i + j, 100 * (i + 1) + j, 100 * (i + 1) + j + 1), (100 * i + j, 100 * (i + 1) + j + 1, 100 * i + j + 1)) AS v (v0, v1, v2)
WHERE NOT (i BETWEEN 20 AND 30 AND j BETWEEN 20 AND 30);
CREATE TABLE solid_node AS
SELECT 10000 * i + 100 * j + k AS id, i::float8 AS x, j::float8 AS y, k::float8 AS z, (i + j + k)::float8 AS u
FROM generate_series(0, 12) AS i, generate_series(0, 12) AS j, generate_series(0, 12) AS k;
CREATE TABLE solid_element AS
SELECT c[v[1]] AS v0, c[v[2]] AS v1, c[v[3]] AS v2, c[v[4]] AS v3, (i + j) % 5 AS rock
FROM generate_series(0, 11) AS i, generate_series(0, 11) AS j, generate_series(0, 11) AS k,
     LATERAL (SELECT array_agg(10000 * (i + a) + 100 * (j + b) + k + d ORDER BY a, b, d) AS c
              FROM generate_series(0, 1) AS a, generate_series(0, 1) AS b, generate_series(0, 1) AS d) AS corner,
     LATERAL (SELECT t::int[] AS v FROM unnest(CASE WHEN (i + j + k) % 2 = 0
         THEN ARRAY['{1,2,3,5}', '{4,2,3,8}', '{6,2,5,8}', '{7,3,5,8}', '{2,3,5,8}']
         ELSE ARRAY['{2,1,4,6}', '{3,1,4,7}', '{5,1,6,7}', '{8,4,6,7}', '{1,4,6,7}'] END) AS t) AS tetrahedron
WHERE NOT (i BETWEEN 4 AND 6 AND j BETWEEN 4 AND 6 AND k BETWEEN 4 AND 6);

SELECT abacus_load('plane', 'TABLE plane_node', 'TABLE plane_element', labels => '{rock}', facets => 'VALUES (0, 100, 9), (100, 201, 8)');
SELECT abacus_load('solid', 'TABLE solid_node', 'TABLE solid_element', labels => '{rock}');
SELECT is((SELECT value FROM abacus_stats(mesh) WHERE name = 'changeable'), 0::double precision, mesh || ' cannot have other points')
FROM (VALUES ('plane'::regclass), ('solid')) AS m (mesh);
CREATE TABLE expected AS
SELECT mesh, v.id, v.x, v.y, v.z, v.attributes FROM (VALUES ('plane'::regclass), ('solid')) AS m (mesh), abacus_vertices(mesh) AS v;
CREATE TABLE simplices AS SELECT 'plane'::regclass AS mesh, c.* FROM abacus_cells('plane') AS c UNION ALL SELECT 'solid', c.* FROM abacus_cells('solid') AS c;

-- What a mesh has: by its list of vertices, by the corners of its simplices, and sound.
CREATE FUNCTION pg_temp.holds(mesh regclass, what text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    RETURN NEXT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), mesh || ' is sound: ' || what);
    RETURN NEXT results_eq(format('SELECT id, attributes FROM abacus_vertices(%L) ORDER BY id', mesh),
                           format('SELECT id, attributes FROM expected WHERE mesh = %L::regclass ORDER BY id', mesh), mesh || ': ' || what);
    RETURN NEXT is_empty(format('SELECT code, v0, v1, v2, v3, labels FROM abacus_cells(%1$L) EXCEPT SELECT code, v0, v1, v2, v3, labels FROM simplices WHERE mesh = %1$L::regclass', mesh),
                         mesh || ' has its simplices with their labels: ' || what);
END $$;
CREATE FUNCTION pg_temp.each(what text, query text) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    mesh regclass;
BEGIN
    FOREACH mesh IN ARRAY '{plane,solid}'::regclass[] LOOP
        EXECUTE format(query, mesh);
        RETURN QUERY SELECT * FROM pg_temp.holds(mesh, what);
    END LOOP;
END $$;

UPDATE expected SET attributes = ARRAY[-id] WHERE id % 3 = 0;
SELECT * FROM pg_temp.each('a third of the values', $$ SELECT abacus_update('%1$s', 'SELECT id, x, y' || CASE '%1$s' WHEN 'solid' THEN ', z' ELSE '' END || ', -id AS u FROM expected WHERE mesh = ''%1$s''::regclass AND id %% 3 = 0') $$);
UPDATE expected SET attributes = attributes || '{NULL}';
SELECT * FROM pg_temp.each('one attribute more', $$ SELECT abacus_add_attribute('%s', 'v') $$);
UPDATE expected SET attributes[2] = sqrt(id);
SELECT * FROM pg_temp.each('it has values', $$ SELECT abacus_update('%1$s', 'SELECT id, x, y' || CASE '%1$s' WHEN 'solid' THEN ', z' ELSE '' END || ', sqrt(id) AS v FROM expected WHERE mesh = ''%1$s''::regclass') $$);
SELECT is(abacus_interpolate('plane', x, y, 'v'), attributes[2], 'the value at a vertex') FROM expected WHERE mesh = 'plane'::regclass AND id = 505;
UPDATE expected SET attributes = attributes[2:2];
SELECT * FROM pg_temp.each('the first one dropped', $$ SELECT abacus_drop_attribute('%s', 'u') $$);

-- So many that they are apart, and none.
UPDATE expected SET attributes = attributes || array_fill(NULL::float8, ARRAY[40]);
SELECT * FROM pg_temp.each('forty more', $$ DO 'BEGIN FOR i IN 1 .. 40 LOOP PERFORM abacus_add_attribute(''%s'', ''w'' || i); END LOOP; END' $$);
UPDATE expected SET attributes[41] = id / 8.0, attributes[2] = NULL;
SELECT * FROM pg_temp.each('the last one has values', $$ SELECT abacus_update('%1$s', 'SELECT id, x, y' || CASE '%1$s' WHEN 'solid' THEN ', z' ELSE '' END || ', id / 8.0 AS w40 FROM expected WHERE mesh = ''%1$s''::regclass') $$);
UPDATE expected SET attributes = attributes[40:41];
SELECT * FROM pg_temp.each('the last two stay', $$ DO 'BEGIN FOR i IN 1 .. 38 LOOP PERFORM abacus_drop_attribute(''%1$s'', ''w'' || i); END LOOP; PERFORM abacus_drop_attribute(''%1$s'', ''v''); END' $$);
UPDATE expected SET attributes = '{}';
SELECT * FROM pg_temp.each('none is left', $$ DO 'BEGIN PERFORM abacus_drop_attribute(''%1$s'', ''w39''); PERFORM abacus_drop_attribute(''%1$s'', ''w40''); END' $$);
SELECT results_eq($$ SELECT marker, v0, v1 FROM abacus_facets('plane') $$, $$ VALUES (8, 100::bigint, 201::bigint), (9, 0, 100) $$, 'markers stay');

-- Errors leave everything as it is.
SELECT abacus_add_attribute('plane', 'h');
SELECT throws_ok($$ SELECT abacus_update('plane', 'VALUES (1, 0, 0.5, 1)') $$, '42703', NULL, 'an attribute that is not there');
SELECT throws_ok($$ SELECT abacus_update('plane', 'SELECT 7, 0.25 AS x, 0.5 AS y, 1 AS h') $$, '22023', 'mesh "plane" has no point at the place of point 7, (0.25, 0.5)', 'no vertex there');
SELECT throws_ok($$ SELECT abacus_insert('plane', 'SELECT 7, 0.25, 0.5, 1') $$, '55000', 'the mesh is not a Delaunay triangulation', 'other points are refused');
SELECT throws_ok($$ SELECT abacus_delete('plane', 'SELECT 0, 0, 0') $$, '55000', 'the mesh is not a Delaunay triangulation', 'fewer as well');
SELECT is(abacus_update('plane', $$ VALUES (0, 0, 0, 1), (0, 0, 0, 2) $$), 2::bigint, 'of two rows') FROM (SELECT abacus_rename_attribute('plane', 'h', 'column4')) AS renamed;
SELECT is((SELECT attributes FROM abacus_vertices('plane') WHERE id = 0), '{2}', 'the last one counts');

-- Split nodes share a place: the id says which one is meant.
SELECT abacus_load('fault', 'VALUES (1, 0, 0, 0.0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 1, 0, 0), (5, 1, 1, 0), (6, 0, 1, 0)', 'VALUES (1, 2, 3), (4, 5, 6)', '{slip}', split_nodes => true);
SELECT is(abacus_update('fault', 'SELECT id, x, y, slip FROM (VALUES (2, 1, 0, 5), (6, 0, 1, 7)) AS m (id, x, y, slip)'), 2::bigint, 'each side by its id');
SELECT results_eq($$ SELECT id, attributes FROM abacus_vertices('fault') ORDER BY id $$,
                  $$ VALUES (1::bigint, '{0}'::float8[]), (2, '{5}'), (3, '{0}'), (4, '{0}'), (5, '{0}'), (6, '{7}') $$, 'the other side keeps its value');
SELECT is_empty($$ SELECT * FROM abacus_check('fault') $$, 'the fault is sound');
SELECT throws_ok($$ SELECT abacus_update('fault', 'SELECT 9 AS id, 1 AS x, 0 AS y, 5 AS slip') $$, '22023', 'mesh "fault" has no point at the place of point 9, (1, 0)', 'another id means none of them');
SELECT lives_ok($$ DO 'BEGIN FOR i IN 2 .. 100 LOOP PERFORM abacus_add_attribute(''fault'', ''a'' || i); END LOOP; END' $$, 'a hundred attributes');
SELECT is_empty($$ SELECT * FROM abacus_check('fault') $$, 'it is still sound');
SELECT is((SELECT attributes[1] FROM abacus_vertices('fault') WHERE id = 6), 7::float8, 'and has its values');
SELECT throws_ok($$ SELECT abacus_add_attribute('fault', 'more') $$, '54000', 'a mesh with split nodes can have at most 100 attributes', 'no more than that');

SELECT finish();
ROLLBACK;

-- abacus_load: the interface; meshes out and in again; holes; privileges.
BEGIN;
SELECT no_plan();

SELECT has_function('abacus_load', ARRAY['text', 'text', 'text', 'text[]', 'double precision[]', 'double precision[]', 'boolean', 'boolean', 'text[]', 'text', 'boolean', 'text', 'boolean'], 'abacus_load');
SELECT function_returns('abacus_load', 'bigint', 'it returns a number');
SELECT volatility_is('abacus_load', 'volatile', 'it changes things');
SELECT isnt(obj_description('abacus_load(text, text, text, text[], float8[], float8[], boolean, boolean, text[], text, boolean, text, boolean)'::regprocedure), NULL, 'it has a comment');

-- The same simplices and vertices, whatever the order of rows and corners.
CREATE FUNCTION pg_temp.simplices(mesh regclass) RETURNS TABLE (ids bigint[]) LANGUAGE sql AS
    $$ SELECT ARRAY(SELECT v FROM unnest(ARRAY[v0, v1, v2, v3]) AS v WHERE v IS NOT NULL ORDER BY v) FROM abacus_simplices(mesh) $$;

CREATE TABLE flat AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y, i * 0.5 AS height FROM generate_series(1, 4000) AS i;
SELECT abacus_triangulate('flat_mesh', 'TABLE flat');
SELECT is(abacus_load('flat_copy', 'SELECT id, x, y, height FROM flat ORDER BY random()',
                      'SELECT v2, v0, v1 FROM abacus_simplices(''flat_mesh'') ORDER BY random()'),
          (SELECT count(*) FROM abacus_simplices('flat_mesh')), 'all triangles');
SELECT set_eq($$ SELECT * FROM pg_temp.simplices('flat_copy') $$, $$ SELECT * FROM pg_temp.simplices('flat_mesh') $$, 'the same triangles');
SELECT set_eq($$ SELECT id, x, y, attributes FROM abacus_vertices('flat_copy') $$, $$ SELECT id, x, y, attributes FROM abacus_vertices('flat_mesh') $$, 'the same vertices');
SELECT is_empty($$ SELECT * FROM abacus_check('flat_copy') $$, 'sound');
SELECT is((SELECT value FROM abacus_stats('flat_copy') WHERE name = 'delaunay'), 1::float8, 'Delaunay');
SELECT is(abacus_insert('flat_copy', 'SELECT -id, x + 0.25, y + 0.25, 0 FROM flat WHERE id <= 500'), 500::bigint, 'points can be inserted');
SELECT is(abacus_delete('flat_copy', 'SELECT -id, x + 0.25, y + 0.25 FROM flat WHERE id <= 500'), 500::bigint, 'and deleted');
SELECT set_eq($$ SELECT * FROM pg_temp.simplices('flat_copy') $$, $$ SELECT * FROM pg_temp.simplices('flat_mesh') $$, 'the same triangles again');

CREATE TABLE solid AS SELECT i AS id, (i * 7919) % 109 AS x, (i * 104729) % 97 AS y, (i * 31337) % 101 AS z FROM generate_series(1, 1500) AS i;
SELECT abacus_triangulate('solid_mesh', 'TABLE solid', dimension => 3);
CREATE TABLE tetrahedra AS SELECT v0, v1, v2, v3 FROM abacus_simplices('solid_mesh');
SELECT is(abacus_load('solid_copy', 'TABLE solid', 'TABLE tetrahedra'), (SELECT count(*) FROM tetrahedra), 'all tetrahedra');
SELECT set_eq($$ SELECT * FROM pg_temp.simplices('solid_copy') $$, $$ SELECT * FROM pg_temp.simplices('solid_mesh') $$, 'the same tetrahedra');
SELECT is_empty($$ SELECT * FROM abacus_check('solid_copy') $$, 'sound');

-- With this many attributes only some tetrahedra fit into a page, and pages are cut within codes.
CREATE TABLE heavy AS SELECT solid.*, number.* FROM solid,
    LATERAL (SELECT array_agg(sqrt(id * 100 + i)) AS of FROM generate_series(1, 100) AS i) AS number;
SELECT is(abacus_load('heavy_copy', 'SELECT id, x, y, z, ' || string_agg(format('of[%s]', i), ', ') || ' FROM heavy', 'TABLE tetrahedra',
                      attributes => array_agg('a' || i)), (SELECT count(*) FROM tetrahedra), 'all tetrahedra with 100 attributes')
FROM generate_series(1, 100) AS i;
SELECT is_empty($$ SELECT * FROM abacus_check('heavy_copy') $$, 'sound with 100 attributes');
CREATE FUNCTION pg_temp.neighbours(mesh regclass) RETURNS TABLE (ids bigint[], beyond bigint, neighbour bigint[]) LANGUAGE sql AS
    $$ SELECT ARRAY[s.v0, s.v1, s.v2, s.v3], (ARRAY[s.v0, s.v1, s.v2, s.v3])[facet + 1], ARRAY[n.v0, n.v1, n.v2, n.v3]
       FROM abacus_simplices(mesh) AS s, generate_series(0, 3) AS facet, abacus_walk(mesh, s, facet) AS n $$;
SET LOCAL abacus.cache_size = '1MB';
SELECT set_eq($$ SELECT * FROM pg_temp.neighbours('heavy_copy') $$, $$ SELECT * FROM pg_temp.neighbours('solid_mesh') $$, 'the same neighbours');
RESET abacus.cache_size;

-- With holes: places are located exactly where a simplex is left.
CREATE TABLE left_over AS SELECT * FROM tetrahedra WHERE (v0 + v1 + v2 + v3) % 3 > 0;
SELECT is(abacus_load('holes', 'TABLE solid', 'TABLE left_over'), (SELECT count(*) FROM left_over), 'what is left over');
SELECT is_empty($$ SELECT * FROM abacus_check('holes') $$, 'sound with holes');
SELECT is((SELECT value FROM abacus_stats('holes') WHERE name = 'delaunay'), 0::float8, 'not Delaunay');
SELECT is_empty($$
    SELECT x, y, z
    FROM generate_series(3.1, 108, 9.7) AS x, generate_series(3.1, 96, 9.7) AS y, generate_series(3.1, 100, 9.7) AS z,
         abacus_locate('solid_mesh', x, y, z) AS whole, abacus_locate('holes', x, y, z) AS part
    WHERE (part.v0, part.v1, part.v2, part.v3) IS DISTINCT FROM
          CASE WHEN EXISTS (SELECT FROM left_over AS l WHERE (l.v0, l.v1, l.v2, l.v3) = (whole.v0, whole.v1, whole.v2, whole.v3))
               THEN (whole.v0, whole.v1, whole.v2, whole.v3) ELSE (NULL::bigint, NULL::bigint, NULL::bigint, NULL::bigint) END $$,
    'the same simplex as in the whole mesh, or none');

-- A cavity, with places in it, around it, at its border and outside, also on facets and vertices: with every
-- query.
SELECT abacus_triangulate('block', 'SELECT 10000 * x + 100 * y + z, x, y, z FROM generate_series(0, 10) x, generate_series(0, 10) y, generate_series(0, 10) z', dimension => 3);
CREATE TABLE block_vertex AS SELECT id, x, y, z FROM abacus_vertices('block');
CREATE TABLE shell AS SELECT v0, v1, v2, v3 FROM abacus_simplices('block') AS s
    WHERE EXISTS (SELECT FROM block_vertex WHERE id IN (v0, v1, v2, v3) AND NOT (x BETWEEN 3 AND 7 AND y BETWEEN 3 AND 7 AND z BETWEEN 3 AND 7));
SELECT is(abacus_load('hollow', 'TABLE block_vertex', 'TABLE shell'), (SELECT count(*) FROM shell), 'a block with a cavity');
CREATE TABLE place AS SELECT row_number() OVER () AS id, x, y, z
    FROM generate_series(-0.5, 10.5, 0.5) x, generate_series(2, 10.5, 0.5) y, generate_series(2, 8, 0.75) z;
CREATE TABLE expected_place AS
    SELECT p.id, l.v0 IS NOT NULL AS inside FROM place p LEFT JOIN LATERAL (SELECT 1 AS v0 WHERE x BETWEEN 0 AND 10 AND y BETWEEN 0 AND 10 AND z BETWEEN 0 AND 10
        AND NOT (x > 3 AND x < 7 AND y > 3 AND y < 7 AND z > 3 AND z < 7)) AS l ON true;
CREATE FUNCTION pg_temp.places_one_by_one() RETURNS TABLE (id bigint, code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint) LANGUAGE sql AS
    $$ SELECT p.id, s.* FROM place p LEFT JOIN LATERAL abacus_locate('hollow', x, y, z) s ON true $$;
SELECT bag_eq($$ SELECT id, v0 IS NOT NULL FROM pg_temp.places_one_by_one() $$, 'TABLE expected_place', 'in a simplex or not, one by one');
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('hollow', 'TABLE place') $$, $$ SELECT * FROM pg_temp.places_one_by_one() $$, 'the same in one call');
SET LOCAL abacus.cache_size = '1MB';
SELECT bag_eq($$ SELECT id, code, v0, v1, v2, v3 FROM abacus_locate('hollow', 'TABLE place') $$, $$ SELECT * FROM pg_temp.places_one_by_one() $$, 'and with a small cache');
RESET abacus.cache_size;
SELECT is_empty($$ SELECT id, v0, v1, v2, v3 FROM abacus_locate('hollow', 'TABLE place') WHERE v0 IS NOT NULL AND NOT EXISTS (SELECT FROM shell AS s WHERE (s.v0, s.v1, s.v2, s.v3) = (abacus_locate.v0, abacus_locate.v1, abacus_locate.v2, abacus_locate.v3)) $$, 'only tetrahedra that there are');
SELECT set_eq($$ SELECT id FROM abacus_vertices('holes') $$, $$ SELECT unnest(ARRAY[v0, v1, v2, v3]) FROM left_over $$, 'its vertices are listed');
SELECT throws_ok(format('SELECT %s', f), '55000', NULL, f || ' is refused')
FROM unnest(ARRAY[$$abacus_stage('holes', 'SELECT 0, 1, 2, 3')$$, $$abacus_triangulate('holes')$$,
                  $$abacus_insert('holes', 'SELECT 0, 1, 2, 3')$$, $$abacus_delete('holes', 'SELECT 0, 1, 2, 3')$$]) AS f;

-- The list of vertices is verified.
SAVEPOINT damage;
DELETE FROM holes_vertices WHERE first = (SELECT min(first) FROM holes_vertices);
SELECT isnt_empty($$ SELECT * FROM abacus_check('holes') $$, 'a page of the list is missing');
ROLLBACK TO damage;
UPDATE holes_vertices SET page = overlay(page::bytea PLACING '\xff' FROM 25)::abacus_page WHERE first = 0;
SELECT isnt_empty($$ SELECT * FROM abacus_check('holes') WHERE fault = 'vertex' $$, 'an id of the list is another');
ROLLBACK TO damage;
INSERT INTO holes_vertices SELECT first + 1, part, page FROM holes_vertices WHERE first = 0;
SELECT is((SELECT array_agg(ROW(fault, code, part)::text) FROM abacus_check('holes')), ARRAY['(point,1,0)'], 'a page of the list is there twice');
ROLLBACK TO damage;

-- The list is in order even if vertices share a code and have negative coordinates.
SELECT is(abacus_load('outskirts', 'VALUES (1, -2, -2), (2, -1, -2), (3, -2, -1), (4, -1, 5)', 'VALUES (1, 2, 4), (1, 4, 3)',
                      lower => '{0, 0}', upper => '{9, 9}'), 2::bigint, 'all vertices outside of the domain');
SELECT is_empty($$ SELECT * FROM abacus_check('outskirts') $$, 'sound outside of the domain');

-- A given domain is widened if many vertices lie outside, but not for a few.
SELECT abacus_load('elsewhere', 'TABLE flat', 'SELECT v0, v1, v2 FROM abacus_simplices(''flat_mesh'') WHERE v0 > 9', '{height}', '{5000, 5000}', '{6000, 6000}');
SELECT cmp_ok((SELECT count(DISTINCT code) FROM abacus_simplices('elsewhere')), '>', 1000::bigint, 'places on the curve, not one');
SELECT is_empty($$ SELECT * FROM abacus_check('elsewhere') $$, 'sound elsewhere');
SELECT is((SELECT value FROM abacus_stats('outskirts') WHERE name = 'outside'), 4::float8, 'a few outside are counted');

-- Without the right to read the source, it cannot be loaded.
CREATE ROLE abacus_reader;
GRANT CREATE ON SCHEMA public TO abacus_reader;
SET LOCAL ROLE abacus_reader;
SELECT throws_ok($$ SELECT abacus_load('mine', 'SELECT 1, 0, 0', 'SELECT v0, v1, v2 FROM triangles_of_others') $$, '42P01', NULL, 'no such table');
SELECT throws_ok($$ SELECT abacus_load('mine', 'TABLE flat', 'SELECT 1, 2, 3') $$, '42501', NULL, 'no privilege on the vertices');
SELECT lives_ok($$ SELECT abacus_load('mine', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)', 'VALUES (3, 2, 1)') $$, 'a mesh of one''s own');
RESET ROLE;

SELECT * FROM finish();
ROLLBACK;

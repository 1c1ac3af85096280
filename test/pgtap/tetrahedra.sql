-- Meshes of dimension 3 compared with dimension 2: the same rules for arguments, privileges, transactions and
-- damage, and the same answers however they are built.
BEGIN;
SELECT no_plan();

CREATE FUNCTION pg_temp.state(command text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN '00000';
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;

-- 0 to 7 points on the moment curve; no four of them are coplanar
SELECT is(abacus_triangulate('few' || n, format('SELECT i, i, i * i, i * i * i FROM generate_series(1, %s) i', n), dimension => 3) > 0,
          n >= 4, n || ' points in general position') FROM generate_series(0, 7) n;
SELECT is_empty(format('SELECT * FROM abacus_check(''few%s'')', n), n || ' points checked') FROM generate_series(0, 7) n;
SELECT is((SELECT count(*) FROM abacus_simplices(('few' || n)::regclass)),
          (SELECT value::bigint FROM abacus_stats(('few' || n)::regclass) WHERE name = 'simplices'), n || ' points listed')
FROM generate_series(0, 7) n;

-- arguments, one at a time
SELECT is(pg_temp.state(c), s, c) FROM (VALUES
    ('SELECT abacus_locate(''few5'', 1, 2)', '22023'),
    ('SELECT abacus_locate(''few5'', 1, 2, 3)', '00000'),
    ('SELECT abacus_locate(''few5'', 1, 2, ''NaN'')', '22023'),
    ('SELECT abacus_locate(''few5'', ''NaN'', 2, 3)', '22023'),
    ('SELECT abacus_walk(''few5'', ROW(1,2,3,4,NULL)::abacus_simplex, 0)', '22004'),
    ('SELECT abacus_walk(''few5'', ROW(NULL,1,2,3,4)::abacus_simplex, 0)', '22004'),
    ('SELECT abacus_walk(''few5'', ROW(1,2,3,4,5)::abacus_simplex, 4)', '22023'),
    ('SELECT abacus_walk(''few5'', ROW(-1,1,2,3,4)::abacus_simplex, 0)', '22023'),
    ('SELECT abacus_walk(''few5'', ROW(1,1,1,1,1)::abacus_simplex, 0)', '22023'),
    ('SELECT abacus_stage(''few5'', ''SELECT 1, 2, 3'')', '42804'),
    ('SELECT abacus_stage(''few5'', ''SELECT 1, 2, 3, 4, 5'')', '42804'),
    ('SELECT abacus_stage(''few5'', ''SELECT 1, 2, 3, true'')', '42804'),
    ('SELECT abacus_stage(''few5'', ''SELECT 1, 2, 3, NULL::float8'')', '22004'),
    ('SELECT abacus_stage(''few5'', ''SELECT 1, 2, 3, 1e309::numeric'')', '22023'),
    ('SELECT abacus_triangulate(''bad'', ''SELECT 1, 2, 3, 4'', dimension => 4)', '22023'),
    ('SELECT abacus_triangulate(''bad'', ''SELECT 1, 2, 3, 4'', dimension => NULL)', '22004'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0,0}'')', '22023'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0}'', upper => ''{1,1,1}'')', '2202E'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0,0}'', upper => ''{1,1}'')', '2202E'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{{0,0,0}}'', upper => ''{{1,1,1}}'')', '2202E'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0,NULL}'', upper => ''{1,1,1}'')', '2202E'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0,NaN}'', upper => ''{1,1,1}'')', '22023'),
    ('SELECT abacus_create(''bad'', 3, lower => ''{0,0,1}'', upper => ''{1,1,1}'')', '22023'),
    ('SELECT abacus_draw(''few5'')', '22023')
) AS t (c, s);
SELECT is(abacus_locate('few5', a, b, c), NULL, format('locate at %s, %s, %s', a, b, c))
FROM (VALUES (NULL, 1, 1), (1, NULL, 1), (1, 1, NULL), ('Infinity'::float8, 1, 1), (1, '-Infinity', 1), (1, 1, 'Infinity'),
             (1e308, -1e308, 1e308), (1 - 1e-15, 1, 1), (5e-324, 0, 0)) AS t (a, b, c);
SELECT is(abacus_walk('few5', NULL, 0), NULL, 'walk from NULL');
SELECT is(abacus_walk('few5', ROW(NULL, NULL, NULL, NULL, NULL)::abacus_simplex, 0), NULL, 'walk from a row of NULLs');

-- each vertex is a corner of the tetrahedron where it lies
SELECT ok(v.id IN (s.v0, s.v1, s.v2, s.v3), format('vertex %s', v.id))
FROM abacus_vertices('few7') AS v, abacus_locate('few7', v.x, v.y, v.z) AS s;

-- one set of points, with duplicates, built in many ways: the same tetrahedra, no fault
CREATE TABLE points AS
SELECT i AS id, (i * 7919) % 13 AS x, (i * 104729) % 17 AS y, (i::bigint * 1299709) % 11 AS z, sin(i) AS vs FROM generate_series(1, 2500) i;
CREATE FUNCTION pg_temp.content(mesh regclass) RETURNS text LANGUAGE sql AS $$
    SELECT md5(string_agg(corners::text, ' ' ORDER BY corners))
    FROM (SELECT array_agg((x, y, z) ORDER BY x, y, z) AS corners
          FROM (SELECT row_number() OVER () AS n, s.* FROM abacus_simplices(mesh) AS s) AS s,
               unnest(ARRAY[v0, v1, v2, v3]) AS v JOIN points ON id = v GROUP BY n) AS t
$$;
SELECT ok(abacus_triangulate('at_once', 'TABLE points', dimension => 3) > 0, 'at once');
CREATE TABLE ways (mesh text, query text, cache text, lower float8[], upper float8[]);
INSERT INTO ways VALUES
    ('backwards', 'SELECT * FROM points ORDER BY id DESC', '128MB', NULL, NULL),
    ('shuffled', 'SELECT * FROM points ORDER BY md5(id::text)', '1MB', NULL, NULL),
    ('by_height', 'SELECT * FROM points ORDER BY z, id', '1MB', NULL, NULL),
    ('small_domain', 'TABLE points', '1MB', '{5,5,5}', '{5.5,5.5,5.5}'),
    ('far_domain', 'TABLE points', '1MB', '{1000,1000,1000}', '{1001,1001,1001}'),
    ('large_domain', 'TABLE points', '1MB', '{-1e307,-1e307,-1e307}', '{1e307,1e307,1e307}');
SELECT ok(set_config('abacus.cache_size', cache, true) = cache AND abacus_triangulate(mesh, query, dimension => 3, lower => lower, upper => upper) > 0, mesh) FROM ways;
SELECT is(pg_temp.content(mesh::regclass), pg_temp.content('at_once'), mesh || ' makes the same mesh') FROM ways;
SELECT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), mesh || ' is sound') FROM ways;
SELECT isnt(abacus_create('in_steps', 3, '{vs}'), NULL, 'in steps');
SELECT ok(abacus_stage('in_steps', format('SELECT * FROM points WHERE id %% 9 = %s', i)) > 0 AND abacus_triangulate('in_steps') >= 0, 'step ' || i)
FROM generate_series(0, 8) i;
SELECT is(pg_temp.content('in_steps'), pg_temp.content('at_once'), 'nine steps make the same mesh');
SELECT is_empty('SELECT * FROM abacus_check(''in_steps'')', 'and a sound one');
-- every point is traced to a vertex at its place, with its attributes kept
SELECT is_empty($$ SELECT v.id FROM abacus_vertices('in_steps') AS v JOIN points AS p ON p.id = v.id JOIN points AS q ON q.id = v.vertex
                   WHERE (v.x, v.y, v.z, v.attributes[1]) <> (p.x, p.y, p.z, p.vs) OR (q.x, q.y, q.z) <> (p.x, p.y, p.z) $$, 'vertices of all points');
SELECT is((SELECT count(DISTINCT vertex) FROM abacus_vertices('in_steps')), (SELECT count(*) FROM (SELECT DISTINCT x, y, z FROM points) t), 'one for each place');

-- transactions: to a savepoint and back
SAVEPOINT before;
SELECT is(abacus_stage('in_steps', 'SELECT 9000, 50, 50, 50, 0'), 1::bigint, 'a point far out');
SELECT ok(abacus_triangulate('in_steps') > 0, 'is inserted');
SELECT isnt(abacus_locate('in_steps', 30, 30, 30), NULL, 'and seen');
ROLLBACK TO before;
SELECT is(abacus_locate('in_steps', 30, 30, 30), NULL, 'and taken back');
SELECT is(pg_temp.content('in_steps'), pg_temp.content('at_once'), 'as if it had never been');

-- privileges and row-level security do not depend on the dimension
CREATE ROLE abacus_solid_reader;
SELECT is(pg_temp.state('SET LOCAL ROLE abacus_solid_reader; SELECT ' || f), s, f || ' without a privilege') FROM (VALUES
    ('abacus_locate(''in_steps'', 1, 1, 1)', '42501'), ('count(*) FROM abacus_simplices(''in_steps'')', '42501'),
    ('count(*) FROM abacus_vertices(''in_steps'')', '42501'), ('count(*) FROM abacus_check(''in_steps'')', '42501'),
    ('count(*) FROM abacus_stats(''in_steps'')', '42501'), ('abacus_draw(''in_steps'')', '42501'),
    ('abacus_walk(''in_steps'', ROW(1,2,3,4,5)::abacus_simplex, 0)', '42501'),
    ('abacus_stage(''in_steps'', ''SELECT 1, 2, 3, 4, 5'')', '42501'), ('abacus_triangulate(''in_steps'')', '42501')) AS t (f, s);
GRANT SELECT ON in_steps TO abacus_solid_reader;
SET LOCAL ROLE abacus_solid_reader;
SELECT isnt(abacus_locate('in_steps', 1, 1, 1), NULL, 'with SELECT it locates');
RESET ROLE;
ALTER TABLE in_steps ENABLE ROW LEVEL SECURITY;
SELECT is(pg_temp.state('SET LOCAL ROLE abacus_solid_reader; SELECT abacus_locate(''in_steps'', 1, 1, 1)'), '0A000', 'row-level security');
RESET ROLE;

-- a copy made with SQL is a mesh, and can grow
CREATE TABLE by_hand OF abacus_simplex_page (PRIMARY KEY (code, part));
CREATE TABLE by_hand_vertices OF abacus_vertex_page (PRIMARY KEY (first, part));
INSERT INTO by_hand SELECT * FROM at_once;
INSERT INTO by_hand_vertices SELECT * FROM at_once_vertices;
SELECT is(abacus_stage('by_hand', 'SELECT 9001, 5.5, 5.5, 20, 0'), 1::bigint, 'a copy takes points');
SELECT ok(abacus_triangulate('by_hand') > 0, 'and tetrahedra');
SELECT is_empty('SELECT * FROM abacus_check(''by_hand'')', 'and stays sound');

SELECT * FROM finish();
ROLLBACK;

-- Hard and soft lines: what natural neighbours see, and which kind an edge has while lines come and go.
BEGIN;
SELECT no_plan();

SELECT setseed(0.75);
CREATE TABLE point AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 600) AS i;
CREATE VIEW height AS SELECT *, sin(9 * x) * cos(7 * y) AS h, 3 * x - 2 * y + 1 AS plane FROM point;
SELECT abacus_triangulate('coarse', 'SELECT * FROM point WHERE id % 15 = 0');
-- long edges that do not cross, each a line; every other one is soft
CREATE TABLE segment AS SELECT row_number() OVER (ORDER BY v0, v1) AS line, v0, v1 FROM abacus_edges('coarse') ORDER BY v0, v1;
CREATE TABLE corner AS SELECT line, 1 AS position, v0 AS point FROM segment UNION ALL SELECT line, 2, v1 FROM segment;
CREATE TABLE place AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 3000) AS i;

SELECT abacus_triangulate('hard', 'TABLE height');
SELECT abacus_constrain('hard', 'SELECT * FROM corner WHERE line % 2 = 0');
SELECT abacus_triangulate('field', 'TABLE height');
SELECT abacus_constrain('field', 'SELECT * FROM corner WHERE line % 2 = 0');
SELECT abacus_constrain('field', 'SELECT * FROM corner WHERE line % 2 = 1', kind => 'soft');

CREATE FUNCTION pg_temp.natural(mesh regclass) RETURNS text LANGUAGE sql AS $$
    SELECT md5(string_agg(w::text, ';' ORDER BY w.id, w.vertex)) FROM abacus_weights(mesh, 'TABLE place', method => 'natural') AS w $$;
CREATE FUNCTION pg_temp.linear(mesh regclass) RETURNS text LANGUAGE sql AS $$
    SELECT md5(string_agg(w::text, ';' ORDER BY w.id, w.vertex)) FROM abacus_weights(mesh, 'TABLE place') AS w $$;
CREATE FUNCTION pg_temp.kinds(mesh regclass) RETURNS text LANGUAGE sql AS $$
    SELECT string_agg(kind || ' ' || n, ', ' ORDER BY kind) FROM (SELECT kind, count(*) AS n FROM abacus_edges(mesh, fixed => true) GROUP BY kind) AS s $$;

SELECT is(pg_temp.kinds('field'), format('hard %s, soft %s', count(*) FILTER (WHERE line % 2 = 0), count(*) FILTER (WHERE line % 2 = 1)), 'edges of both kinds') FROM segment;
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows them');
SELECT is(pg_temp.natural('field'), pg_temp.natural('hard'), 'natural neighbours see across soft lines, to the last bit');
SELECT isnt(pg_temp.linear('field'), pg_temp.linear('hard'), 'linear values follow the triangles');
SET LOCAL abacus.threads = 3;
SET LOCAL abacus.cache_size = '1MB';
SELECT is(pg_temp.natural('field'), pg_temp.natural('hard'), 'the same by several threads');
RESET abacus.threads;
RESET abacus.cache_size;
SELECT cmp_ok(max(abs(v.values[2] - (3 * x - 2 * y + 1))), '<', 1e-9::float8, 'linear data come back')
    FROM abacus_interpolate('field', 'TABLE place', method => 'natural') AS v JOIN place USING (id) WHERE v.values IS NOT NULL;
-- an edge of both kinds is hard, and soft again when the hard line goes
SELECT abacus_constrain('field', 'SELECT line + 1000, position, point FROM corner WHERE line % 2 = 1');
SELECT is(pg_temp.kinds('field'), 'hard ' || count(*), 'hard lines over the soft ones') FROM segment;
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
SELECT isnt(pg_temp.natural('field'), pg_temp.natural('hard'), 'they end what natural neighbours see');
SELECT abacus_constrain('hard', 'SELECT * FROM corner WHERE line % 2 = 1');
SELECT is(pg_temp.natural('field'), pg_temp.natural('hard'), 'as hard lines alone do');
SELECT abacus_unconstrain('field', 'SELECT line + 1000 FROM segment WHERE line % 2 = 1');
SELECT abacus_unconstrain('hard', 'SELECT line FROM segment WHERE line % 2 = 1');
SELECT is(pg_temp.kinds('field'), format('hard %s, soft %s', count(*) FILTER (WHERE line % 2 = 0), count(*) FILTER (WHERE line % 2 = 1)), 'soft again') FROM segment;
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
SELECT is(pg_temp.natural('field'), pg_temp.natural('hard'), 'natural neighbours see across them');
-- soft lines over hard ones change nothing
SELECT abacus_constrain('field', 'SELECT line + 1000, position, point FROM corner WHERE line % 2 = 0', kind => 'soft');
SELECT is(pg_temp.natural('field'), pg_temp.natural('hard'), 'soft lines over hard ones');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
-- lines that are replaced by others of another kind
SELECT abacus_constrain('field', 'SELECT * FROM corner WHERE line % 2 = 0', kind => 'soft', existing => 'replace');
SELECT is(pg_temp.kinds('field'), 'soft ' || count(*), 'all are soft') FROM segment;
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
SELECT abacus_triangulate('bare', 'TABLE height');
SELECT is(pg_temp.natural('field'), pg_temp.natural('bare'), 'natural neighbours of the points alone');
-- points on soft edges come and go: their parts are soft
CREATE TABLE later AS SELECT 10000 + line AS id, (p.x + q.x) / 2 AS x, (p.y + q.y) / 2 AS y, 0::float8 AS h, 0::float8 AS plane FROM segment JOIN point AS p ON p.id = v0 JOIN point AS q ON q.id = v1 WHERE line % 3 = 0;
SELECT abacus_insert('field', 'TABLE later');
SELECT abacus_insert('bare', 'TABLE later');
SELECT is(pg_temp.natural('field'), pg_temp.natural('bare'), 'with points on some of them');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
SELECT abacus_delete('field', 'SELECT id, x, y FROM later');
SELECT abacus_delete('bare', 'SELECT id, x, y FROM later');
SELECT is(pg_temp.natural('field'), pg_temp.natural('bare'), 'and without');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'the mesh knows it');
-- lines of both kinds that wait
SELECT abacus_create('waits', 2, ARRAY['h', 'plane']);
SELECT abacus_stage('waits', 'TABLE height');
SELECT abacus_constrain('waits', 'SELECT * FROM corner WHERE line % 2 = 0');
SELECT abacus_constrain('waits', 'SELECT * FROM corner WHERE line % 2 = 1', kind => 'soft');
SELECT abacus_insert('waits', 'SELECT * FROM height WHERE false');
SELECT is(pg_temp.natural('waits'), pg_temp.natural('hard'), 'lines of both kinds that have waited');
SELECT is_empty($$ SELECT * FROM abacus_check('waits') $$, 'the mesh knows them');

SELECT * FROM finish();
ROLLBACK;

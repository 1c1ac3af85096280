-- Markers of fixed edges: the parts of a split edge inherit them, and so does an edge that is joined again.
BEGIN;
SELECT no_plan();

-- a line along y = 0, and points on both sides
SELECT abacus_triangulate('shore', $$VALUES (1, 0, 0), (2, 1000, 0), (3, 500, 700), (4, 400, -600), (5, -300, -500), (6, 1300, 800), (7, -200, 900)$$);
SELECT abacus_constrain('shore', 'VALUES (10, 1, 1), (10, 2, 2)');

CREATE FUNCTION pg_temp.mark(a bigint, b bigint, marker integer) RETURNS bigint LANGUAGE sql AS $$
    SELECT abacus_mark('shore', format('SELECT code, v0, v1, v2, f, %s FROM abacus_simplices(''shore''), generate_series(0, 2) AS f
        WHERE ARRAY[%s::bigint, %s] <@ ARRAY[v0, v1, v2] AND NOT (ARRAY[v0, v1, v2])[f + 1] = ANY (ARRAY[%2$s::bigint, %3$s])', coalesce(marker::text, 'NULL::int'), a, b)) $$;
CREATE FUNCTION pg_temp.marked() RETURNS text LANGUAGE sql AS $$
    SELECT string_agg(format('%s-%s:%s', least(v0, v1), greatest(v0, v1), marker), ' ' ORDER BY least(v0, v1), greatest(v0, v1)) FROM abacus_facets('shore') $$;

SELECT pg_temp.mark(1, 2, 7);
SELECT is(pg_temp.marked(), '1-2:7', 'one edge');
SELECT abacus_insert('shore', 'VALUES (20, 300, 0)');
SELECT is(pg_temp.marked(), '1-20:7 2-20:7', 'a point splits it: both parts inherit');
SELECT abacus_insert('shore', 'VALUES (21, 100, 0), (22, 900, 0), (23, 200, 0)');
SELECT is(pg_temp.marked(), '1-21:7 2-22:7 20-22:7 20-23:7 21-23:7', 'several points at once');
SELECT is((SELECT count(*) FROM abacus_check('shore')), 0::bigint, 'both sides agree');
SELECT abacus_delete('shore', 'VALUES (23, 200, 0)');
SELECT is(pg_temp.marked(), '1-21:7 2-22:7 20-21:7 20-22:7', 'a point goes: the joined edge inherits');
SELECT pg_temp.mark(20, 22, 8);
SELECT abacus_delete('shore', 'VALUES (22, 900, 0)');
SELECT is(pg_temp.marked(), '1-21:7 20-21:7', 'parts with two markers: the joined edge has none');
SELECT pg_temp.mark(2, 20, 7);
SELECT abacus_delete('shore', 'VALUES (20, 300, 0), (21, 100, 0)');
SELECT is(pg_temp.marked(), '1-2:7', 'all points go at once');
SELECT abacus_insert('shore', 'VALUES (20, 300, 0)');
SELECT pg_temp.mark(2, 20, NULL);
SELECT is(pg_temp.marked(), '1-20:7', 'one part without a marker');
SELECT abacus_delete('shore', 'VALUES (20, 300, 0)');
SELECT is(pg_temp.marked(), NULL, 'a joined edge inherits only what all its parts have');
SELECT pg_temp.mark(1, 2, 7);
SELECT abacus_unconstrain('shore', 'VALUES (10)');
SELECT is(pg_temp.marked(), '1-2:7', 'a free edge keeps its marker while it is there');
SELECT abacus_insert('shore', 'VALUES (20, 300, 0)');
SELECT is(pg_temp.marked(), NULL, 'the parts of a free edge inherit none');
SELECT is((SELECT count(*) FROM abacus_check('shore')), 0::bigint, 'both sides agree');

-- edges of the hull
DROP TABLE shore CASCADE;
SELECT abacus_triangulate('shore', 'VALUES (1, 0, 0), (2, 1000, 0), (3, 1000, 700), (4, 0, 700), (5, 480, 350)');
SELECT abacus_constrain('shore', 'VALUES (10, 1, 1), (10, 2, 2), (10, 3, 3), (10, 4, 4), (10, 5, 1)');
SELECT pg_temp.mark(a, b, 7) FROM (VALUES (1, 2), (2, 3), (3, 4), (4, 1)) AS e (a, b);
SELECT abacus_insert('shore', 'VALUES (20, 300, 0), (21, 1000, 300), (22, 300, 700), (23, 0, 300), (24, 700, 0)');
SELECT is(pg_temp.marked(), '1-20:7 1-23:7 2-21:7 2-24:7 3-21:7 3-22:7 4-22:7 4-23:7 20-24:7', 'points split edges of the hull');
SELECT abacus_delete('shore', 'VALUES (20, 300, 0), (21, 1000, 300), (22, 300, 700), (23, 0, 300), (24, 700, 0)');
SELECT is(pg_temp.marked(), '1-2:7 1-4:7 2-3:7 3-4:7', '... and go');

-- what is left of an edge inherits, whichever part that is
DROP TABLE shore CASCADE;
CREATE TABLE bank (id int PRIMARY KEY, x float8, y float8);
INSERT INTO bank VALUES (1, 0, 0), (2, 1000, 0), (3, 500, 700), (4, 400, -600), (5, -300, -500), (6, 1300, 800), (7, -200, 900), (8, 1200, -300), (9, 500, 2), (10, 501, -2);
SELECT abacus_triangulate('shore', 'TABLE bank');
CREATE FUNCTION pg_temp.left_over(a float8, b float8) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_constrain('shore', 'VALUES (10, 1, 1), (10, 2, 2)', existing => 'replace');
    PERFORM pg_temp.mark(1, 2, 7);
    PERFORM abacus_constrain('shore', format('VALUES (10, 1, NULL::bigint, %s, 0), (10, 2, NULL, %s, 0)', a, b), existing => 'replace');
    RETURN (SELECT string_agg(format('%s-%s:%s', p.x, q.x, marker), ' ') FROM abacus_facets('shore') AS f JOIN abacus_vertices('shore') AS p ON p.id = v0 JOIN abacus_vertices('shore') AS q ON q.id = v1)
        || (SELECT string_agg(abacus_delete('shore', format('VALUES (%s, %s, 0)', id, x))::text, '') FROM abacus_vertices('shore') WHERE id > 10 AND abacus_unconstrain('shore', 'VALUES (10)') >= 0);
END $$;
SELECT is(pg_temp.left_over(0, 300), '0-300:71', 'the line becomes shorter at its greater end');
SELECT is(pg_temp.left_over(300, 1000), '300-1000:71', '... at its lesser end');
SELECT is(pg_temp.left_over(300, 700), '300-700:711', '... at both');
SELECT abacus_constrain('shore', 'VALUES (10, 1, 1), (10, 2, 2)');
SELECT pg_temp.mark(1, 2, 7);
CREATE TABLE dike (line int, "position" int, point int);
INSERT INTO dike VALUES (10, 1, 1), (10, 2, 2);
SELECT abacus_track('shore', 'bank');
SELECT abacus_track_lines('shore', 'dike');
UPDATE bank SET x = x * 0.25 + 100 WHERE id <= 2;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is(pg_temp.marked(), '1-2:7', 'both ends move along the line');
UPDATE bank SET x = 400 WHERE id = 2;
SELECT is(pg_temp.marked(), NULL, 'a longer edge was not covered');
SELECT is((SELECT count(*) FROM abacus_check('shore')), 0::bigint, 'both sides agree');
SET CONSTRAINTS ALL DEFERRED;

-- Lines in all directions with points on them that come and go: a fixed edge has a marker if one marker has covered it.
SELECT setseed(0.25);
CREATE TABLE post AS SELECT row_number() OVER (ORDER BY i, random()) AS id, 0::float8 + 64 * (i % 6) AS x, 0::float8 + 64 * (i / 6) AS y FROM generate_series(0, 35) AS i;
CREATE TABLE rail AS SELECT a.id AS line, a.id AS a, b.id AS b FROM post AS a JOIN post AS b ON (b.x - a.x, b.y - a.y) IN ((64, 0), (0, 64), (64, 64)) WHERE random() < 0.7;
DELETE FROM rail AS r USING rail AS s WHERE r.line = s.line AND r.b > s.b;
-- places inside rails, in 64ths
CREATE TABLE place AS SELECT 1000 + row_number() OVER () AS id, p.x + (q.x - p.x) * k / 64 AS x, p.y + (q.y - p.y) * k / 64 AS y, line, k
    FROM rail JOIN post AS p ON p.id = a JOIN post AS q ON q.id = b, generate_series(4, 60, 4) AS k;
SELECT abacus_triangulate('net', 'TABLE post');
SELECT abacus_constrain('net', 'SELECT line, 1, a FROM rail UNION ALL SELECT line, 2, b FROM rail');
SELECT is((SELECT count(*) FROM abacus_edges('net', fixed => true)), (SELECT count(*) FROM rail), 'every rail is an edge');
CREATE TABLE there (id bigint PRIMARY KEY);
CREATE VIEW piece AS -- the fixed edges on rails, from and to in 64ths
    SELECT line, k AS f, lead(k, 1, 64) OVER (PARTITION BY line ORDER BY k) AS t, id AS v, lead(id, 1, b) OVER (PARTITION BY line ORDER BY k) AS w
    FROM (SELECT line, 0 AS k, a AS id, b FROM rail UNION ALL SELECT p.line, p.k, p.id, r.b FROM place AS p JOIN there USING (id) JOIN rail AS r USING (line)) AS s;
CREATE TABLE expected (line bigint, f int, t int, marker int);
CREATE FUNCTION pg_temp.round(part float8) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    -- other markers for some edges
    CREATE TEMPORARY TABLE painted ON COMMIT DROP AS SELECT line, f, t, v, w, CASE WHEN random() < 0.8 THEN (random() * 2)::int END AS marker FROM piece WHERE random() < part;
    PERFORM abacus_mark('net', 'SELECT s.code, s.v0, s.v1, s.v2, g.n, p.marker FROM abacus_simplices(''net'') AS s JOIN pg_temp.painted AS p ON ARRAY[p.v, p.w] <@ ARRAY[s.v0, s.v1, s.v2],
        generate_series(0, 2) AS g(n) WHERE NOT (ARRAY[s.v0, s.v1, s.v2])[g.n + 1] = ANY (ARRAY[p.v, p.w])');
    DELETE FROM expected AS e USING painted AS p WHERE (e.line, e.f, e.t) = (p.line, p.f, p.t);
    INSERT INTO expected SELECT line, f, t, marker FROM painted WHERE marker IS NOT NULL;
    DROP TABLE painted;
    -- points go, others come
    CREATE TEMPORARY TABLE going ON COMMIT DROP AS SELECT id FROM there WHERE random() < part;
    PERFORM abacus_delete('net', 'SELECT id, x, y FROM place JOIN pg_temp.going USING (id)');
    DELETE FROM there USING going AS g WHERE there.id = g.id;
    DROP TABLE going;
    CREATE TEMPORARY TABLE next ON COMMIT DROP AS SELECT p.line, p.f, p.t, e.marker FROM piece AS p JOIN expected AS e ON e.line = p.line AND e.f < p.t AND e.t > p.f
        GROUP BY p.line, p.f, p.t, e.marker HAVING sum(least(e.t, p.t) - greatest(e.f, p.f)) = p.t - p.f;
    TRUNCATE expected;
    INSERT INTO expected TABLE next;
    DROP TABLE next;
    CREATE TEMPORARY TABLE coming ON COMMIT DROP AS SELECT id FROM place WHERE random() < part / 2 AND id NOT IN (TABLE there);
    PERFORM abacus_insert('net', 'SELECT id, x, y FROM place JOIN pg_temp.coming USING (id)');
    INSERT INTO there TABLE coming;
    DROP TABLE coming;
    CREATE TEMPORARY TABLE next ON COMMIT DROP AS SELECT p.line, p.f, p.t, e.marker FROM piece AS p JOIN expected AS e ON e.line = p.line AND e.f < p.t AND e.t > p.f
        GROUP BY p.line, p.f, p.t, e.marker HAVING sum(least(e.t, p.t) - greatest(e.f, p.f)) = p.t - p.f;
    TRUNCATE expected;
    INSERT INTO expected TABLE next;
    DROP TABLE next;
    RETURN NEXT set_eq('SELECT least(v0, v1), greatest(v0, v1), marker FROM abacus_facets(''net'')',
                       'SELECT least(v, w), greatest(v, w), marker FROM piece JOIN expected USING (line, f, t)', 'markers are where they have been');
    RETURN NEXT is((SELECT count(*) FROM abacus_check('net')), 0::bigint, 'both sides agree');
END $$;
SELECT pg_temp.round(CASE WHEN n % 7 = 0 THEN 0.9 ELSE 0.3 END) FROM generate_series(1, 30) AS n;
SET abacus.threads = 3;
SET abacus.tiny_intervals = on;
SET abacus.cache_size = '1MB';
SELECT pg_temp.round(0.4) FROM generate_series(1, 10);
SELECT cmp_ok((SELECT count(*) FROM expected), '>', 20::bigint, 'there were markers');
SELECT * FROM finish();
ROLLBACK;

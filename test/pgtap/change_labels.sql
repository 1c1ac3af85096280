-- A simplex that is in the mesh before and after a call keeps its labels, and a facet its marker, also where the call takes several steps:
-- points and lines come and go, and the edges of other lines are fixed or freed in between.
BEGIN;
SELECT no_plan();
SET client_min_messages = warning;

SELECT setseed(0.5);
CREATE TABLE peg AS SELECT row_number() OVER (ORDER BY random()) AS id, i % 7 AS x, i / 7 AS y FROM generate_series(0, 48) AS i;
SELECT abacus_triangulate('yard', 'SELECT id, x, y FROM peg WHERE id <= 30 OR x IN (0, 6) AND y IN (0, 6)');
CREATE TABLE simplex_before (v0 bigint, v1 bigint, v2 bigint, labels float8[]);
CREATE TABLE facet_before (v0 bigint, v1 bigint, marker int);
CREATE VIEW facet AS SELECT DISTINCT least(a, b) AS v0, greatest(a, b) AS v1 FROM abacus_simplices('yard') AS s, LATERAL (VALUES (v0, v1), (v1, v2), (v2, v0)) AS e(a, b);

-- Labels and markers, another for each, where there is none yet.
CREATE FUNCTION pg_temp.paint() RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_label('yard', 'SELECT code, v0, v1, v2, 10000 * v0 + 100 * v1 + v2 AS paint FROM abacus_simplices(''yard'')');
    PERFORM abacus_mark('yard', 'SELECT s.code, s.v0, s.v1, s.v2, f.n, 100 * least(f.a, f.b) + greatest(f.a, f.b) FROM abacus_simplices(''yard'') AS s,
        LATERAL (VALUES (2, s.v0, s.v1), (0, s.v1, s.v2), (1, s.v2, s.v0)) AS f(n, a, b)');
    TRUNCATE simplex_before, facet_before;
    INSERT INTO simplex_before SELECT v0, v1, v2, labels FROM abacus_cells('yard');
    INSERT INTO facet_before SELECT least(v0, v1), greatest(v0, v1), marker FROM abacus_facets('yard');
END $$;
-- Of the simplices and facets that stay, whether all have what they had.
CREATE FUNCTION pg_temp.kept(what text) RETURNS SETOF text LANGUAGE sql AS $$
    SELECT is_empty('SELECT * FROM simplex_before JOIN abacus_cells(''yard'') AS c USING (v0, v1, v2) WHERE c.labels <> simplex_before.labels', what || ': labels') UNION ALL
    SELECT is_empty('SELECT v0, v1, marker FROM facet_before JOIN facet USING (v0, v1) EXCEPT
                     SELECT least(v0, v1), greatest(v0, v1), marker FROM abacus_facets(''yard'')', what || ': markers') UNION ALL
    SELECT is_empty('SELECT * FROM abacus_check(''yard'')', what || ': sound') $$;
-- Lines between pegs near one another, which may be new: 1 if they have come, 0 if they cross others.
CREATE FUNCTION pg_temp.fence(n int) RETURNS int LANGUAGE plpgsql AS $$
BEGIN
    PERFORM abacus_constrain('yard', format('VALUES %s', (SELECT string_agg(format('(%1$s, 1, %2$s, %3$s, %4$s), (%1$s, 2, %5$s, %6$s, %7$s)', line, a.id, a.x, a.y, b.id, b.x, b.y), ', ')
        FROM generate_series(n % 5, n % 5 + n % 3) AS line, LATERAL (SELECT * FROM peg WHERE line >= 0 ORDER BY random() LIMIT 1) AS a,
             LATERAL (SELECT * FROM peg WHERE (x, y) <> (a.x, a.y) AND abs(x - a.x) + abs(y - a.y) <= 5 ORDER BY random() LIMIT 1) AS b)), existing => 'replace');
    RETURN 1;
EXCEPTION WHEN invalid_parameter_value THEN
    RETURN 0;
END $$;
CREATE FUNCTION pg_temp.round(n int) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    PERFORM pg_temp.paint();
    INSERT INTO made VALUES (pg_temp.fence(n));
    RETURN QUERY SELECT pg_temp.kept('lines, ' || n);
    -- some pegs leave again
    PERFORM pg_temp.paint();
    BEGIN
        PERFORM abacus_delete('yard', format('SELECT id, x, y FROM abacus_vertices(''yard'') WHERE id > 30 AND NOT (x IN (0, 6) AND y IN (0, 6)) AND id %% 4 = %s
            AND (x, y) NOT IN (SELECT x, y FROM abacus_lines(''yard''))', n % 4));
    EXCEPTION WHEN object_not_in_prerequisite_state THEN -- lines would cross there
    END;
    RETURN QUERY SELECT pg_temp.kept('points, ' || n);
END $$;
CREATE TABLE made (n int);
SELECT pg_temp.round(n) FROM generate_series(1, 60) AS n;
SET abacus.threads = 3;
SET abacus.tiny_intervals = on;
SET abacus.cache_size = '1MB';
SELECT pg_temp.round(n) FROM generate_series(1, 30) AS n;
SELECT cmp_ok((SELECT sum(n) FROM made), '>', 20::bigint, 'many lines came');

-- lines that wait for points, and come with them
SELECT abacus_unconstrain('yard', 'SELECT DISTINCT line FROM abacus_lines(''yard'')');
SELECT pg_temp.paint();
SELECT abacus_stage('yard', 'VALUES (100, 0.25, 3.5), (101, 5.75, 3.5)');
SELECT abacus_constrain('yard', 'VALUES (1, 1, 100, 0.25, 3.5), (1, 2, 101, 5.75, 3.5)');
SELECT abacus_triangulate('yard');
SELECT pg_temp.kept('lines that have waited');

-- A mesh whose simplices all go in a transaction of tables that it follows, and those that come back.
SELECT count(*) > 0 AS has_postgis FROM pg_available_extensions WHERE name = 'postgis' \gset
\if :has_postgis
CREATE EXTENSION IF NOT EXISTS postgis;
DROP TABLE yard CASCADE;
CREATE TABLE drawn (line int PRIMARY KEY, geom geometry);
INSERT INTO drawn VALUES (1, 'LINESTRING (0 0, 4 0, 4 4)'), (2, 'LINESTRING (0 1, 1 3)'), (3, 'LINESTRING (2 1, 3 1, 3 2)');
SELECT abacus_create('yard', 2);
SELECT abacus_track_lines('yard', 'drawn');
CREATE FUNCTION pg_temp.places() RETURNS TABLE (corners float8[], labels float8[]) LANGUAGE sql AS $$ SELECT corners, labels FROM abacus_cells('yard') ORDER BY 1 $$;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT abacus_label('yard', 'SELECT code, v0, v1, v2, 7 AS soil FROM abacus_simplices(''yard'')');
SELECT abacus_mark('yard', 'SELECT code, v0, v1, v2, f, 5 FROM abacus_simplices(''yard''), generate_series(0, 2) AS f');
SELECT lives_ok('UPDATE drawn SET geom = ST_Translate(geom, 100, 50)', 'all lines move');
SELECT is((SELECT count(*) FROM abacus_cells('yard') WHERE labels[1] IS NOT NULL) + (SELECT count(*) FROM abacus_facets('yard')), 0::bigint, 'no simplex is an old one');
SELECT abacus_label('yard', 'SELECT code, v0, v1, v2, 8 AS soil FROM abacus_simplices(''yard'')');
SELECT abacus_mark('yard', 'SELECT code, v0, v1, v2, f, 5 FROM abacus_simplices(''yard''), generate_series(0, 2) AS f');
CREATE TABLE places AS SELECT * FROM pg_temp.places();
CREATE TABLE facets AS SELECT marker, corners FROM abacus_facets('yard');
CREATE TABLE kept AS TABLE drawn;
SET CONSTRAINTS ALL DEFERRED;
TRUNCATE drawn;
INSERT INTO drawn SELECT line + 10, geom FROM kept;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT results_eq('SELECT * FROM pg_temp.places()', 'SELECT * FROM places ORDER BY 1', 'all lines go and come back under other ids: labels');
SELECT set_eq('SELECT marker, corners FROM abacus_facets(''yard'')', 'TABLE facets', '... markers');
SET CONSTRAINTS ALL DEFERRED;
DELETE FROM drawn WHERE line > 11;
INSERT INTO drawn VALUES (5, 'LINESTRING (1000 0, 1004 3)');
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is_empty('SELECT * FROM abacus_check(''yard'')', 'fewer simplices than there were labels');
\endif
SELECT * FROM finish();
ROLLBACK;

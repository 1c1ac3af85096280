-- Locating, walking, and the content as rows.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4), (5, 2, 1)');
SELECT v0, v1, v2, v3 FROM abacus_simplices('field') ORDER BY 1, 2, 3;
-- inside, on an edge, on a vertex, on the hull, outside
SELECT p, (abacus_locate('field', x, y)).v0 IS NOT NULL AS found
FROM (VALUES ('inside', 2, 0.5), ('edge', 1, 0.5), ('vertex', 2, 1), ('hull', 2, 0), ('corner', 4, 4),
             ('outside', 5, 5), ('just outside', 2, -1e-300), ('far', 1e308, 0)) AS t (p, x, y);
-- the answer contains the point: its corners, looked up by id
SELECT p, (s).v0, (s).v1, (s).v2
FROM (VALUES ('south', 2, 0.5), ('west', 0.5, 1.5), ('east', 3.5, 1.5), ('north', 2, 3)) AS t (p, x, y),
     abacus_locate('field', x, y) s;
-- on a facet: always the same simplex, that with the least code
SELECT abacus_locate('field', 1, 0.5) = (SELECT s FROM abacus_simplices('field') s
    WHERE ARRAY[1, 5]::bigint[] <@ ARRAY[v0, v1, v2] ORDER BY (s).code LIMIT 1) AS least_code;
SELECT abacus_locate('field', NULL, 1) IS NULL AS null_x, abacus_locate(NULL, 1, 1) IS NULL AS null_mesh;
SELECT abacus_locate('field', 'Infinity', 0) IS NULL AS infinite;
SELECT abacus_locate('field', 'NaN', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('field', 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE

-- many places at once: the same simplices, along the curve
SELECT id, v0, v1, v2, v3 FROM abacus_locate('field', 'VALUES (1, 2, 0.5), (2, 0.5, 1.5), (3, 3.5, 1.5), (4, 2, 3), (5, 5, 5)');
SELECT q.id, (q.code, q.v0, q.v1, q.v2, q.v3)::abacus_simplex = abacus_locate('field', x, y) AS same
FROM (VALUES (1, 1, 0.5), (2, 2, 1), (3, 2, 0), (4, 4, 4)) AS p (id, x, y)
     JOIN abacus_locate('field', 'VALUES (1, 1, 0.5), (2, 2, 1), (3, 2, 0), (4, 4, 4)') AS q USING (id) ORDER BY id;
SELECT * FROM abacus_locate('field', 'SELECT 1, 2, 3 WHERE false');
SELECT abacus_locate('field', 'SELECT 1, ''Infinity''::float8, 0');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('field', 'SELECT 1, 1, 1, 1');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('no_mesh', 'SELECT 1, 1, 1');
SELECT abacus_locate('pg_class', 'SELECT 1, 1, 1');
\echo :LAST_ERROR_SQLSTATE

-- walking there and back across every facet
SELECT count(*) AS steps, count(n.code) AS inner_steps,
       count(*) FILTER (WHERE s IN (abacus_walk('field', n, 0), abacus_walk('field', n, 1), abacus_walk('field', n, 2))) AS back
FROM abacus_simplices('field') s, generate_series(0, 2) f, LATERAL abacus_walk('field', s, f) n;
SELECT abacus_walk('field', abacus_locate('field', 2, 0.5), 3);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', abacus_locate('field', 2, 0.5), -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(1, 2, 3, 4, NULL)::abacus_simplex, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(1, 2, NULL, 4, NULL)::abacus_simplex, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', ROW(NULL, NULL, NULL, NULL, 5)::abacus_simplex, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_walk('field', NULL, 0) IS NULL AS strict;
-- after an error the session reads on
SELECT (abacus_locate('field', 2, 0.5)).v0 IS NOT NULL AS found;

-- sets end early and nest
SELECT count(*) FROM (SELECT abacus_simplices('field') LIMIT 2) t;
SELECT count(*) FROM abacus_simplices('field') a, LATERAL (SELECT abacus_vertices('field') LIMIT 1) b;
BEGIN;
DECLARE reader CURSOR FOR SELECT abacus_simplices('field');
MOVE 1 FROM reader;
-- the cursor goes on reading what it began with
SELECT abacus_stage('field', 'VALUES (6, 1, 3), (7, 3, 3), (8, 2, 2)'), abacus_triangulate('field');
MOVE ALL FROM reader;
SELECT count(*) FROM abacus_simplices('field');
ROLLBACK;
SELECT count(*) FROM abacus_simplices('field');

-- what is no mesh
CREATE TABLE plain (code bigint, part bigint, page abacus_page, PRIMARY KEY (code, part));
CREATE VIEW seen AS TABLE field;
SELECT abacus_locate('plain', 0, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('seen', 0, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_simplices('field_pkey');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_simplices('field_vertices');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_check('pg_class');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_stage('plain', 'SELECT 1, 2, 3');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate('nothing', 0, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_locate(1::regclass, 0, 0);
\echo :LAST_ERROR_SQLSTATE

-- more meshes than a session keeps open
DO $$
BEGIN
    FOR i IN 1..6 LOOP
        PERFORM abacus_triangulate('kept' || i, format('VALUES (%s, 0, 0), (%s, 1, 0), (%s, 0, 1)', i * 10, i * 10 + 1, i * 10 + 2));
    END LOOP;
END $$;
SELECT i, least((s).v0, (s).v1, (s).v2) FROM generate_series(1, 12) i, LATERAL abacus_locate(('kept' || 1 + i % 6)::regclass, 0.25, 0.25) s ORDER BY i;

DROP VIEW seen;
DROP TABLE field, plain, kept1, kept2, kept3, kept4, kept5, kept6;

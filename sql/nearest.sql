-- The nearest vertices.
SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10), (2, 4, 0, 20), (3, 4, 4, 30), (4, 0, 4, NULL), (5, 2, 1, 50)', '{height}');
SELECT abacus_triangulate('solid', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 0, 4, 0), (4, 0, 0, 4), (5, 1, 1, 1)', dimension => 3);
-- one, some, all; on a vertex, outside, far away
SELECT * FROM abacus_nearest('field', 2, 0.5);
SELECT * FROM abacus_nearest('field', 3.5, 3, 3);
SELECT vertex, round(distance::numeric, 3) FROM abacus_nearest('field', 2, 1, 10);
SELECT vertex, distance FROM abacus_nearest('field', 4, -3);
SELECT vertex, distance FROM abacus_nearest('field', 0, 3e200, k => 2);
SELECT vertex, x, y, z, distance FROM abacus_nearest('solid', 0.5, 0.5, 0.5::float8);
SELECT vertex, x, y, z FROM abacus_nearest('solid', 0.25, 0, 0.0, 2);
-- of equally far ones the lexicographically least comes first
SELECT vertex, distance FROM abacus_nearest('field', 2, 4, 2);
SELECT vertex FROM abacus_nearest('field', 2, 2.1, 5);
-- it is not always a corner of the triangle around the place
SELECT abacus_triangulate('thin', 'VALUES (1, 0, 0), (2, 10, 0), (3, 5, 6), (4, 5, -4.5)');
SELECT l.v0, l.v1, l.v2, n.vertex FROM abacus_locate('thin', 5, 0.1) AS l, abacus_nearest('thin', 5, 0.1) AS n;
-- many places
SELECT id, rank, vertex, distance FROM abacus_nearest('field', 'VALUES (7, 0, 1), (8, 4, -3)', 2) ORDER BY id, rank;
SELECT id, rank, vertex, distance FROM abacus_nearest('solid', 'VALUES (7, 1, 1, 2)');
SELECT * FROM abacus_nearest('field', 'SELECT 1, 2, 3 WHERE false', 4);
-- points equal to a vertex, and those that wait, are none
SELECT abacus_stage('field', 'VALUES (6, 2, 1, 60), (7, 2, 0.5, 70)');
SELECT vertex FROM abacus_nearest('field', 2, 0.5);
-- nothing near: an empty mesh, NULL
SELECT abacus_create('empty', 2);
SELECT * FROM abacus_nearest('empty', 1, 1);
SELECT * FROM abacus_nearest('empty', 'SELECT 1, 1, 1');
SELECT * FROM abacus_nearest('field', NULL, 1);
-- what cannot be asked
SELECT * FROM abacus_nearest('field', 1, 1, 0);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('field', 'SELECT 1, 1, 1', -1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('field', 'NaN'::float8, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('field', 1, '-Infinity');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('field', 'SELECT 1, 1, ''NaN''::float8');
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('field', 1, 1, 1.0);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('solid', 1, 1, 1);
\echo :LAST_ERROR_SQLSTATE
SELECT * FROM abacus_nearest('pg_class', 1, 1);
\echo :LAST_ERROR_SQLSTATE
-- after an error the session reads on
SELECT vertex FROM abacus_nearest('field', 2, 0.5);
DROP TABLE field, solid, thin, empty;

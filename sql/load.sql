-- abacus_load: triangulations made elsewhere.

-- A square in two triangles that share the diagonal that Abacus chooses.
CREATE TABLE corner (id bigint, x float8, y float8, height float8);
INSERT INTO corner VALUES (1, 0, 0, 5), (2, 4, 0, 6), (3, 4, 4, NULL), (4, 0, 4, 8);
CREATE TABLE triangle (a int, b bigint, c smallint);
INSERT INTO triangle VALUES (1, 2, 4), (4, 2, 3);
SELECT abacus_load('square', 'TABLE corner', 'TABLE triangle');
SELECT v0, v1, v2, v3 FROM abacus_simplices('square') ORDER BY 1, 2, 3;
SELECT id, x, y, attributes FROM abacus_vertices('square') ORDER BY id;
SELECT * FROM abacus_check('square');
SELECT name, value FROM abacus_stats('square')
WHERE name IN ('dimension', 'attributes', 'vertices', 'simplices', 'hull_facets', 'delaunay')
ORDER BY name;

-- It is a Delaunay triangulation, so it can be added to: the same as made anew.
SELECT abacus_insert('square', 'SELECT 5, 2, 9, 1');
SELECT abacus_delete('square', 'SELECT 2, 4, 0');
SELECT abacus_stage('square', 'SELECT 6, 3, 1, 1');
SELECT abacus_triangulate('square');
SELECT * FROM abacus_check('square');
SELECT abacus_triangulate('anew', 'SELECT * FROM corner WHERE id <> 2 UNION ALL VALUES (5, 2, 9, 1), (6, 3, 1, 1)');
(SELECT v0, v1, v2 FROM abacus_simplices('square') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('anew'))
UNION ALL
(SELECT v0, v1, v2 FROM abacus_simplices('anew') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('square'));

-- With the other diagonal it is another one: it can be read, not changed.
SELECT abacus_load('other', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, 4)', attributes => '{h}');
SELECT * FROM abacus_check('other');
SELECT name, value, description FROM abacus_stats('other') WHERE name IN ('delaunay', 'changeable') ORDER BY name;
SELECT v0, v1, v2 FROM abacus_locate('other', 3, 1);
SELECT n.v0, n.v1, n.v2 FROM abacus_locate('other', 3, 1) AS t, abacus_walk('other', t, 1) AS n;
SELECT n IS NULL FROM abacus_locate('other', 3, 1) AS t, abacus_walk('other', t, 0) AS n;
SELECT abacus_locate('other', 5, 1) IS NULL;
SELECT id, attributes FROM abacus_vertices('other') ORDER BY id;
SELECT length(abacus_draw('other', attribute => 'h', width => 40)) > 100 AS drawn;
SELECT abacus_stage('other', 'SELECT 5, 2, 9, 1');
SELECT abacus_triangulate('other');
-- nothing waits to be inserted, and a restored mesh is bound by it
CALL abacus_build('other');
CREATE TABLE restored OF abacus_simplex_page (PRIMARY KEY (code, part));
CREATE TABLE restored_vertices OF abacus_vertex_page (PRIMARY KEY (first, part));
INSERT INTO restored TABLE other;
INSERT INTO restored_vertices TABLE other_vertices;
CALL abacus_build('restored');
ALTER TABLE restored RENAME TO bound;
SELECT * FROM abacus_check('bound') UNION ALL SELECT * FROM abacus_check('other');
SELECT count(*) = (SELECT count(*) FROM abacus_vertices('other')) AS all_there FROM abacus_vertices('bound');
DROP TABLE bound;
SELECT to_regclass('restored_vertices') IS NULL AS gone;
SELECT abacus_insert('other', 'SELECT 5, 2, 9, 1');
SELECT abacus_delete('other', 'SELECT 1, 0, 0');

-- A cube in five tetrahedra: all corners lie on one sphere. Then one moved into that, and one taken out.
CREATE TABLE cube AS SELECT 4 * x + 2 * y + z AS id, x, y, z
FROM generate_series(0, 1) AS x, generate_series(0, 1) AS y, generate_series(0, 1) AS z;
CREATE TABLE five (v0 int, v1 int, v2 int, v3 int);
INSERT INTO five VALUES (0, 3, 5, 6), (1, 0, 3, 5), (2, 0, 3, 6), (4, 0, 5, 6), (7, 3, 5, 6);
SELECT abacus_load('weak', 'TABLE cube', 'TABLE five');
SELECT abacus_load('inside', 'SELECT id, x, y, z - CASE id WHEN 7 THEN 1e-15 ELSE 0 END AS z FROM cube', 'TABLE five');
SELECT abacus_load('notch', 'TABLE cube', 'SELECT * FROM five WHERE v0 > 0');
SELECT mesh, name, value, description
FROM unnest('{weak, inside, notch}'::text[]) AS mesh, abacus_stats(mesh::regclass)
WHERE name IN ('delaunay', 'changeable') ORDER BY mesh, name;
SELECT abacus_insert('weak', 'VALUES (9, 0.3, 0.4, 0.5)');
SELECT abacus_insert('inside', 'VALUES (9, 0.3, 0.4, 0.5)');
SELECT abacus_delete('notch', 'TABLE cube');
-- Abacus' own triangulation of the same vertices can be changed.
SELECT abacus_load('weak_anew', 'TABLE cube', 'TABLE five', retriangulate => true);
SELECT abacus_load('inside_anew', 'SELECT id, x, y, z - CASE id WHEN 7 THEN 1e-15 ELSE 0 END AS z FROM cube', 'TABLE five', retriangulate => true);
SELECT abacus_load('notch_anew', 'TABLE cube', 'SELECT * FROM five WHERE v0 > 0', retriangulate => true);
SELECT abacus_load('own_anew', 'TABLE cube', 'SELECT v0, v1, v2, v3 FROM abacus_simplices(''weak_anew'')', retriangulate => true);
SELECT mesh, value AS changeable, c.* FROM unnest('{weak_anew, inside_anew, notch_anew, own_anew}'::text[]) AS mesh,
    abacus_stats(mesh::regclass) LEFT JOIN LATERAL abacus_check(mesh::regclass) AS c ON true
WHERE name = 'changeable';
SELECT abacus_triangulate('straight', 'TABLE cube', dimension => 3);
SELECT abacus_insert('weak_anew', 'VALUES (9, 0.3, 0.4, 0.5)');
SELECT abacus_delete('weak_anew', 'VALUES (9, 0.3, 0.4, 0.5)');
SELECT v0, v1, v2, v3 FROM abacus_simplices('weak_anew') EXCEPT SELECT v0, v1, v2, v3 FROM abacus_simplices('straight');
SELECT abacus_load('lone_anew', 'TABLE cube', 'VALUES (0, 1, 2, 4)', retriangulate => true);
SELECT abacus_load('refused', 'TABLE cube', 'VALUES (0, 1, 2, 3)', retriangulate => true);
SELECT abacus_load('refused', 'TABLE cube', 'TABLE five', retriangulate => NULL);

-- A ring: a hole in the middle, found by walks that end there.
CREATE TABLE ring_vertex AS
SELECT i * 2 + r AS id, (1 + r) * cos(i * pi() / 16) AS x, (1 + r) * sin(i * pi() / 16) AS y
FROM generate_series(0, 31) AS i, generate_series(0, 1) AS r;
CREATE TABLE ring_triangle AS
SELECT i * 2 AS v0, i * 2 + 1 AS v1, (i * 2 + 3) % 64 AS v2 FROM generate_series(0, 31) AS i
UNION ALL
SELECT i * 2, (i * 2 + 3) % 64, (i * 2 + 2) % 64 FROM generate_series(0, 31) AS i;
SELECT abacus_load('ring', 'TABLE ring_vertex', 'TABLE ring_triangle');
SELECT * FROM abacus_check('ring');
SELECT name, value FROM abacus_stats('ring') WHERE name IN ('hull_facets', 'delaunay') ORDER BY 1;
SELECT count(*) AS places, count(t.code) AS inside,
       count(*) FILTER (WHERE (t.code IS NOT NULL) <> (sqrt(x * x + y * y) BETWEEN 1 AND 1.9)) AS wrong
FROM generate_series(-2.05, 2.05, 0.1) AS x, generate_series(-2.05, 2.05, 0.1) AS y,
     abacus_locate('ring', x, y) AS t
WHERE sqrt(x * x + y * y) NOT BETWEEN 0.95 AND 1.05 AND sqrt(x * x + y * y) NOT BETWEEN 1.85 AND 2.05;

-- Two tetrahedra.
SELECT abacus_load('solid',
    'VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 0, 0, 1), (5, 1, 1, 1)',
    'VALUES (4, 3, 2, 1), (2, 3, 4, 5)');
SELECT v0, v1, v2, v3 FROM abacus_simplices('solid') ORDER BY 1, 2, 3, 4;
SELECT v0, v1, v2, v3 FROM abacus_locate('solid', 0.6, 0.6, 0.6);
SELECT * FROM abacus_check('solid');

-- A mesh goes out and in again.
SELECT abacus_triangulate('grid', 'SELECT i, i % 50, i / 50 FROM generate_series(0, 2499) AS i');
SELECT abacus_load('copy', 'SELECT id, x, y FROM abacus_vertices(''grid'')',
                   'SELECT v0, v1, v2 FROM abacus_simplices(''grid'')');
SELECT count(*) FROM (TABLE abacus_progress) AS running;
SELECT * FROM abacus_check('copy');
SELECT value FROM abacus_stats('copy') WHERE name = 'delaunay';

-- Nothing at all.
SELECT abacus_load('nothing', 'SELECT 1, 2, 3 WHERE false', 'SELECT 1, 2, 3 WHERE false');
SELECT * FROM abacus_check('nothing');

-- Vertices that no simplex names are left out.
SELECT abacus_load('lone', 'TABLE corner', 'VALUES (1, 2, 3)');
SELECT id FROM abacus_vertices('lone') ORDER BY id;
SELECT * FROM abacus_check('lone');

-- Orientation is put right, or refused.
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3), (4, 3, 1)', reorient => false);

-- Everything that is no triangulation is refused, and named.
CREATE FUNCTION try_load(vertices text, simplices text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    message text; detail text; hint text;
BEGIN
    RETURN abacus_load('bad', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4)' || vertices,
                       'VALUES (1, 2, 3), (1, 3, 4)' || simplices);
EXCEPTION WHEN OTHERS THEN
    GET STACKED DIAGNOSTICS message = MESSAGE_TEXT, detail = PG_EXCEPTION_DETAIL,
        hint = PG_EXCEPTION_HINT;
    RETURN SQLSTATE || ' ' || message || E'\n' || detail || E'\n' || hint;
END $$;
\pset format unaligned
\pset tuples_only on
SELECT try_load(', (4, 7, 7)', '');
SELECT try_load(', (5, 4, 4)', ', (2, 5, 4)');
SELECT try_load('', ', (2, 3, 7)');
SELECT try_load('', ', (2, 3, 3)');
SELECT try_load(', (5, 2, 2)', ', (1, 3, 5)');
SELECT try_load('', ', (3, 2, 1)');
SELECT try_load(', (5, 0, 5)', ', (1, 3, 5)');
SELECT try_load(', (5, 3, 1), (6, 3, 2), (7, 9, 9)', ', (5, 6, 7)');
SELECT try_load(', (5, 4, 2), (6, 6, 1), (7, 6, 3)', ', (5, 6, 7)');
SELECT try_load(', (5, 4, -1)', ', (2, 3, 5)');
SELECT try_load(', (5, 7, 7)', ', (2, 3, 5)');
DROP TABLE bad;
-- Several at once: all of a step, up to a hundred.
SELECT try_load(', (5, 4, 4), (6, 0, 4), (7, 0, 0)', ', (2, 5, 4), (6, 7, 2)');
SELECT try_load(', (1, 7, 7), (4, 7, 8)', ', (2, 3, 3), (2, 8, 9), (2, 8, 3)');
SELECT try_load(', (5, 2, 2), (6, 1, 1), (7, 9, 9)', ', (1, 3, 5), (1, 5, 6), (4, 3, 7)');
SELECT try_load(', (5, 0, 5), (6, 9, 9), (7, 8, 9)', ', (3, 2, 1), (1, 4, 3), (1, 3, 5), (2, 3, 6), (2, 3, 7), (3, 6, 7), (7, 3, 6)');
SELECT try_load(', (5, 3, 1), (6, 3, 2), (7, 9, 9), (8, 2, 3), (9, -9, 3.5)', ', (5, 6, 7), (8, 4, 9)');
SELECT string_agg(line, E'\n') FROM (SELECT line FROM regexp_split_to_table((SELECT try_load('', ', ' || string_agg(format('(%s, 2, 3)', i), ', ' ORDER BY i)) FROM generate_series(11, 260) AS i), E'\n') WITH ORDINALITY AS l (line, n)
    WHERE n < 6 OR n > 98) AS ends;
SELECT count(*), max(length(line)) FROM regexp_split_to_table((
    SELECT try_load(', ' || string_agg(format('(%s, %s, 0.5), (%s, %s, 0.5), (%s, %s, 9)', -i * 10, i / 100.0, -i * 10 - 1, i / 100.0 + 0.005, -i * 10 - 2, i), ', ' ORDER BY i),
                    ', ' || string_agg(format('(%s, %s, %s)', -i * 10, -i * 10 - 1, -i * 10 - 2), ', ' ORDER BY i))
    FROM generate_series(1, 300) AS i), E'\n') AS line;
\pset format aligned
\pset tuples_only off

-- Arguments.
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2)');
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, NULL)');
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3.5)');
SELECT abacus_load('bad', 'SELECT id, x FROM corner', 'TABLE triangle');
SELECT abacus_load('bad', 'SELECT id, x, ''nan''::float8 FROM corner', 'TABLE triangle');
SELECT abacus_load('bad', 'TABLE corner', 'DELETE FROM triangle');
SELECT abacus_load('bad', NULL, 'TABLE triangle');
SELECT abacus_load('square', 'TABLE corner', 'TABLE triangle');
SELECT to_regclass('bad') IS NULL AS nothing_left, to_regclass('bad_vertices') IS NULL AS here_neither;

-- With lines: edges that are fixed. Ties that the perturbation decides otherwise are flipped.
SELECT abacus_load('lined', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, 4)', lines => 'VALUES (9, 3, 1)');
SELECT v0, v1, lines FROM abacus_edges('lined', fixed => true);
SELECT abacus_insert('lined', 'SELECT 5, 3, 1, 1');
SELECT * FROM abacus_check('lined');
SELECT abacus_load('flipped', 'TABLE corner', 'VALUES (1, 2, 3, 7), (1, 3, 4, 7)', labels => '{part}', facets => 'VALUES (1, 3, 1), (1, 2, 2)', lines => 'VALUES (9, 1, 2)');
SELECT v0, v1, v2, labels FROM abacus_cells('flipped') ORDER BY 1, 2, 3;
SELECT marker, v0, v1 FROM abacus_facets('flipped');
-- what cannot be changed has no lines; triangulated anew it has
SELECT abacus_load('kite', 'VALUES (1, 0, 0), (2, 9, 1), (3, 1, 2), (4, -9, 1)', 'VALUES (1, 2, 4), (2, 3, 4)', lines => 'VALUES (9, 1, 2)');
SELECT * FROM abacus_lines('kite');
SELECT abacus_insert('kite', 'SELECT 5, 3, 1');
SELECT abacus_load('rebuilt', 'VALUES (1, 0, 0), (2, 9, 1), (3, 1, 2), (4, -9, 1)', 'VALUES (1, 2, 4), (2, 3, 4)', lines => 'VALUES (9, 4, 2)', retriangulate => true);
SELECT abacus_load('rejoined', 'VALUES (1, 0, 0), (2, 9, 1), (3, 1, 2), (4, -9, 1)', 'VALUES (1, 2, 4), (2, 3, 4)', lines => 'VALUES (9, 1, 2)', retriangulate => true);
SELECT line, position, point FROM abacus_lines('rejoined');
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, 4)', lines => 'VALUES (9, 2, 4), (8, 1, 7), (7, 1, 1)');
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, 4)', lines => 'VALUES (9, 2, 4), (8, 1, 7)');
SELECT abacus_load('bad', 'TABLE corner', 'VALUES (1, 2, 3), (1, 3, 4)', lines => 'VALUES (9, 2.0, 4)');
SELECT abacus_load('bad', 'VALUES (1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0), (4, 0, 0, 1)', 'VALUES (1, 2, 3, 4)', lines => 'VALUES (1, 1, 2)');

-- Little memory; the list of the vertices of a mesh that is not Delaunay is verified.
SET maintenance_work_mem = '1MB';
SELECT abacus_load('small', 'SELECT id, x, y FROM abacus_vertices(''grid'')',
                   'SELECT v0, v1, v2 FROM abacus_simplices(''grid'') WHERE v0 % 7 > 0');
SELECT * FROM abacus_check('small');
SELECT count(*), count(DISTINCT id), bool_and(id = vertex AND sequence IS NULL) AS inserted FROM abacus_vertices('small');
RESET maintenance_work_mem;

DROP TABLE cube, five, weak, inside, notch, weak_anew, inside_anew, notch_anew, own_anew, straight, lone_anew;
DROP TABLE square, anew, other, ring, solid, grid, copy, nothing, lone, small, lined, flipped, kite, rebuilt, rejoined, corner, triangle, ring_triangle, ring_vertex;
DROP FUNCTION try_load;

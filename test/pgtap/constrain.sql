-- Lines of a mesh: the interface, and every error of their rows; nothing is changed by any of them.
BEGIN;
SELECT no_plan();

SELECT has_type('abacus_line_point');
SELECT function_returns('abacus_constrain', ARRAY['regclass', 'text', 'text', 'text', 'text'], 'bigint');
SELECT function_returns('abacus_unconstrain', ARRAY['regclass', 'text'], 'bigint');
SELECT function_returns('abacus_lines', ARRAY['regclass'], 'setof record');
SELECT is((SELECT count(*) FROM pg_attribute AS a, col_description(a.attrelid, a.attnum) AS d
           WHERE a.attrelid = 'abacus_line_point'::regclass AND d IS NULL), 0::bigint, 'all columns of the type have comments');

CREATE TABLE point AS SELECT 10 * x + y AS id, x, y, x * 0.5 AS h FROM generate_series(0, 3) AS x, generate_series(0, 2) AS y WHERE NOT (x = 1 AND y = 1);
SELECT abacus_triangulate('field', 'TABLE point');
SELECT abacus_constrain('field', 'VALUES (1, 1, 0), (1, 2, 30)');
SELECT is((SELECT string_agg(col_description('field_lines'::regclass, n), ';' ORDER BY n) FROM generate_series(1, 7) AS n),
          (SELECT string_agg(col_description('abacus_line_point'::regclass, n), ';' ORDER BY n) FROM generate_series(1, 7) AS n), 'columns of the table have them, too');

CREATE FUNCTION pg_temp.state() RETURNS text LANGUAGE sql AS $$
    SELECT concat((SELECT string_agg(l::text, ';') FROM abacus_lines('field') AS l), (SELECT string_agg(v::text, ';') FROM abacus_vertices('field') AS v),
                  (SELECT string_agg(e::text, ';') FROM abacus_edges('field', fixed => true) AS e), (SELECT count(*) FROM abacus_edges('field'))) $$;
CREATE FUNCTION pg_temp.refused(query text, state text, message text, detail text DEFAULT NULL, more text DEFAULT '') RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    before text := pg_temp.state();
    found record;
BEGIN
    BEGIN
        EXECUTE format('SELECT abacus_constrain(''field'', %L%s)', query, more);
        RETURN NEXT fail('not refused: ' || message);
        RETURN;
    EXCEPTION WHEN OTHERS THEN
        DECLARE
            m text; d text; h text;
        BEGIN
            GET STACKED DIAGNOSTICS m = MESSAGE_TEXT, d = PG_EXCEPTION_DETAIL, h = PG_EXCEPTION_HINT;
            RETURN NEXT is(SQLSTATE || ' ' || m || coalesce(' ' || nullif(d, ''), ''), state || ' ' || message || coalesce(' ' || detail, ''), message);
            IF state <> '42701' THEN
                RETURN NEXT isnt(h, '', 'with a hint');
            END IF;
        END;
    END;
    RETURN NEXT is(pg_temp.state(), before, 'nothing has changed');
END $$;

-- shapes of rows
SELECT pg_temp.refused('SELECT 2, 1', '42804', 'the query of lines returns 2 columns', 'Rows of lines have three columns, or five and more.');
SELECT pg_temp.refused('SELECT 2', '42804', 'the query of lines returns 1 column', 'Rows of lines have three columns, or five and more.');
SELECT pg_temp.refused('SELECT 2, 1, 0, 0', '42804', 'the query of lines returns 4 columns', 'Rows of lines have three columns, or five and more.');
SELECT pg_temp.refused('SELECT 2, 1.5, 0', '42804', 'column 2 of the query of lines has type numeric', 'It is the position, which is an integer.');
SELECT pg_temp.refused('SELECT ''a''::text, 1, 0', '42804', 'column 1 of the query of lines has type text', 'It is the line, which is an integer.');
SELECT pg_temp.refused('SELECT 2, 1, 0, true, 1', '42804', 'column 4 of the query of lines has type boolean', 'It is x, which is a number.');
SELECT pg_temp.refused('SELECT 2, 1, 0, 1, 1, true AS h', '42804', 'column 6 of the query of lines has type boolean', 'It is the attribute "h", which is a number.');
SELECT pg_temp.refused('VALUES (2, 1, ''0''::text, 1, 1), (2, 2, ''a'', 1, 2)', '42804', 'column 3 of the query of lines has type text');
SELECT pg_temp.refused('SELECT 2, 1, 0, 1, 1, 7 AS g', '42703', 'mesh has no attribute "g"', 'Columns of the query of lines after x and y are attributes of the mesh, by name.');
SELECT pg_temp.refused('SELECT 2, 1, 0, 1, 1, 7 AS h, 7 AS h', '42701', 'the query of lines returns attribute "h" twice');
SELECT pg_temp.refused('DELETE FROM point RETURNING 1, 1, id', '22023', 'source query must be a single SELECT that changes and locks nothing');
-- values
SELECT pg_temp.refused('VALUES (2, 1, 0), (NULL, 2, 30)', '22004', 'line of row 2 is NULL');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, NULL, 30)', '22004', 'a position in line 2 is NULL');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 5, NULL)', '22004', 'point id at position 5 of line 2 is NULL');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0, 0), (2, 5, NULL, NULL, 1)', '22004', 'x at position 5 of line 2 is NULL');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0, 0), (2, 5, NULL, 1, NULL)', '22004', 'y at position 5 of line 2 is NULL');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0, 0::float8), (2, 5, NULL, 1, ''NaN'')', '22023', 'y at position 5 of line 2 is NaN');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0::float8, 0), (2, 5, NULL, ''-inf'', 1)', '22023', 'x at position 5 of line 2 is infinite');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0, 0), (2, 5, NULL, 10::numeric ^ 400, 1)', '22023', 'x at position 5 of line 2 is infinite');
-- lines
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 1, 30)', '23505', 'line 2 has position 1 twice');
SELECT pg_temp.refused('VALUES (2, 1, 0), (3, 1, 0), (3, 2, 30)', '22023', 'line 2 has only one point');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 2, 30), (2, 7, 30)', '22023', 'line 2 has a segment of length zero', 'Its positions 2 and 7 are both at (3, 0).');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 7, 7), (2, 3, 77, 7.0, 7.0)', '22023', 'line 2 has a segment of length zero', 'Its positions 1 and 3 are both at (7, 7).');
SELECT pg_temp.refused('VALUES (2, 1, NULL, 0.0::float8, 7), (2, 3, NULL, ''-0''::float8, 7)', '22023', 'line 2 has a segment of length zero', 'Its positions 1 and 3 are both at (0, 7).');
SELECT pg_temp.refused('VALUES (1, 1, 0), (1, 2, 22)', '23505', 'the mesh already has a line 1');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 2, 22)', '22023', 'kind "harder" is not known', NULL, ', kind => ''harder''');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 2, 22)', '22023', 'existing "ignore" is not known', NULL, ', existing => ''ignore''');
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 2, 22)', '22023', 'z is for lines given as geometries', NULL, ', z => ''h''');
-- points
SELECT pg_temp.refused('VALUES (2, 1, 0), (2, 2, 77)', '22023', 'mesh has no point 77', 'It is at position 2 of line 2.');
SELECT pg_temp.refused('VALUES (2, 1, 0, 0, 0), (2, 2, 22, 2, 1)', '22023', 'point 22 is at another place in the mesh', 'It is (2, 1) at position 2 of line 2, and (2, 2) in the mesh.');
SELECT pg_temp.refused('VALUES (2, 1, 77, 7, 7), (2, 2, 77, 7, 8)', '22023', 'point 77 is given with two places', 'It is (7, 7) at position 1 of line 2, and (7, 8) at position 2 of line 2.');
SELECT pg_temp.refused('SELECT 2, i, 70 + i, 7, 7, i AS h FROM generate_series(1, 2) AS i', '22023', 'attribute "h" has two values at (7, 7)', 'It is 1 at position 1 of line 2, and 2 at position 2 of line 2.');
SELECT pg_temp.refused('SELECT 2, i, NULL, 3, i, 7 AS h FROM generate_series(0, 1) AS i', '22023', 'attribute "h" has two values at (3, 0)', 'It is 1.5 at vertex 30, and 7 at position 0 of line 2.');
SELECT lives_ok($$ SELECT abacus_constrain('field', 'SELECT 2, i, NULL, 3, i, CASE WHEN i = 0 THEN 1.5 END AS h FROM generate_series(0, 1) AS i') $$, 'the value that it has, or none');
SELECT lives_ok($$ SELECT abacus_constrain('field', 'SELECT 2, i, NULL, 3, i, NULL AS h FROM generate_series(0, 1) AS i', existing => 'replace') $$, 'a bare NULL');
SELECT throws_ok($$ SELECT abacus_constrain('field', NULL) $$, '22004', 'mesh and query must not be NULL');
SELECT throws_ok($$ SELECT abacus_unconstrain('field', 'SELECT 1, 2') $$, '42804', 'the query of lines returns 2 columns');
SELECT throws_ok($$ SELECT abacus_unconstrain('field', 'SELECT 1.5') $$, '42804', 'column 1 of the query of lines has type numeric');
SELECT throws_ok($$ SELECT abacus_unconstrain('field', 'VALUES (1), (NULL)') $$, '22004', 'line of row 2 is NULL');

-- an id at two places of the mesh
SELECT abacus_insert('field', 'VALUES (500, 8, 8, 1), (500, 9, 8, 1)');
SELECT pg_temp.refused('VALUES (3, 1, 0), (3, 2, 500)', '22023', 'several points of the mesh have the id 500', 'Their x is from 8 to 9, and their y from 8 to 8.');
SELECT is(abacus_constrain('field', 'VALUES (3, 1, NULL, 8, 8), (3, 2, NULL, 9, 8)'), 1::bigint, 'they can be named by their places');
SELECT results_eq($$ SELECT v0, v1, lines FROM abacus_edges('field', fixed => true) WHERE lines = '{3}' $$, $$ VALUES (500::bigint, 500::bigint, '{3}'::bigint[]) $$, 'both ends with one id');
-- a repeated point stands for its vertex, and keeps its own id in the line
SELECT abacus_insert('field', 'VALUES (600, 2, 2, 1)');
SELECT is(abacus_constrain('field', 'VALUES (4, 1, 600), (4, 2, 12)'), 1::bigint, 'a repeated point');
SELECT results_eq($$ SELECT point, x, y FROM abacus_lines('field') WHERE line = 4 $$, $$ VALUES (600::bigint, 2::float8, 2::float8), (12, 1, 2) $$, 'is kept as it was given');
SELECT results_eq($$ SELECT v0, v1 FROM abacus_edges('field', fixed => true) WHERE lines = '{4}' $$, $$ VALUES (12::bigint, 22::bigint) $$, 'its vertex has the edge');
-- new ids are above all others, in order of line and position
SELECT is(abacus_constrain('field', 'SELECT 20 - i / 2, -i, CASE WHEN i = 5 THEN 9000 END, i + 20, i % 2 FROM generate_series(0, 5) AS i'), 3::bigint, 'new points');
SELECT results_eq($$ SELECT line, position, point FROM abacus_lines('field') WHERE line >= 18 $$,
    $$ VALUES (18::bigint, -5::bigint, 9000::bigint), (18, -4, 9001), (19, -3, 9002), (19, -2, 9003), (20, -1, 9004), (20, 0, 9005) $$, 'have ids in this order');

-- crossings: the error counts them and shows them, abacus_crossings returns them
CREATE FUNCTION pg_temp.parts(statement text, OUT state text, OUT message text, OUT detail text, OUT hint text) LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE statement;
EXCEPTION WHEN OTHERS THEN
    GET STACKED DIAGNOSTICS state = RETURNED_SQLSTATE, message = MESSAGE_TEXT, detail = PG_EXCEPTION_DETAIL, hint = PG_EXCEPTION_HINT;
END $$;
SELECT abacus_triangulate('wide', 'VALUES (1, 0, 0), (2, 100, 0), (3, 100, 100), (4, 0, 100), (5, 50, 50)');
SELECT abacus_constrain('wide', 'VALUES (1, 1, NULL, 0, 10), (1, 2, NULL, 100, 10)');
CREATE TABLE streets AS SELECT 10 + l AS line, p AS position, NULL::bigint AS point, l * 5 AS x, p * 90 + 5 AS y FROM generate_series(1, 15) AS l, generate_series(0, 1) AS p
    UNION ALL VALUES (90, 1, NULL::bigint, 0, 0), (90, 2, NULL, 100, 100), (91, 1, NULL, 0, 100), (91, 2, NULL, 100, 0);
SELECT results_eq($$ SELECT state, message, split_part(detail, E'\n', 1), cardinality(string_to_array(detail, E'\n')), hint FROM pg_temp.parts($x$ SELECT abacus_constrain('wide', 'TABLE streets') $x$) $$,
    $$ SELECT '22023', 'lines cross', format('There are %s crossings; these are the first ten:', count(*)), 11, 'Find all crossings with abacus_crossings().' FROM abacus_crossings('wide', 'TABLE streets') $$, 'the number and ten of them');
SELECT results_eq($$ SELECT split_part(detail, E'\n', 2) FROM pg_temp.parts($x$ SELECT abacus_constrain('wide', 'TABLE streets') $x$) $$,
    $$ SELECT format('Line %s after position %s crosses line %s after position %s at (%s, %s).', line_a, position_a, line_b, position_b, x, y) FROM abacus_crossings('wide', 'TABLE streets') LIMIT 1 $$, 'in words');
SELECT is((SELECT count(*) FROM abacus_crossings('wide', 'TABLE streets') WHERE line_a = 1), 17::bigint, 'lines of the mesh are crossed');
SELECT is_empty($$ SELECT * FROM abacus_crossings('wide', 'TABLE streets') WHERE (x, y) = (50, 50) $$, 'not in a vertex');
SELECT is((SELECT count(*) FROM abacus_lines('wide')), 2::bigint, 'nothing has changed');
SELECT is((SELECT count(*) FROM abacus_vertices('wide')), 7::bigint, 'nor are there new points');
SELECT abacus_unconstrain('wide', 'VALUES (1)');
SELECT is(abacus_constrain('wide', 'VALUES (2, 1, 1), (2, 2, 3), (3, 1, 1), (3, 2, 5)'), 2::bigint, 'lines may overlap');
SELECT results_eq($$ SELECT detail FROM pg_temp.parts($x$ SELECT abacus_constrain('wide', 'VALUES (4, 1, NULL, 30, 40), (4, 2, NULL, 40, 30)') $x$) $$,
    $$ VALUES (E'There are 2 crossings:\nLine 2 after position 1 crosses line 4 after position 1 at (35, 35).\nLine 3 after position 1 crosses line 4 after position 1 at (35, 35).') $$, 'each pair is one');
SELECT is(abacus_constrain('wide', 'VALUES (2, 1, NULL, 0, 10), (2, 2, NULL, 0, 100)', existing => 'replace'), 1::bigint, 'a line of that id is left out');
SELECT results_eq($$ SELECT state, detail FROM pg_temp.parts($x$ SELECT abacus_constrain('wide', 'VALUES (2, 1, NULL, 5, 0), (2, 2, NULL, 5, 20)', existing => 'replace') $x$) $$,
    $$ VALUES ('22023', 'Line 2 after position 1 crosses line 3 after position 1 at (5, 5).') $$, 'a line that replaces another crosses');
SELECT is((SELECT count(*) FROM abacus_crossings('wide', 'VALUES (1, 1, 1), (1, 2, 4), (3, 1, 2), (3, 2, 3)')), 0::bigint, 'the lines of the query instead of those with the same ids');
-- a vertex where lines pass through one another cannot go, also if it is one line that does
CREATE TEMP TABLE knot AS SELECT i AS id, i % 5 AS x, i / 5 AS y FROM generate_series(0, 24) AS i;
SELECT abacus_triangulate('knot_mesh', 'TABLE knot');
SELECT abacus_constrain('knot_mesh', 'VALUES (3, 1, 9), (3, 2, 15), (3, 3, 17), (3, 4, 2)');
SELECT throws_ok($$ SELECT abacus_delete('knot_mesh', 'VALUES (12, 2, 2)') $$, '55000', 'point 12 cannot be deleted: line 3 of the mesh would cross itself there', 'a loop');
SELECT throws_ok($$ SELECT abacus_delete('knot_mesh', 'SELECT id, x, y FROM knot WHERE id IN (6, 7, 8, 11, 12)') $$, '55000', 'point 12 cannot be deleted: line 3 of the mesh would cross itself there', 'with others');
SELECT abacus_constrain('knot_mesh', 'VALUES (4, 1, 10), (4, 2, 14)');
SELECT throws_ok($$ SELECT abacus_delete('knot_mesh', 'VALUES (12, 2, 2)') $$, '55000', 'point 12 cannot be deleted: lines 3, 4 of the mesh would cross there', 'and another line');
SELECT abacus_constrain('knot_mesh', 'VALUES (3, 1, 9), (3, 2, 15)', existing => 'replace');
SELECT abacus_unconstrain('knot_mesh', 'VALUES (4)');
SELECT is(abacus_delete('knot_mesh', 'VALUES (12, 2, 2)'), 1::bigint, 'without the loop it goes');
SELECT is_empty($$ SELECT * FROM abacus_check('knot_mesh') $$, 'sound');
-- points and lines in one call
SELECT is(abacus_triangulate('with_lines', 'TABLE point', lines => 'VALUES (1, 1, 0), (1, 2, 22)'), abacus_triangulate('without', 'TABLE point'), 'points and lines in one call');
SELECT is((SELECT count(*) FROM abacus_edges('with_lines', fixed => true)), 1::bigint, 'which fixes edges');
SELECT throws_ok($$ SELECT abacus_triangulate('wrong', 'TABLE point', lines => 'SELECT 1') $$, '42804', 'the query of lines returns 1 column');
SELECT throws_ok($$ SELECT abacus_triangulate('wrong', 'TABLE point', lines => 'DELETE FROM point') $$, '22023', NULL, 'lines come from a SELECT');

-- meshes that cannot have lines
SELECT abacus_triangulate('solid', 'SELECT i, i % 2, i / 2 % 2, i / 4 FROM generate_series(0, 7) AS i', dimension => 3);
SELECT throws_ok($$ SELECT abacus_constrain('solid', 'VALUES (1, 1, 0), (1, 2, 1)') $$, '55000', 'mesh "solid" has dimension 3', 'in space');
SELECT is_empty($$ SELECT * FROM abacus_lines('solid') $$, 'it has none');
SELECT is_empty($$ SELECT * FROM abacus_edges('solid', fixed => true) $$, 'nor fixed edges');
SELECT abacus_load('notch', 'VALUES (1, 0, 0), (2, 2, 0), (3, 0.5, 0.5), (4, 0, 2)', 'VALUES (1, 2, 3), (1, 3, 4)');
SELECT throws_ok($$ SELECT abacus_constrain('notch', 'VALUES (1, 1, 2), (1, 2, 3)') $$, '55000', 'the mesh does not fill the convex hull of its vertices', 'one that cannot be changed');
SELECT abacus_octree_create('soil', 2, '{0,0}', '{1,1}');
SELECT throws_ok($$ SELECT abacus_constrain('soil', 'VALUES (1, 1, 2), (1, 2, 3)') $$, NULL, NULL, 'an octree');
SELECT throws_ok($$ SELECT * FROM abacus_lines('soil') $$, NULL, NULL, 'which has none');
SELECT throws_ok($$ SELECT * FROM abacus_lines('point') $$, '42809', '"point" is not a mesh', 'a table');
CREATE TABLE cap_lines (i int);
SELECT abacus_triangulate('cap', 'TABLE point');
SELECT throws_ok($$ SELECT abacus_constrain('cap', 'VALUES (1, 1, 0), (1, 2, 30)') $$, '42P07', 'relation "cap_lines" already exists', 'the name is taken');

-- published
SELECT is(abacus_publish('field', geometry => false)::text, '{field_cells,field_points,field_fixed_edges,field_breaklines}', 'published');
SELECT results_eq('TABLE field_breaklines', $$ SELECT * FROM abacus_lines('field') $$, 'lines as a table');
SELECT results_eq('SELECT * FROM field_fixed_edges', $$ SELECT * FROM abacus_edges('field', fixed => true) $$, 'fixed edges as a table');
SELECT is(abacus_publish('field', 'c', 'p', geometry => false)::text, '{c,p,field_fixed_edges,field_breaklines}', 'views are not made again');
SELECT is(abacus_publish('field', 'd', 'q', geometry => false, fixed_edges => 'Edges', breaklines => 'barriers')::text, '{d,q,"\"Edges\"",barriers}', 'other names');
SELECT throws_ok($$ SELECT abacus_publish('field', 'e', 'r', geometry => false, breaklines => 'point') $$, '42P07', 'relation "point" already exists', 'a name that is taken');
SELECT abacus_create('later', 2);
SELECT throws_ok($$ SELECT abacus_publish('later', 'e', 'r', geometry => false, breaklines => 'barriers') $$, '42P07', 'relation "barriers" already exists', 'even by a view of another mesh');
SELECT is(abacus_publish('solid', geometry => false)::text, '{solid_cells,solid_points}', 'in space there are none');
CREATE VIEW other AS SELECT * FROM abacus_lines('field'::regclass);
SELECT is(abacus_unpublish('field'), 10, 'they go with the tables');
SELECT has_view('other'::name);
DROP VIEW other;
SELECT abacus_triangulate('cap_line', 'TABLE point');
SELECT abacus_publish('cap_line', geometry => false);
SELECT is_empty('TABLE cap_line_breaklines', 'a mesh without lines');
SELECT is_empty('TABLE cap_line_fixed_edges', 'which has no fixed edges');
ALTER TABLE cap_line RENAME TO brim;
SELECT abacus_constrain('brim', 'VALUES (1, 1, 0), (1, 2, 30)');
SELECT is((SELECT count(*) FROM cap_line_breaklines), 2::bigint, 'lines that come later, of a mesh with another name');
DROP TABLE brim;
SELECT hasnt_view('cap_line_breaklines'::name);

-- rights
SELECT abacus_publish('field', geometry => false, fixed_edges => 'edges', breaklines => 'breaklines');
CREATE ROLE surveyor;
CREATE ROLE reader;
GRANT ALL ON field, field_vertices, cap, cap_vertices TO surveyor;
GRANT SELECT ON ALL TABLES IN SCHEMA public TO reader;
DROP TABLE cap_lines;
GRANT SELECT ON breaklines TO surveyor;
SET ROLE surveyor;
SELECT throws_ok('TABLE breaklines', '42501', 'permission denied for table field_lines', 'a view needs the privileges, too');
SELECT throws_ok($$ SELECT abacus_constrain('cap', 'VALUES (1, 1, 0), (1, 2, 30)') $$, '42501', 'must be owner of mesh "cap" to give it its first lines');
SELECT throws_ok($$ SELECT abacus_constrain('field', 'VALUES (50, 1, 0), (50, 2, 30)') $$, '42501', 'permission denied for table field_lines');
SELECT throws_ok($$ SELECT * FROM abacus_lines('field') $$, '42501', 'permission denied for table field_lines');
SELECT throws_ok($$ SELECT * FROM abacus_edges('field', fixed => true) $$, '42501', 'permission denied for table field_lines');
SELECT throws_ok($$ SELECT * FROM abacus_crossings('field', 'VALUES (1, 1, 0, 0)') $$, '42501', 'permission denied for table field_lines');
RESET ROLE;
GRANT ALL ON field_lines TO surveyor;
SET ROLE surveyor;
SELECT is(abacus_constrain('field', 'VALUES (50, 1, 0), (50, 2, 30)'), 1::bigint, 'with privileges on all three tables');
SELECT is(abacus_unconstrain('field', 'VALUES (50)'), 1::bigint, 'the same');
SET ROLE reader;
SELECT isnt_empty($$ SELECT * FROM abacus_lines('field') $$, 'a reader sees them');
SELECT isnt_empty('TABLE breaklines', 'in a view as well');
SELECT isnt_empty('TABLE edges', 'and their edges');
SELECT throws_ok($$ SELECT abacus_unconstrain('field', 'VALUES (1)') $$, '42501', NULL, 'but cannot change them');
RESET ROLE;
-- another owner's mesh, by a superuser: the tables have one owner
ALTER TABLE cap OWNER TO surveyor;
ALTER TABLE cap_vertices OWNER TO surveyor;
GRANT CREATE ON SCHEMA public TO surveyor;
SELECT is(abacus_constrain('cap', 'VALUES (1, 1, 0), (1, 2, 30)'), 1::bigint, 'a superuser');
SELECT table_owner_is('cap_lines', 'surveyor'::name);
ALTER TABLE cap_lines ENABLE ROW LEVEL SECURITY;
ALTER TABLE cap_lines FORCE ROW LEVEL SECURITY;
SET ROLE surveyor;
SELECT throws_ok($$ SELECT * FROM abacus_lines('cap') $$, '0A000', NULL, 'row-level security');
RESET ROLE;

-- the table is lost
DROP TABLE cap_lines;
SELECT throws_ok($$ SELECT * FROM abacus_lines('cap') $$, '42P01', 'mesh "cap" has lines, but no table of lines');
SELECT throws_ok($$ SELECT * FROM abacus_edges('cap', fixed => true) $$, '42P01', 'mesh "cap" has lines, but no table of lines');
SELECT lives_ok($$ DROP TABLE cap $$, 'it can be dropped');

-- a rule that keeps rows out; no id is left
SELECT abacus_triangulate('ruled', 'TABLE point');
SELECT abacus_constrain('ruled', 'VALUES (1, 1, 0), (1, 2, 30)');
CREATE RULE nothing AS ON INSERT TO ruled_lines DO INSTEAD NOTHING;
SELECT throws_ok($$ SELECT abacus_constrain('ruled', 'VALUES (2, 1, 0), (2, 2, 2)') $$, '55000',
                 'a rule or a trigger interferes with the table of lines');
DROP RULE nothing ON ruled_lines;
CREATE RULE nothing AS ON DELETE TO ruled_lines DO INSTEAD NOTHING;
SELECT throws_ok($$ SELECT abacus_unconstrain('ruled', 'VALUES (1)') $$, '55000', 'a rule or a trigger interferes with the table of lines');
SELECT throws_ok($$ SELECT abacus_constrain('ruled', 'VALUES (1, 1, 0), (1, 2, 2)', existing => 'replace') $$, '55000',
                 'a rule or a trigger interferes with the table of lines');
DROP RULE nothing ON ruled_lines;
CREATE FUNCTION pg_temp.keep() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RETURN CASE WHEN OLD.position > 1 THEN OLD END; END $$;
CREATE TRIGGER keeps BEFORE DELETE ON ruled_lines FOR EACH ROW EXECUTE FUNCTION pg_temp.keep();
SELECT throws_ok($$ SELECT abacus_unconstrain('ruled', 'VALUES (1)') $$, '55000', 'a rule or a trigger interferes with the table of lines');
DROP TRIGGER keeps ON ruled_lines;
SELECT abacus_insert('ruled', 'VALUES (9223372036854775807, 1.5, 1.5, 0)');
SELECT throws_ok($$ SELECT abacus_constrain('ruled', 'VALUES (2, 1, 0, 0, 0), (2, 2, NULL, 0.5, 0.75)') $$, '54000',
                 'no id is left above the greatest one, 9223372036854775807');
SELECT is_empty($$ SELECT * FROM abacus_check('ruled') $$, 'nothing has changed');

-- a temporary mesh; operators of a hostile search path are not used
SELECT abacus_triangulate('pg_temp.short', 'TABLE point');
SELECT is(abacus_constrain('short', 'VALUES (1, 1, 0), (1, 2, 30)'), 1::bigint, 'a temporary mesh');
SELECT is((SELECT relpersistence::text FROM pg_class WHERE oid = 'short_lines'::regclass), 't', 'whose lines are temporary');
CREATE SCHEMA hostile;
CREATE FUNCTION hostile.never(bigint, bigint) RETURNS boolean LANGUAGE plpgsql AS $$ BEGIN RAISE EXCEPTION 'called'; END $$;
CREATE FUNCTION hostile.never(float8, float8) RETURNS boolean LANGUAGE plpgsql AS $$ BEGIN RAISE EXCEPTION 'called'; END $$;
CREATE OPERATOR hostile.= (LEFTARG = bigint, RIGHTARG = bigint, FUNCTION = hostile.never);
CREATE OPERATOR hostile.= (LEFTARG = float8, RIGHTARG = float8, FUNCTION = hostile.never);
CREATE OPERATOR hostile.< (LEFTARG = bigint, RIGHTARG = bigint, FUNCTION = hostile.never);
SET LOCAL search_path = hostile, public, pg_catalog;
SELECT is(public.abacus_constrain('field', 'VALUES (1, 1, NULL, 0, 0), (1, 2, 30, 3, 0)', existing => 'replace') > 0, true, 'a hostile search path');
SELECT is(public.abacus_unconstrain('field', 'VALUES (1)') > 0, true, 'the same');
SELECT is((SELECT count(*) > 0 FROM public.abacus_crossings('field', 'VALUES (1, 1, 0), (1, 2, 30)')), false, 'the same of crossings');
SELECT throws_ok($$ SELECT public.abacus_constrain('field', 'VALUES (801, 1, 0), (801, 2, 22), (802, 1, 2), (802, 2, 30)') $$, '22023', 'lines cross', 'the same of their error');
SELECT is(public.abacus_delete('field', 'VALUES (0, 0, 0)') > 0, true, 'the same in questions of the core');
RESET search_path;

-- points of lines in a mesh with many vertices are looked up, and found as by a scan
SELECT abacus_triangulate('broad', 'SELECT 100 * i + j AS id, i::float8 AS x, j::float8 AS y, (i + j)::float8 AS h FROM generate_series(0, 40) AS i, generate_series(0, 40) AS j');
SELECT abacus_insert('broad', 'VALUES (5000, 7, 7, 14)'); -- repeats vertex 707
SELECT is(abacus_constrain('broad', 'SELECT 1, 1, NULL::bigint, 0.5, 0.5 UNION ALL SELECT 1, 2, NULL, 2, 3'), 1::bigint, 'a new point and a vertex');
SELECT is((SELECT string_agg(point::text, ' ' ORDER BY position) FROM abacus_lines('broad')), '5001 203', 'the new one has an id above all others');
SELECT throws_ok($$SELECT abacus_constrain('broad', 'VALUES (2, 1, 101, 20.5, 0.5), (2, 2, NULL, 25.5, 5.25)')$$, '22023', 'point 101 is at another place in the mesh');
SELECT throws_ok($$SELECT abacus_constrain('broad', 'VALUES (2, 1, 5000, 20.5, 0.5), (2, 2, NULL, 25.5, 5.25)')$$, '22023', 'point 5000 is at another place in the mesh', 'a repeated point too');
SELECT throws_ok($$SELECT abacus_constrain('broad', 'VALUES (2, 1, 6000, 20.5, 0.5), (2, 2, 6000, 25.5, 5.25)')$$, '22023', 'point 6000 is given with two places', 'and a new one');
SELECT is(abacus_constrain('broad', 'VALUES (2, 1, 5000, 7, 7), (2, 2, 909, 9, 9), (2, 3, 7000, 9.5, 9.5)'), 1::bigint, 'a repeated point, a vertex and a new id at their places');
SELECT is(abacus_constrain('broad', 'VALUES (3, 1, NULL::bigint, 30.5, 0.5), (3, 2, NULL, 30.5, 8.5)'), 1::bigint, 'new ids');
SELECT is((SELECT string_agg(point::text, ' ' ORDER BY position) FROM abacus_lines('broad') WHERE line = 3), '7001 7002', 'above those that lines gave');
SELECT abacus_insert('broad', 'VALUES (8000, 35.5, 35.5, 1)');
SELECT abacus_delete('broad', 'VALUES (8000, 35.5, 35.5, 1)');
SELECT throws_ok($$SELECT abacus_constrain('broad', 'SELECT 4, 1, NULL::bigint, 12::float8, 30.5::float8, 4::float8 AS h UNION ALL SELECT 4, 2, NULL, 14, 31, 46')$$, '22023', 'attribute "h" has two values at (14, 31)', 'attributes of vertices are compared');
SELECT is(abacus_constrain('broad', 'SELECT 4, 1, NULL::bigint, 12::float8, 30.5::float8, 4::float8 AS h UNION ALL SELECT 4, 2, NULL, 14, 31, 45'), 1::bigint, 'attributes');
SELECT cmp_ok((SELECT min(point) FROM abacus_lines('broad') WHERE line = 4 AND position = 1), '>', 7002::bigint, 'no id comes twice');
SELECT abacus_stage('broad', 'VALUES (9000, 33.5, 1.5, 1)');
SELECT is(abacus_constrain('broad', 'VALUES (5, 1, NULL::bigint, 33.5, 1.5), (5, 2, NULL, 34.5, 2.5)'), 1::bigint, 'a point that waits');
SELECT abacus_triangulate('broad');
SELECT is((SELECT string_agg(point::text, ' ' ORDER BY position) FROM abacus_lines('broad') WHERE line = 5), '9000 9001', 'is found');
SELECT is((SELECT count(DISTINCT id) FROM abacus_vertices('broad')), (SELECT count(*) FROM abacus_vertices('broad')), 'all ids are different');
SELECT is((SELECT count(*) FROM abacus_check('broad')), 0::bigint, 'the mesh is sound');

SELECT * FROM finish();
ROLLBACK;

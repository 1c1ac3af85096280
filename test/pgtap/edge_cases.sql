-- Small numbers of points, wrong objects, NULL arguments.
BEGIN;
SELECT no_plan();

CREATE FUNCTION pg_temp.state(command text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN '00000';
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;

-- 0 to 6 points on a convex curve: max(n - 2, 0) triangles
SELECT is(abacus_triangulate('few' || n, format('SELECT i, i, i * i FROM generate_series(1, %s) i', n)),
          greatest(n - 2, 0)::bigint, n || ' points in convex position')
FROM generate_series(0, 6) n;
SELECT is_empty(format('SELECT * FROM abacus_check(''few%s'')', n), n || ' points checked') FROM generate_series(0, 6) n;
SELECT is((SELECT count(*) FROM abacus_simplices(('few' || n)::regclass)), greatest(n - 2, 0)::bigint, n || ' points listed')
FROM generate_series(0, 6) n;

-- NULL arguments
SELECT is(abacus_stage(NULL, 'SELECT 1, 2, 3'), NULL, 'stage NULL');
SELECT is(abacus_triangulate(NULL::regclass), NULL, 'triangulate NULL');
SELECT is(abacus_locate(NULL, 1, 2), NULL, 'locate in NULL');
SELECT is(abacus_locate('few3', NULL, 2), NULL, 'locate at NULL');
SELECT is(abacus_walk('few3', NULL, 0), NULL, 'walk from NULL');
SELECT is(abacus_walk('few3', ROW(NULL, NULL, NULL, NULL, NULL)::abacus_simplex, 0), NULL, 'walk from a row of NULLs');
SELECT is_empty('SELECT * FROM abacus_simplices(NULL)', 'simplices of NULL');
SELECT is_empty('SELECT * FROM abacus_vertices(NULL)', 'vertices of NULL');
SELECT is(pg_temp.state('SELECT * FROM abacus_check(NULL)'), '22004', 'check of NULL');
SELECT is(pg_temp.state('SELECT * FROM abacus_check(''few3'', NULL)'), '22004', 'check for NULL faults');
SELECT is_empty('SELECT * FROM abacus_stats(NULL)', 'stats of NULL');
SELECT is(abacus_draw(NULL), NULL, 'draw NULL');
SELECT is(abacus_draw_section(NULL, '{0,0,0}', '{0,0,1}'), NULL, 'draw a section of NULL');
SELECT is(pg_temp.state('SELECT abacus_create(NULL, 2)'), '22004', 'create NULL');
SELECT is(pg_temp.state('SELECT * FROM abacus_check(''few3'', 0)'), '22023', 'check for no fault');

-- a procedure that commits, in a transaction
SELECT is_procedure('abacus_build', ARRAY['regclass', 'bigint'], 'build in batches');
SELECT is(pg_temp.state('CALL abacus_build(''few3'')'), '2D000', 'build in a transaction');
SELECT is(pg_temp.state('CALL abacus_build(NULL, 0)'), '2D000', 'whatever the arguments');

-- objects that are not meshes, for each function
CREATE TEMP TABLE thing (code bigint, part bigint, page bytea);
CREATE TEMP VIEW looks AS TABLE few3;
CREATE TEMP SEQUENCE counter;
SELECT is(pg_temp.state(format(f, o)), '42809', format(f, o))
FROM (VALUES ('thing'), ('looks'), ('counter'), ('few3_vertices'), ('few3_pkey'), ('pg_class')) AS o (o),
     (VALUES ('SELECT abacus_stage(%L, ''SELECT 1, 2, 3'')'), ('SELECT abacus_triangulate(%L::regclass)'),
             ('SELECT abacus_locate(%L, 1, 2)'), ('SELECT abacus_walk(%L, ROW(1,2,3,4,5)::abacus_simplex, 0)'),
             ('SELECT * FROM abacus_simplices(%L)'), ('SELECT * FROM abacus_vertices(%L)'),
             ('SELECT * FROM abacus_check(%L)'), ('SELECT * FROM abacus_stats(%L)'), ('SELECT abacus_draw(%L)'),
             ('SELECT abacus_draw_section(%L, ''{0,0,0}'', ''{0,0,1}'')')) AS f (f);
SELECT is(pg_temp.state('SELECT abacus_locate(0::regclass, 1, 2)'), '42P01', 'no object');
-- a row type of the same name is not ours
CREATE SCHEMA forged;
CREATE TYPE forged.abacus_simplex_page AS (code bigint, part bigint, page bytea);
CREATE TABLE forged.mesh OF forged.abacus_simplex_page (PRIMARY KEY (code, part));
INSERT INTO forged.mesh VALUES (-1, 0, '\x00');
SELECT is(pg_temp.state('SELECT abacus_locate(''forged.mesh'', 1, 2)'), '42809', 'a forged mesh');

-- sections of meshes of dimension 3 with few tetrahedra or none, which NOTICEs report
SET LOCAL client_min_messages = warning;
SELECT is(abacus_triangulate('solid' || n, format('SELECT i, i, i * i, i * i * i FROM generate_series(1, %s) i', n), dimension => 3) > 0,
          n > 3, n || ' points in space')
FROM generate_series(0, 6) n;
SELECT is(substr(abacus_draw_section(('solid' || n)::regclass, '{2,4,8}', normal::float8[], 20), 2, 3), 'PNG',
          format('a section of %s points, normal %s', n, normal))
FROM generate_series(0, 6) n, (VALUES ('{0,0,1}'), ('{1,0,0}'), ('{-1,1,0.5}'), ('{1e-300,0,1e300}')) AS f (normal);
SELECT is(pg_temp.state(format('SELECT abacus_draw_section(%s)', arguments)), state, format('abacus_draw_section(%s)', arguments))
FROM (VALUES ($$'few6', '{0,0,0}', '{0,0,1}'$$, '22023'), ($$'solid6', '{}', '{0,0,1}'$$, '2202E'),
             ($$'solid6', '{0,0,0}', '{{0,0,1}}'$$, '2202E'), ($$'solid6', '{0,0,0}', '{-0,0,-0}'$$, '22023'),
             ($$'solid6', '{0,0,0}', '{0,0,5e-324}'$$, '00000'), ($$'solid6', '{0,0,-Infinity}', '{0,0,1}'$$, '22023'),
             ($$'solid6', '{0,0,0}', '{0,0,1}', 16385$$, '22023'), ($$'solid6', '{0,0,0}', '{0,0,1}', 8, -1$$, '22023'),
             ($$'solid6', '{0,0,0}', '{0,0,1}', attribute => 'vs'$$, '42703'),
             ($$'solid6', '{0,0,0}', '{0,0,1}', attribute => ''$$, '42703'),
             ($$'solid6', '{0,0,0}', '{0,0,1}', upper => '{1,1,1}'$$, '22023'),
             ($$'solid6', '{0,0,0}', '{0,0,1}', lower => '{1,1,1}', upper => '{2,2,2}'$$, '22023')) AS f (arguments, state);
SELECT is(pg_temp.state('SELECT abacus_draw(''solid6'')'), '22023', 'abacus_draw of a mesh in space');

-- a mesh made by hand has no header
CREATE TABLE by_hand OF abacus_simplex_page (PRIMARY KEY (code, part));
CREATE TABLE by_hand_vertices OF abacus_vertex_page (PRIMARY KEY (first, part));
SELECT is(pg_temp.state('SELECT abacus_locate(''by_hand'', 1, 2)'), 'XX001', 'no header');
INSERT INTO by_hand SELECT * FROM few6;
INSERT INTO by_hand_vertices SELECT * FROM few6_vertices;
SELECT is_empty($$ SELECT * FROM abacus_check('by_hand') $$, 'copied with SQL, it is a mesh');
SELECT is(abacus_stage('by_hand', 'SELECT 7, 7, 49') + abacus_triangulate('by_hand'), 6::bigint, 'that can grow');
INSERT INTO by_hand VALUES (0, -5, '');
SELECT is(pg_temp.state('SELECT count(*) FROM abacus_simplices(''by_hand'')'), 'XX001', 'a negative part');
DELETE FROM by_hand WHERE part = -5;
ALTER TABLE by_hand ALTER page DROP NOT NULL;
UPDATE by_hand SET page = NULL WHERE code >= 0;
SELECT is(pg_temp.state('SELECT count(*) FROM abacus_simplices(''by_hand'')'), 'XX001', 'a NULL page');

-- an event trigger that drops new objects
CREATE FUNCTION drop_what_is_made() RETURNS event_trigger LANGUAGE plpgsql AS
    $$ BEGIN EXECUTE 'DROP TABLE IF EXISTS ' || current_setting('edge.dropped'); END $$;
CREATE EVENT TRIGGER drops ON ddl_command_end WHEN TAG IN ('CREATE TABLE') EXECUTE FUNCTION drop_what_is_made();
SET LOCAL client_min_messages = warning; -- no notices of the other CREATE TABLE
SET LOCAL edge.dropped = 'doomed';
SELECT is(pg_temp.state('SELECT abacus_create(''doomed'', 2)'), '42P01', 'a mesh dropped at once');
SET LOCAL edge.dropped = 'doomed_vertices';
SELECT is(pg_temp.state('SELECT abacus_create(''doomed'', 2)'), '42P01', 'its vertex table dropped at once');
DROP EVENT TRIGGER drops;
SELECT lives_ok('SELECT abacus_create(''doomed'', 2)', 'and without that trigger');

SELECT * FROM finish();
ROLLBACK;

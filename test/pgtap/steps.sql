-- Steps of a solution: stored by parts, replaced, refused; the table of steps with its mesh; privileges.
BEGIN;
SELECT no_plan();
CREATE TABLE points AS SELECT i AS id, (i * 0.7548776662466927 % 1)::float8 AS x, (i * 0.5698402909980532 % 1)::float8 AS y, (i * 0.4301597090019468 % 1)::float8 AS z FROM generate_series(1, 500) AS i;
SELECT isnt(abacus_triangulate('plane', 'SELECT id, x, y, z FROM points', '{z}'), NULL, 'a plane');
SELECT isnt(abacus_triangulate('space', 'SELECT id, x, y, z FROM points', dimension => 3), NULL, 'a space');
-- the solution: 2x + y, and NULL where x is small
CREATE FUNCTION pg_temp.own(mesh regclass, parts int, part int, weight text DEFAULT NULL) RETURNS TABLE (id bigint, u float8, w float8) LANGUAGE sql AS
    $$ SELECT id, 2 * x + y, CASE WHEN x > 0.1 THEN x END FROM abacus_share_vertices(mesh, parts, part, 0, weight) WHERE owner = part $$;
CREATE FUNCTION pg_temp.store(mesh regclass, step bigint, parts int, part int, weight text DEFAULT NULL) RETURNS bigint LANGUAGE sql AS
    $$ SELECT abacus_store(mesh, step, parts, part, format('SELECT * FROM pg_temp.own(%L, %s, %s, %L)', mesh, parts, part, weight), weight) $$;

SELECT is_empty($$ SELECT * FROM abacus_steps('plane') $$, 'no steps');
SELECT is(pg_temp.store('plane', 1, 3, 0), (SELECT vertices FROM abacus_partition('plane', 3) WHERE part = 0), 'the vertices of a part');
SELECT results_eq($$ SELECT step, parts, stored, whole FROM abacus_steps('plane') $$, $$ VALUES (1::bigint, 3, 1, false) $$, 'not whole');
SELECT is((SELECT sum(pg_temp.store('plane', 1, 3, p))::bigint FROM generate_series(1, 2) AS p), (SELECT sum(vertices)::bigint FROM abacus_partition('plane', 3) WHERE part > 0), 'the others');
SELECT results_eq($$ SELECT * FROM abacus_steps('plane') $$, $$ VALUES (1::bigint, 3, 3, 500::bigint, true) $$, 'whole');
SELECT set_eq($$ SELECT id, "values"[1] AS u, "values"[2] AS w FROM plane_steps WHERE step = 1 AND id IS NOT NULL $$, $$ SELECT id, 2 * x + y AS u, CASE WHEN x > 0.1 THEN x END AS w FROM points $$, 'all values');
-- again, in place of the former
SELECT is(abacus_store('plane', 1, 3, 1, 'SELECT id, -1, -2 FROM pg_temp.own(''plane'', 3, 1)'), (SELECT vertices FROM abacus_partition('plane', 3) WHERE part = 1), 'a part once more');
SELECT is((SELECT count(*) FROM plane_steps WHERE "values" = '{-1,-2}'), (SELECT vertices FROM abacus_partition('plane', 3) WHERE part = 1), 'its new values');
SELECT is((SELECT count(*) FROM plane_steps), 503::bigint, 'nothing else');
SELECT is((SELECT sum(pg_temp.store('plane', step, 2, p, 'z'))::bigint FROM unnest('{-7,9223372036854775807}'::bigint[]) AS step, generate_series(0, 1) AS p), 1000::bigint, 'steps with any number, by weight');
SELECT is((SELECT count(*) FROM abacus_steps('plane') WHERE whole), 3::bigint, 'all whole');
SELECT is((SELECT sum(pg_temp.store('space', 1, 9, p))::bigint FROM generate_series(0, 8) AS p), 500::bigint, 'in space');
SELECT is((SELECT count(*) FROM pg_inherits WHERE inhparent = 'plane_steps'::regclass), 3::bigint, 'a partition for each step');
-- weights join steps: the value between the vertices
SELECT is_empty($$ SELECT s.* FROM (SELECT p.x, p.y, sum(w.weight * s."values"[1]) AS u FROM (VALUES (0.3, 0.4), (0.7, 0.2)) AS p (x, y), abacus_weights('plane', p.x, p.y) AS w, plane_steps AS s
                             WHERE s.id = w.vertex AND s.step = -7 GROUP BY p.x, p.y) AS s WHERE abs(u - (2 * x + y)) > 1e-12 $$, 'a value between the vertices');
SELECT is(abacus_update('plane', 'SELECT id, x, y, "values"[1] AS z FROM plane_steps JOIN points USING (id) WHERE step = -7'), 500::bigint, 'as an attribute');
SELECT is(round(abacus_interpolate('plane', 0.3, 0.4)::numeric, 9), 1.0, 'interpolated');

-- what is refused changes nothing
CREATE TABLE before AS SELECT * FROM plane_steps;
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT id, u FROM pg_temp.own(''plane'', 3, 0) UNION ALL SELECT 7777, 1') $$, '22023', 'id 7777 is not that of a vertex of part 0', 'an id that nobody has');
SELECT throws_like($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT id, u FROM pg_temp.own(''plane'', 3, 0) UNION ALL SELECT id, u FROM pg_temp.own(''plane'', 3, 1)') $$, 'id % is not that of a vertex of part 0', 'ids of another part');
SELECT throws_like($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT id, u FROM pg_temp.own(''plane'', 3, 0) ORDER BY id OFFSET 1') $$, 'the source query has no row for vertex % of part 0', 'one is missing');
SELECT throws_like($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT id, u FROM pg_temp.own(''plane'', 3, 0) UNION ALL (SELECT id, u FROM pg_temp.own(''plane'', 3, 0) LIMIT 1)') $$, 'the source query has the id % twice', 'one twice');
SELECT throws_ok($$ SELECT pg_temp.store('plane', 1, 4, 3) $$, '23505', 'another part has stored a vertex of this part at this step', 'cut otherwise');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 0, 0, 'SELECT 1') $$, '22023', 'parts must be at least 1, not 0', 'no parts');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 3, 'SELECT 1') $$, '22023', 'part must be between 0 and 2, not 3', 'no such part');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, NULL, 'SELECT 1') $$, '22004', NULL, 'NULL');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT NULL::bigint, 1') $$, '22004', NULL, 'an id that is NULL');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT 1, ''a''::text') $$, '42804', NULL, 'a text');
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 0, 'DELETE FROM points RETURNING id, x') $$, '22023', NULL, 'a change');
SELECT throws_ok($$ SELECT abacus_store('points', 1, 3, 0, 'SELECT 1') $$, '42809', NULL, 'not a mesh');
SELECT throws_ok($$ SELECT abacus_store('plane', 8, 3, 0, 'SELECT 1, 2') $$, '22023', NULL, 'a step that fails');
SELECT set_eq('TABLE before', 'TABLE plane_steps', 'nothing is stored');
SELECT hasnt_table('plane_steps_8');
-- a query that changes the mesh
CREATE FUNCTION pg_temp.grow(mesh regclass, place int) RETURNS int LANGUAGE sql VOLATILE AS $$ SELECT abacus_insert(mesh, format('SELECT %s, 0.5, %s / 1000.0, 0', place, place))::int $$;
SELECT throws_ok($$ SELECT abacus_store('plane', 1, 3, 0, 'SELECT id, CASE row_number() OVER () WHEN 1 THEN pg_temp.grow(''plane'', 701) END FROM pg_temp.own(''plane'', 3, 0)') $$, '55006', 'the statement that stores values also changes mesh "plane"', 'changes the mesh');
SELECT throws_ok($$ SELECT pg_temp.grow('plane', 702), pg_temp.store('plane', 1, 3, 0) $$, '55006', 'the statement that stores values also changes mesh "plane"', 'so does another part of the statement');
SELECT is((SELECT count(*) FROM abacus_vertices('plane')), 500::bigint, 'the mesh is as it was');
SELECT set_eq('TABLE before', 'TABLE plane_steps', 'and its steps');
-- infinities are kept, NaN is NULL
SELECT is(abacus_store('plane', 5, 1, 0, 'SELECT id, ''Infinity''::float8, ''-Infinity''::float8, ''NaN''::float8 FROM points'), 500::bigint, 'values that are no numbers');
SELECT set_eq('SELECT "values" FROM plane_steps WHERE step = 5 AND id IS NOT NULL', $$ VALUES (ARRAY['Infinity', '-Infinity', NULL]::float8[]) $$, 'as they are stored');
DELETE FROM plane_steps WHERE step = 5;
-- names that are too long
SELECT isnt(abacus_triangulate(repeat('n', 52), 'SELECT id, x, y FROM points'), NULL, 'a long name');
PREPARE store_long(bigint) AS SELECT abacus_store(repeat('n', 52)::regclass, $1, 1, 0, 'SELECT id FROM points');
SELECT is((SELECT count(*) FROM pg_class WHERE relname LIKE 'nnn%steps%'), 0::bigint, 'has no steps');
CREATE FUNCTION pg_temp.hint_of(statement text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
    state text;
    hint text;
BEGIN
    EXECUTE statement;
    RETURN 'none';
EXCEPTION WHEN name_too_long THEN
    GET STACKED DIAGNOSTICS hint = PG_EXCEPTION_HINT, state = MESSAGE_TEXT;
    RETURN state || ' ' || hint;
END $$;
SELECT is(pg_temp.hint_of('EXECUTE store_long(-12345678)'), format('name of mesh "%s" is too long for step -12345678 Rename the mesh.', repeat('n', 52)), 'the first step has no table yet');
SELECT is(pg_temp.hint_of('EXECUTE store_long(1)'), 'none', 'a shorter number');
SELECT is(pg_temp.hint_of('EXECUTE store_long(12345678)'), format('name of table "%s_steps" is too long for step 12345678 Rename the table, which stays that of the mesh.', repeat('n', 52)), 'from then on the table decides');
SELECT lives_ok(format('ALTER TABLE %s_steps RENAME TO short', repeat('n', 52)), 'renamed');
SELECT is(pg_temp.hint_of('EXECUTE store_long(12345678)'), 'none', 'as the hint says');
-- vertices with one id
SELECT isnt(abacus_triangulate('twins', 'VALUES (1, 0, 0), (1, 4, 0), (2, 4, 4), (3, 0, 4)'), NULL, 'two vertices have one id');
SELECT throws_ok($$ SELECT abacus_store('twins', 1, 1, 0, 'VALUES (1, 5), (2, 5), (3, 5)') $$, '23505', 'two vertices of the part have the id 1', 'which names none');
-- no values but the ids
SELECT is(abacus_store('space', 2, 1, 0, 'SELECT id FROM points'), 500::bigint, 'no value at all');
-- parts that saw different states of the mesh make no whole step
SELECT isnt(abacus_insert('space', 'SELECT 501, 2, 2, 2'), NULL, 'the mesh changes');
SELECT isnt(abacus_store('space', 3, 2, 0, 'SELECT * FROM pg_temp.own(''space'', 2, 0)'), NULL, 'one part');
SELECT isnt(abacus_label('space', 'SELECT code, v0, v1, v2, v3, 1 AS soil FROM abacus_simplices(''space'')'), NULL, 'and again');
SELECT isnt(abacus_store('space', 3, 2, 1, 'SELECT * FROM pg_temp.own(''space'', 2, 1)'), NULL, 'the other');
SELECT results_eq($$ SELECT stored, whole FROM abacus_steps('space') WHERE step = 3 $$, $$ VALUES (2, false) $$, 'not whole');

-- the table goes with its mesh
ALTER TABLE plane RENAME TO field;
SELECT is(pg_temp.store('field', 2, 1, 0), 500::bigint, 'the mesh renamed');
SELECT has_table('plane_steps_2');
SELECT is((SELECT count(*) FROM abacus_steps('field')), 4::bigint, 'has its steps');
-- privileges: the first step is the owner's, others need those on the table
CREATE ROLE rank_of_solver;
GRANT SELECT ON field, points TO rank_of_solver;
GRANT SELECT ON space TO rank_of_solver;
DROP TABLE space_steps;
SET LOCAL ROLE rank_of_solver;
SELECT throws_ok($$ SELECT abacus_store('space', 1, 1, 0, 'SELECT id, 1 FROM points UNION ALL SELECT 501, 1') $$, '42501', 'must be owner of mesh "space" to give it its first steps', 'not the first');
SELECT throws_ok($$ SELECT abacus_store('field', 3, 1, 0, 'SELECT id, 1 FROM points') $$, '42501', 'permission denied for table plane_steps', 'no privilege');
SELECT throws_ok($$ SELECT * FROM abacus_steps('field') $$, '42501', 'permission denied for table plane_steps', 'nor to read');
RESET ROLE;
GRANT SELECT, INSERT, UPDATE, DELETE ON plane_steps TO rank_of_solver;
SET LOCAL ROLE rank_of_solver;
SELECT is(abacus_store('field', 3, 1, 0, 'SELECT id, 1 FROM points'), 500::bigint, 'with them, also a new step');
RESET ROLE;
SELECT is((SELECT relowner FROM pg_class WHERE relname = 'plane_steps_3'), (SELECT relowner FROM pg_class WHERE relname = 'field'), 'which belongs to the owner');
ALTER TABLE plane_steps ENABLE ROW LEVEL SECURITY;
SET LOCAL ROLE rank_of_solver;
SELECT throws_ok($$ SELECT abacus_store('field', 4, 1, 0, 'SELECT id, 1 FROM points') $$, '0A000', NULL, 'no rows by policies');
RESET ROLE;
DROP TABLE field;
SELECT hasnt_table('plane_steps');
SELECT hasnt_table('plane_steps_3');
SELECT * FROM finish();
ROLLBACK;

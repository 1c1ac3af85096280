-- The source query: every type in every column, and every way to get it wrong.
BEGIN;
SELECT no_plan();
SELECT isnt(abacus_create('field', 2, '{height}'), NULL, 'a mesh with an attribute');

-- types: id, coordinate, attribute
CREATE TEMP TABLE types (type text, literal text, as_id boolean, as_number boolean);
INSERT INTO types VALUES
    ('smallint', '7', true, true), ('integer', '7', true, true), ('bigint', '7', true, true),
    ('real', '7.5', false, true), ('double precision', '7.5', false, true), ('numeric', '7.5', false, true),
    ('numeric(6,2)', '7.25', false, true), ('text', '7', false, false), ('boolean', 'true', false, false),
    ('date', '2000-01-01', false, false), ('point', '(1,2)', false, false), ('bigint[]', '{7}', false, false),
    ('oid', '7', false, false), ('abacus_page', '\x00', false, false), ('money', '7', false, false), ('jsonb', '7', false, false);
CREATE FUNCTION pg_temp.try(query text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    RETURN abacus_stage('field', query);
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;
SELECT is(pg_temp.try(format('SELECT %L::%s, 1, 2, 3', literal, type)), CASE WHEN as_id THEN '1' ELSE '42804' END, 'id of type ' || type) FROM types;
SELECT is(pg_temp.try(format('SELECT 1, %L::%s, 2, 3', literal, type)), CASE WHEN as_number THEN '1' ELSE '42804' END, 'x of type ' || type) FROM types;
SELECT is(pg_temp.try(format('SELECT 1, 2, %L::%s, 3', literal, type)), CASE WHEN as_number THEN '1' ELSE '42804' END, 'y of type ' || type) FROM types;
SELECT is(pg_temp.try(format('SELECT 1, 2, 3, %L::%s', literal, type)), CASE WHEN as_number THEN '1' ELSE '42804' END, 'attribute of type ' || type) FROM types;

-- values
SELECT is(pg_temp.try(format('SELECT 1, %L::float8, 0, 0', v)), s, 'x = ' || v)
FROM (VALUES ('NaN', '22023'), ('Infinity', '22023'), ('-Infinity', '22023'), ('1.7976931348623157e308', '1'), ('-5e-324', '1'), ('-0', '1')) AS t (v, s);
SELECT is(pg_temp.try(format('SELECT 1, %L::real, 0, 0', v)), s, 'x = real ' || v)
FROM (VALUES ('NaN', '22023'), ('Infinity', '22023'), ('3.4e38', '1')) AS t (v, s);
SELECT is(pg_temp.try(format('SELECT 1, 0, %L::numeric, 0', v)), s, 'y = numeric ' || v)
FROM (VALUES ('NaN', '22023'), ('Infinity', '22023'), ('1e308', '1'), ('1e309', '22023'), ('1e-400', '1')) AS t (v, s);
SELECT is(pg_temp.try(format('SELECT 1, 0, 0, %L::float8', v)), '1', 'attribute = ' || v)
FROM (VALUES ('NaN'), ('Infinity'), ('-Infinity'), ('1e308')) AS t (v);
SELECT is(pg_temp.try(format('SELECT %s::bigint, 0, 0, 0', v)), '1', 'id = ' || v)
FROM (VALUES ('9223372036854775807'), ('(-9223372036854775808)'), ('0'), ('(-1)')) AS t (v);
SELECT is(pg_temp.try('SELECT NULL::bigint, 0, 0, 0'), '22004', 'id NULL');
SELECT is(pg_temp.try('SELECT 1, NULL::float8, 0, 0'), '22004', 'x NULL');
SELECT is(pg_temp.try('SELECT 1, 0, NULL::numeric, 0'), '22004', 'y NULL');
SELECT is(pg_temp.try('SELECT 1, 0, 0, NULL::int'), '1', 'attribute NULL');
SELECT is(pg_temp.try('SELECT 1, 0, 0, NULL'), '1', 'attribute NULL without a type');
SELECT is(pg_temp.try('SELECT 1, 0, 0, NULL UNION ALL SELECT 2, 0, 0, ''1'''), '42804', 'attribute of no type');

-- shapes
SELECT is(pg_temp.try('SELECT 1'), '42804', 'one column');
SELECT is(pg_temp.try('SELECT'), '42804', 'no column');
SELECT is(pg_temp.try('SELECT 1, 2, 3'), '42804', 'attribute missing');
SELECT is(pg_temp.try('SELECT 1, 2, 3, 4, 5'), '42804', 'one column too many');
SELECT is(pg_temp.try('SELECT * FROM (VALUES (1, 2, 3, 4)) AS t WHERE false'), '0', 'no row');

-- statements
SELECT is(pg_temp.try(q), s, q) FROM (VALUES
    ('', '22023'), (';', '22023'), ('SELEC', '42601'), ('0101000000', '42601'), ('(1, 2)', '42601'), ('points', '42601'), (';;select 1, 2, 3, 4', '1'), ('SELECT 1, 2, 3, 4;', '1'),
    ('SELECT 1, 2, 3, 4; SELECT 1, 2, 3, 4', '22023'), ('VALUES (1, 2, 3, 4), (2, 3, 4, 5)', '2'),
    ('CREATE TABLE x ()', '22023'), ('SELECT 1, 2, 3, 4 INTO x', '22023'), ('SHOW ALL', '22023'),
    ('INSERT INTO types VALUES (''x'') RETURNING 1, 2, 3, 4', '22023'), ('COMMIT', '22023'),
    ('SELECT id, x, y, z FROM nowhere', '42P01'), ('SELECT nosuch, 1, 2, 3', '42703'),
    ('SELECT 1, 2, 3, 1 / 0', '22012'), ('SELECT 1, 2, 3, $1', '42P02'),
    ('SELECT 1, 2, 3, pg_sleep(0)', '42804'),
    ('SELECT 1 UNION ALL SELECT 2', '42804'), ('SELECT 1, 2, 3, 4 UNION ALL SELECT 5, 6, 7, 8 ORDER BY 1 DESC LIMIT 1', '1')
) AS t (q, s);

-- a function with side effects is the user's own business, but it cannot change this mesh
CREATE FUNCTION pg_temp.restage() RETURNS bigint LANGUAGE sql AS $$ SELECT abacus_stage('field', 'SELECT 1, 2, 3, 4') $$;
SELECT is(pg_temp.try('SELECT 1, 2, 3, pg_temp.restage()'), '55006', 'staging while staging the same mesh');
CREATE FUNCTION pg_temp.drop() RETURNS bigint LANGUAGE plpgsql AS $$ BEGIN DROP TABLE field; RETURN 1; END $$;
SELECT is(pg_temp.try('SELECT 1, 2, 3, pg_temp.drop()'), '55006', 'dropping the mesh while staging it');
-- ... nor the definition of its tables, on which writing pages depends
CREATE FUNCTION pg_temp.run(command text) RETURNS bigint LANGUAGE plpgsql AS $$ BEGIN EXECUTE command; RETURN 1; END $$;
SELECT is(pg_temp.try(format('SELECT 1, 2, 3, pg_temp.run(%L)', format(command, name))), '55006', format(command, name))
FROM unnest('{field,field_vertices}'::text[]) AS name,
     unnest('{DROP TABLE %I,TRUNCATE %I,ALTER TABLE %I NOT OF,ALTER TABLE %I NOT OF; ALTER TABLE %1$I ADD COLUMN other text,CREATE INDEX ON %I (part),ALTER TABLE %I SET UNLOGGED}'::text[]) AS command;

-- ... but any number of other meshes: in each, more rows are replaced than fit where those of the first are
-- remembered
CREATE FUNCTION pg_temp.points(first int, last int) RETURNS text LANGUAGE sql AS
    $$ SELECT format('SELECT i, i::bigint * 7919 %% 1000003, i::bigint * 104729 %% 1000033 FROM generate_series(%s, %s) AS i', first, last) $$;
SELECT abacus_triangulate('other_' || n, pg_temp.points(1, 3000)) FROM generate_series(0, 6) AS n;
CREATE FUNCTION pg_temp.change_others() RETURNS bigint LANGUAGE sql AS
    $$ SELECT sum(abacus_insert(format('other_%s', n)::regclass, pg_temp.points(3001, 6000))) FROM generate_series(1, 6) AS n $$;
SELECT is(abacus_insert('other_0', 'SELECT pg_temp.change_others(), 0.5, 0.5 UNION ALL ' || pg_temp.points(3001, 6000)), 3001::bigint,
          'changing six meshes while changing another');
SELECT is_empty(format('SELECT * FROM abacus_check(%L)', mesh), mesh || ' is sound') FROM (SELECT 'other_' || n AS mesh FROM generate_series(0, 6) AS n) AS others;

-- all accepted rows are there, and nothing else
SELECT is((SELECT count(*) FROM abacus_vertices('field')),
          (SELECT value::bigint FROM abacus_stats('field') WHERE name = 'points'), 'as many vertices as points');
SELECT lives_ok($$ SELECT abacus_triangulate('field') $$, 'and they triangulate');
SELECT is_empty($$ SELECT * FROM abacus_check('field') $$, 'soundly');

SELECT * FROM finish();
ROLLBACK;

-- abacus_track: how the triggers find their mesh, odd tables, points without a place.
BEGIN;
SELECT plan(75);

CREATE FUNCTION differences(mesh regclass, source text) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    there text := format('SELECT id, x, y FROM abacus_vertices(%L)', mesh);
    n bigint;
BEGIN
    EXECUTE format('SELECT (SELECT count(*) FROM (%1$s EXCEPT ALL %2$s) a)
                         + (SELECT count(*) FROM (%2$s EXCEPT ALL %1$s) b)
                         + (SELECT count(*) FROM abacus_check(%3$L))', source, there, mesh) INTO n;
    RETURN n;
END $$;

-- bound by a dependency, or found by name after a restore, which carries no dependency
CREATE TABLE wells (id bigint, x float8, y float8);
SELECT abacus_create('field', 2);
SELECT is(abacus_track('field', 'wells'), 0::bigint, 'an empty table is tracked');
SELECT is(count(*), 4::bigint, 'four triggers depend on the mesh')
FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'field'::regclass AND deptype = 'a';
DELETE FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'field'::regclass;
INSERT INTO wells SELECT i, i % 10, i / 10 FROM generate_series(0, 99) i;
SELECT is(differences('field', 'TABLE wells'), 0::bigint, 'the mesh is found by name');
SELECT is(count(*), 4::bigint, '... and all triggers are bound again')
FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'field'::regclass AND deptype = 'a';
DELETE FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'field'::regclass;
SELECT is(abacus_track('field', 'wells'), 100::bigint, 'tracking again');
SELECT is(count(*), 4::bigint, '... replaces the triggers')
FROM pg_trigger WHERE tgrelid = 'wells'::regclass;
-- table and mesh in another schema together
CREATE SCHEMA elsewhere;
ALTER TABLE wells SET SCHEMA elsewhere;
ALTER TABLE field SET SCHEMA elsewhere;
ALTER TABLE field_vertices SET SCHEMA elsewhere;
DELETE FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'elsewhere.field'::regclass;
DELETE FROM elsewhere.wells WHERE id % 3 = 0;
SELECT is(differences('elsewhere.field', 'TABLE elsewhere.wells'), 0::bigint, 'restored into another schema');
ALTER TABLE elsewhere.field RENAME TO meadow;
DELETE FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'elsewhere.meadow'::regclass;
SELECT throws_ok('DELETE FROM elsewhere.wells', '42P01',
    'mesh "field", which follows table "wells", does not exist', 'a mesh that is not found');

-- names that need quotes, columns in another order and of other types
CREATE TABLE "Odd ""Table'" ("the id" smallint, "Y" int, deep numeric, "X" real);
SELECT abacus_create('"Odd Mesh''s"', 2);
SELECT is(abacus_track('"Odd Mesh''s"', '"Odd ""Table''"', '{the id,X,Y}'), 0::bigint, 'odd names');
INSERT INTO "Odd ""Table'" SELECT i, i % 7, 1e300, i / 7.0 FROM generate_series(1, 60) i;
UPDATE "Odd ""Table'" SET "Y" = -"Y" WHERE "the id" > 30;
SELECT is(differences('"Odd Mesh''s"', 'SELECT "the id", "X"::float8, "Y" FROM "Odd ""Table''"'), 0::bigint,
    '... and types');
SELECT lives_ok($$ SELECT abacus_untrack('"Odd Mesh''s"', '"Odd ""Table''"') $$, '... and untracked');

-- ids that are not unique, or NULL
CREATE TABLE loose (id int, x float8, y float8);
SELECT abacus_create('loose_mesh', 2);
SELECT abacus_track('loose_mesh', 'loose');
INSERT INTO loose SELECT i % 3, i % 4, i / 4 FROM generate_series(0, 15) i;
INSERT INTO loose SELECT i % 2, i % 4, i / 4 FROM generate_series(0, 15) i;
INSERT INTO loose TABLE loose;
DELETE FROM loose WHERE ctid IN (SELECT ctid FROM loose ORDER BY ctid OFFSET 5 LIMIT 30);
SELECT is(differences('loose_mesh', 'TABLE loose'), 0::bigint, 'a multiset');
SELECT throws_ok('INSERT INTO loose VALUES (NULL, 1, 1)', '22004', 'id is NULL in row 1 of the statement',
    'an id is needed');
SELECT lives_ok('INSERT INTO loose VALUES (NULL, NULL, 1)', '... unless there is no place');
DELETE FROM loose;
SELECT is(differences('loose_mesh', 'TABLE loose'), 0::bigint, 'all rows at once');
-- points on one line wait; the mesh comes and goes
INSERT INTO loose SELECT i, i, i FROM generate_series(1, 9) i;
INSERT INTO loose VALUES (10, 5, 6);
SELECT is(count(*), 8::bigint, 'a point beside the line') FROM abacus_simplices('loose_mesh');
UPDATE loose SET y = x WHERE id = 10;
SELECT is(count(*), 0::bigint, '... and on it') FROM abacus_simplices('loose_mesh');
SELECT is(differences('loose_mesh', 'TABLE loose'), 0::bigint, '... is kept');
TRUNCATE loose;
SELECT is(count(*), 0::bigint, 'TRUNCATE, where points wait') FROM abacus_vertices('loose_mesh');

-- triggers of the table that change rows see the mesh in step afterwards
CREATE FUNCTION snap() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN NEW.x := round(NEW.x); RETURN NEW; END $$;
CREATE TRIGGER snap BEFORE INSERT OR UPDATE ON loose FOR EACH ROW EXECUTE FUNCTION snap();
CREATE FUNCTION twin() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.id < 1000 THEN INSERT INTO loose VALUES (NEW.id + 1000, NEW.x + 0.6, NEW.y); END IF;
    RETURN NULL;
END $$;
CREATE TRIGGER twin AFTER INSERT ON loose FOR EACH ROW EXECUTE FUNCTION twin();
INSERT INTO loose SELECT i, i * 0.77, i * i % 13 FROM generate_series(1, 40) i;
SELECT is(differences('loose_mesh', 'TABLE loose'), 0::bigint, 'triggers that change rows and add some');
SELECT is(count(*), 80::bigint, '... all of them') FROM abacus_vertices('loose_mesh');
-- ... unless they change the rows of their own statement again, afterwards: a row's point is looked up by its
-- id, so that no other row at the place loses its own
CREATE TABLE nudged (id int, x float8, y float8);
SELECT abacus_create('nudged_mesh', 2);
SELECT abacus_track('nudged_mesh', 'nudged');
INSERT INTO nudged VALUES (1, 0, 0), (2, 3, 0), (3, 0, 3), (4, 1, 1);
CREATE FUNCTION nudge() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    UPDATE nudged SET x = x + 1 WHERE id = NEW.id;
    RETURN NULL;
END $$;
CREATE TRIGGER nudge AFTER INSERT ON nudged FOR EACH ROW EXECUTE FUNCTION nudge();
SELECT throws_ok('INSERT INTO nudged VALUES (5, 1, 1)', '55000', 'mesh "nudged_mesh" is not in step with table "nudged"',
    'an AFTER trigger that changes the row again');
SELECT is(differences('nudged_mesh', 'TABLE nudged'), 0::bigint, '... leaves all in step');
UPDATE nudged SET id = 40 WHERE id = 4;
ALTER TABLE nudged DISABLE TRIGGER USER;
UPDATE nudged SET id = 4 WHERE id = 40;
ALTER TABLE nudged ENABLE TRIGGER USER;
SELECT throws_ok('DELETE FROM nudged WHERE id = 4', '55000', NULL, 'the point of another id is not taken');
-- disabled triggers, and the way back
ALTER TABLE loose DISABLE TRIGGER USER;
DELETE FROM loose WHERE id < 10;
ALTER TABLE loose ENABLE TRIGGER USER;
SELECT throws_ok($$ SELECT abacus_track('loose_mesh', 'loose') $$, '55000', NULL, 'out of step');
SELECT is(abacus_track('loose_mesh', 'loose', synchronize => true), 71::bigint, '... and in step again');
SELECT is(differences('loose_mesh', 'TABLE loose'), 0::bigint, '... exactly');

-- ... they fire as before, except for disabled ones
CREATE FUNCTION firing() RETURNS text LANGUAGE sql AS $$
    SELECT string_agg(tgenabled::text, '' ORDER BY tgtype) FROM pg_trigger WHERE tgrelid = 'loose'::regclass AND tgname LIKE 'abacus%'
$$;
DO $$ DECLARE name text; type int; BEGIN
    FOR name, type IN SELECT tgname, tgtype FROM pg_trigger WHERE tgrelid = 'loose'::regclass AND tgname LIKE 'abacus%' LOOP
        EXECUTE format('ALTER TABLE loose ENABLE %s TRIGGER %I', CASE type WHEN 4 THEN 'REPLICA' WHEN 8 THEN '' ELSE 'ALWAYS' END, name);
    END LOOP; END $$;
SELECT is(firing(), 'ROAA', 'some triggers fire in another way');
SELECT is(abacus_track('loose_mesh', 'loose'), 71::bigint, '... are made anew');
SELECT is(firing(), 'ROAA', '... and fire as before');
ALTER TABLE loose DISABLE TRIGGER USER;
SELECT is(abacus_track('loose_mesh', 'loose'), 71::bigint, '... and once more, disabled');
SELECT is(firing(), 'OOOO', '... which they are no longer');

-- ... even if points wait
SELECT abacus_create('few', 2);
SELECT abacus_insert('few', 'VALUES (2, 1, 0), (3, 0, 1)');
CREATE TABLE fewer (id int, x float8, y float8);
INSERT INTO fewer VALUES (1, 0, 0), (2, 4, 0), (3, 0, 4), (4, 5, 4);
SELECT is(abacus_track('few', 'fewer', synchronize => true), 4::bigint, 'in step, where points wait');
SELECT is(differences('few', 'TABLE fewer'), 0::bigint, '... exactly');

-- table and mesh must have the same persistence: a crash would empty only one of the two
CREATE TABLE kept (id int, x float8, y float8);
CREATE UNLOGGED TABLE lost (LIKE kept);
CREATE TEMP TABLE brief (LIKE kept) ON COMMIT DROP;
SELECT abacus_create('kept_mesh', 2), abacus_create('lost_mesh', 2);
ALTER TABLE lost_mesh SET UNLOGGED;
SELECT throws_ok(format('SELECT abacus_track(%L, %L)', 'lost_mesh', name), '42809', NULL, 'a mesh of which half is unlogged: ' || name) FROM unnest('{kept,lost}'::text[]) AS name;
ALTER TABLE lost_mesh_vertices SET UNLOGGED;
SELECT throws_ok($$ SELECT abacus_track('lost_mesh', 'kept') $$, '42809', 'an unlogged mesh cannot follow a logged table', 'an unlogged mesh');
SELECT throws_ok($$ SELECT abacus_track('kept_mesh', 'lost') $$, '42809', 'a logged mesh cannot follow an unlogged table', 'an unlogged table');
SELECT lives_ok($$ SELECT abacus_track('lost_mesh', 'lost') $$, 'both unlogged');
SELECT lives_ok($$ SELECT abacus_track('kept_mesh', 'brief') $$, 'a temporary table');
SELECT abacus_untrack('lost_mesh', 'lost'), abacus_untrack('kept_mesh', 'brief');

-- types are checked whether the mesh has points or not
CREATE TABLE typed (id int, "numeric id" numeric, x float8, y float8, "text" text);
INSERT INTO typed VALUES (1, 1, 0, 0, '0');
SELECT throws_ok($$ SELECT abacus_track('kept_mesh', 'typed', '{numeric id,x,y}') $$, '42804', NULL, 'a numeric id, empty mesh');
SELECT throws_ok($$ SELECT abacus_track('kept_mesh', 'typed', '{id,text,y}') $$, '42804', NULL, '... and text');
SELECT abacus_insert('kept_mesh', 'SELECT id, x, y FROM typed');
SELECT throws_ok($$ SELECT abacus_track('kept_mesh', 'typed', '{numeric id,x,y}') $$, '42804', NULL, 'a numeric id, points');
SELECT throws_ok($$ SELECT abacus_track('kept_mesh', 'typed', '{id,text,y}') $$, '42804', NULL, '... and text');
SELECT is(abacus_track('kept_mesh', 'typed'), 1::bigint, 'the right ones');

-- numerics that no double can hold, read back as before: at half the least double, at the greatest plus half
-- a step, and around them
CREATE DOMAIN exact AS numeric;
CREATE TABLE precise (id int, x numeric, y exact, height exact);
SELECT abacus_create('precise_mesh', 2, '{height}');
INSERT INTO precise SELECT i, s * v, i, s * h
FROM (VALUES (1, 1e-400, 1e400), (2, 0.5 ^ 1, 'NaN'), (3, 1e300, 'Infinity'),
             (4, 1 / 3.0, power(2::numeric, 1024) - power(2::numeric, 970)),
             (5, 5e-324, power(2::numeric, 1024) - power(2::numeric, 970) - 1),
             (6, 0, NULL), (7, 3e-310, 1e-320)) AS v (i, v, h), (VALUES (1), (-1)) AS s (s);
UPDATE precise SET y = -y WHERE x < 0;
-- 0.5 ^ 1075, exactly, and a little more
INSERT INTO precise SELECT 10 + i, power(5::numeric, 1075) * 1e-1075 + i * 1e-2000, 10 + i, NULL FROM generate_series(0, 1) i;
SELECT is(abacus_track('precise_mesh', 'precise'), 16::bigint, 'numerics beyond the range of double');
SELECT is(abacus_track('precise_mesh', 'precise'), 16::bigint, '... are the same when compared');
SELECT results_eq($$ SELECT id, x::text FROM abacus_vertices('precise_mesh') WHERE id > 9 ORDER BY id $$,
    $$ VALUES (10::bigint, '0'), (11, '5e-324') $$, 'half the least double is zero, more is not');
UPDATE precise SET x = x + 1, height = height + 1;
SELECT is(abacus_track('precise_mesh', 'precise'), 16::bigint, '... also as the triggers have read them');
SELECT abacus_untrack('precise_mesh', 'precise');
UPDATE precise SET height = 5 WHERE id = 4;
SELECT throws_ok($$ SELECT abacus_track('precise_mesh', 'precise') $$, '55000', NULL, 'a difference is seen');
UPDATE precise SET x = 1e400 WHERE id = 4;
SELECT throws_ok($$ SELECT abacus_track('precise_mesh', 'precise', synchronize => true) $$, '22023',
    'x of point 4 is not finite', 'what has no place, compared');
DELETE FROM precise WHERE id = 4;
UPDATE precise SET x = 'NaN' WHERE id = 5;
SELECT throws_ok($$ SELECT abacus_track('precise_mesh', 'precise', synchronize => true) $$, '22023',
    'x of point 5 is not finite', '... nor this');
DELETE FROM precise WHERE id = 5;
SELECT is(abacus_track('precise_mesh', 'precise', synchronize => true), 12::bigint, 'in step without them');

-- the meshes of a table are changed in one order by all statements, whatever their names
CREATE TABLE shared (id bigint, x float8, y float8, h float8);
SELECT abacus_create(m, 2) FROM unnest('{terrain,terrain_fine,terrain_a}'::text[]) m;
SELECT abacus_track(m::regclass, 'shared') FROM unnest('{terrain_fine,terrain,terrain_a}'::text[]) m;
SELECT is(count(DISTINCT meshes), 1::bigint, 'one order of meshes for all events')
FROM (SELECT tgtype, array_agg(split_part(encode(tgargs, 'escape'), '\000', 1) ORDER BY tgname) FROM pg_trigger
      WHERE tgrelid = 'shared'::regclass GROUP BY tgtype) AS events (event, meshes);
DROP TABLE terrain, terrain_fine, terrain_a;

-- a point is identified by its attributes as well, so a change that the mesh has missed is noticed
SELECT abacus_create('tellers', 2, '{h}');
SELECT abacus_track('tellers', 'shared');
INSERT INTO shared VALUES (1, 0, 0, 1), (1, 0, 0, 2), (1, 0, 0, NULL), (2, 4, 0, '-0'), (3, 0, 4, 'NaN'), (4, 0, 0, 3);
DELETE FROM shared WHERE id = 1 AND h = 2;
UPDATE shared SET h = 5 WHERE h IS NULL;
UPDATE shared SET h = 0 WHERE id = 2;
UPDATE shared SET h = NULL WHERE id = 3;
SELECT results_eq($$ SELECT id, attributes[1] FROM abacus_vertices('tellers') ORDER BY 1, 2 $$,
                  $$ SELECT id, h FROM shared ORDER BY 1, 2 $$, 'rows that agree in id and place');
UPDATE shared SET id = 1 WHERE id = 4;
DELETE FROM shared WHERE h = 3;
SELECT results_eq($$ SELECT id, attributes[1] FROM abacus_vertices('tellers') ORDER BY 1, 2 $$,
                  $$ SELECT id, h FROM shared ORDER BY 1, 2 $$, '... each goes by its own attributes');
CREATE FUNCTION bump() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN UPDATE shared SET h = h + 1000 WHERE h = 77; RETURN NULL; END $$;
CREATE TRIGGER bump AFTER INSERT OR UPDATE ON shared FOR EACH ROW EXECUTE FUNCTION bump();
SELECT throws_ok($$ INSERT INTO shared VALUES (9, 1, 1, 77) $$, '55000', NULL, 'a row changed again before the mesh has heard of it');
SELECT throws_ok($$ UPDATE shared SET h = 77 WHERE id = 2 $$, '55000', NULL, '... an attribute alone');
DROP TRIGGER bump ON shared;
CREATE TRIGGER zz_bump AFTER INSERT ON shared EXECUTE FUNCTION bump();
SELECT lives_ok($$ INSERT INTO shared VALUES (9, 1, 1, 77) $$, 'and after it has');
DROP TRIGGER zz_bump ON shared;
SELECT results_eq($$ SELECT id, attributes[1] FROM abacus_vertices('tellers') ORDER BY 1, 2 $$,
                  $$ SELECT id, h FROM shared ORDER BY 1, 2 $$, '... it follows');
DELETE FROM shared WHERE id = 1;
SELECT is((SELECT value FROM abacus_stats('tellers') WHERE name = 'duplicates'), 0::float8, 'no two rows are at one place');
CREATE TRIGGER bump AFTER UPDATE ON shared FOR EACH ROW EXECUTE FUNCTION bump();
SELECT throws_ok($$ UPDATE shared SET h = 77 WHERE id = 2 $$, '55000', NULL, 'an attribute that is changed again, of such a row');
DROP TRIGGER bump ON shared;
ALTER TABLE shared DROP COLUMN h;
ALTER TABLE shared ADD COLUMN h float8 DEFAULT 99;
SELECT throws_ok($$ DELETE FROM shared WHERE id = 2 $$, '55000', NULL, 'a column that was replaced');
SELECT abacus_track('tellers', 'shared', synchronize => true);
SELECT lives_ok($$ DELETE FROM shared WHERE id = 2 $$, '... in step again');

-- columns that are computed only when they are read are not in the rows that triggers get
CREATE FUNCTION pg_temp.make_virtual(name text) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    IF current_setting('server_version_num')::int >= 180000 THEN
        EXECUTE format('ALTER TABLE %1$I DROP COLUMN x; ALTER TABLE %1$I ADD COLUMN x float8 GENERATED ALWAYS AS (e / 1000) VIRTUAL', name);
    ELSE                        -- has no such columns: one is marked as if it were
        UPDATE pg_attribute SET attgenerated = 'v' WHERE attrelid IN (SELECT relid FROM pg_partition_tree(name::regclass) UNION SELECT name::regclass) AND attname = 'x';
    END IF;
END $$;
CREATE TABLE computed (id int, e float8, y float8, x float8 GENERATED ALWAYS AS (e / 1000) STORED);
CREATE TABLE computed_parts (LIKE computed INCLUDING ALL) PARTITION BY RANGE (id);
CREATE TABLE computed_part PARTITION OF computed_parts FOR VALUES FROM (0) TO (100);
SELECT abacus_create('computed_mesh', 2), abacus_create('parts_mesh', 2);
SELECT is(abacus_track('computed_mesh', 'computed') + abacus_track('parts_mesh', 'computed_parts', deferred => true), 0::bigint, 'stored generated columns');
INSERT INTO computed VALUES (1, 0, 0), (2, 1000, 0), (3, 0, 1);
INSERT INTO computed_parts (id, e, y) SELECT id, e, y FROM computed;
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is((SELECT count(*) FROM abacus_vertices('computed_mesh')) + (SELECT count(*) FROM abacus_vertices('parts_mesh')), 6::bigint, '... are followed');
SET CONSTRAINTS ALL DEFERRED;
SELECT pg_temp.make_virtual('computed'), pg_temp.make_virtual('computed_parts');
SELECT throws_ok('DELETE FROM ' || name || ' WHERE id = 3', '0A000', NULL, 'they have become virtual: ' || name) FROM unnest('{computed,computed_parts}'::text[]) AS name;
SELECT throws_ok(format('SELECT abacus_track(%L, %L)', mesh, name), '0A000', format('a mesh cannot follow the virtual generated column "x" of table "%s"', name), '... and cannot be tracked')
FROM (VALUES ('computed_mesh', 'computed'), ('parts_mesh', 'computed_parts')) AS t(mesh, name);
SELECT is((SELECT count(*) FROM abacus_vertices('computed_mesh')) + (SELECT count(*) FROM abacus_vertices('parts_mesh')), 6::bigint, '... and no point is lost');
SELECT lives_ok($$ SELECT abacus_untrack('computed_mesh', 'computed') $$, '... untracked');
SELECT lives_ok('DELETE FROM computed WHERE id = 3', '... the table is written');

-- event triggers may interfere with creating triggers
CREATE FUNCTION drop_it() RETURNS event_trigger LANGUAGE plpgsql AS $$ BEGIN EXECUTE 'DROP TABLE IF EXISTS ' || current_setting('test.drop'); END $$;
CREATE EVENT TRIGGER drops ON ddl_command_end WHEN TAG IN ('CREATE TRIGGER', 'DROP TRIGGER') EXECUTE FUNCTION drop_it();
SET LOCAL test.drop = 'tellers';
SELECT throws_ok($$ SELECT abacus_track('tellers', 'shared') $$, '55006', NULL, 'the mesh is in use while it gets its triggers');
SET LOCAL test.drop = 'shared';
SELECT throws_ok($$ SELECT abacus_track('tellers', 'shared') $$, '42P01', NULL, 'the table has gone with its triggers');
DROP EVENT TRIGGER drops;

SELECT * FROM finish();
ROLLBACK;

-- abacus_track: whose rights its triggers have, and which triggers belong to a mesh, when they are bound to
-- it (pg_depend) and when they only name it: made by hand, or restored from a dump.
BEGIN;
SELECT plan(56);

CREATE ROLE pgtap_owner;
CREATE ROLE pgtap_guest;
CREATE SCHEMA own AUTHORIZATION pgtap_owner;
CREATE SCHEMA guests AUTHORIZATION pgtap_guest;
GRANT USAGE ON SCHEMA own TO pgtap_guest;

-- the state after a restore: triggers (except for `keep` of them) and, if wanted, vertex tables unbound
CREATE FUNCTION public.forget(mesh regclass, vertices boolean DEFAULT false, keep int DEFAULT 0) RETURNS void
LANGUAGE sql SECURITY DEFINER AS $$
    DELETE FROM pg_depend WHERE ctid IN (
        SELECT ctid FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = mesh AND deptype = 'a'
        ORDER BY objid OFFSET keep);
    DELETE FROM pg_depend WHERE vertices AND classid = 'pg_class'::regclass AND refobjid = mesh AND deptype = 'a'
        AND objid IN (SELECT oid FROM pg_class WHERE reloftype = 'abacus_vertex_page'::regtype) $$;
CREATE FUNCTION public.bound(mesh regclass) RETURNS bigint LANGUAGE sql AS $$
    SELECT count(*) FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = mesh AND deptype = 'a' $$;
CREATE FUNCTION public.triggers(tracked regclass) RETURNS bigint LANGUAGE sql AS $$
    SELECT count(*) FROM pg_trigger WHERE tgrelid = tracked AND NOT tgisinternal $$;
CREATE FUNCTION public.apart(mesh regclass, tracked regclass) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    n bigint;
BEGIN
    EXECUTE format('WITH here AS (SELECT id::bigint, x, y FROM %s), there AS (SELECT id, x, y FROM abacus_vertices(%L))
        SELECT (SELECT count(*) FROM (TABLE here EXCEPT ALL TABLE there) a)
             + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE here) b)', tracked, mesh) INTO n;
    RETURN n;
END $$;

SET ROLE pgtap_owner;
CREATE TABLE own.wells (id int, x float8, y float8);
INSERT INTO own.wells VALUES (1, 0, 0), (2, 4, 0), (3, 0, 4);
SELECT abacus_create('own.field', 2);
SELECT abacus_track('own.field', 'own.wells');
CREATE TABLE own.notes (id int, x float8, y float8);
GRANT ALL ON own.notes, own.wells TO pgtap_guest;

-- a trigger made by hand has the rights of the user who fires it, and uses no rights of the owner
SET ROLE pgtap_guest;
CREATE TRIGGER a AFTER INSERT ON own.notes REFERENCING NEW TABLE AS n FOR EACH STATEMENT
    EXECUTE FUNCTION abacus_tracked('field', '2', 'id', 'x', 'y');
CREATE TRIGGER b AFTER TRUNCATE ON own.notes FOR EACH STATEMENT
    EXECUTE FUNCTION abacus_tracked('own.field', '2', 'id', 'x', 'y');
SELECT throws_ok('INSERT INTO own.notes VALUES (9, 9, 9)', '42501', 'permission denied for table field',
    'made by hand: does not write with the rights of the owner');
SELECT throws_ok('TRUNCATE own.notes', '42501', 'permission denied for table field', '... nor empty');
INSERT INTO own.wells VALUES (4, 4, 4);
SELECT throws_ok('SELECT count(*) FROM own.field', '42501', NULL, 'the triggers of abacus_track do write');
RESET ROLE;
SELECT is(apart('own.field', 'own.wells'), 0::bigint, '... so the mesh is in step');
SET ROLE pgtap_owner;
INSERT INTO own.notes VALUES (9, 9, 9);
SELECT is(bound('own.field'), 4::bigint, 'a mesh that follows a table is not bound to another');
DROP TABLE own.notes;
SELECT is(abacus_track('own.field', 'own.wells', synchronize => true), 4::bigint, 'in step again');
-- a trigger that replaces a bound one is not bound
SET ROLE pgtap_guest;
CREATE OR REPLACE TRIGGER abacus_track_insert_field AFTER INSERT ON own.wells REFERENCING NEW TABLE AS n
    FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('field', '2', 'id', 'y', 'x');
SELECT is(bound('own.field'), 3::bigint, 'a trigger that replaces a bound one');
SELECT throws_ok('INSERT INTO own.wells VALUES (9, 9, 8)', '42501', NULL, '... has no rights but the writer''s');
-- a trigger depends on its own table; on a mesh's table this does not bind it to the mesh
RESET ROLE;
SELECT abacus_create('own.other', 2);
GRANT ALL ON own.other TO pgtap_guest;
SET ROLE pgtap_guest;
CREATE TRIGGER c AFTER TRUNCATE ON own.other FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('nothing', '2', 'id', 'x', 'y');
SELECT throws_ok('TRUNCATE own.other', '42P01', NULL, 'a trigger of the mesh''s table is not bound to it');
RESET ROLE;
DROP TABLE own.other;

-- after a restore: the first user who may bind them binds all of them
SET ROLE pgtap_owner;
SELECT abacus_track('own.field', 'own.wells');
SELECT forget('own.field');
SET ROLE pgtap_guest;
SELECT throws_ok('INSERT INTO own.wells VALUES (5, 1, 1)', '42501', NULL, 'restored: a guest has his rights alone');
SET ROLE pgtap_owner;
UPDATE own.wells SET x = 5 WHERE id = 4;
SELECT is(bound('own.field'), 4::bigint, '... the owner binds all triggers');
SET ROLE pgtap_guest;
SELECT lives_ok('INSERT INTO own.wells VALUES (5, 1, 1)', '... and guests write');
SET ROLE pgtap_owner;
ALTER TABLE own.field RENAME TO meadow;
SET ROLE pgtap_guest;
SELECT lives_ok('DELETE FROM own.wells WHERE id = 5', '... also after the mesh is renamed');
SET ROLE pgtap_owner;
SELECT is(apart('own.meadow', 'own.wells'), 0::bigint, '... in step');
ALTER TABLE own.meadow RENAME TO field;
-- with the vertex table, by any change of the mesh
SELECT forget('own.field', true);
SELECT is(bound('own.field'), 0::bigint, 'restored again');
SELECT abacus_set_srid('own.field', 0);
SELECT is(bound('own.field'), 4::bigint, '... a change of the mesh binds them');
SELECT is(count(*), 1::bigint, '... and the vertex table')
FROM pg_depend WHERE objid = 'own.field_vertices'::regclass AND refobjid = 'own.field'::regclass AND deptype = 'a';
SELECT forget('own.field', true);
RESET ROLE;
SELECT abacus_set_srid('own.field', 0);
SELECT is(bound('own.field'), 4::bigint, '... also one by a superuser');
SET ROLE pgtap_owner;
SELECT forget('own.field', true);
CREATE TABLE own.twin (id int, x float8, y float8);
CREATE TRIGGER a AFTER INSERT ON own.twin REFERENCING NEW TABLE AS n FOR EACH STATEMENT
    EXECUTE FUNCTION abacus_tracked('field', '2', 'id', 'x', 'y');
SELECT abacus_set_srid('own.field', 0);
SELECT is(bound('own.field'), 0::bigint, '... not where two tables name it');
DROP TABLE own.twin;
-- all go: with the mesh, or with abacus_untrack
SELECT lives_ok($$ SELECT abacus_untrack('own.field', 'own.wells') $$, 'untracked though no trigger is bound');
SELECT is(triggers('own.wells'), 0::bigint, '... all have gone');
SELECT abacus_track('own.field', 'own.wells');
SELECT forget('own.field', keep => 1);
SELECT is(bound('own.field'), 1::bigint, 'one bound, three not');
SELECT abacus_untrack('own.field', 'own.wells');
SELECT is(triggers('own.wells'), 0::bigint, '... all have gone, too');
SELECT abacus_track('own.field', 'own.wells');
SELECT forget('own.field', keep => 1);
UPDATE own.wells SET x = 3 WHERE id = 4;
SELECT is(bound('own.field'), 4::bigint, '... or the first write binds those that are left');
DROP TABLE own.field;
SELECT is(triggers('own.wells'), 0::bigint, 'the mesh takes them all with it');

-- a restored mesh of another owner: the writer's rights are enough, and bind nothing
SELECT abacus_create('own.field', 2);
GRANT ALL ON own.field, own.field_vertices TO pgtap_guest;
SET ROLE pgtap_guest;
CREATE TABLE guests.wells (id int, x float8, y float8);
SELECT is(abacus_track('own.field', 'guests.wells'), 0::bigint, 'a mesh of somebody else');
SELECT forget('own.field');
INSERT INTO guests.wells VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1);
SELECT is(apart('own.field', 'guests.wells'), 0::bigint, '... restored, with the writer''s rights');
SELECT is(bound('own.field'), 0::bigint, '... which are not those of both owners');
RESET ROLE;
DELETE FROM guests.wells WHERE id = 1;
SELECT is(bound('own.field'), 4::bigint, '... those of a superuser are');
SET ROLE pgtap_owner;
SELECT throws_ok($$ SELECT abacus_insert('own.field', 'VALUES (9, 1, 1)') $$, '55000',
    'points of mesh "field" are rows of table "wells", which it follows', 'the owner of the mesh does not change it by hand');
SELECT lives_ok(format('SELECT abacus_untrack(%L, %s)', 'own.field', (SELECT oid FROM pg_class WHERE relname = 'wells' AND relnamespace = 'guests'::regnamespace)),
    '... but may end that it follows the table of somebody else');
SELECT is(bound('own.field'), 0::bigint, '... for all of its triggers');
SELECT is(abacus_delete('own.field', 'VALUES (2, 1, 0)'), 1::bigint, '... and change it then');
SET ROLE pgtap_guest;
SELECT throws_ok($$ SELECT abacus_untrack('own.field', 'guests.wells') $$, '42704', NULL, '... it follows no more');
-- ... whose attributes have changed since the columns were chosen, though there are as many
SET ROLE pgtap_owner;
SELECT abacus_create('own.valued', 2, '{g,h}');
GRANT ALL ON own.valued, own.valued_vertices TO pgtap_guest;
SET ROLE pgtap_guest;
CREATE TABLE guests.valued (id int, x float8, y float8, g float8, h float8);
SELECT abacus_track('own.valued', 'guests.valued');
SELECT forget('own.valued');
SELECT lives_ok('INSERT INTO guests.valued VALUES (1, 0, 0, 4, 100), (2, 1, 0, 4, 100), (3, 0, 1, 4, 100)', 'attributes');
SET ROLE pgtap_owner;
SELECT lives_ok($$ SELECT abacus_drop_attribute('own.valued', 'g'), abacus_add_attribute('own.valued', 'k') $$, '... of which one goes and one comes');
SET ROLE pgtap_guest;
SELECT throws_ok('INSERT INTO guests.valued VALUES (4, 1, 1, 4, 100)', '55000', 'trigger "abacus_track_insert_valued" was made for other attributes', '... and no value comes under another name');
SELECT is(abacus_track('own.valued', 'guests.valued', '{id,x,y,h,g}', synchronize => true, deferred => true), 3::bigint, '... tracked anew');
SELECT forget('own.valued');
INSERT INTO guests.valued VALUES (4, 1, 1, 5, 100);
SET CONSTRAINTS ALL IMMEDIATE;
SELECT is((SELECT attributes FROM abacus_vertices('own.valued') WHERE id = 4), '{100,5}', '... it follows, at commit');
SET CONSTRAINTS ALL DEFERRED;
SET ROLE pgtap_owner;
REVOKE USAGE ON SCHEMA own FROM pgtap_guest;
SET ROLE pgtap_guest;
CREATE TRIGGER a AFTER TRUNCATE ON guests.wells FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('own.field', '2', 'id', 'x', 'y');
SELECT throws_ok('TRUNCATE guests.wells', '42501', 'permission denied for schema own', 'a schema that the writer may not use');

-- names in triggers of others: no error, and they disturb no one
CREATE TABLE guests.notes (id int, x float8, y float8);
CREATE TRIGGER a AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('guests.secret', '2', 'id', 'x', 'y');
CREATE TRIGGER b AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('a.b.c', '2', 'id', 'x', 'y');
CREATE TRIGGER c AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('"open', '2', 'id', 'x', 'y');
CREATE TRIGGER d AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('', '2', 'id', 'x', 'y');
CREATE TRIGGER e AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('nowhere.field', '2', 'id', 'x', 'y');
CREATE TRIGGER f AFTER TRUNCATE ON guests.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked();
SET ROLE pgtap_owner;
SELECT throws_ok('SELECT count(*) FROM guests.notes', '42501', NULL, 'a schema that the owner may not use');
SELECT lives_ok($$ SELECT abacus_track('own.field', 'own.wells', synchronize => true) $$,
    'names that lead nowhere, and a trigger of somebody else that names the mesh');
SELECT is(triggers('own.wells'), 4::bigint, '... tracked');
SELECT lives_ok($$ SELECT abacus_untrack('own.field', 'own.wells') $$, '... and untracked');
RESET ROLE;
SELECT is(triggers('guests.wells') + triggers('guests.notes'), 7::bigint, '... and theirs are left alone');
-- the owner's own triggers count
RESET ROLE;
CREATE TRIGGER g AFTER TRUNCATE ON own.wells FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('field', '2', 'id', 'x', 'y');
CREATE TABLE own.notes (id int, x float8, y float8);
ALTER TABLE own.notes OWNER TO pgtap_owner;
SET ROLE pgtap_owner;
SELECT throws_ok($$ SELECT abacus_track('own.field', 'own.notes') $$, '55006',
    'mesh "field" already follows table "wells"', 'a restored trigger of the owner''s table counts');
RESET ROLE;
DROP TRIGGER g ON own.wells;

-- a constraint trigger depends on the table that it names after FROM, but is not bound by that
SET ROLE pgtap_owner;
SELECT abacus_create('own.lone', 2);
CREATE TABLE own.points (id int, x float8, y float8);
GRANT USAGE ON SCHEMA own TO pgtap_guest;
GRANT TRIGGER ON own.lone, own.points, own.notes TO pgtap_guest;
SET ROLE pgtap_guest;
CREATE CONSTRAINT TRIGGER k AFTER INSERT ON guests.wells FROM own.lone FOR EACH ROW EXECUTE FUNCTION abacus_tracked();
CREATE CONSTRAINT TRIGGER k AFTER INSERT ON own.points FROM own.lone FOR EACH ROW
    EXECUTE FUNCTION abacus_tracked('lone', '2', 'id', 'x', 'y');
SELECT is(bound('own.lone'), 2::bigint, 'two constraint triggers depend on a mesh');
SET ROLE pgtap_owner;
SELECT throws_ok(format('SELECT abacus_untrack(%s, %s)', 'own.lone'::regclass::oid, (SELECT oid FROM pg_class WHERE relname = 'wells' AND relnamespace = 'guests'::regnamespace)),
    '42704', NULL, '... which does not follow their table by that');
SELECT is(abacus_track('own.lone', 'own.points'), 0::bigint, '... and keep nobody from tracking another, nor the one they are on');
SELECT is(triggers('own.points'), 4::bigint, '... of which they go');
RESET ROLE;
SELECT is(triggers('guests.wells'), 2::bigint, '... and not from that of somebody else');
-- nor are triggers by hand on another table of the owner, once the mesh has its own
SET ROLE pgtap_guest;
CREATE TRIGGER h AFTER TRUNCATE ON own.notes FOR EACH STATEMENT EXECUTE FUNCTION abacus_tracked('lone', '2', 'id', 'x', 'y');
SET ROLE pgtap_owner;
SELECT is(abacus_track('own.lone', 'own.points'), 0::bigint, 'a trigger that names a mesh which follows another table');
SELECT lives_ok($$ SELECT abacus_untrack('own.lone', 'own.notes') $$, '... and is dropped by the owner');

-- deferred: the rights are the same, and missing rights are found at the statement
SET ROLE pgtap_owner;
SELECT abacus_track('own.lone', 'own.points', deferred => true);
GRANT INSERT ON own.points TO pgtap_guest;
SET ROLE pgtap_guest;
SELECT lives_ok('INSERT INTO own.points VALUES (1, 2, 3)', 'deferred: noted by a guest, with the rights of the owner');
CREATE TABLE guests.deferred (id int, x float8, y float8);
CREATE TRIGGER d AFTER INSERT ON guests.deferred REFERENCING NEW TABLE AS n FOR EACH STATEMENT
    EXECUTE FUNCTION abacus_tracked('own.lone', '2 deferred', 'id', 'x', 'y');
SELECT throws_ok('INSERT INTO guests.deferred VALUES (9, 9, 9)', '42501', 'permission denied for table lone', 'made by hand: no rights but the writer''s');
SET CONSTRAINTS ALL IMMEDIATE;
RESET ROLE;
SELECT is(apart('own.lone', 'own.points'), 0::bigint, '... in step');

SELECT * FROM finish();
ROLLBACK;

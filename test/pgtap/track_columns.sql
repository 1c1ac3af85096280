-- Columns of tables that a mesh follows, renamed, dropped or given another type: the next change names them, and the mesh stays as it is.
BEGIN;
SELECT no_plan();
SET client_min_messages = warning;

CREATE TABLE peg (id int, x float8, y float8, h float8);
INSERT INTO peg SELECT i, i % 5, i / 5, i FROM generate_series(0, 24) AS i;
CREATE TABLE wall (line int, "position" int, point int, kind text);
INSERT INTO wall VALUES (1, 1, 0, 'soft'), (1, 2, 4, 'soft');
SELECT abacus_create('site', 2, '{h}');
SELECT abacus_track('site', 'peg');
SELECT abacus_track_lines('site', 'wall', kind => 'kind');
SET CONSTRAINTS ALL IMMEDIATE;

-- A change of a table's columns, and then one of its lines or points, and the error.
CREATE FUNCTION pg_temp.fails(change text, statement text, state text, message text) RETURNS SETOF text LANGUAGE plpgsql AS $$
BEGIN
    RETURN NEXT throws_ok(format('DO $do$ BEGIN %s; %s; END $do$', change, statement), state, message, change || ': ' || statement);
    RETURN QUERY SELECT is_empty('SELECT * FROM abacus_check(''site'')', 'the mesh is as it was');
END $$;
CREATE TABLE lines_change AS SELECT $$INSERT INTO wall VALUES (2, 1, 5, 'hard'), (2, 2, 9, 'hard')$$ AS sql;

SELECT pg_temp.fails(format('ALTER TABLE peg RENAME %s TO other', name), sql, '42703', format('column "%s" of table "peg", which a mesh follows, does not exist', name))
    FROM lines_change, unnest('{id,x,y}'::text[]) AS name;
SELECT pg_temp.fails(format('ALTER TABLE peg DROP %s', name), sql, '42703', format('column "%s" of table "peg", which a mesh follows, does not exist', name))
    FROM lines_change, unnest('{id,x,y}'::text[]) AS name;
SELECT pg_temp.fails(format('ALTER TABLE peg ALTER %s TYPE text', name), sql, '42804', NULL) FROM lines_change, unnest('{id,x,y}'::text[]) AS name;
SELECT pg_temp.fails(format('ALTER TABLE peg ALTER %s TYPE text', name), 'INSERT INTO peg VALUES (30, 7, 7, 7)', '42804', NULL) FROM unnest('{id,x,y,h}'::text[]) AS name;
SELECT pg_temp.fails(format('ALTER TABLE wall RENAME %s TO other', name), sql, '42703', format('column "%s" of table "wall", which a mesh follows, does not exist', name))
    FROM lines_change, unnest('{line,position,point,kind}'::text[]) AS name;
SELECT pg_temp.fails(format('ALTER TABLE wall ALTER %s TYPE text', name), sql, '42804', format('column "%s" of table "wall" has type text', name))
    FROM lines_change, unnest('{line,position,point}'::text[]) AS name;

-- what need not be the same
SELECT lives_ok('ALTER TABLE peg RENAME h TO other; ' || sql, 'an attribute does not matter to lines') FROM lines_change;
ALTER TABLE peg RENAME other TO h;
SELECT lives_ok('ALTER TABLE peg ALTER id TYPE bigint, ALTER x TYPE numeric; ALTER TABLE wall ALTER point TYPE smallint; DELETE FROM wall WHERE line = 2; ' || sql, 'other numbers') FROM lines_change;
SELECT is((SELECT count(*) FROM abacus_lines('site')), 4::bigint, 'the mesh follows');
SELECT is_empty('SELECT * FROM abacus_check(''site'')', 'the mesh is sound');
SELECT * FROM finish();
ROLLBACK;

-- Pages are bytes that their owner can write: damage is an ERROR or a fault, never a crash.
SELECT abacus_triangulate('field', 'SELECT i, i % 30, i / 30, i AS height FROM generate_series(0, 899) i');
SELECT abacus_triangulate('solid', 'SELECT i, i % 8, i / 8 % 8, i / 64, i AS height FROM generate_series(0, 511) i', dimension => 3);
-- some points are there twice, some wait
SELECT abacus_insert('field', 'SELECT i, i % 30, i / 30, i FROM generate_series(0, 99) i'), abacus_stage('field', 'SELECT i, i, i, i FROM generate_series(900, 999) i');
SELECT abacus_insert('solid', 'SELECT i, i % 8, i / 8 % 8, i / 64, i FROM generate_series(0, 99) i'), abacus_stage('solid', 'SELECT i, i, i, i, i FROM generate_series(900, 999) i');
SELECT * FROM abacus_check('field') UNION ALL SELECT * FROM abacus_check('solid');
CREATE FUNCTION faults() RETURNS text LANGUAGE sql AS
    $$ SELECT coalesce(string_agg(DISTINCT fault, ', ' ORDER BY fault), 'none') FROM abacus_check('field') $$;

-- the type: bytes in, bytes out, no more than a page
SELECT '\x0102'::abacus_page, ''::abacus_page, '\x0102'::bytea::abacus_page, ('\x0102'::abacus_page)::bytea;
SELECT length(repeat('x', 7936)::bytea::abacus_page::bytea);
SELECT length(repeat('x', 7937)::bytea::abacus_page::bytea);
\echo :LAST_ERROR_SQLSTATE
SELECT bool_and(page::bytea::abacus_page::text = page::text) AS same FROM field;
SELECT max(pg_column_size(f.*)) <= 8000 AS fits FROM field f;

-- the header
BEGIN;
UPDATE field SET page = ''::bytea::abacus_page WHERE code = -1;
SELECT abacus_locate('field', 1, 1);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET page = overlay(page::bytea PLACING '\xff' FROM 1)::abacus_page WHERE code = -1;
SELECT faults();
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
DELETE FROM field WHERE code = -1;
SELECT * FROM abacus_check('field');
SELECT abacus_stage('field', 'SELECT 1, 2, 3, 4');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- Whether the check finds a fault of this kind after a damage, in which %1$s is the mesh, in either
-- dimension, and ends without an error. Undone each time.
CREATE FUNCTION after(damage text, fault text, meshes regclass[] DEFAULT '{field,solid}',
                      OUT mesh regclass, OUT noticed boolean)
RETURNS SETOF record LANGUAGE plpgsql AS $$
BEGIN
    FOREACH mesh IN ARRAY meshes LOOP
        BEGIN
            EXECUTE format(damage, mesh);
            noticed := fault IN (SELECT c.fault FROM abacus_check(mesh) c);
            RAISE SQLSTATE 'UNDO1';
        EXCEPTION WHEN SQLSTATE 'UNDO1' THEN
        END;
        RETURN NEXT;
    END LOOP;
END $$;
CREATE FUNCTION last(mesh regclass) RETURNS bigint LANGUAGE plpgsql AS
    $$ DECLARE code bigint; BEGIN EXECUTE format('SELECT max(code) FROM %s', mesh) INTO code; RETURN code; END $$;

-- pages: lost, emptied, cut short, under another key, under no key, exchanged
SELECT fault, damage, a.mesh, a.noticed FROM (VALUES
    ('interval', 'DELETE FROM %1$s WHERE code = last(%1$L)'),
    ('count', 'DELETE FROM %1$s WHERE code >= 0'),
    ('page', 'UPDATE %1$s SET page = ''''::bytea::abacus_page WHERE code = last(%1$L)'),
    ('page', 'UPDATE %1$s SET page = substr(page::bytea, 1, length(page::bytea) - 8)::abacus_page WHERE code >= 0'),
    ('interval', 'UPDATE %1$s SET code = code + 1 WHERE code = last(%1$L)'),
    ('interval', 'UPDATE %1$s SET page = (SELECT page FROM %1$s WHERE code = last(%1$L)) WHERE code = 0')
) AS t (fault, damage), after(damage, fault) AS a;
BEGIN;
UPDATE solid SET page = ''::bytea::abacus_page WHERE code = last('solid');
SELECT count(*) FROM abacus_simplices('solid');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET part = -1 WHERE code = last('field');
\set VERBOSITY terse
SELECT count(*) FROM abacus_simplices('field');
\set VERBOSITY default
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- planted faults of every kind; where things lie in a page is in docs/design.md, the page format
CREATE FUNCTION flipped(page abacus_page, at int) RETURNS abacus_page LANGUAGE sql AS
    $$ SELECT set_byte(page::bytea, at, get_byte(page::bytea, at) # 1)::abacus_page $$;
CREATE FUNCTION number_at(page bytea, at int) RETURNS int LANGUAGE sql AS
    $$ SELECT get_byte(page, at) + 256 * get_byte(page, at + 1) $$;
CREATE FUNCTION little_endian(value bytea) RETURNS bytea LANGUAGE sql AS
    $$ SELECT string_agg(substr(value, i, 1), '' ORDER BY i DESC) FROM generate_series(1, length(value)) i $$;
-- after header, box, and an id, a point and an attribute for each vertex
CREATE FUNCTION links_at(page abacus_page) RETURNS int LANGUAGE sql AS
    $$ SELECT 48 + 16 * get_byte(page::bytea, 5) + 8 * number_at(page::bytea, 10) * (2 + get_byte(page::bytea, 5)) $$;
-- exchanges two corners of the first simplex that is no ghost
CREATE FUNCTION turned(page bytea) RETURNS abacus_page LANGUAGE plpgsql AS $$
DECLARE
    corners int := get_byte(page, 5) + 1;
    wide int := 1 + get_byte(page, 7) % 2;
    at int := length(page) - number_at(page, 8) * corners * wide;
BEGIN
    WHILE substr(page, at + (corners - 1) * wide + 1, wide) = substr(page, 11, wide) LOOP
        at := at + corners * wide;
    END LOOP;
    RETURN overlay(page PLACING substr(page, at + wide + 1, wide) || substr(page, at + 1, wide) FROM at + 1)::abacus_page;
END $$;
-- gives the vertex with this id another x, or another id
CREATE FUNCTION altered(page bytea, vertex bigint, x float8, id bigint DEFAULT NULL) RETURNS abacus_page LANGUAGE plpgsql AS $$
DECLARE
    dimension int := get_byte(page, 5);
    ids int := 48 + 16 * dimension;
    n int := number_at(page, 10);
BEGIN
    FOR v IN 0 .. n - 1 LOOP
        IF substr(page, ids + 8 * v + 1, 8) = little_endian(int8send(vertex)) THEN
            page := overlay(page PLACING little_endian(float8send(x)) FROM ids + 8 * n + 8 * dimension * v + 1);
            page := overlay(page PLACING little_endian(int8send(coalesce(id, vertex))) FROM ids + 8 * v + 1);
        END IF;
    END LOOP;
    RETURN page::abacus_page;
END $$;
SELECT what, fault, a.mesh, a.noticed FROM (VALUES
    ('its magic number', 'header', 'UPDATE %1$s SET page = flipped(page, 0) WHERE code = -1'),
    ('its domain', 'key', 'UPDATE %1$s SET page = overlay(page::bytea PLACING little_endian(float8send(1000)) FROM 8 * 7 + 1)::abacus_page WHERE code = -1'),
    ('its domain', 'header', 'UPDATE %1$s SET page = overlay(page::bytea PLACING little_endian(float8send(''NaN'')) FROM 8 * 7 + 1)::abacus_page WHERE code = -1'),
    ('its simplices', 'count', 'UPDATE %1$s SET page = flipped(page, 8 * 16) WHERE code = -1'),
    ('its hull facets', 'count', 'UPDATE %1$s SET page = flipped(page, 8 * 17) WHERE code = -1'),
    ('a page''s box', 'box', 'UPDATE %1$s SET page = flipped(page, 48) WHERE code = last(%1$L)'),
    ('a page''s lower key', 'interval', 'UPDATE %1$s SET page = flipped(page, 16) WHERE code = last(%1$L)'),
    ('a page''s upper key', 'interval', 'UPDATE %1$s SET page = flipped(page, 32) WHERE code = 0'),
    ('a page''s dimension', 'page', 'UPDATE %1$s SET page = flipped(page, 5) WHERE code = 0'),
    ('two corners', 'orientation', 'UPDATE %1$s SET page = turned(page::bytea) WHERE code = last(%1$L)'),
    ('a vertex number', 'page', 'UPDATE %1$s SET page = set_byte(page::bytea, length(page::bytea) - 1, 255)::abacus_page WHERE code = last(%1$L)'),
    ('a link', 'link', 'UPDATE %1$s SET page = flipped(page, links_at(page) + 5) WHERE code = last(%1$L)'),
    ('a repeated point''s serial number', 'count', 'UPDATE %1$s_vertices SET page = flipped(page, 16 + 1) WHERE first < 0'),
    ('a repeated point''s place', 'point', 'UPDATE %1$s_vertices SET page = flipped(page, 16 + 8 + 8) WHERE first < 0'),
    ('a page of repeated points', 'count', 'DELETE FROM %1$s_vertices WHERE first < 0'),
    ('a waiting point''s place', 'point', 'UPDATE %1$s_vertices SET page = overlay(page::bytea PLACING ''\xffff'' FROM 24 + 8 + 7)::abacus_page WHERE first = 0'),
    ('a page of waiting points', 'point', 'DELETE FROM %1$s_vertices WHERE first = 0')
) AS t (what, fault, damage), after(damage, fault) AS a;
-- of a single page: a vertex inside a circumsphere, a dent in the hull; a vertex elsewhere or with another id
SELECT abacus_triangulate('field_1', 'VALUES (1, 0, 0), (2, 8, 0), (3, 0, 8), (4, 8, 8), (5, 3, 4), (6, 5, 3), (7, 0, 4)');
SELECT abacus_triangulate('solid_1', 'VALUES (1, 0, 0, 0), (2, 8, 0, 0), (3, 0, 8, 0), (4, 8, 8, 0), (11, 0, 0, 8), (12, 8, 0, 8), (13, 0, 8, 8), (14, 8, 8, 8), (5, 3, 4, 4), (6, 5, 3, 4), (7, 0, 4, 4)', dimension => 3);
SELECT what, fault, a.mesh, a.noticed FROM (VALUES
    ('an inner vertex moved', 'delaunay', 'UPDATE %1$s SET page = altered(page::bytea, 6, 7.5) WHERE code >= 0'),
    ('a vertex of the hull moved in', 'hull', 'UPDATE %1$s SET page = altered(page::bytea, 7, 0.5) WHERE code >= 0'),
    ('a vertex moved to another', 'orientation', 'UPDATE %1$s SET page = altered(page::bytea, 5, 9) WHERE code >= 0'),
    ('a minus zero', 'page', 'UPDATE %1$s SET page = altered(page::bytea, 7, ''-0'') WHERE code >= 0')
) AS t (what, fault, damage), after(damage, fault, '{field_1,solid_1}') AS a;

-- every byte of a page changed in turn is noticed or harmless, and never ends the session
CREATE PROCEDURE change_each_byte(mesh regclass) LANGUAGE plpgsql AS $$
DECLARE
    key bigint := last(mesh);
    original bytea;
    noticed int := 0;
    changed int := 0;
BEGIN
    EXECUTE format('SELECT page::bytea FROM %s WHERE code = $1', mesh) INTO original USING key;
    FOR i IN 0 .. length(original) - 1 BY 11 LOOP
        EXECUTE format('UPDATE %s SET page = $1 WHERE code = $2', mesh)
            USING set_byte(original, i, 255 - get_byte(original, i))::abacus_page, key;
        changed := changed + 1;
        BEGIN
            IF (SELECT count(*) FROM abacus_check(mesh)) > 0 THEN
                noticed := noticed + 1;
            END IF;
            IF get_byte(original, 5) = 2 THEN
                PERFORM abacus_locate(mesh, x + 0.3, y + 0.6) FROM generate_series(0, 28, 7) x, generate_series(0, 28, 7) y;
            ELSE
                PERFORM abacus_locate(mesh, x + 0.3, y + 0.6, z + 0.4) FROM generate_series(0, 6, 2) x, generate_series(0, 6, 2) y, generate_series(0, 6, 3) z;
            END IF;
        EXCEPTION WHEN data_corrupted THEN
            noticed := noticed + 1;
        END;
    END LOOP;
    EXECUTE format('UPDATE %s SET page = $1 WHERE code = $2', mesh) USING original::abacus_page, key;
    RAISE NOTICE '%: more than nine in ten noticed: %', mesh, noticed > changed * 0.9;
END $$;
CALL change_each_byte('field');
CALL change_each_byte('solid');
SELECT * FROM abacus_check('field') UNION ALL SELECT * FROM abacus_check('solid');

-- the vertex pages
BEGIN;
DELETE FROM field_vertices WHERE first = 0;
SELECT faults() <> 'none' AS found;
SELECT count(*) FROM abacus_vertices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field_vertices SET page = substr(page::bytea, 1, 20)::abacus_page WHERE first = 0;
SELECT count(*) FROM abacus_vertices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- without the primary key, or with an index that the store does not keep
BEGIN;
ALTER TABLE field DROP CONSTRAINT field_pkey;
SELECT abacus_locate('field', 1, 1);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
CREATE INDEX extra ON field ((part + 1));
SELECT (abacus_locate('field', 1, 1)).v0 IS NOT NULL AS readable;
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

DROP FUNCTION faults, after, last, flipped, number_at, little_endian, links_at, turned, altered;
DROP PROCEDURE change_each_byte;
DROP TABLE field, solid, field_1, solid_1;

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
SELECT length(repeat('x', 8064)::bytea::abacus_page::bytea);
SELECT length(repeat('x', 8065)::bytea::abacus_page::bytea);
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
    ('interval', 'UPDATE %1$s SET page = (SELECT page FROM %1$s WHERE code = last(%1$L)) WHERE code = 0'),
    ('page', 'UPDATE %1$s SET part = -1 WHERE code = last(%1$L)'),
    ('interval', 'INSERT INTO %1$s SELECT -1, 1, page FROM %1$s WHERE code = 0'),
    ('interval', 'INSERT INTO %1$s SELECT -9223372036854775808, 0, page FROM %1$s WHERE code = 0'),
    ('interval', 'INSERT INTO %1$s SELECT -9223372036854775808, -9223372036854775808, page FROM %1$s WHERE code = 0'),
    ('page', 'INSERT INTO %1$s SELECT 0, -9223372036854775808, page FROM %1$s WHERE code = 0'),
    ('count', 'INSERT INTO %1$s_vertices SELECT 0, -9223372036854775808, page FROM %1$s WHERE code = 0'),
    ('point', 'INSERT INTO %1$s_vertices SELECT -9223372036854775808, -9223372036854775808, page FROM %1$s WHERE code = 0'),
    ('page', 'ALTER TABLE %1$s ALTER page DROP NOT NULL; UPDATE %1$s SET page = NULL WHERE code = last(%1$L)'),
    ('header', 'ALTER TABLE %1$s ALTER page DROP NOT NULL; UPDATE %1$s SET page = NULL WHERE code = -1')
) AS t (fault, damage), after(damage, fault) AS a;
BEGIN;
UPDATE solid SET page = ''::bytea::abacus_page WHERE code = last('solid');
SELECT count(*) FROM abacus_simplices('solid');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET page = set_byte(page::bytea, 4, 1)::abacus_page WHERE code = last('field');
SELECT count(*) FROM abacus_simplices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET page = set_byte(page::bytea, 60, get_byte(page::bytea, 60) # 1)::abacus_page WHERE code >= 0;
SELECT abacus_locate('field', 1.5, 1.5);
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET page = set_byte(page::bytea, 60, get_byte(page::bytea, 60) # 1)::abacus_page WHERE code >= 0;
SELECT count(*) FROM abacus_locate('field', 'SELECT 1, 1.5, 1.5');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
-- a page is gone: its places are looked for in no other one
BEGIN;
DELETE FROM field WHERE code = last('field');
SELECT count(*) FROM abacus_locate('field', 'SELECT x + 1000 * y, x + 0.3, y + 0.6 FROM generate_series(0, 28) x, generate_series(0, 28) y');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
-- ... and whatever reads all pages, or those around, notices
CREATE FUNCTION error_of(query text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE query;
    RETURN 'none';
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;
BEGIN;
DELETE FROM field WHERE code = (SELECT code FROM field WHERE code > 0 ORDER BY code LIMIT 1);
DELETE FROM solid WHERE code = (SELECT code FROM solid WHERE code > 0 ORDER BY code OFFSET 1 LIMIT 1);
SELECT query, error_of(query) FROM (VALUES
    ('SELECT count(*) FROM abacus_simplices(''field'')'),
    ('SELECT count(*) FROM abacus_vertices(''field'')'),
    ('SELECT abacus_draw(''field'', 10)'),
    ('SELECT abacus_draw(''field'', 10, attribute => ''height'', lower => ''{5,5}'', upper => ''{25,25}'')'),
    ('SELECT abacus_volume(''field'', 0)'),
    ('SELECT abacus_volume(''field'', ''field'')'),
    ('SELECT count(*) FROM abacus_simplices(''solid'')'),
    ('SELECT count(*) FROM abacus_vertices(''solid'')'),
    ('SELECT abacus_draw_section(''solid'', ''{3.5,3.5,3.5}'', ''{0,0,1}'', 10)')) AS t (query);
ROLLBACK;
-- all are gone: nothing is left but the count in the header
BEGIN;
DELETE FROM field WHERE code >= 0;
SELECT query, error_of(query) FROM (VALUES
    ('SELECT count(*) FROM abacus_simplices(''field'')'),
    ('SELECT count(*) FROM abacus_vertices(''field'')'),
    ('SELECT abacus_draw(''field'', 10)'),
    ('SELECT abacus_volume(''field'', ''field'', lower => ''{5,5}'', upper => ''{6,6}'')'),
    ('SELECT abacus_draw(''field'', 10, lower => ''{5,5}'', upper => ''{6,6}'')')) AS t (query);
ROLLBACK;
-- a page too many
BEGIN;
INSERT INTO field SELECT code + 1, part, page FROM field WHERE code = last('field');
SELECT error_of('SELECT count(*) FROM abacus_simplices(''field'')');
ROLLBACK;
DROP FUNCTION error_of;
BEGIN;
UPDATE field SET part = -1 WHERE code = last('field');
\set VERBOSITY terse
SELECT count(*) FROM abacus_simplices('field');
\set VERBOSITY default
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- planted faults of every kind; where things lie in a page is in docs/design/format.md
CREATE FUNCTION flipped(page abacus_page, at int) RETURNS abacus_page LANGUAGE sql AS
    $$ SELECT set_byte(page::bytea, at, get_byte(page::bytea, at) # 1)::abacus_page $$;
CREATE FUNCTION number_at(page bytea, at int) RETURNS int LANGUAGE sql AS
    $$ SELECT get_byte(page, at) + 256 * get_byte(page, at + 1) $$;
CREATE FUNCTION little_endian(value bytea) RETURNS bytea LANGUAGE sql AS
    $$ SELECT string_agg(substr(value, i, 1), '' ORDER BY i DESC) FROM generate_series(1, length(value)) i $$;
CREATE FUNCTION word(value bytea) RETURNS numeric LANGUAGE sql AS
    $$ SELECT sum(get_byte(value, i) * 256 ^ (length(value) - 1 - i)::numeric) FROM generate_series(0, length(value) - 1) i $$;
CREATE FUNCTION bit_width(number int) RETURNS int LANGUAGE sql AS
    $$ SELECT length(ltrim(number::bit(16)::text, '0')) $$;
-- where a column's words begin, in bits, and how they are stored: an axis each, ids, attributes, codes, parts
CREATE FUNCTION words_of(page bytea, number int, OUT at int, OUT width int, OUT step numeric, OUT base numeric, OUT after int) LANGUAGE plpgsql AS $$
DECLARE
    dimension int := get_byte(page, 5);
    simplices int := number_at(page, 8);
    vertices int := number_at(page, 10);
    columns int := 3 + dimension + get_byte(page, 6);
    patch int := 4 + 4 * dimension;
    head int := 48 + (simplices + 63) / 64 * patch;
    named int := number_at(page, head - patch);
    n int;
BEGIN
    after := head;
    FOR i IN 1 .. columns LOOP
        after := after + 2 + 8 * (get_byte(page, after + 1) / 128);
    END LOOP;
    after := after + (simplices * (dimension + 1) + 7) / 8 + (named * bit_width(vertices) + 7) / 8;
    FOR i IN 0 .. number LOOP
        n := CASE WHEN i < columns - 2 THEN vertices WHEN i = columns - 2 THEN number_at(page, 14) ELSE number_at(page, 12) END;
        width := get_byte(page, head);
        step := 2 ^ (get_byte(page, head + 1) % 128)::numeric;
        base := 0;
        head := head + 2;
        IF get_byte(page, head - 1) >= 128 THEN
            base := word(little_endian(substr(page, head + 1, 8)));
            head := head + 8;
        END IF;
        at := 8 * after;
        after := after + (n * width + 7) / 8;
    END LOOP;
END $$;
CREATE FUNCTION bits_at(page bytea, at int, width int) RETURNS numeric LANGUAGE sql AS
    $$ SELECT coalesce(sum(get_bit(page, at + i) * 2 ^ i::numeric), 0) FROM generate_series(0, width - 1) i $$;
-- gives the vertex with this id another word in a column
CREATE FUNCTION altered(page bytea, vertex bigint, number int, word numeric) RETURNS abacus_page LANGUAGE plpgsql AS $$
DECLARE
    ids record := words_of(page, get_byte(page, 5));
    words record := words_of(page, number);
    bits numeric := (word - words.base) / words.step;
    at int;
BEGIN
    IF bits <> trunc(bits) OR bits < 0 OR bits >= 2 ^ words.width::numeric THEN
        RAISE 'the column has no room for this word';
    END IF;
    FOR v IN 0 .. number_at(page, 10) - 1 LOOP
        IF ids.base + bits_at(page, ids.at + v * ids.width, ids.width) * ids.step = vertex THEN
            at := words.at + v * words.width;
            FOR i IN 0 .. words.width - 1 LOOP
                page := set_bit(page, at + i, mod(div(bits, 2 ^ i::numeric), 2)::int);
            END LOOP;
        END IF;
    END LOOP;
    RETURN page::abacus_page;
END $$;
-- its x, not negative
CREATE FUNCTION moved(page bytea, vertex bigint, x float8) RETURNS abacus_page LANGUAGE sql AS
    $$ SELECT altered(page, vertex, 0, word(float8send(x)) + 2 ^ 63::numeric) $$;
-- the last numbers of vertices, which end where the coordinates begin
CREATE FUNCTION renumbered(page bytea) RETURNS abacus_page LANGUAGE sql AS
    $$ SELECT set_byte(set_byte(page, at / 8 - 1, 127), at / 8 - 2, 255)::abacus_page FROM words_of(page, 0) $$;
-- flips the least bit of the number of a vertex that gives a neighbour its key
CREATE FUNCTION relinked(page abacus_page, link int) RETURNS abacus_page LANGUAGE sql AS $$
    SELECT set_bit(b, place, 1 - get_bit(b, place))::abacus_page
    FROM (SELECT page::bytea) AS p (b),
         words_of(b, 2 + get_byte(b, 5) + get_byte(b, 6)) AS parts,
         CAST(8 * parts.after + link * bit_width(number_at(b, 10) + number_at(b, 14)) AS int) AS place
$$;
SELECT what, fault, a.mesh, a.noticed FROM (VALUES
    ('its magic number', 'header', 'UPDATE %1$s SET page = flipped(page, 0) WHERE code = -1'),
    ('its domain', 'key', 'UPDATE %1$s SET page = overlay(page::bytea PLACING little_endian(float8send(1000)) FROM 8 * 7 + 1)::abacus_page WHERE code = -1'),
    ('its domain', 'header', 'UPDATE %1$s SET page = overlay(page::bytea PLACING little_endian(float8send(''NaN'')) FROM 8 * 7 + 1)::abacus_page WHERE code = -1'),
    ('its simplices', 'count', 'UPDATE %1$s SET page = flipped(page, 8 * 17) WHERE code = -1'),
    ('its hull facets', 'count', 'UPDATE %1$s SET page = flipped(page, 8 * 18) WHERE code = -1'),
    ('a page''s checksum', 'checksum', 'UPDATE %1$s SET page = flipped(page, length(page::bytea) - 1) WHERE code = last(%1$L)'),
    ('a page''s version', 'page', 'UPDATE %1$s SET page = set_byte(page::bytea, 4, 1)::abacus_page WHERE code = 0'),
    ('a page''s lower key', 'interval', 'UPDATE %1$s SET page = flipped(page, 16) WHERE code = last(%1$L)'),
    ('a page''s upper key', 'interval', 'UPDATE %1$s SET page = flipped(page, 32) WHERE code = 0'),
    ('a page''s dimension', 'page', 'UPDATE %1$s SET page = flipped(page, 5) WHERE code = 0'),
    ('a vertex number', 'page', 'UPDATE %1$s SET page = renumbered(page::bytea) WHERE code = last(%1$L)'),
    ('a link', 'link', 'UPDATE %1$s SET page = relinked(page, 3) WHERE code = last(%1$L)'),
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
    ('an inner vertex moved', 'delaunay', 'UPDATE %1$s SET page = moved(page::bytea, 5, 1) WHERE code >= 0'),
    ('a vertex of the hull moved in', 'hull', 'UPDATE %1$s SET page = moved(page::bytea, 7, 0.5) WHERE code >= 0'),
    ('a vertex moved to another', 'orientation', 'UPDATE %1$s SET page = moved(page::bytea, 5, 10) WHERE code >= 0'),
    ('a vertex moved', 'checksum', 'UPDATE %1$s SET page = moved(page::bytea, 6, 4) WHERE code >= 0'),
    ('a vertex with another id', 'checksum', 'UPDATE %1$s SET page = altered(page::bytea, 6, get_byte(page::bytea, 5), 5) WHERE code >= 0'),
    ('a vertex at infinity', 'page', 'UPDATE %1$s SET page = moved(page::bytea, 7, ''Infinity'') WHERE code >= 0')
) AS t (what, fault, damage), after(damage, fault, '{field_1,solid_1}') AS a;

-- every byte of a page changed in turn is noticed, and never ends the session
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
    RAISE NOTICE '%: every change noticed: %', mesh, noticed >= changed;
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

-- columns that lie at other places than those of the type, since one was dropped before the table got the type
CREATE TABLE shifted (code bigint, part bigint, other bigint, page abacus_page, PRIMARY KEY (code, part));
INSERT INTO shifted SELECT code, part, 4611686018427387904, page FROM field;
ALTER TABLE shifted DROP COLUMN other;
ALTER TABLE shifted OF abacus_simplex_page;
CREATE TABLE shifted_vertices OF abacus_vertex_page (PRIMARY KEY (first, part));
SELECT count(*) FROM abacus_simplices('shifted');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('shifted', 'SELECT 1, 2, 3');
VACUUM shifted;
CREATE TABLE copied OF abacus_simplex_page (PRIMARY KEY (code, part));
INSERT INTO copied TABLE shifted;
SELECT count(*) = (SELECT count(*) FROM abacus_simplices('field')) AS all_there FROM abacus_simplices('copied');
CREATE TABLE bare_vertices (other bigint, first bigint, part bigint, page abacus_page, PRIMARY KEY (first, part));
ALTER TABLE bare_vertices DROP COLUMN other;
ALTER TABLE bare_vertices OF abacus_vertex_page;
ALTER TABLE copied RENAME TO bare;
SELECT count(*) FROM abacus_vertices('bare');
DROP TABLE bare, bare_vertices, shifted, shifted_vertices;

DROP FUNCTION faults, after, last, flipped, number_at, little_endian, word, bit_width, words_of, bits_at, altered, moved, renumbered, relinked;
DROP PROCEDURE change_each_byte;
DROP TABLE field, solid, field_1, solid_1;

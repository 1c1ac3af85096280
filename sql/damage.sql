-- Pages are bytes that their owner can write: damage is an ERROR or a fault, never a crash.
SELECT abacus_triangulate('field', 'SELECT i, i % 30, i / 30, i AS height FROM generate_series(0, 899) i');
SELECT * FROM abacus_check('field');
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

-- pages: lost, emptied, cut short, swapped
BEGIN;
DELETE FROM field WHERE code = (SELECT max(code) FROM field);
SELECT faults() <> 'none' AS found;
ROLLBACK;
BEGIN;
UPDATE field SET page = ''::bytea::abacus_page WHERE code = (SELECT max(code) FROM field);
SELECT faults() <> 'none' AS found;
SELECT count(*) FROM abacus_simplices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
BEGIN;
UPDATE field SET page = substr(page::bytea, 1, length(page::bytea) - 8)::abacus_page WHERE code >= 0;
SELECT faults() <> 'none' AS found;
ROLLBACK;
BEGIN;
UPDATE field SET code = code + 1 WHERE code = (SELECT max(code) FROM field);
SELECT faults() <> 'none' AS found;
ROLLBACK;
BEGIN;
UPDATE field SET part = -1 WHERE code = (SELECT max(code) FROM field);
SELECT count(*) FROM abacus_simplices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

-- every byte of a page changed in turn is noticed or harmless, and never ends the session
DO $$
DECLARE
    original bytea := (SELECT page::bytea FROM field WHERE code = (SELECT max(code) FROM field));
    key bigint := (SELECT max(code) FROM field);
    noticed int := 0;
    changed int := 0;
BEGIN
    FOR i IN 0 .. length(original) - 1 BY 11 LOOP
        UPDATE field SET page = set_byte(original, i, 255 - get_byte(original, i))::abacus_page WHERE code = key;
        changed := changed + 1;
        BEGIN
            IF (SELECT count(*) FROM abacus_check('field')) > 0 THEN
                noticed := noticed + 1;
            END IF;
            PERFORM abacus_locate('field', x + 0.3, y + 0.6) FROM generate_series(0, 28, 7) x, generate_series(0, 28, 7) y;
        EXCEPTION WHEN data_corrupted THEN
            noticed := noticed + 1;
        END;
    END LOOP;
    UPDATE field SET page = original::abacus_page WHERE code = key;
    RAISE NOTICE 'more than half noticed: %', noticed > changed / 2;
END $$;
SELECT faults();

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
CREATE INDEX extra ON field (part);
SELECT (abacus_locate('field', 1, 1)).v0 IS NOT NULL AS readable;
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;

DROP FUNCTION faults;
DROP TABLE field;

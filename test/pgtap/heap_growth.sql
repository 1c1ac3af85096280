-- A table of pages grows by many heap pages at a time, if the file system can do that, as nearly all that
-- PostgreSQL is used with can; unused pages are used next.
BEGIN;
LOAD 'abacus';
SELECT plan(7);
SELECT current_setting('abacus.shortcuts')::boolean OR current_setting('server_version_num')::int >= 160000 AS many \gset
\if :many

CREATE EXTENSION IF NOT EXISTS pg_freespacemap;
CREATE FUNCTION pg_temp.points(first int, last int) RETURNS text LANGUAGE sql AS
    $$ SELECT format('SELECT i, i::bigint * 7919 %% 1000003, i::bigint * 104729 %% 1000033
                      FROM generate_series(%s, %s) AS i', first, last) $$;
-- Heap pages that never had a row.
CREATE FUNCTION pg_temp.unused(mesh regclass) RETURNS TABLE (block bigint) LANGUAGE sql AS
    $$ SELECT blkno FROM pg_freespace(mesh) WHERE avail >= 8128 $$;
-- A few rows: page by page.
SELECT abacus_triangulate('small', pg_temp.points(1, 5000));
SELECT is_empty($$ SELECT pg_temp.unused('small') $$, 'a small table has no page that is not used');

-- Many rows: at most a sixteenth of the stored rows is left, and some rows were stored twice.
SELECT abacus_triangulate('large', pg_temp.points(1, 160000)); -- other numbers may end within the last step
CREATE TEMP TABLE left_over AS SELECT array_agg(block) AS blocks FROM pg_temp.unused('large');
SELECT cmp_ok((SELECT cardinality(blocks) FROM left_over), '>', 0, 'the last step was not used up');
SELECT cmp_ok((SELECT cardinality(blocks) FROM left_over), '<=', (SELECT count(*) FROM large)::int / 12, 'but nearly');
SELECT cmp_ok((SELECT max(block) FROM left_over, unnest(blocks) AS block) + 1, '=', pg_relation_size('large') / 8192,
              'it is the end of the table');
SELECT is_empty($$ SELECT code FROM large, left_over WHERE (large.ctid::text::point)[0] = ANY (blocks) $$, 'no rows are there');
SELECT abacus_insert('large', pg_temp.points(160001, 250000));
SELECT is_empty($$ SELECT block FROM pg_temp.unused('large'), left_over WHERE block = ANY (blocks) $$, 'the next change writes them');
SELECT is_empty($$ SELECT * FROM abacus_check('large') $$, 'the mesh is sound');

\else
SELECT skip('built without shortcuts', 7);
\endif

SELECT * FROM finish();
ROLLBACK;

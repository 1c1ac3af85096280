-- What a shard shows of the mesh of all shards, asked on its server: pages of any stretch of the curve, one after the other, and their counts.
BEGIN;
SELECT no_plan();

SELECT isnt(abacus_triangulate('m', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, i FROM generate_series(1, 3000) AS i'), NULL, 'a mesh');
SELECT isnt(abacus_triangulate('apart', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, i AS a, i AS b, i AS c, i AS d, i AS e, i AS f FROM generate_series(1, 3000) AS i'), NULL, 'a mesh whose attributes are apart');
CREATE TABLE stored AS SELECT code, part FROM m WHERE code >= 0;
CREATE TABLE cut AS SELECT percentile_disc(0.4) WITHIN GROUP (ORDER BY code) + 12345 AS at FROM stored;

-- the whole curve: the pages as they are stored, and the end
SELECT results_eq($$ SELECT code, part FROM abacus_shard_pages('m', 0, 0, 9223372036854775807, 0, 0, 1000000000) WHERE page IS NOT NULL $$,
                  $$ SELECT code, part FROM stored ORDER BY code, part $$, 'all pages');
SELECT results_eq($$ SELECT code FROM abacus_shard_pages('m', 0, 0, 9223372036854775807, 0, 0, 1000000000) WHERE page IS NULL $$,
                  $$ VALUES ((-9223372036854775808)::bigint) $$, 'the end of the curve does not fit bigint, and comes back as its least');
SELECT results_eq($$ SELECT count(*), count(page) FROM abacus_shard_pages('m', 0, 0, 9223372036854775807, 0, 0, 0) $$, $$ VALUES (2::bigint, 1::bigint) $$, 'one page at least');
SELECT cmp_ok((SELECT sum(length(page)) FROM abacus_shard_pages('m', 0, 0, 9223372036854775807, 0, 0, 20000)), '<', 28000::bigint, 'about so many bytes');

-- two stretches: together they own all simplices, each once
SELECT results_eq($$ SELECT a.simplices + b.simplices, a.ghosts + b.ghosts FROM cut, abacus_shard_facts('m', 0, at - 1) AS a, abacus_shard_facts('m', at, 9223372036854775807) AS b $$,
                  $$ SELECT simplices, ghosts FROM abacus_shard_facts('m', 0, 9223372036854775807) $$, 'counts');
SELECT results_eq($$ SELECT simplices FROM abacus_shard_facts('m', 0, 9223372036854775807) $$, $$ SELECT count(*) FROM abacus_simplices('m') $$, 'of all');
SELECT results_eq($$ SELECT simplices FROM cut, abacus_shard_facts('m', 0, at - 1) $$, $$ SELECT count(*) FROM abacus_simplices('m'), cut WHERE code < at $$, 'of the first');
SELECT results_eq($$ SELECT code, part FROM cut, abacus_shard_pages('m', 0, at, 9223372036854775807, at, 0, 1) LIMIT 1 $$, $$ SELECT at, 0::bigint FROM cut $$, 'a page begins with the stretch');
SELECT results_eq($$ SELECT code FROM cut, abacus_shard_pages('m', 0, 0, at - 1, 0, 0, 1000000000) WHERE page IS NULL $$, $$ SELECT at FROM cut $$, 'and ends with it');
SELECT results_eq($$ SELECT p.code FROM cut, abacus_shard_pages('m', 0, 0, at - 1, at - 7, 0, 1) AS p LIMIT 1 $$, $$ SELECT max(code) FROM stored, cut WHERE code <= at - 7 $$, 'the page that owns the key comes first');
SELECT is_empty($$ SELECT * FROM abacus_shard_pages('m', 0, 5, 4, 5, 0, 100) $$, 'a shard that owns nothing has no pages');
SELECT results_eq($$ SELECT simplices, ghosts FROM abacus_shard_facts('m', 5, 4) $$, $$ VALUES (0::bigint, 0::bigint) $$, 'nor simplices');

-- attributes that are apart
SELECT cmp_ok((SELECT count(page) FROM abacus_shard_pages('apart', 3, 0, 9223372036854775807, 0, 0, 1000000000)), '=', (SELECT count(*) FROM apart WHERE code < -1), 'all pages of attributes');
SELECT results_eq($$ SELECT count(page) FROM abacus_shard_pages('apart', 3, 0, 9223372036854775807, 9007199254740992, 0, 1000) $$, $$ VALUES (0::bigint) $$, 'there is no second group');
SELECT is_empty($$ SELECT 1 FROM abacus_shard_pages('m', 3, 0, 9223372036854775807, 0, 0, 1000) WHERE page IS NOT NULL $$, 'a mesh without');

-- no simplices: one page without any
SELECT isnt(abacus_create('empty', 2), NULL, 'an empty mesh');
SELECT results_eq($$ SELECT count(page), count(*) FROM abacus_shard_pages('empty', 0, 100, 200, 100, 0, 100) $$, $$ VALUES (1::bigint, 2::bigint) $$, 'an empty page');

SELECT throws_ok($$ SELECT * FROM abacus_shard_pages('m', 1, 0, 5, 0, 0, 100) $$, '22023', 'a shard has no own pages of this kind', 'another kind');
SELECT throws_ok($$ SELECT * FROM abacus_shard_pages('m', 0, -1, 5, 0, 0, 100) $$, '22023', 'codes and parts must not be negative', 'a negative code');
SELECT throws_ok($$ SELECT * FROM abacus_shard_pages('m', 0, 0, 5, 0, -1, 100) $$, '22023', NULL, 'a negative part');
SELECT throws_ok($$ SELECT * FROM abacus_shard_pages('pg_class', 0, 0, 5, 0, 0, 100) $$, '42809', NULL, 'not a mesh');
SELECT throws_ok($$ SELECT * FROM abacus_shard_facts('pg_class', 0, 5) $$, '42809', NULL, 'nor here');
SELECT is_empty($$ SELECT * FROM abacus_shard_pages('m', 0, NULL, 5, 0, 0, 100) $$, 'NULL');
CREATE ROLE shard_reader;
SET ROLE shard_reader;
SELECT throws_ok($$ SELECT * FROM abacus_shard_pages('m', 0, 0, 5, 0, 0, 100) $$, '42501', NULL, 'no right');
SELECT throws_ok($$ SELECT * FROM abacus_shard_facts('m', 0, 5) $$, '42501', NULL, 'nor here');
RESET ROLE;

SELECT * FROM finish();
ROLLBACK;

-- What the coordinator of a mesh over several servers calls on a server while points are spread: rows are kept,
-- dealt out and staged; what another server sends is not trusted.
BEGIN;
SET search_path TO public;
SELECT no_plan();

SELECT throws_ok($$ SELECT abacus_shard_survey('SELECT 1, 2.0, 3.0', 2, 0) $$, '42P01', NULL, 'a survey without a place for its rows');
SELECT throws_ok($$ SELECT abacus_shard_survey(NULL, 2, 0) $$, '22004', NULL, 'no query');

CREATE TEMPORARY TABLE abacus_points (n bigserial PRIMARY KEY, source integer NOT NULL, shard integer, points bytea NOT NULL);
SELECT results_eq($$ SELECT points, attributes, "least", "greatest", srid FROM abacus_shard_survey('SELECT i, i / 8.0, 1 - i / 8.0, NULLIF(i, 3)::float8 AS h FROM generate_series(0, 8) AS i', 2, 1) $$,
    $$ VALUES (9::bigint, '{h}'::text[], '{0,0}'::float8[], '{1,1}'::float8[], NULL::integer) $$, 'a survey');
SELECT results_eq('SELECT source, shard, length(points) FROM abacus_points', 'VALUES (1, NULL::integer, 9 * 4 * 8)', 'its rows are kept, without a shard');

-- Of four quarters of the curve, shard 1 owns the second and the third.
SELECT abacus_shard_begin('part', 2, '{h}', '{0,0}', '{1,1}', 2056);
CREATE TEMPORARY TABLE cut AS SELECT ARRAY[(1::bigint << 60), (3::bigint << 60)] AS borders;
SELECT results_eq($$ SELECT abacus_shard_split(1, '{0,0}', '{1,1}', (SELECT borders FROM cut), 1) $$,
    $$ SELECT count(*) FROM generate_series(0, 8) AS i, cut WHERE abacus_shard_owner('{0,0}', '{1,1}', borders, ARRAY[i / 8.0, 1 - i / 8.0]) <> 1 $$, 'those of others are sorted out');
SELECT results_eq('SELECT count(*) FROM (SELECT DISTINCT shard FROM abacus_points WHERE shard = 1) AS s', 'VALUES (0::bigint)', 'its own stay');
SELECT results_eq($$ SELECT abacus_shard_stage('part', (SELECT borders FROM cut), 1, '{0,0}', '{1,1}') $$,
    $$ SELECT count(*) FROM generate_series(0, 8) AS i, cut WHERE abacus_shard_owner('{0,0}', '{1,1}', borders, ARRAY[i / 8.0, 1 - i / 8.0]) = 1 $$, 'and are staged');
SELECT results_eq($$ SELECT id FROM abacus_vertices('part') EXCEPT SELECT i FROM generate_series(0, 8) AS i, cut WHERE abacus_shard_owner('{0,0}', '{1,1}', borders, ARRAY[i / 8.0, 1 - i / 8.0]) = 1 $$,
    'SELECT 1::bigint LIMIT 0', 'they alone');
SELECT is(abacus_srid('part'), 2056, 'the SRID is that of all shards');

SELECT throws_ok($$ SELECT abacus_shard_stage('part', '{}', 0, '{0,0}', '{0.5,1}') $$, '22023', 'a point lies outside the extent of all points', 'a point outside');
SELECT throws_ok($$ SELECT abacus_shard_stage('part', '{{1},{2}}', 0, '{0,0}', '{1,1}') $$, '22023', NULL, 'borders in two dimensions');
SELECT throws_ok($$ SELECT abacus_shard_split(1, '{0,0,0,0}', '{1,1,1,1}', '{}', 0) $$, '22023', NULL, 'four coordinates');

-- Points that another server has sent: words, the greatest byte first.
CREATE FUNCTION pg_temp.sent(VARIADIC words text[]) RETURNS void LANGUAGE sql AS
    $$ DELETE FROM pg_temp.abacus_points; INSERT INTO pg_temp.abacus_points (source, shard, points) VALUES (0, 1, decode(array_to_string(words, ''), 'hex')) $$;
SELECT pg_temp.sent(encode(int8send(7), 'hex'), encode(float8send(0.75), 'hex'), encode(float8send(0.75), 'hex'), encode(float8send('NaN'), 'hex'));
SELECT results_eq($$ SELECT abacus_shard_stage('part', '{0}', 1, '{0,0}', '{1,1}') $$, 'VALUES (1::bigint)', 'a point that comes');
SELECT results_eq($$ SELECT x, y, attributes[1] FROM abacus_vertices('part') WHERE id = 7 ORDER BY y DESC LIMIT 1 $$, $$ VALUES (0.75::float8, 0.75::float8, NULL::float8) $$, 'is the point that was sent');
SELECT throws_ok($$ SELECT abacus_shard_stage('part', '{4611686018427387904}', 1, '{0,0}', '{1,1}') $$, 'XX001', 'a point has come to a shard that does not own it', 'a point of another shard');
SELECT pg_temp.sent(encode(int8send(7), 'hex'), encode(float8send('Infinity'), 'hex'), encode(float8send(0.75), 'hex'), encode(float8send(0), 'hex'));
SELECT throws_ok($$ SELECT abacus_shard_stage('part', '{0}', 1, '{0,0}', '{1,1}') $$, 'XX001', NULL, 'a coordinate that is not finite');
SELECT pg_temp.sent(encode(int8send(7), 'hex'), encode(float8send(0.75), 'hex'));
SELECT throws_ok($$ SELECT abacus_shard_stage('part', '{0}', 1, '{0,0}', '{1,1}') $$, 'XX001', NULL, 'half a point');

SELECT finish();
ROLLBACK;

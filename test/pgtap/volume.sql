-- Volumes: for any cache, order of points and way of making a mesh; while the mesh changes; of meshes with
-- holes.
BEGIN;
SELECT no_plan();
SELECT setseed(0.25);
CREATE TABLE points AS SELECT id, random() * 1000 AS x, random() * 1000 AS y FROM generate_series(1, 8000) AS id;
CREATE TABLE others AS SELECT id, random() * 900 + 50 AS x, random() * 900 AS y FROM generate_series(1, 6000) AS id;
CREATE FUNCTION pg_temp.height(x float8, y float8) RETURNS float8 IMMUTABLE RETURN sin(x / 90) * cos(y / 70) * 20 + x / 50;
SELECT isnt(abacus_triangulate('before', 'SELECT id, x, y, pg_temp.height(x, y) AS height FROM points'), NULL, 'a survey');
SELECT isnt(abacus_triangulate('after', 'SELECT id, x, y, pg_temp.height(x, y) + 0.5 AS height FROM others'), NULL, 'another one');
CREATE TEMP TABLE known AS SELECT * FROM abacus_volume('after', 'before');
SELECT ok((SELECT abs(net / area - 0.5) < 0.02 FROM known), 'half a unit is between them');
SELECT cmp_ok((SELECT area FROM known), '<=', (SELECT area FROM abacus_volume('after', 0)), 'no more area than the smaller one has');
SET LOCAL abacus.cache_size = '1MB';
SELECT results_eq($$ SELECT * FROM abacus_volume('after', 'before') $$, 'TABLE known', 'with a small cache');
RESET abacus.cache_size;
SELECT results_eq($$ SELECT area, fill, cut FROM abacus_volume('before', 'after') $$, 'SELECT area, cut, fill FROM known', 'the other way round');
-- the same points in another order, made in another way
SELECT isnt(abacus_triangulate('again', 'SELECT -id, x, y, pg_temp.height(x, y) + 0.5 AS height FROM others WHERE id > 3000 ORDER BY y'), NULL, 'a part');
SELECT is(abacus_insert('again', 'SELECT id, x, y, pg_temp.height(x, y) + 0.5 FROM others WHERE id <= 3000 ORDER BY x'), 3000::bigint, 'and the rest');
SELECT results_eq($$ SELECT * FROM abacus_volume('again', 'before') $$, 'TABLE known', 'between them is the same, to the last bit');
SELECT results_eq($$ SELECT * FROM abacus_volume('again', 3, lower => '{100,200}', upper => '{333,444}') $$,
                  $$ SELECT * FROM abacus_volume('after', 3, lower => '{100,200}', upper => '{333,444}') $$, 'over a base, too');
-- a loaded mesh with a hole: it lacks just the area that the others' triangles cover there
SELECT isnt(abacus_load('holes', 'SELECT id, x, y, pg_temp.height(x, y) FROM points',
    $$ SELECT v0, v1, v2 FROM abacus_cells('before') WHERE ("corners")[1][1] NOT BETWEEN 400 AND 600 OR ("corners")[1][2] NOT BETWEEN 300 AND 700 $$, '{height}'), NULL, 'a mesh with a hole');
SELECT is((SELECT round((area + coalesce(missing, 0))::numeric, 6) FROM abacus_volume('holes', 'before'), LATERAL (SELECT sum(abs((c[2][1] - c[1][1]) * (c[3][2] - c[1][2]) - (c[3][1] - c[1][1]) * (c[2][2] - c[1][2]))) / 2 AS missing
    FROM abacus_cells('before') AS t, LATERAL (VALUES (corners)) AS p (c) WHERE c[1][1] BETWEEN 400 AND 600 AND c[1][2] BETWEEN 300 AND 700) AS m),
    (SELECT round(area::numeric, 6) FROM abacus_volume('before', 0)), 'the area without the hole');
SELECT results_eq($$ SELECT cut, fill FROM abacus_volume('holes', 'before') $$, 'VALUES (0::float8, 0::float8)', 'nothing lies between');
SELECT results_eq($$ SELECT area, cut, fill FROM abacus_volume('after', 'holes') $$, $$ SELECT area, fill, cut FROM abacus_volume('holes', 'after') $$, 'either may have the hole');
-- one row for each row of a query; a change is seen, and rolled back
SELECT is((SELECT round(sum(area)::numeric, 6) FROM generate_series(0, 900, 100) AS x, LATERAL abacus_volume('after', 'before', lower => ARRAY[x, 0], upper => ARRAY[x + 100, 1000])),
          (SELECT round(area::numeric, 6) FROM known), 'windows add up');
SAVEPOINT changed;
SELECT isnt(abacus_delete('after', 'SELECT id, x, y FROM others WHERE x > 500'), NULL, 'half of it goes');
SELECT ok((SELECT area FROM abacus_volume('after', 'before')) < (SELECT area * 0.7 FROM known), 'which the next call sees');
ROLLBACK TO changed;
SELECT results_eq($$ SELECT * FROM abacus_volume('after', 'before') $$, 'TABLE known', 'until it is rolled back');
-- a literal without a type is a base if it is a number, otherwise a name
SELECT results_eq($$ SELECT * FROM abacus_volume('after', '12.5') $$, $$ SELECT * FROM abacus_volume('after', 12.5) $$, 'a quoted number is a base');
SELECT throws_matching($$ SELECT abacus_volume('after', 'elsewhere') $$, 'does not exist', '... and another text a mesh');
SELECT lives_ok($$ SELECT abacus_volume('after', 12), abacus_volume('after', 12.5), abacus_volume('after', base => '12.5') $$, 'numbers are');
-- triangles whose area is 0 in doubles
CREATE TABLE flat AS SELECT * FROM (VALUES (1, -1::float8, -1::float8, 1::float8), (2, 1e-17, 2e-17, 2), (3, 1, 1, 6)) AS f (id, x, y, h);
SELECT isnt(abacus_triangulate('flat_one', 'TABLE flat'), NULL, 'a flat triangle');
SELECT isnt(abacus_triangulate('flat_level', 'SELECT id, x, y, 0.0::float8 AS h FROM flat'), NULL, '... and another');
SELECT is(ARRAY[round(mean::numeric, 9), round(mean_absolute::numeric, 9), round((rms ^ 2 * 12)::numeric, 9)], ARRAY[3, 3, 122]::numeric[],
    'means over a flat triangle') FROM abacus_compare('flat_one', 'flat_level');
SELECT ok(area > 0 AND abs(net / area - 3) < 1e-9, 'the volume over it') FROM abacus_volume('flat_one', 'flat_level');

SELECT * FROM finish();
ROLLBACK;

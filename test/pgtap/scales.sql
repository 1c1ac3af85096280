-- Coordinates and values of any size: the answers are those at an ordinary scale.
BEGIN;
SELECT no_plan();

CREATE FUNCTION pg_temp.mesh(name text, s float8) RETURNS bigint LANGUAGE sql AS $f$
    SELECT abacus_triangulate(name, format($$SELECT id, x * %L::float8, y * %1$L::float8, h FROM (VALUES (1, 0, 0, 0), (2, 4, 0, 1), (3, 4, 3, 3), (4, 0, 3, 2), (5, 1, 1, 5)) AS v (id, x, y, h)$$, s), '{h}')
$f$;
-- corners times a power of ten
CREATE FUNCTION pg_temp.polygon(power int, VARIADIC corners float8[]) RETURNS text LANGUAGE sql AS $$
    SELECT format('POLYGON((%s))', string_agg(format('%se%s %se%2$s', corners[i], power, corners[i + 1]), ',' ORDER BY i)) FROM generate_series(1, cardinality(corners), 2) AS i
$$;
CREATE FUNCTION pg_temp.state(command text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN '00000';
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;
SELECT pg_temp.mesh('m' || n, ('1e' || power)::float8) FROM (VALUES (0, 0), (1, 104), (2, 200), (3, 300), (4, -110), (5, -170), (6, -290)) AS s (n, power);

-- in a polygon
PREPARE corners (regclass, int) AS
    SELECT position, vertex, round((x / ('1e' || $2)::float8)::numeric, 3), round((y / ('1e' || $2)::float8)::numeric, 3)
    FROM abacus_hull($1, within => pg_temp.polygon($2, 1, 1, 5, 1, 1, 4, 1, 1));
PREPARE bands (regclass, int) AS
    SELECT id, value, round((p / ('1e' || $2)::float8)::numeric, 3)
    FROM abacus_contours($1, 1, polygonize => true, within => pg_temp.polygon($2, 1, 1, 5, 1, 1, 4, 1, 1)) AS c, unnest(path) WITH ORDINALITY AS u (p, n) ORDER BY id, n;
SELECT results_eq(format('EXECUTE corners(%L, %s)', 'm' || n, power), 'EXECUTE corners(''m0'', 0)', 'hull in a polygon at 1e' || power)
FROM (VALUES (1, 104), (2, 200), (3, 300), (4, -110), (5, -170), (6, -290)) AS s (n, power);
SELECT results_eq('EXECUTE corners(''m0'', 0)', 'VALUES (1::bigint, NULL::bigint, 1.000, 1.000), (2, NULL, 4, 1), (3, NULL, 4, 1.75), (4, NULL, 2.333, 3), (5, NULL, 1, 3)', 'its corners');
SELECT results_eq(format('EXECUTE bands(%L, %s)', 'm' || n, power), 'EXECUTE bands(''m0'', 0)', 'bands in a polygon at 1e' || power)
FROM (VALUES (1, 104), (2, 200), (3, 300), (4, -110), (5, -170), (6, -290)) AS s (n, power);
SELECT is((SELECT count(*) FROM abacus_hull(mesh, within => polygon)), corners::bigint, mesh || ' in ' || polygon)
FROM (VALUES ('m5', pg_temp.polygon(0, -1, -1, 1, -1, 1, 1, -1, 1, -1, -1), 4), ('m3', pg_temp.polygon(307, -9, -9, 9, -9, 9, 9, -9, 9, -9, -9), 4),
             ('m2', 'POLYGON EMPTY', 0)) AS f (mesh, polygon, corners);
SELECT is(pg_temp.state(format('SELECT * FROM abacus_hull(%L, within => %L)', 'm0', pg_temp.polygon(307, -9, -9, 9, -9, 9, 9, -9, 9, -9, -9))), '22003', 'a polygon of another size');
SELECT is(pg_temp.state(format('SELECT * FROM abacus_hull(%L, within => %L)', 'm2', pg_temp.polygon(200, 0, 0, 4, 4, 4, 0, 0, 4, 0, 0))), '22023', 'a polygon that crosses itself');

-- Voronoi cells in a window
SELECT results_eq(format($$SELECT vertex FROM abacus_voronoi('m%s', '{0,0}', '{2e%s,2e%2$s}') ORDER BY 1$$, n, power), 'VALUES (1::bigint), (4), (5)', 'cells at 1e' || power)
FROM (VALUES (0, 0), (1, 104), (2, 200), (3, 300), (4, -110), (5, -170), (6, -290)) AS s (n, power);
SELECT results_eq(format($$SELECT vertex, neighbour, round((size / '1e%s')::numeric, 6) FROM abacus_voronoi_facets('m%s', '{0,0}', '{2e%1$s,2e%1$s}') ORDER BY 1, 2, 3$$, power, n),
    $$SELECT vertex, neighbour, round(size::numeric, 6) FROM abacus_voronoi_facets('m0', '{0,0}', '{2,2}') ORDER BY 1, 2, 3$$, 'facets at 1e' || power)
FROM (VALUES (1, 104), (2, 200), (3, 300), (4, -110), (5, -170), (6, -290)) AS s (n, power);

-- slopes whose gradient overflows or underflows
SELECT abacus_triangulate('steep', 'VALUES (1, 0, 0, 0::float8), (2, 1e-10, 0, 1e300), (3, 0, 1e-10, 2e300)', '{h}');
SELECT abacus_triangulate('gentle', 'VALUES (1, 0, 0, 0::float8), (2, 1e200, 0, 1e-200), (3, 0, 1e200, 2e-200)', '{h}');
SELECT abacus_triangulate('level', 'VALUES (1, 0, 0, 1e-200::float8), (2, 1e200, 0, 1e-200), (3, 0, 1e200, 1e-200)', '{h}');
SELECT is((SELECT (slope, round(aspect::numeric, 3)) FROM abacus_slope('steep', 1e-11, 1e-11)), (90::float8, 206.565), 'infinitely steep');
SELECT is((SELECT (slope, round(aspect::numeric, 3)) FROM abacus_slope('gentle', 1e199, 1e199)), (0::float8, 206.565), 'almost level');
SELECT is((SELECT (slope, aspect) FROM abacus_slope('level', 1e199, 1e199)), (0::float8, NULL::float8), 'level');

SELECT * FROM finish();
ROLLBACK;

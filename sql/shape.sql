-- What the points of a mesh look like: Voronoi cells, hulls and outlines, the spanning tree.
SELECT abacus_triangulate('field', 'SELECT i + 1, i % 4, i / 4 FROM generate_series(0, 15) i');
SELECT abacus_triangulate('solid', 'SELECT i + 1, i % 4, i / 4 % 4, i / 16 FROM generate_series(0, 63) i', dimension => 3);
-- Voronoi cells of a grid are squares, whose corners come once; those at the hull have no end
SELECT vertex, bounded, area, volume, ring FROM abacus_voronoi('field') WHERE bounded ORDER BY vertex;
SELECT DISTINCT bounded, area, volume, ring FROM abacus_voronoi('field') WHERE NOT bounded;
SELECT bounded, area, volume, ring, count(*) FROM abacus_voronoi('solid') GROUP BY 1, 2, 3, 4 ORDER BY bounded;
-- with a window the parts of cells in it, also of vertices outside; they fill it
SELECT vertex, bounded, area, ring FROM abacus_voronoi('field', '{0.25,0.25}', '{1,0.75}') ORDER BY vertex;
SELECT vertex, bounded, area, ring FROM abacus_voronoi('field', '{10,10}', '{12,11}') ORDER BY vertex;
SELECT count(*), sum(area) FROM abacus_voronoi('field', '{-7,-7}', '{13,13}');
SELECT vertex, area, volume FROM abacus_voronoi('solid', '{0.25,0.25,0.25}', '{1,0.75,0.5}') ORDER BY vertex;
SELECT count(*), sum(volume) FROM abacus_voronoi('solid', '{-7,-7,-7}', '{13,13,13}');
SELECT count(*) FROM abacus_voronoi('field', '{1,0}', '{1,4}');
-- facets: edges of the cells in the plane, polygons in space; without a neighbour on the window's sides
SELECT vertex, neighbour, bounded, size, ring FROM abacus_voronoi_facets('field') WHERE vertex = 6 ORDER BY neighbour;
SELECT vertex, neighbour, bounded, size FROM abacus_voronoi_facets('field') WHERE vertex = 1 ORDER BY neighbour;
SELECT vertex, neighbour, size, ring FROM abacus_voronoi_facets('field', '{0.25,0.25}', '{1,0.75}') ORDER BY vertex, neighbour, ring;
SELECT neighbour, size, ring FROM abacus_voronoi_facets('solid') WHERE vertex = 22 ORDER BY neighbour;
SELECT sum(size) FROM abacus_voronoi_facets('solid', '{0.25,0.25,0.25}', '{1,0.75,0.5}') WHERE neighbour IS NULL;
-- the hull: every point of its edges that is a vertex
SELECT ring, string_agg(vertex::text, ' ' ORDER BY position) AS vertices FROM abacus_hull('field') GROUP BY ring;
SELECT count(DISTINCT ring), count(*), min(position), max(position), max(z) FROM abacus_hull('solid');
-- counterclockwise seen from outside: the volume inside
SELECT sum(a[1] * (b[2] * c[3] - b[3] * c[2]) + a[2] * (b[3] * c[1] - b[1] * c[3]) + a[3] * (b[1] * c[2] - b[2] * c[1])) / 6 AS volume
FROM (SELECT max(ARRAY[x, y, z]) FILTER (WHERE position = 1) AS a, max(ARRAY[x, y, z]) FILTER (WHERE position = 2) AS b,
             max(ARRAY[x, y, z]) FILTER (WHERE position = 3) AS c FROM abacus_hull('solid') GROUP BY ring) t;
-- outlines: a square with a hole that touches its border, an island in another hole, two that touch one another
CREATE TABLE rows (y int, line text);
INSERT INTO rows VALUES
    (9, '##########..###'),
    (8, '##########..###'),
    (7, '##......##..###'),
    (6, '##......##.....'),
    (5, '##..##..##.....'),
    (4, '##..##..###....'),
    (3, '##......##.#...'),
    (2, '##......###....'),
    (1, '##########.....'),
    (0, '##########.....');
-- a fine grid where there is land, a coarse one elsewhere
CREATE TABLE points AS SELECT row_number() OVER (ORDER BY x, y) AS id, x, y FROM
    (SELECT DISTINCT x + dx AS x, rows.y + dy AS y FROM rows, generate_series(0, 14) x, generate_series(0, 2) a, generate_series(0, 2) b,
     LATERAL (SELECT a / 2.0 AS dx, b / 2.0 AS dy) d WHERE substr(line, x + 1, 1) = '#') t;
SELECT abacus_triangulate('land', 'SELECT id, x, y FROM points');
CREATE FUNCTION rings(query text) RETURNS TABLE (ring bigint, corners bigint, area numeric, first text) LANGUAGE plpgsql AS $$
BEGIN
    RETURN QUERY EXECUTE format(
        'SELECT ring, count(*), round(sum(x * (next_y) - next_x * y)::numeric / 2, 3), min(point) FILTER (WHERE position = 1)
         FROM (SELECT *, format(''%%s %%s'', x, y) AS point, coalesce(lead(x) OVER r, first_value(x) OVER r) AS next_x,
                      coalesce(lead(y) OVER r, first_value(y) OVER r) AS next_y FROM %s WINDOW r AS (PARTITION BY ring ORDER BY position)) t
         GROUP BY ring ORDER BY ring', query);
END $$;
SELECT * FROM rings('abacus_hull(''land'', 0.75)');
SELECT * FROM rings('abacus_alpha_shape(''land'', 0.13, true)');
SELECT * FROM rings('abacus_alpha_shape(''land'', 0.13)');
-- alpha is the square of a radius, compared exactly: here that of all triangles is 0.125
SELECT count(*) FROM abacus_alpha_shape('land', 0.125);
SELECT count(*) FROM abacus_alpha_shape('land', 0.12499999999999999);
SELECT * FROM rings('abacus_alpha_shape(''land'', ''Infinity'')');
SELECT count(DISTINCT ring) FROM abacus_alpha_shape('solid', 0.75);
SELECT count(DISTINCT ring) FROM abacus_alpha_shape('solid', 0.7499999999999999);
-- a cube within the cavity of another one: the volume that triangles enclose, with the cavity and without
SELECT abacus_triangulate('hollow', 'SELECT row_number() OVER (ORDER BY x, y, z), x, y, z FROM generate_series(-5, 5) x, generate_series(-5, 5) y,
    generate_series(-5, 5) z WHERE greatest(abs(x), abs(y), abs(z)) % 4 < 2', dimension => 3);
CREATE FUNCTION enclosed(holes boolean) RETURNS TABLE (triangles bigint, volume numeric) LANGUAGE sql AS $$
    SELECT count(*), round((sum(p[1][1] * (p[2][2] * p[3][3] - p[2][3] * p[3][2]) - p[1][2] * (p[2][1] * p[3][3] - p[2][3] * p[3][1])
                              + p[1][3] * (p[2][1] * p[3][2] - p[2][2] * p[3][1])) / 6)::numeric, 3)
    FROM (SELECT array_agg(ARRAY[x, y, z] ORDER BY position) AS p FROM abacus_alpha_shape('hollow', 0.75, holes) GROUP BY ring) t $$;
SELECT * FROM enclosed(false);
SELECT volume > 10 ^ 3 - 8 ^ 3 AND volume < 10 ^ 3 - 6 ^ 3 AS has_a_cavity FROM enclosed(true);
SELECT volume < 1000 AS has_a_cavity FROM enclosed(NULL);
DROP FUNCTION enclosed;
DROP TABLE hollow;
-- no ring comes through a vertex twice
SELECT count(*) FROM (SELECT FROM abacus_hull('land', 0.75) GROUP BY ring, vertex HAVING count(*) > 1) t;
-- they enclose what is kept
SELECT round((SELECT sum(area) FROM rings('abacus_hull(''land'', 0.75)')), 6) = round(sum((corners[2][1] - corners[1][1]) * (corners[3][2] - corners[1][2]) - (corners[3][1] - corners[1][1]) * (corners[2][2] - corners[1][2]))::numeric / 2, 6) AS same
FROM abacus_cells('land', max_edge => 0.75);
-- in little memory
SET work_mem = '64kB';
SET abacus.cache_size = '1MB';
SELECT abacus_triangulate('many', 'SELECT i, i * 0.7548776662466927 % 1, i * 0.5698402909980532 % 1 FROM generate_series(1, 20000) i');
SELECT count(*), count(DISTINCT ring) FROM abacus_hull('many', 0.008) \gset little_
SELECT count(*), round(sum(length)::numeric, 9) AS sum FROM abacus_spanning_tree('many') \gset little_
RESET work_mem;
RESET abacus.cache_size;
SELECT count(*) = :little_count AS same_tree, round(sum(length)::numeric, 9) = :little_sum AS same_sum, count(*) FROM abacus_spanning_tree('many');
-- the spanning tree, the shortest edges first; among equal lengths those with the lesser ends
SELECT * FROM abacus_spanning_tree('field');
SELECT count(*), sum(length) FROM abacus_spanning_tree('solid');
-- loaded meshes, with holes
CREATE TABLE vertices AS SELECT id, x, y FROM abacus_vertices('field');
CREATE TABLE triangles AS SELECT v0, v1, v2 FROM abacus_cells('field') WHERE NOT (corners[1][1] + corners[2][1] + corners[3][1] BETWEEN 3.1 AND 5.9 AND corners[1][2] + corners[2][2] + corners[3][2] BETWEEN 3.1 AND 5.9);
SELECT abacus_load('holed', 'SELECT id, x, y FROM vertices', 'SELECT v0, v1, v2 FROM triangles');
SELECT ring, string_agg(vertex::text, ' ' ORDER BY position) AS vertices FROM abacus_hull('holed') GROUP BY ring ORDER BY ring;
SELECT count(*), sum(length) FROM abacus_spanning_tree('holed');
SELECT count(*) FROM abacus_voronoi('holed');
SELECT count(*) FROM abacus_alpha_shape('holed', 1);
-- an empty mesh, points on a line, one simplex, NULL
SELECT abacus_create('empty', 2);
SELECT abacus_triangulate('line', 'VALUES (1, 0, 0), (2, 1, 1), (3, 2, 2)');
SELECT abacus_triangulate('one', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT mesh, (SELECT count(*) FROM abacus_voronoi(mesh)) AS cells, (SELECT count(*) FROM abacus_voronoi(mesh, '{0,0}', '{2,2}')) AS parts,
       (SELECT count(*) FROM abacus_voronoi_facets(mesh)) AS facets, (SELECT count(*) FROM abacus_hull(mesh)) AS hull,
       (SELECT count(*) FROM abacus_hull(mesh, 1.2)) AS short, (SELECT count(*) FROM abacus_alpha_shape(mesh, 0.5)) AS shape,
       (SELECT count(*) FROM abacus_alpha_shape(mesh, 0.4999)) AS none, (SELECT count(*) FROM abacus_spanning_tree(mesh)) AS tree
FROM unnest(ARRAY['empty', 'line', 'one', NULL]::regclass[]) mesh;
-- a cursor ends early
BEGIN;
DECLARE reader CURSOR FOR SELECT abacus_voronoi('field', '{0,0}', '{9,9}');
MOVE 1 FROM reader;
CLOSE reader;
COMMIT;
SELECT count(*) FROM (SELECT abacus_hull('many', 0.01) LIMIT 1) t;
-- errors
SELECT abacus_voronoi('field', '{1,1}', '{0,2}');
SELECT abacus_voronoi('field', '{1,1}', NULL);
SELECT abacus_voronoi('field', '{1,NaN}', '{2,2}');
SELECT abacus_voronoi('field', '{1,1,1}', '{2,2,2}');
SELECT abacus_voronoi_facets('field', '{1,1}', '{2,Infinity}');
SELECT abacus_hull('field', -1);
SELECT abacus_hull('field', 'NaN');
SELECT abacus_alpha_shape('field', 0);
SELECT abacus_alpha_shape('field', 'NaN');
SELECT abacus_alpha_shape('field', NULL);
SELECT abacus_spanning_tree('points');
DROP FUNCTION rings;
DROP TABLE field, solid, land, many, holed, empty, line, one, rows, points, vertices, triangles;

-- Thinning a mesh to a stated error.
CREATE TABLE thin_ground AS
SELECT 100 * x + y AS id, x::float8 AS x, y::float8 AS y, 10 * sin(x / 15.0) * cos(y / 20.0) + 0.001 * x * y AS height, x - y::float8 AS other
FROM generate_series(0, 60) AS x, generate_series(0, 60) AS y;
SELECT abacus_triangulate('thin_mesh', 'SELECT id, x, y, height, other FROM thin_ground', lower => '{-1, -1}', upper => '{70, 70}');
SELECT abacus_set_srid('thin_mesh', 25832);
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height') <= 0.25 AS is_within;
SELECT count(*) FROM abacus_vertices('thin_new');
SELECT * FROM abacus_check('thin_new');
SELECT abacus_srid('thin_new'), (SELECT array_agg(name) FROM abacus_attributes('thin_new')) AS attributes;
SELECT mesh, attribute, max_error, keep, target, greatest <= 0.25 AS is_within FROM thin_new_thinning;
-- ids and attributes are those of the points
SELECT count(*) FROM abacus_vertices('thin_new') AS v JOIN thin_ground AS g USING (id, x, y)
WHERE v.attributes = ARRAY[g.height, g.other];
-- every point left out is within the error
SELECT max(abs(height - "values"[1])) <= 0.25 AS is_within, count("values"[1])
FROM thin_ground JOIN abacus_interpolate('thin_new', 'SELECT id, x, y FROM thin_ground', '{height}') USING (id);
-- the table goes with the mesh
DROP TABLE thin_new;
SELECT count(*) FROM pg_class WHERE relname LIKE 'thin_new%';

-- a target
SELECT abacus_thin('thin_mesh', 'thin_new', 0, 'height', target => 40) > 0.25 AS is_coarse;
SELECT count(*) FROM abacus_vertices('thin_new');
-- the new mesh is a mesh like any other
SELECT abacus_insert('thin_new', 'SELECT id, x, y, height, other FROM thin_ground WHERE id = 3030');
SELECT abacus_delete('thin_new', 'SELECT id, x, y FROM thin_ground WHERE id = 3030');
DROP TABLE thin_new;

-- kept: the border, ids, lines
SELECT abacus_thin('thin_mesh', 'thin_new', 100, 'height', keep => 'border');
SELECT count(*) FROM abacus_vertices('thin_new');
DROP TABLE thin_new;
SELECT abacus_thin('thin_mesh', 'thin_new', 100, 'height', keep => 'SELECT * FROM (VALUES (3030), (3030), (1), (-7)) AS ids (id)') > 1 AS is_coarse;
SELECT id FROM abacus_vertices('thin_new') ORDER BY id;
DROP TABLE thin_new;
SELECT abacus_constrain('thin_mesh', 'VALUES (1, 1, 1010), (1, 2, 5040), (1, 3, 2020), (2, 1, 301), (2, 2, 305)');
SELECT abacus_constrain('thin_mesh', 'VALUES (3, 1, 5100), (3, 2, 5110)', kind => 'soft');
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height') <= 0.25 AS is_within;
SELECT * FROM abacus_check('thin_new');
SELECT (SELECT array_agg(l ORDER BY line, position) FROM abacus_lines('thin_new') AS l)
       = (SELECT array_agg(l ORDER BY line, position) FROM abacus_lines('thin_mesh') AS l) AS same_lines;
SELECT max(abs(height - "values"[1])) <= 0.25 AS is_within
FROM thin_ground JOIN abacus_interpolate('thin_new', 'SELECT id, x, y FROM thin_ground', '{height}') USING (id);
CALL abacus_thin_build('thin_mesh', 'thin_again', 0.25, 'height');
SELECT (SELECT array_agg(id ORDER BY id) FROM abacus_vertices('thin_new')) = (SELECT array_agg(id ORDER BY id) FROM abacus_vertices('thin_again')) AS same;
DROP TABLE thin_new, thin_again;
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height', 'none') <= 0.25 AS is_within;
SELECT count(*) FROM abacus_lines('thin_new');
DROP TABLE thin_new;
SELECT abacus_unconstrain('thin_mesh', 'VALUES (1), (2), (3)');

-- what a loaded mesh has beyond vertices does not come along
SELECT abacus_load('thin_holes', 'SELECT id, x, y, height FROM thin_ground',
    $$ SELECT v0, v1, v2, CASE WHEN v0 < 3000 THEN 1 ELSE 2 END AS soil FROM abacus_cells('thin_mesh') WHERE NOT (("corners")[1][1] BETWEEN 20 AND 40 AND ("corners")[1][2] BETWEEN 20 AND 40) $$,
    '{height}', labels => '{soil}');
SELECT abacus_thin('thin_holes', 'thin_new', 0.25) <= 0.25 AS is_within;
SELECT * FROM abacus_check('thin_new');
DROP TABLE thin_new;
SELECT count(*) FROM abacus_levels('thin_holes', '{0.5, 1}');
CALL abacus_thin_build('thin_holes', 'thin_new', 0.25);
-- an interrupted thinning goes on only with a mesh that nobody has touched, and until it is done no mesh is made of it
UPDATE thin_new_thinning SET greatest = NULL;
CALL abacus_thin_build('thin_holes', 'thin_new', 0.25);
SELECT abacus_thin('thin_new', 'thin_newer', 1);
CALL abacus_thin_build('thin_new', 'thin_newer', 1);
SELECT abacus_levels('thin_new', '{1}');
SELECT count(*) FROM pg_class WHERE relname LIKE 'thin_newer%' OR relname LIKE 'thin_new_level%';
DROP TABLE thin_new, thin_holes;

SELECT abacus_triangulate('thin_parts', 'SELECT id, x, y, height FROM thin_ground');
SELECT abacus_label('thin_parts', 'SELECT code, v0, v1, v2, 7 AS soil FROM abacus_simplices(''thin_parts'') WHERE v0 < 100');
SELECT abacus_mark('thin_parts', 'SELECT code, v0, v1, v2, 0, 1 FROM abacus_simplices(''thin_parts'') WHERE v0 < 100') > 0 AS is_marked;
SELECT abacus_constrain('thin_parts', 'VALUES (1, 1, 1010), (1, 2, 5040), (1, 3, 2020), (1, 4, 1010)');
SELECT abacus_region('thin_parts', $$VALUES ('inner', 1)$$);
SELECT abacus_thin('thin_parts', 'thin_new', 0.25) <= 0.25 AS is_within;
DROP TABLE thin_parts, thin_new;

-- vertices without a value, duplicates, and points that wait
SELECT abacus_update('thin_mesh', 'SELECT id, x, y, NULL::float8 AS height FROM thin_ground WHERE x > 50 OR id = 3030');
SELECT abacus_insert('thin_mesh', 'VALUES (9001, 5.0, 5.0, 1.0, 1.0)');
SELECT abacus_stage('thin_mesh', 'VALUES (9002, 5.5, 5.5, 1.0, 1.0)');
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height') <= 0.25 AS is_within;
SELECT max(x) FROM abacus_vertices('thin_new');
DROP TABLE thin_new;
SELECT abacus_constrain('thin_mesh', 'VALUES (1, 1, 3030), (1, 2, 3040)');
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height');
SELECT abacus_triangulate('thin_mesh') > 7200;
SELECT abacus_thin('thin_mesh', 'thin_new', 0.25, 'height');
CALL abacus_thin_build('thin_mesh', 'thin_new', 0.25, 'height');

-- space
SELECT abacus_triangulate('thin_solid', $$
    SELECT i, (i * 0.8191725133961645) % 1, (i * 0.6710436067037893) % 1, (i * 0.5497004779019703) % 1,
           sin(3 * ((i * 0.8191725133961645) % 1)) + (i * 0.6710436067037893) % 1 FROM generate_series(1, 3000) AS i $$,
    '{salt}', dimension => 3);
SELECT abacus_thin('thin_solid', 'thin_new', 0.05) <= 0.05 AS is_within;
SELECT * FROM abacus_check('thin_new');
SELECT max(abs(v.attributes[1] - "values"[1])) <= 0.05 AS is_within, count("values"[1])
FROM abacus_vertices('thin_solid') AS v JOIN abacus_interpolate('thin_new', $$SELECT id, x, y, z FROM abacus_vertices('thin_solid')$$) USING (id);
DROP TABLE thin_new;

-- attributes in pages of their own
SELECT abacus_triangulate('thin_apart', 'SELECT 10 * x + y, x, y, ' || (SELECT string_agg(format('x * y %% %s AS a%s', i, i), ', ') FROM generate_series(2, 40) AS i)
                          || ' FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y');
SELECT abacus_thin('thin_apart', 'thin_new', 2, 'a30') <= 2 AS is_within;
SELECT count(*) < 100 AS is_thin, count(v.id) = count(w.id) AS same FROM abacus_vertices('thin_new') AS v LEFT JOIN abacus_vertices('thin_apart') AS w USING (id, attributes);
DROP TABLE thin_new, thin_apart;

-- an error beyond all doubles
SELECT abacus_triangulate('thin_extreme', 'VALUES (1, 0, 0, -1.7e308), (2, 4, 0, -1.7e308), (3, 0, 4, -1.7e308), (4, 1, 1, 1.7e308)', '{h}');
SELECT abacus_thin('thin_extreme', 'thin_new', 1e308, target => 3);
SELECT greatest FROM thin_new_thinning;
DROP TABLE thin_new;
SELECT abacus_thin('thin_extreme', 'thin_new', 1e308);
DROP TABLE thin_new, thin_extreme;

-- errors leave no table
SELECT abacus_thin(NULL, 'thin_new', 1);
SELECT abacus_thin('thin_solid', 'thin_new', NULL);
SELECT abacus_thin('thin_solid', 'thin_new', 'NaN');
SELECT abacus_thin('thin_solid', 'thin_new', -1);
SELECT abacus_thin('thin_solid', 'thin_new', 'Infinity');
SELECT abacus_thin('thin_solid', 'thin_new', 1, target => 0);
SELECT abacus_thin('thin_solid', 'thin_new', 1, 'pepper');
SELECT abacus_thin('thin_mesh', 'thin_new', 1);
SELECT abacus_thin('thin_solid', 'thin_mesh', 1);
SELECT abacus_thin('thin_ground', 'thin_new', 1);
SELECT abacus_thin('thin_solid', 'thin_new', 1, keep => 'lins');
SELECT abacus_thin('thin_solid', 'thin_new', 1, keep => 'SELECT 1; SELECT 2');
SELECT abacus_thin('thin_solid', 'thin_new', 1, keep => 'none, border');
SELECT abacus_thin('thin_solid', 'thin_new', 1, keep => $$SELECT 'a'$$);
SELECT abacus_thin('thin_solid', 'thin_new', 1, keep => 'SELECT NULL::int');
SELECT abacus_triangulate('thin_plain', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT abacus_thin('thin_plain', 'thin_new', 1);
SELECT abacus_create('thin_empty', 2, '{h}');
SELECT abacus_thin('thin_empty', 'thin_new', 1);
SELECT abacus_triangulate('thin_line', 'VALUES (1, 0, 0, 1), (2, 1, 1, 2), (3, 3, 3, 5), (4, 0, 1, NULL::int)', '{h}');
SELECT abacus_thin('thin_line', 'thin_new', 1);
SELECT abacus_update('thin_line', 'SELECT 1 AS id, 0 AS x, 0 AS y, NULL::int AS h UNION ALL SELECT 2, 1, 1, NULL UNION ALL SELECT 3, 3, 3, NULL');
SELECT abacus_thin('thin_line', 'thin_new', 1);
BEGIN;
CALL abacus_thin_build('thin_solid', 'thin_new', 1);
ROLLBACK;
CALL abacus_thin_build('thin_line', 'thin_new', 1);
CALL abacus_thin_build('thin_solid', 'thin_new', 1, keep => 'SELECT 1.5');
SELECT count(*) FROM pg_class WHERE relname LIKE 'thin_new%';
DROP TABLE thin_ground, thin_mesh, thin_solid, thin_plain, thin_empty, thin_line;
-- few points fit the memory: the temporary files of the last step end with it
CREATE TABLE thin_points AS SELECT i AS id, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y, sin(i) AS h FROM generate_series(1, 20000) AS i;
SELECT abacus_triangulate('thin_rough', 'TABLE thin_points');
SET maintenance_work_mem = '1MB';
SELECT abacus_thin('thin_rough', 'thin_smooth', 0.3) > 0 AS thinned;
SELECT abacus_triangulate('thin_gaps', 'SELECT id, x, y, CASE WHEN id % 10 = 0 THEN h END AS h FROM thin_points');
SELECT abacus_thin('thin_gaps', 'thin_few', 0.3) > 0 AS thinned;
RESET maintenance_work_mem;
DROP TABLE thin_rough, thin_smooth, thin_gaps, thin_few, thin_points;

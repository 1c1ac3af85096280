-- Labels of simplices, markers of facets: given with a load or later, returned, kept as long as the simplex is there.
CREATE SCHEMA regress_labels;
SET search_path = regress_labels, public;

-- A load takes them behind the vertices; the mesh is not convex.
CREATE TABLE corner (id int, x float8, y float8);
INSERT INTO corner VALUES (1, 0, 0), (2, 2, 0), (3, 2, 1), (4, 1, 1), (5, 1, 2), (6, 0, 2);
CREATE TABLE part (v0 int, v1 int, v2 int, soil int, depth numeric);
INSERT INTO part VALUES (1, 2, 3, 7, 1.5), (1, 3, 4, NULL, NULL), (1, 4, 6, 8, NULL), (4, 5, 6, 8, -2);
SELECT abacus_load('notch', 'TABLE corner', 'TABLE part', labels => '{soil,depth}');
SELECT abacus_labels('notch');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
SELECT v0, v1, v2, labels FROM abacus_cells('notch', ARRAY[1.5, 0], 0.1);
SELECT id, v0, v1, v2, labels FROM abacus_locate('notch', 'VALUES (1, 1.5, 0.25), (2, 0.5, 1.75), (3, 1.75, 1.75), (4, 1, 0.75)') ORDER BY id;
SELECT * FROM abacus_check('notch');
SELECT abacus_labels('notch', abacus_locate('notch', 0.5, 1.75)), abacus_labels('notch', abacus_locate('notch', 1.75, 1.75)) IS NULL AS outside;
-- it cannot be changed, but it can be labelled
SELECT abacus_label('notch', 'SELECT code, v0, v1, v2, NULL AS depth, v0 + v1 AS "a sum" FROM abacus_simplices(''notch'') WHERE v0 = 1');
SELECT abacus_labels('notch');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
SELECT * FROM abacus_check('notch');

-- In a mesh that changes they stay with their simplices.
CREATE TABLE points AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y FROM generate_series(1, 4000) i;
SELECT abacus_triangulate('field', 'TABLE points');
SELECT count(*), count(labels[1]) FROM abacus_cells('field');
SELECT abacus_label('field', 'SELECT code, v0, v1, v2, v0 * 1000003 + v1 * 1009 + v2 AS n, v1 % 5 AS fifth FROM abacus_simplices(''field'')')
    = (SELECT count(*) FROM abacus_simplices('field')) AS all_of_them;
CREATE VIEW wrong AS SELECT v0, v1, v2, labels FROM abacus_cells('field')
    WHERE labels[1] <> v0 * 1000003 + v1 * 1009 + v2 OR labels[2] <> v1 % 5;
CREATE TABLE before AS SELECT v0, v1, v2 FROM abacus_cells('field');
CREATE VIEW lost AS SELECT v0, v1, v2 FROM abacus_cells('field') JOIN before USING (v0, v1, v2) WHERE labels[1] IS NULL;
CREATE VIEW found AS SELECT v0, v1, v2 FROM abacus_cells('field') LEFT JOIN before b USING (v0, v1, v2) WHERE b IS NULL AND labels <> '{NULL,NULL}';
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT abacus_insert('field', 'SELECT 10000 + id, x + 0.5, y + 0.25 FROM points WHERE id % 40 = 0');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT count(labels[1]) BETWEEN 6000 AND 7800 AS some_are_left FROM abacus_cells('field');
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 50 = 1');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT * FROM abacus_check('field');
SELECT count(*) FROM abacus_cells('field') WHERE labels IS DISTINCT FROM abacus_labels('field', (code, v0, v1, v2, v3));
-- another domain
SELECT abacus_insert('field', 'SELECT 20000 + id, x * 50 + 3000, y * 70 + 3000 FROM points');
TABLE wrong UNION ALL SELECT *, NULL FROM lost UNION ALL SELECT *, NULL FROM found;
SELECT count(labels[1]) > 5000 AS many_are_left FROM abacus_cells('field');
SELECT * FROM abacus_check('field');
-- rolled back
BEGIN;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points');
SELECT count(labels[1]) FROM abacus_cells('field');
ROLLBACK;
SELECT count(labels[1]) > 5000 AS there_again FROM abacus_cells('field');

-- Those with a label in a range, of all of the mesh and of windows.
CREATE VIEW ranges AS SELECT n AS label, f AS first, f + w AS last
    FROM (VALUES ('n', 1, 0), ('n', 1e6, 3e7), ('n', -1, 1e12), ('fifth', 3, 0), ('fifth', 2.5, 2), ('fifth', 7, 9)) r (n, f, w);
SELECT label, first, last, count(*) FILTER (WHERE found) AS found, count(*) FILTER (WHERE NOT found OR NOT there) AS wrong FROM ranges,
    LATERAL (SELECT f.code IS NOT NULL AS found, e.code IS NOT NULL AS there
        FROM abacus_cells('field', label => label, range => ARRAY[first, last]) f
        FULL JOIN (SELECT * FROM abacus_cells('field') a WHERE a.labels[CASE label WHEN 'n' THEN 1 ELSE 2 END] BETWEEN first AND last) e USING (code, v0, v1, v2, labels, corners)) c
    GROUP BY 1, 2, 3 ORDER BY 1, 2, 3;
SELECT label, first, last, count(*) FILTER (WHERE found) AS found, count(*) FILTER (WHERE NOT found OR NOT there) AS wrong FROM ranges,
    LATERAL (SELECT f.code IS NOT NULL AS found, e.code IS NOT NULL AS there
        FROM abacus_cells('field', '{300, 300}', 200, label => label, range => ARRAY[first, last]) f
        FULL JOIN (SELECT * FROM abacus_cells('field', '{300, 300}', 200, 1e9) a WHERE a.labels[CASE label WHEN 'n' THEN 1 ELSE 2 END] BETWEEN first AND last) e USING (code, v0, v1, v2, labels, corners)) c
    GROUP BY 1, 2, 3 ORDER BY 1, 2, 3;
SELECT v0, v1, v2, labels FROM abacus_cells('notch', label => 'a sum', range => '{4,Infinity}') ORDER BY 1, 2, 3;
SELECT v0, v1, v2, labels FROM abacus_cells('notch', label => 'soil') ORDER BY 1, 2, 3;
SELECT v0, v1, v2, labels FROM abacus_cells('notch', ARRAY[1.5, 0], ARRAY[2, 2], label => 'soil', range => '{7,7}');
SELECT count(*) FROM abacus_cells('notch', label => 'soil', range => '{9,9}');
SELECT * FROM abacus_cells('notch', label => 'salt');
SELECT * FROM abacus_cells('notch', label => 'soil', range => '{9,8}');
SELECT * FROM abacus_cells('notch', label => 'soil', range => '{9,NaN}');
SELECT * FROM abacus_cells('notch', label => 'soil', range => '{9}');
SELECT * FROM abacus_cells('notch', range => '{8,9}');

-- In space, with attributes, of which there are many.
CREATE TABLE solid AS SELECT i AS id, (i * 7919) % 109 AS x, (i * 104729) % 97 AS y, (i * 31337) % 101 AS z, i AS a, i AS b, i AS c FROM generate_series(1, 600) i;
SELECT abacus_triangulate('solid_mesh', 'TABLE solid', dimension => 3);
SELECT abacus_label('solid_mesh', 'SELECT code, v0, v1, v2, v3, v0 - v3 AS material FROM abacus_simplices(''solid_mesh'') WHERE v0 % 2 = 0') > 0 AS some;
SELECT count(*) FROM abacus_cells('solid_mesh') WHERE labels[1] IS DISTINCT FROM CASE v0 % 2 WHEN 0 THEN v0 - v3 END;
SELECT count(*) > 20 AS some, count(*) = (SELECT count(*) FROM abacus_cells('solid_mesh') WHERE labels[1] BETWEEN -400 AND -50) AS all_of_them
    FROM abacus_cells('solid_mesh', label => 'material', range => '{-400,-50}') WHERE labels[1] BETWEEN -400 AND -50;
SELECT * FROM abacus_cells('solid_mesh', label => 'a');
SELECT abacus_triangulate('bare', 'TABLE points');
SELECT * FROM abacus_cells('bare', label => 'a');
SELECT * FROM abacus_check('solid_mesh');

-- Markers of facets: the boundary of a mesh, then all edges of some triangles.
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, f, 7 FROM abacus_simplices(''notch'') s, generate_series(0, 2) f WHERE abacus_walk(''notch'', s, f) IS NULL');
SELECT marker, v0, v1, v2, corners FROM abacus_facets('notch') ORDER BY v0, v1;
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, f, CASE v2 WHEN 4 THEN -3 END FROM abacus_simplices(''notch'') s, generate_series(0, 2) f WHERE (v0, v1) IN ((1, 3), (4, 5))');
SELECT marker, v0, v1 FROM abacus_facets('notch') ORDER BY marker, v0, v1;
SELECT count(*) FROM abacus_facets('notch', -3);
SELECT * FROM abacus_check('notch');
CREATE VIEW edges AS SELECT least(a, b) AS a, greatest(a, b) AS b FROM abacus_simplices('field'), LATERAL (VALUES (v0, v1), (v1, v2), (v2, v0)) e (a, b) GROUP BY 1, 2;
SELECT abacus_mark('field', 'SELECT code, v0, v1, v2, 2, (v0 + v1) % 1000 FROM abacus_simplices(''field'') WHERE v2 % 3 = 0') > 1000 AS many;
CREATE TABLE marked AS SELECT marker, least(v0, v1) AS a, greatest(v0, v1) AS b FROM abacus_facets('field');
SELECT count(*) - count(DISTINCT (a, b)) AS twice, count(*) FILTER (WHERE marker <> (a + b) % 1000) AS wrong FROM marked;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id % 50 = 2');
SELECT abacus_insert('field', 'SELECT 40000 + id, x + 0.25, y + 0.5 FROM points WHERE id % 40 = 3');
CREATE VIEW kept AS SELECT marker, least(v0, v1) AS a, greatest(v0, v1) AS b FROM abacus_facets('field');
(SELECT * FROM marked WHERE (a, b) IN (TABLE edges) EXCEPT TABLE kept) UNION ALL (TABLE kept EXCEPT SELECT * FROM marked WHERE (a, b) IN (TABLE edges));
SELECT (SELECT count(*) FROM kept) < (SELECT count(*) FROM marked) AS some_have_gone;
SELECT * FROM abacus_check('field');
-- edges of the hull that get a triangle beyond them
SELECT abacus_triangulate('outer', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 3), (4, 0, 3), (5, 2, 1)');
SELECT abacus_mark('outer', 'SELECT code, v0, v1, v2, f, 1 FROM abacus_simplices(''outer'') s, generate_series(0, 2) f WHERE abacus_walk(''outer'', s, f) IS NULL');
SELECT abacus_insert('outer', 'VALUES (6, 20, 1.5)');
SELECT marker, v0, v1 FROM abacus_facets('outer') ORDER BY v0, v1;
SELECT * FROM abacus_check('outer');
SELECT abacus_mark('notch', 'SELECT 1, 2, 3, 4, 0, 1');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 3, 1 FROM abacus_simplices(''notch'')');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 0, 1.5 FROM abacus_simplices(''notch'')');
SELECT abacus_mark('notch', 'SELECT code, v0, v1, v2, 0 FROM abacus_simplices(''notch'')');

-- Markers given with a load.
SELECT abacus_load('marked_notch', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1, 5), (3, 1, 6), (1, 3, 6), (5, 6, NULL)');
SELECT marker, v0, v1 FROM abacus_facets('marked_notch');
SELECT * FROM abacus_check('marked_notch');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1, 5), (3, 6, 6), (1, 3, 6), (3, 1, 7)');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 2, 5), (1, 2, 2.5)');
SELECT abacus_load('bad', 'TABLE corner', 'SELECT v0, v1, v2 FROM part', facets => 'VALUES (2, 1)');

-- Rays, sections and figures tell them, too.
SELECT enters, v0, v1, v2, labels FROM abacus_ray('notch', '{0.25, 3}', '{0, -1}');
SELECT count(*) > 10 AS some, count(*) FILTER (WHERE labels IS DISTINCT FROM abacus_labels('field', (code, v0, v1, v2, v3))) AS wrong FROM abacus_ray('field', '{0, 0}', '{5, 4}');
SELECT count(*) > 10 AS some, count(*) FILTER (WHERE labels IS DISTINCT FROM abacus_labels('solid_mesh', (code, v0, v1, v2, v3))) AS wrong FROM abacus_ray('solid_mesh', '{-1, 50, 50}', '{1, 0.01, 0.02}');
SELECT abacus_triangulate('dice', 'VALUES (1, 0, 0, 0), (2, 4, 0, 0), (3, 0, 4, 0), (4, 0, 0, 4)', dimension => 3);
SELECT labels FROM abacus_section('dice', '{0, 0, 1}', '{0, 0, 1}');
SELECT abacus_label('dice', 'SELECT code, v0, v1, v2, v3, 6 AS eyes FROM abacus_simplices(''dice'')');
SELECT polygon, labels FROM abacus_section('dice', '{0, 0, 1}', '{0, 0, 1}');
SELECT polygon, labels FROM abacus_section('dice', '{0, 0, 0}', '{0, 0, 1}');
SELECT polygon, labels FROM abacus_section('dice', '{0, 0, 0}', '{0, 0, -1}');
WITH polygons AS MATERIALIZED (SELECT row_number() OVER () AS id, code, polygon, labels FROM abacus_section('solid_mesh', '{50, 50, 50}', '{1, 2, 3}', 'a'))
SELECT count(*) > 10 AS some, count(*) FILTER (WHERE NOT EXISTS (SELECT FROM abacus_cells('solid_mesh') c WHERE c.code = p.code AND c.labels IS NOT DISTINCT FROM p.labels)) AS wrong FROM polygons p;
-- pictures: a window in one triangle has the colour of its label, as that of an attribute
SELECT abacus_triangulate('tile', 'VALUES (1, 0, 0), (2, 4, 0), (3, 0, 4), (4, 5, 5), (5, -3, -3)');
SELECT abacus_label('tile', 'SELECT code, v0, v1, v2, NULLIF(v0 + v1 + v2, 8) AS ids FROM abacus_simplices(''tile'')');
SELECT v0 + v1 + v2 AS ids, labels FROM abacus_cells('tile') ORDER BY ids;
CREATE FUNCTION window_at(mesh regclass, attribute text, x float8, y float8) RETURNS bytea LANGUAGE sql AS $$
    SELECT abacus_draw(mesh, width => 8, height => 8, lower => ARRAY[x, y], upper => ARRAY[x + 0.1, y + 0.1], attribute => attribute, edges => false, range => '{0,20}') $$;
SELECT abacus_triangulate('plain', 'VALUES (1, -50, -50, 9, 6, NULL::float8), (2, 50, -50, 9, 6, NULL), (3, 0, 50, 9, 6, NULL)', '{nine,six,missing}');
SELECT window_at('tile', 'ids', 3, 3) = window_at('plain', 'nine', 3, 3) AS nine, window_at('tile', 'ids', 1, 1) = window_at('plain', 'six', 1, 1) AS six,
       window_at('tile', 'ids', 1, -0.5) = window_at('plain', 'missing', 1, -0.5) AS missing, window_at('tile', 'ids', 1, 1) = window_at('tile', 'ids', 3, 3) AS same;
SELECT length(abacus_draw('tile', 32, attribute => 'ids', contours => 1)) > 0 AS drawn;
SELECT abacus_triangulate('other_dice', 'VALUES (1, 0, 0, 0, 6), (2, 4, 0, 0, 6), (3, 0, 4, 0, 6), (4, 0, 0, 4, 6)', '{six}', 3);
SELECT abacus_draw_section('dice', '{0, 0, 1}', '{0, 0, 1}', 16, attribute => 'eyes', range => '{0,20}', edges => false) = abacus_draw_section('other_dice', '{0, 0, 1}', '{0, 0, 1}', 16, attribute => 'six', range => '{0,20}', edges => false) AS six;
SELECT abacus_draw('tile', attribute => 'none');
SELECT name, value FROM abacus_stats('notch') WHERE name IN ('labels', 'labelled', 'marked') ORDER BY name;
SELECT count(*) FROM abacus_stats('dice') WHERE name = 'marked';

-- New simplices inherit: each what the simplex has in which its centroid lay, which a mesh that does not change tells.
SELECT abacus_create('empty', 2);
SELECT abacus_inherit_labels('empty');
CREATE TABLE strewn AS SELECT i AS id, u - floor(u) AS x, v - floor(v) AS y, w - floor(w) AS z FROM generate_series(1, 3000) i,
    LATERAL (SELECT sin(i * 12.9898) * 43758.5453 AS u, sin(i * 78.233) * 24634.6345 AS v, sin(i * 37.719) * 13758.7431 AS w) s;
SELECT abacus_triangulate(m, 'SELECT id, x, y FROM strewn WHERE id <= 2000') FROM (VALUES ('heir'), ('old')) m (m);
SELECT abacus_label(m, format('SELECT code, v0, v1, v2, %s FROM abacus_simplices(%L) WHERE v0 %% 10 > 0', string_agg(format('v0 * %s AS l%s', n, n), ', ' ORDER BY n), m)) > 3000 AS most
    FROM (VALUES ('heir'), ('old')) m (m), generate_series(1, 40) n GROUP BY m;
SELECT abacus_inherit_labels('heir');
CREATE VIEW heirs AS SELECT c.labels AS "is", abacus_labels('old', abacus_locate('old', c.corners[1][1] / 3 + c.corners[2][1] / 3 + c.corners[3][1] / 3, c.corners[1][2] / 3 + c.corners[2][2] / 3 + c.corners[3][2] / 3)) AS was FROM abacus_cells('heir') c;
SELECT abacus_insert('heir', 'SELECT id, x * 1.1, y * 1.1 FROM strewn WHERE id > 2000'); -- some are outside
SELECT count(*), count(*) FILTER (WHERE "is"[40] > 0) > 4500 AS most, count(*) FILTER (WHERE "is" IS DISTINCT FROM COALESCE(was, array_fill(NULL::float8, '{40}'))) AS wrong FROM heirs;
SELECT * FROM abacus_check('heir');
-- back again: what came goes, and others inherit from it
SELECT abacus_delete('heir', 'SELECT id, x * 1.1, y * 1.1 FROM strewn WHERE id > 2000');
SELECT count(*), count(*) FILTER (WHERE "is"[40] > 0) > 3000 AS most FROM heirs;
SELECT * FROM abacus_check('heir');
SELECT abacus_inherit_labels('heir', false);
SELECT value FROM abacus_stats('heir') WHERE name = 'labels_inherited';
SELECT abacus_insert('heir', 'SELECT id, x * 1.1, y * 1.1 FROM strewn WHERE id > 2000');
SELECT count(*), count(*) FILTER (WHERE "is"[40] > 0) < 3000 AS fewer FROM heirs;
SELECT abacus_triangulate(m, 'SELECT id, x, y, z FROM strewn WHERE id <= 700', dimension => 3) FROM (VALUES ('heir_solid'), ('old_solid')) m (m);
SELECT abacus_label(m, format('SELECT code, v0, v1, v2, v3, v0 AS l FROM abacus_simplices(%L)', m)) > 3000 AS all_of_them FROM (VALUES ('heir_solid'), ('old_solid')) m (m);
SELECT abacus_inherit_labels('heir_solid');
SELECT abacus_insert('heir_solid', 'SELECT id, x, y, z FROM strewn WHERE id > 2700'), abacus_delete('heir_solid', 'SELECT id, x, y, z FROM strewn WHERE id > 2700');
SELECT abacus_insert('heir_solid', 'SELECT id, x, y, z FROM strewn WHERE id > 2700') FROM abacus_label('heir_solid', 'SELECT code, v0, v1, v2, v3, v0 AS l FROM abacus_simplices(''heir_solid'')');
SELECT count(*), count(*) FILTER (WHERE is_now IS DISTINCT FROM was) AS wrong FROM (SELECT labels[1] AS is_now, (abacus_labels('old_solid', abacus_locate('old_solid', x[1] / 4 + x[2] / 4 + x[3] / 4 + x[4] / 4, y[1] / 4 + y[2] / 4 + y[3] / 4 + y[4] / 4, z[1] / 4 + z[2] / 4 + z[3] / 4 + z[4] / 4)))[1] AS was
    FROM abacus_cells('heir_solid'), LATERAL (SELECT ARRAY(SELECT corners[i][1] FROM generate_series(1, 4) i) AS x, ARRAY(SELECT corners[i][2] FROM generate_series(1, 4) i) AS y, ARRAY(SELECT corners[i][3] FROM generate_series(1, 4) i) AS z) c) compared;
SELECT * FROM abacus_check('heir_solid');

-- Attributes come and go, in the simplex pages and apart; labels and markers stay.
CREATE TABLE solid_labels AS SELECT v0, v1, v2, v3, labels FROM abacus_cells('solid_mesh');
CREATE VIEW solid_changed AS (SELECT v0, v1, v2, v3, labels FROM abacus_cells('solid_mesh') EXCEPT TABLE solid_labels) UNION ALL (TABLE solid_labels EXCEPT SELECT v0, v1, v2, v3, labels FROM abacus_cells('solid_mesh'));
SELECT abacus_mark('solid_mesh', 'SELECT code, v0, v1, v2, v3, 0, v1 % 10 FROM abacus_simplices(''solid_mesh'') WHERE v0 % 3 = 0') > 0 AS some;
CREATE TABLE solid_facets AS SELECT * FROM abacus_facets('solid_mesh');
SELECT abacus_add_attribute('solid_mesh', 'd');
SELECT abacus_drop_attribute('solid_mesh', 'a');
SELECT abacus_labels('solid_mesh'), (SELECT string_agg(name, ' ') FROM abacus_attributes('solid_mesh')) AS attributes;
TABLE solid_changed;
SELECT abacus_drop_attribute('solid_mesh', name) FROM (VALUES ('b'), ('c'), ('d')) n (name);
SELECT abacus_labels('solid_mesh'), (SELECT count(*) FROM abacus_attributes('solid_mesh')) AS attributes;
TABLE solid_changed;
TABLE solid_facets EXCEPT SELECT * FROM abacus_facets('solid_mesh');
SELECT * FROM abacus_check('solid_mesh');
SELECT abacus_add_attribute('solid_mesh', 'e'), abacus_label('solid_mesh', 'SELECT code, v0, v1, v2, v3, 1 AS e2 FROM abacus_simplices(''solid_mesh'') LIMIT 1');
SELECT abacus_labels('solid_mesh'), (SELECT string_agg(name, ' ') FROM abacus_attributes('solid_mesh')) AS attributes;
SELECT * FROM abacus_check('solid_mesh');
SELECT abacus_rename_attribute('solid_mesh', 'e', 'material');
SELECT abacus_add_attribute('solid_mesh', 'material');
SELECT abacus_drop_attribute('solid_mesh', 'material');
-- a mesh with many attributes in its simplex pages gets them apart
SELECT abacus_create('former', 2, '{a,b,c,d,e,f}');
UPDATE former SET page = set_byte(page::bytea, 6, 3)::abacus_page WHERE code = -1;
SELECT abacus_insert('former', 'SELECT id, x, y, id, id, id, id, id, id FROM points');
SELECT abacus_label('former', 'SELECT code, v0, v1, v2, v0 AS first FROM abacus_simplices(''former'')') > 0 AS some;
CALL abacus_build('former');
SELECT count(*) FROM abacus_cells('former') WHERE labels <> ARRAY[v0]::float8[];
SELECT array_agg(name) FROM abacus_attributes('former') WHERE "least" = 1 AND "greatest" = 4000;
SELECT * FROM abacus_check('former');
-- what a change has changed
CREATE TABLE told AS SELECT created, v0, v1, v2 FROM abacus_insert_returning('field', 'SELECT 50000, 500.125, 500.375');
SELECT created, count(*) > 2 AS some FROM told GROUP BY created ORDER BY created;
SELECT count(*) AS wrong FROM abacus_delete_returning('field', 'SELECT 50000, 500.125, 500.375') d FULL JOIN told t ON (d.v0, d.v1, d.v2, d.created) = (t.v0, t.v1, t.v2, NOT t.created) WHERE d IS NULL OR t IS NULL;
-- what came back in another call has no labels
TABLE lost EXCEPT SELECT v0, v1, v2 FROM told WHERE NOT created;
SELECT (SELECT count(*) FROM lost) = (SELECT count(*) FROM told JOIN before USING (v0, v1, v2) WHERE NOT created) AS all_of_them;
TABLE wrong UNION ALL SELECT *, NULL FROM found;
SELECT * FROM abacus_check('field');
-- all names together
SELECT abacus_create('names', 2, array_agg('a' || i)) FROM generate_series(1, 90) i;
SELECT abacus_insert('names', 'SELECT i, i % 2, i / 2, ' || string_agg(n::text, ', ') || ' FROM generate_series(0, 2) i') FROM generate_series(1, 90) n;
SELECT abacus_label('names', 'SELECT code, v0, v1, v2, ' || string_agg(n || ' AS l' || n, ', ' ORDER BY n) || ' FROM abacus_simplices(''names'')') FROM generate_series(1, 115) n;
SELECT labels[1] = 1 AND labels[115] = 115 AS all_of_them, array_length(labels, 1) FROM abacus_cells('names');
SELECT abacus_label('names', 'SELECT code, v0, v1, v2, 1 AS one_more FROM abacus_simplices(''names'')');
SELECT abacus_add_attribute('names', 'one_more');
SELECT abacus_drop_attribute('names', 'a2');
SELECT abacus_label('names', 'SELECT code, v0, v1, v2, 26 AS l115 FROM abacus_simplices(''names'')');
SELECT labels[1] = 1 AND labels[114] = 114 AND labels[115] = 26 AS all_of_them, (abacus_labels('names'))[115] FROM abacus_cells('names');
SELECT position, name, "least" FROM abacus_attributes('names') WHERE position IN (1, 2, 89, 90) ORDER BY position;
SELECT * FROM abacus_check('names');

-- Of a statement on a table that the mesh follows, before and after are what others see.
CREATE TABLE moving AS SELECT * FROM (VALUES (1, 0, 0), (2, 4, 0), (3, 2, 3), (4, 2, -1.4), (5, 2, -10)) AS p(id, x, y);
SELECT abacus_triangulate('followed', 'TABLE moving');
SELECT abacus_track('followed', 'moving');
SELECT abacus_label('followed', 'SELECT code, v0, v1, v2, 10 * v0 + v1 AS soil FROM abacus_simplices(''followed'')');
SELECT abacus_inherit_labels('followed');
SELECT abacus_mark('followed', 'SELECT code, v0, v1, v2, f, 7 FROM abacus_simplices(''followed''), generate_series(0, 2) AS f
                                WHERE 1 IN (v0, v1, v2) AND 2 IN (v0, v1, v2) AND (ARRAY[v0, v1, v2])[f + 1] > 2');
SELECT v0, v1, v2, labels FROM abacus_cells('followed') ORDER BY v0, v1, v2;
-- with the point at both places the edge from 1 to 2 is not in the mesh
UPDATE moving SET y = 2 WHERE id = 4;
SELECT marker, v0, v1 FROM abacus_facets('followed');
SELECT v0, v1, v2, labels FROM abacus_cells('followed') ORDER BY v0, v1, v2;
SELECT abacus_track('followed', 'moving', deferred => true);
BEGIN;
UPDATE moving SET y = -1.4 WHERE id = 4;
UPDATE moving SET y = 2.5 WHERE id = 4;
COMMIT;
SELECT marker, v0, v1 FROM abacus_facets('followed');
SELECT * FROM abacus_check('followed');
-- a row with NULLs alone is none
SELECT abacus_label('followed', 'SELECT code, v0, v1, v2, NULL AS soil FROM abacus_simplices(''followed'') LIMIT 2');
SELECT name, value FROM abacus_stats('followed') WHERE name IN ('labelled', 'marked') ORDER BY name;
TRUNCATE moving;
SELECT name, value FROM abacus_stats('followed') WHERE name IN ('labelled', 'marked', 'simplices') ORDER BY name;

-- Errors change nothing.
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4');
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4, 5 AS soil, 6 AS soil');
SELECT abacus_label('notch', 'SELECT 1, 2, 3, 4, 5 AS soil');
SELECT abacus_label('notch', 'SELECT code, v0, v1, v2, ''clay'' AS soil FROM abacus_simplices(''notch'')');
SELECT abacus_label('notch', 'SELECT code, v0, v1, NULL::int, 1 AS soil FROM abacus_simplices(''notch'')');
SELECT abacus_label('solid_mesh', 'SELECT code, v0, v1, v2, v3, 1 AS e FROM abacus_simplices(''solid_mesh'')');
SELECT abacus_labels('notch', (1, 2, 3, 4, NULL)::abacus_simplex);
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil}');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil,soil}');
SELECT abacus_load('bad', 'TABLE corner', 'TABLE part', labels => '{soil,NULL}');
SELECT abacus_load('bad', 'SELECT *, 1 AS soil FROM corner', 'TABLE part', labels => '{soil,depth}');
SELECT v0, v1, v2, labels FROM abacus_cells('notch') ORDER BY 1, 2, 3;
-- a mesh triangulated anew has other simplices
SELECT abacus_load('anew', 'TABLE corner', 'TABLE part', labels => '{soil,depth}', retriangulate => true);
SELECT count(*), count(labels[1]), count(labels[2]) FROM abacus_cells('anew');
SELECT * FROM abacus_check('anew');

SET client_min_messages = warning;
DROP SCHEMA regress_labels CASCADE;

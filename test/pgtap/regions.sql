-- Regions of a mesh: outlines, seeds, what they do to other changes, and questions within them.
BEGIN;
SELECT no_plan();

SELECT has_type('abacus_region_part');
SELECT function_returns('abacus_region', ARRAY['regclass', 'text'], 'bigint');
SELECT function_returns('abacus_unregion', ARRAY['regclass', 'text'], 'void');
SELECT function_returns('abacus_regions', ARRAY['regclass'], 'setof record');
SELECT is((SELECT count(*) FROM pg_attribute AS a, col_description(a.attrelid, a.attnum) AS d
           WHERE a.attrelid = 'abacus_region_part'::regclass AND d IS NULL), 0::bigint, 'all columns of the type have comments');
SELECT is((SELECT count(*) FROM pg_proc WHERE 'max_edge' = ANY (proargnames) AND NOT 'within' = ANY (proargnames)
           AND proname NOT IN ('abacus_isosurface', 'abacus_section', 'abacus_draw_section', 'abacus_draw_volume') AND pronamespace = 'public'::regnamespace), 0::bigint,
          'whatever takes max_edge in the plane takes within');

-- a field of 10 by 10 with heights, a square with a hole and an island, a square beside it along half an edge, and a triangle at a corner
CREATE TABLE point AS SELECT (10 * x + y)::bigint AS id, x::float8, y::float8, (x + 2 * y)::float8 AS h FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y;
SELECT abacus_triangulate('field', 'TABLE point');
CREATE FUNCTION pg_temp.ring(line bigint, ids bigint[]) RETURNS TABLE (l bigint, p bigint, id bigint) LANGUAGE sql AS $$ SELECT line, n, ids[n] FROM generate_subscripts(ids, 1) AS n $$;
CREATE TABLE line AS SELECT r.* FROM (VALUES (1, ARRAY[11, 61, 66, 16, 11]), (2, ARRAY[22, 52, 55, 25, 22]), (3, ARRAY[33, 43, 44, 34, 33]), (4, ARRAY[61, 91, 93, 63, 61]),
    (5, ARRAY[66, 86, 88, 66]), (6, ARRAY[61, 66, 16, 11, 61]), (7, ARRAY[18, 38]), (8, ARRAY[22, 25, 55, 52, 22])) AS g (line, ids), pg_temp.ring(line, ids) AS r;

CREATE FUNCTION pg_temp.refused(command text, state text, message text, detail text DEFAULT NULL) RETURNS SETOF text LANGUAGE plpgsql AS $$
DECLARE
    before text := (SELECT string_agg(r::text, ';') FROM abacus_regions('field') AS r);
    m text; d text; h text;
BEGIN
    BEGIN
        EXECUTE command;
        RETURN NEXT fail('not refused: ' || message);
    EXCEPTION WHEN OTHERS THEN
        GET STACKED DIAGNOSTICS m = MESSAGE_TEXT, d = PG_EXCEPTION_DETAIL, h = PG_EXCEPTION_HINT;
        RETURN NEXT is(SQLSTATE || ' ' || m || coalesce(' ' || nullif(d, ''), ''), state || ' ' || message || coalesce(' ' || detail, ''), message);
    END;
    RETURN NEXT is((SELECT string_agg(r::text, ';') FROM abacus_regions('field') AS r), before, 'nothing has changed');
    RETURN NEXT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'the mesh is sound');
END $$;

-- before there are lines, and of a mesh in space
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 1)')$$, '55000', 'mesh "field" has no lines', 'A region ends at the fixed edges of lines.');
SELECT is((SELECT count(*) FROM abacus_regions('field')), 0::bigint, 'a mesh without regions has none');
SELECT pg_temp.refused($$SELECT abacus_unregion('field', 'a')$$, '42704', 'mesh "field" has no regions');
SELECT pg_temp.refused($$SELECT abacus_interpolate('field', 1, 1, within => 'a')$$, '42704', 'mesh "field" has no region "a"', 'It has no regions.');
SELECT abacus_create('solid', 3);
SELECT abacus_insert('solid', 'SELECT id, x, y, h * h FROM point');
SELECT throws_ok($$SELECT abacus_region('solid', 'VALUES (''a'', 1)')$$, '55000', 'mesh "solid" has dimension 3');
SELECT is((SELECT count(*) FROM abacus_regions('solid')), 0::bigint, 'which has none');

SELECT abacus_constrain('field', 'TABLE line');
SELECT is(abacus_region('field', 'SELECT ''a'', 1 WHERE false'), 0::bigint, 'no rows, no regions');
SELECT is(to_regclass('field_regions'), NULL, 'and no table');

-- rows
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT ''a''')$$, '42804', 'the query of regions returns 1 column', 'Rows of regions have two or three columns.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT 1, 1')$$, '42804', 'column 1 of the query of regions has type integer', 'It is the region, which is text.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT ''a'', 1.5')$$, '42804', 'column 2 of the query of regions has type numeric', 'It is the line, which is an integer.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT ''a'', true, 1')$$, '42804', 'column 2 of the query of regions has type boolean', 'It is x, which is a number.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 1), (NULL, 1)')$$, '22004', 'the region of row 2 is NULL');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 1), (''a'', NULL)')$$, '22004', 'the line of row 2 is NULL');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES ('''', 1)')$$, '22023', 'the region of row 1 has an empty name');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''POINT (1 1)'', 1)')$$, '22023', 'the region of row 1 is named like a geometry', 'Questions within "POINT (1 1)" would be about that polygon.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT ''a'', 1, ''NaN''::float8')$$, '22023', 'y of row 1 is NaN');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'SELECT ''a'', ''Infinity''::float8, 1')$$, '22023', 'x of row 1 is infinite');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 1), (''b'', 100)')$$, '22023', 'the mesh has no line 100', 'It is an outline of region "b".');
-- outlines and seeds that make no region
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 7)')$$, '22023', 'outline of region "a" is not closed', 'An odd number of its edges meets at (1, 8), where line 7 has a point.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 1), (''b'', 2)')$$, '22023', 'regions "b" and "a" overlap', 'A triangle at (2, 2) beside line 2 would be in both.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''b'', 1), (''a'', 2)')$$, '22023', 'regions "b" and "a" overlap', 'A triangle at (2, 2) beside line 2 would be in both.');
SELECT throws_like($$SELECT abacus_region('field', 'VALUES (''a'', 8.5, 5)')$$, 'region "a" leaks to the hull of mesh "field"');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 10, 5)')$$, '22023', 'seed (10, 5) of region "a" is outside of mesh "field"');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 2, 3.5)')$$, '22023', 'seed (2, 3.5) of region "a" is on a fixed edge', 'It is one of line 2.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''a'', 2, 2)')$$, '22023', 'seed (2, 2) of region "a" is on a fixed edge', 'It is one of line 2.');

-- parity, and what is given twice
SELECT is(abacus_region('field', $$VALUES ('fields', 1), ('fields', 2), ('fields', 3), ('fields', 1), ('fields', 6), ('fields', 8), ('wood', 4), ('hut', 5)$$), 3::bigint, 'three regions');
SELECT results_eq($$SELECT region, triangles, area, edges FROM abacus_regions('field')$$,
    $$VALUES ('fields', 34::bigint, 17::float8, 36::bigint), ('hut', 4, 2, 6), ('wood', 12, 6, 10)$$, 'with their triangles, areas and borders');
SELECT is((SELECT count(*) FROM field_regions), 5::bigint, 'what was given twice is there once');
SELECT is((SELECT string_agg(col_description('field_regions'::regclass, n), ';' ORDER BY n) FROM generate_series(1, 6) AS n),
          (SELECT string_agg(col_description('abacus_region_part'::regclass, n), ';' ORDER BY n) FROM generate_series(1, 6) AS n), 'columns of the table have comments, too');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''hut'', 5)')$$, '42710', 'the mesh already has a region "hut"');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''barn'', 5)')$$, '22023', 'regions "barn" and "hut" overlap', 'A triangle at (6, 6) beside line 5 would be in both.');
SELECT pg_temp.refused($$SELECT abacus_region('field', 'VALUES (''barn'', 7.5, 1.5)')$$, '22023', 'regions "barn" and "wood" overlap', 'A triangle at (7.5, 1.5) would be in both.');
SELECT is(abacus_region('field', $$VALUES ('pond', 2.5, 2.5), ('pond', 4.5, 4.5)$$), 1::bigint, 'a seed, and another one in the same place');
SELECT results_eq($$SELECT triangles, area FROM abacus_regions('field') WHERE region = 'pond'$$, $$VALUES (16::bigint, 8::float8)$$, 'fill the hole around the island');

-- within
CREATE TABLE answers AS SELECT r.region, r.triangles, r.area,
    (SELECT count(*) FROM abacus_cells('field', within => r.region)) AS cells,
    (SELECT count(*) FROM abacus_simplices('field', r.region)) AS simplices,
    (SELECT count(*) FROM abacus_simplices('field', '{0,0}', '{9,9}', within => r.region)) AS in_window,
    (SELECT count(*) FROM abacus_simplices('field', ARRAY[4, 4], 20, within => r.region)) AS in_ball,
    (SELECT v.area FROM abacus_volume('field', 0, within => r.region) AS v) AS volume_area,
    (SELECT count(*) FROM abacus_edges('field', within => r.region)) AS edges,
    (SELECT count(*) FROM abacus_edges('field', fixed => true, within => r.region)) AS fixed,
    (SELECT count(DISTINCT ring) FROM abacus_hull('field', within => r.region)) AS rings,
    (SELECT count(v) FROM abacus_raster('field', '{0,0}', '{9,9}', 90, 90, within => r.region) AS o, unnest(o."values") AS v) AS pixels,
    (SELECT count(i.id) FROM abacus_interpolate('field', 'SELECT 100 * x + y, x / 4.0 + 0.01, y / 4.0 + 0.02 FROM generate_series(0, 35) AS x, generate_series(0, 35) AS y', within => r.region) AS i WHERE i."values"[1] IS NOT NULL) AS places,
    (SELECT count(DISTINCT w.id) FROM abacus_weights('field', 'SELECT 100 * x + y, x / 4.0 + 0.01, y / 4.0 + 0.02 FROM generate_series(0, 35) AS x, generate_series(0, 35) AS y', within => r.region) AS w) AS weighed
    FROM abacus_regions('field') AS r;
SELECT results_eq('SELECT cells, simplices, in_window, in_ball FROM answers', 'SELECT triangles, triangles, triangles, triangles FROM answers', 'cells and simplices are those of the region');
SELECT results_eq('SELECT volume_area FROM answers', 'SELECT area FROM answers', 'so is the area');
SELECT results_eq('SELECT region, rings FROM answers ORDER BY 1', $$VALUES ('fields', 3::bigint), ('hut', 1), ('pond', 2), ('wood', 1)$$, 'rings of the border');
SELECT results_eq('SELECT edges FROM answers', 'SELECT e FROM (SELECT region, (3 * triangles + edges) / 2 AS e FROM abacus_regions(''field'')) AS s', 'each edge once: three a triangle, those of the border on one side');
SELECT results_eq('SELECT fixed FROM answers ORDER BY region', 'SELECT edges FROM abacus_regions(''field'') ORDER BY region', 'fixed ones are those of the border');
SELECT ok(bool_and(pixels BETWEEN 95 * area AND 105 * area + 30 AND places = weighed AND places BETWEEN 13 * area AND 19 * area), 'values are there inside, and NULL outside') FROM answers;
SELECT is((SELECT sum(v.net) FROM (SELECT 'fields' AS r UNION ALL SELECT 'pond') AS s, abacus_volume('field', 0, within => r) AS v),
          25 * 10.5::float8, 'volumes of the parts add up');
SELECT is(abacus_interpolate('field', 3.5, 1.5, within => 'fields'), 6.5::float8, 'inside');
SELECT is(abacus_interpolate('field', 2.5, 2.25, within => 'fields'), NULL, 'in the hole');
SELECT is(abacus_interpolate('field', 2.5, 2.25, outside => 'nearest', within => 'fields'), (SELECT h FROM point WHERE id = 22), 'in the hole, by the nearest vertex');
SELECT is(abacus_interpolate('field', 2, 2.5, within => 'fields'), abacus_interpolate('field', 2, 2.5, within => 'pond'), 'the border belongs to both');
SELECT is(abacus_interpolate('field', 2.5, 2.25, method => 'natural', within => 'fields'), NULL, 'natural neighbours, too');
SELECT is(abacus_interpolate('field', 2.5, 2.25, method => 'nearest', within => 'fields'), NULL, 'and the nearest vertex');
SELECT is((SELECT array_agg(w.vertex ORDER BY w.vertex) FROM abacus_weights('field', 1.5, 1.25, within => 'fields') AS w), (SELECT array_agg(w.vertex ORDER BY w.vertex) FROM abacus_weights('field', 1.5, 1.25) AS w), 'weights inside');
SELECT is((SELECT count(*) FROM abacus_weights('field', 0.5, 0.25, within => 'fields')), 0::bigint, 'weights outside');
SELECT is(abacus_gradient('field', 1.5, 1.25, within => 'fields'), '{1,2}'::float8[], 'gradient inside');
SELECT is(abacus_gradient('field', 0.5, 0.25, within => 'fields'), NULL, 'gradient outside');
SELECT is((SELECT slope FROM abacus_slope('field', 0.5, 0.25, within => 'fields')), NULL, 'slope outside');
SELECT results_eq($$SELECT x, value FROM abacus_profile('field', '{0,3.5,9,3.5}', within => 'fields') WHERE value IS NULL OR x IN (1, 2, 3, 4, 5, 6) ORDER BY distance, value NULLS FIRST$$,
    $$VALUES (0::float8, NULL::float8), (1, NULL), (1, 8), (2, NULL), (2, 9), (3, NULL), (3, 10), (4, NULL), (4, 11), (5, NULL), (5, 12), (6, NULL), (6, 13), (9, NULL)$$, 'a profile leaves and enters at the border');
SELECT is((SELECT visible FROM abacus_visible('field', '{0.5,0.5}', '{1.5,1.25}', within => 'fields')), NULL, 'who stands outside stands nowhere');
SELECT is((SELECT visible FROM abacus_visible('field', '{1.25,1.5}', '{5.5,5.25}', within => 'fields')), true, 'nothing outside blocks');
SELECT is((SELECT count(*) FROM abacus_contours('field', fixed_levels => '{8.5}', within => 'fields')), 2::bigint, 'contours end at the border');
SELECT is((SELECT count(*) FROM abacus_contours('field', fixed_levels => '{8.5}')), 1::bigint, 'and are whole elsewhere');
SELECT ok((SELECT bool_and(length(abacus_draw('field', 64, within => region)) > 60) FROM answers), 'pictures');
SELECT isnt(abacus_draw('field', 64, edges => false, within => 'hut'), abacus_draw('field', 64, edges => false), 'a picture of a region is another one');
SELECT isnt(abacus_tile_picture('field', 0, 0, 0, world => '{0,0,10}', within => 'hut'), abacus_tile_picture('field', 0, 0, 0, world => '{0,0,10}'), 'tiles');
SELECT isnt(abacus_tile_vector('field', 0, 0, 0, world => '{0,0,10}', within => 'hut'), abacus_tile_vector('field', 0, 0, 0, world => '{0,0,10}'), 'tiles');
SELECT isnt(abacus_tile_terrain('field', 0, 0, 0, world => '{0,0,10}', within => 'hut'), abacus_tile_terrain('field', 0, 0, 0, world => '{0,0,10}'), 'tiles');
SELECT is((SELECT count(*) FROM abacus_tiles('field', world => '{0,0,10}', within => 'hut')), 4::bigint, 'functions for tiles of a region');
SELECT is((SELECT tile FROM field_picture(0, 0, 0)), (SELECT abacus_tile_picture('field', 0, 0, 0, world => '{0,0,10}', size => 256, attribute => 'h', range => (SELECT ARRAY[least, greatest] FROM abacus_attributes('field')), within => 'hut')), 'which draw it');
SELECT isnt((SELECT tile FROM field_picture(0, 0, 0, q)), (SELECT tile FROM field_picture(0, 0, 0)), q::text) FROM (VALUES ('{"regions": true}'::json), ('{"lines": true}')) AS v (q);
CREATE TEMP TABLE shown AS SELECT tile FROM field_picture(0, 0, 0, '{"regions": true, "lines": true}');
SELECT is((SELECT count(*) FROM abacus_tiles('field', world => '{0,0,10}', within => 'hut', regions => true, lines => true)), 4::bigint, 'or they show them as a rule');
SELECT is((SELECT tile FROM field_picture(0, 0, 0)), (SELECT tile FROM shown), 'the same tile');
SELECT throws_ok($$SELECT * FROM abacus_tiles('field', world => '{0,0,10}', within => 'zoo')$$, '42704', 'mesh "field" has no region "zoo"');
SELECT throws_ok($$SELECT abacus_interpolate('field', 1, 1, within => 'zoo')$$, '42704', 'mesh "field" has no region "zoo"');

-- lines that regions use
SELECT pg_temp.refused($$SELECT abacus_unconstrain('field', 'SELECT 5')$$, '2BP01', 'region "hut" of mesh "field" uses line 5');
SELECT pg_temp.refused($$SELECT abacus_constrain('field', 'SELECT * FROM line WHERE l = 5', existing => 'replace')$$, '2BP01', 'region "hut" of mesh "field" uses line 5');
SELECT is(abacus_unconstrain('field', 'SELECT 8'), 1::bigint, 'the second of two equal lines may go');
SELECT is((SELECT string_agg(region || triangles, ' ' ORDER BY region) FROM abacus_regions('field')), 'fields34 hut4 pond16 wood12', 'and nothing changes');

-- points come and go
CREATE FUNCTION pg_temp.sizes() RETURNS SETOF text LANGUAGE sql AS $$ SELECT concat_ws(' ', region, area, edges) FROM abacus_regions('field') $$;
SELECT abacus_insert('field', $$SELECT 1000 + n, abs(hashint4(n) % 900) / 100.0, abs(hashint4(n + 7777) % 900) / 100.0, n FROM generate_series(1, 2000) AS n$$);
SELECT is((SELECT string_agg(concat_ws(' ', region, area), ';') FROM abacus_regions('field')), 'fields 17;hut 2;pond 8;wood 6', 'areas stay');
SELECT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'sound');
SELECT abacus_insert('field', $$VALUES (5000, -3, -3, 1), (5001, 14, 13, 1)$$);
SELECT is((SELECT string_agg(concat_ws(' ', region, area), ';') FROM abacus_regions('field')), 'fields 17;hut 2;pond 8;wood 6', 'points beyond the hull');
SELECT abacus_delete('field', $$SELECT id, x, y, attributes[1] FROM abacus_vertices('field') WHERE id > 1000 AND id % 3 <> 0$$);
SELECT is((SELECT string_agg(concat_ws(' ', region, area), ';') FROM abacus_regions('field')), 'fields 17;hut 2;pond 8;wood 6', 'points that go');
SELECT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'sound');
SELECT abacus_delete('field', $$SELECT id, x, y, attributes[1] FROM abacus_vertices('field') WHERE id > 1000$$);
SELECT is((SELECT string_agg(concat_ws(' ', region, triangles, area, edges), ';') FROM abacus_regions('field')), 'fields 34 17 36;hut 4 2 6;pond 16 8 16;wood 12 6 10', 'as before');

-- lines come and go within a region with seeds
INSERT INTO line SELECT * FROM pg_temp.ring(20, ARRAY[23, 33]);
SELECT abacus_constrain('field', 'SELECT * FROM line WHERE l = 20');
SELECT is((SELECT string_agg(concat_ws(' ', region, triangles, area), ';') FROM abacus_regions('field') WHERE region = 'pond'), 'pond 16 8', 'a line that ends within');
INSERT INTO line SELECT * FROM pg_temp.ring(21, ARRAY[44, 54]);
SELECT abacus_constrain('field', 'SELECT * FROM line WHERE l = 21');
SELECT is((SELECT string_agg(concat_ws(' ', region, triangles, area), ';') FROM abacus_regions('field') WHERE region = 'pond'), 'pond 16 8', 'another one, and there is a seed on either side');
SELECT abacus_unregion('field', 'pond');
SELECT is((SELECT count(*) FROM abacus_regions('field')), 3::bigint, 'a region goes');
SELECT pg_temp.refused($$SELECT abacus_unregion('field', 'pond')$$, '42704', 'mesh "field" has no region "pond"');
SELECT abacus_region('field', $$VALUES ('half', 2.5, 2.5)$$);
SELECT is((SELECT triangles FROM abacus_regions('field') WHERE region = 'half'), 8::bigint, 'a seed fills its side of the lines');
SELECT throws_ok($$SELECT abacus_unconstrain('field', 'SELECT 20')$$, '55000', 'region "half" ends at line 20');
SELECT abacus_unregion('field', 'half');
SELECT is(abacus_unconstrain('field', 'VALUES (20), (21)'), 2::bigint, 'without the region they may go');
SELECT abacus_region('field', $$VALUES ('pond', 2.5, 2.5)$$);
SELECT abacus_constrain('field', 'SELECT * FROM line WHERE l IN (20, 21)');
SELECT is((SELECT triangles FROM abacus_regions('field') WHERE region = 'pond'), 8::bigint, 'lines that come take from a region what its seed does not reach');
SELECT throws_ok($$SELECT abacus_constrain('field', 'VALUES (22, 1, 22), (22, 2, 33)')$$, '22023', 'seed (2.5, 2.5) of region "pond" is on a fixed edge');
SELECT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'sound');

-- while lines wait for points that wait
SELECT abacus_stage('field', 'VALUES (2001, 12, 12, 1), (2002, 12, 14, 1)');
SELECT abacus_constrain('field', 'VALUES (30, 1, 2001), (30, 2, 2002)');
SELECT pg_temp.refused($$SELECT abacus_unregion('field', 'hut')$$, '55000', 'lines of mesh "field" wait', 'A region ends at the fixed edges of lines.');
SELECT abacus_triangulate('field');
SELECT abacus_unregion('field', 'hut');
SELECT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'when they are fixed, a region goes with its number');
SELECT abacus_region('field', $$VALUES ('hut', 5)$$);
SELECT is((SELECT concat_ws(' ', triangles, area) FROM abacus_regions('field') WHERE region = 'hut'), '4 2', 'and comes back');

-- boxes around regions, of outlines and of seeds; where there is none that can be, all pages are read
SELECT is((SELECT string_agg(DISTINCT concat_ws(' ', region, lower, upper), '; ') FROM field_regions), 'fields {1,1} {6,6}; hut {6,6} {8,8}; pond {2,2} {5,4}; wood {6,1} {9,3}', 'boxes');
CREATE FUNCTION pg_temp.counted(box text) RETURNS bigint LANGUAGE plpgsql AS $$
BEGIN
	EXECUTE format($q$UPDATE field_regions SET upper = %L WHERE region = 'wood'$q$, box);
	PERFORM abacus_insert('field', 'VALUES (3000, 0.5, 8.5, 1)'), abacus_delete('field', 'VALUES (3000, 0.5, 8.5, 1)'); -- what is remembered is forgotten
	RETURN (SELECT count(*) FROM abacus_cells('field', within => 'wood'));
END $$;
SELECT is(pg_temp.counted(box), 12::bigint, coalesce(box, 'none')) FROM (VALUES ('{9,3}'), ('{NULL,NULL}'), ('{NaN,3}'), ('{Infinity,3}'), ('{7}'), ('{-7,3}'), (NULL)) AS v (box);
UPDATE field_regions SET upper = '{8,3}' WHERE region = 'wood';
SELECT is((SELECT string_agg(fault || ': ' || message, ' ') FROM abacus_check('field')), 'regions: A region goes beyond its box.', 'a box that is too small');
UPDATE field_regions SET upper = '{9,3}' WHERE region = 'wood';
SELECT is((SELECT count(*) FROM abacus_check('field')), 0::bigint, 'sound');

-- numbers, damage
UPDATE field_regions SET number = number + 70 WHERE region = 'hut';
SELECT is((SELECT string_agg(fault || ': ' || message, ' ') FROM abacus_check('field')), 'regions: Triangles have the number of a region that does not exist.', 'a number that does not fit');
UPDATE field_regions SET number = number - 70 WHERE region = 'hut';

-- ... of whole faces, with numbers and counts that fit
CREATE FUNCTION pg_temp.finds(damage text, region text, why text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
	found text;
BEGIN
	BEGIN
		EXECUTE damage;
		SELECT string_agg(fault || ': ' || message, ' ') INTO found FROM abacus_check('field');
		RAISE EXCEPTION USING ERRCODE = 'ZZ999';
	EXCEPTION WHEN SQLSTATE 'ZZ999' THEN NULL;
	END;
	RETURN is(found, format('regions: Region "%s" does not have the triangles that its outlines or seeds give it.', region), why);
END $$;
SELECT pg_temp.finds($$UPDATE field_regions AS r SET (number, lower, upper) = (SELECT f.number, f.lower, f.upper FROM field_regions AS f
    WHERE f.region = CASE r.region WHEN 'hut' THEN 'wood' ELSE 'hut' END) WHERE region IN ('hut', 'wood')$$, 'hut', 'numbers exchanged');
SELECT pg_temp.finds($$DELETE FROM field_regions WHERE region = 'fields' AND line = 3$$, 'fields', 'an outline lost');
SELECT pg_temp.finds($$UPDATE field_regions SET line = 4 WHERE region = 'hut'$$, 'hut', 'another outline');
SELECT pg_temp.finds($$UPDATE field_regions SET line = 7 WHERE region = 'hut'$$, 'hut', 'one that is not closed');
SELECT pg_temp.finds($$UPDATE field_regions SET y = 4.5 WHERE region = 'pond'$$, 'pond', 'a seed elsewhere');
SELECT pg_temp.finds($$UPDATE field_regions SET y = 100 WHERE region = 'pond'$$, 'pond', 'a seed beyond the hull');
SELECT pg_temp.finds($$INSERT INTO field_regions SELECT region, number, part + 1, line, x, 4.5 FROM field_regions WHERE region = 'pond'$$, 'pond', 'one more seed');
DELETE FROM field_regions WHERE region = 'wood';
SELECT is((SELECT string_agg(fault || ': ' || message, ' ') FROM abacus_check('field')), 'regions: The header counts more or fewer regions than there are.', 'a region that is lost');

-- many
SELECT abacus_triangulate('town', 'SELECT 1000 * x + y, x, y FROM generate_series(0, 60) AS x, generate_series(0, 60) AS y');
SELECT abacus_constrain('town', $$SELECT 100 * x + y, n, 1000 * (3 * x + (ARRAY[0, 2, 2, 0, 0])[n]) + 3 * y + (ARRAY[0, 0, 2, 2, 0])[n] FROM generate_series(0, 19) AS x, generate_series(0, 19) AS y, generate_series(1, 5) AS n$$);
SELECT is(abacus_region('town', 'SELECT ''house '' || n, n FROM (SELECT 100 * x + y AS n FROM generate_series(0, 19) AS x, generate_series(0, 19) AS y) AS s'), 400::bigint, 'four hundred houses');
SELECT is((SELECT count(*) FILTER (WHERE triangles = 8 AND area = 4 AND edges = 8) FROM abacus_regions('town')), 400::bigint, 'each with its triangles');

SELECT * FROM finish();
ROLLBACK;

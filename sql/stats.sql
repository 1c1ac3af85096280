-- The figures of a mesh, the progress view, versions and comments.
SELECT abacus_triangulate('field', 'SELECT i, i % 100, i / 100, sqrt(i) AS height FROM generate_series(0, 9999) i');
SELECT name, value FROM abacus_stats('field')
WHERE name IN ('dimension', 'attributes', 'points', 'inserted', 'vertices', 'duplicates', 'simplices', 'hull_facets', 'insertions') ORDER BY name;
-- Euler: 2 v - 2 - h triangles
SELECT (SELECT value FROM abacus_stats('field') WHERE name = 'simplices') =
       2 * (SELECT value FROM abacus_stats('field') WHERE name = 'vertices') - 2 -
       (SELECT value FROM abacus_stats('field') WHERE name = 'hull_facets') AS euler;
SELECT (SELECT value FROM abacus_stats('field') WHERE name = 'simplex_table_bytes') = pg_table_size('field') AS table_size,
       (SELECT value FROM abacus_stats('field') WHERE name = 'simplex_index_bytes') = pg_indexes_size('field') AS index_size,
       (SELECT value FROM abacus_stats('field') WHERE name = 'vertex_table_bytes') = pg_table_size('field_vertices') AS vertex_table_size,
       (SELECT value FROM abacus_stats('field') WHERE name = 'hit_ratio') BETWEEN 0.9 AND 1 AS hit_ratio,
       (SELECT value FROM abacus_stats('field') WHERE name = 'stores') > 0 AS stores;
-- no statistic without a description, no name twice
SELECT count(*) - count(DISTINCT name) AS twice, count(*) FILTER (WHERE description = '') AS undescribed FROM abacus_stats('field');
-- the session's own reading, once it has read
SELECT count(*) FROM abacus_stats('field') WHERE name LIKE 'session%';
SELECT (abacus_locate('field', 50.5, 50.25)).v0 IS NOT NULL AS located;
SELECT value > 0 AS loaded FROM abacus_stats('field') WHERE name = 'session_loads';

-- progress: nothing runs now; a real CREATE INDEX is not ours
SELECT * FROM abacus_progress;
SELECT attname, format_type(atttypid, NULL) FROM pg_attribute WHERE attrelid = 'abacus_progress'::regclass AND attnum > 0 ORDER BY attnum;
-- during a build the session sees itself
CREATE FUNCTION look() RETURNS float8 LANGUAGE plpgsql AS $$
DECLARE
    p record;
BEGIN
    SELECT * INTO p FROM abacus_progress WHERE pid = pg_backend_pid();
    RAISE NOTICE 'mesh %, elapsed known: %', p.mesh, p.elapsed IS NOT NULL;
    RETURN 0;
END $$;
SELECT abacus_stage('field', 'SELECT 10000, 200, 200, look()');
SELECT count(*) FROM abacus_progress;
-- many places are located; inside another function the progress of that one stays
SELECT id FROM abacus_locate('field', 'SELECT 1, 50, 50 + look()');
SELECT abacus_triangulate('other', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT abacus_stage('other', 'SELECT id, 2, look() FROM abacus_locate(''field'', ''SELECT 1, 50, 50'')');
SELECT count(*) FROM abacus_progress;
DROP TABLE other;
-- and that of COPY, of our rows or into a table that a mesh follows
CREATE FUNCTION copies() RETURNS bigint LANGUAGE sql AS $$ SELECT pg_stat_clear_snapshot(); SELECT count(*) FROM pg_stat_progress_copy WHERE pid = pg_backend_pid() $$;
CREATE FUNCTION check_and_look() RETURNS bigint LANGUAGE plpgsql AS $$ BEGIN PERFORM abacus_check('field'); RETURN copies(); END $$;
COPY (SELECT check_and_look()) TO STDOUT;
CREATE TABLE spots (id bigint PRIMARY KEY, x float8, y float8);
SELECT abacus_create('followed', 2);
SELECT abacus_track('followed', 'spots');
CREATE FUNCTION see_copy() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE NOTICE 'copies that tell: %', copies(); RETURN NULL; END $$;
CREATE TRIGGER zz_last AFTER INSERT ON spots EXECUTE FUNCTION see_copy();
COPY spots FROM STDIN;
1	0	0
2	1	0
3	0	1
\.
SELECT count(*) FROM abacus_simplices('followed');
DROP TABLE spots, followed;

-- pictures
SELECT substr(abacus_draw('field', 64), 1, 8) = '\x89504e470d0a1a0a' AS png;
SELECT substr(abacus_draw('field', 64, 32, '{10,10}', '{20,20}', 'height', false, 2, 5), 1, 8) = '\x89504e470d0a1a0a' AS png;
-- a range of colours: the same in every window; values beyond it get the last colour
SELECT md5(abacus_draw('field', 64, attribute => 'height')) = md5(abacus_draw('field', 64, attribute => 'height', range => ARRAY[low, high])) AS same_picture
FROM (SELECT min(attributes[1]), max(attributes[1]) FROM abacus_vertices('field')) AS t (low, high);
SELECT md5(abacus_draw('field', 64, attribute => 'height')) = md5(abacus_draw('field', 64, attribute => 'height', range => '{0,1e9}')) AS same_picture;
SELECT abacus_draw('field', 64, attribute => 'height', range => '{1e8,1e9}') = abacus_draw('field', 64, attribute => 'height', range => '{1e300,1e308}') AS same_picture;
SELECT abacus_draw('field', 64, attribute => 'height', range => '{2,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, attribute => 'height', range => '{0,Infinity}');
SELECT abacus_draw('field', 64, attribute => 'height', range => '{1,2,3}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, attribute => 'height', range => '{1,NULL}');
-- what has no effect, and blank pictures
SELECT length(abacus_draw('field', 64, range => '{1,2}', exaggeration => 2)) > 0 AS drawn;
SELECT length(abacus_draw('field', 64, lower => '{-9,-9}', upper => '{-8,-8}')) > 0 AS drawn;
SELECT length(abacus_draw('field', 64, max_edge => 1e-9)) > 0 AS drawn;
SELECT abacus_create('blank', 2);
SELECT length(abacus_draw('blank', 64)) > 0 AS drawn;
SELECT abacus_stage('blank', 'VALUES (1, 0, 0), (2, 1, 1)');
SELECT length(abacus_draw('blank', 64)) > 0 AS drawn;
DROP TABLE blank;
-- a long mesh is no line, and no tower of pixels
SELECT abacus_triangulate('long', 'SELECT i, i * 1000, i % 2 FROM generate_series(0, 99) i'),
       abacus_triangulate('tall', 'SELECT i, i % 2, i * 1000 FROM generate_series(0, 99) i');
SELECT get_byte(png, 22) * 256 + get_byte(png, 23) AS height FROM abacus_draw('long', 800) AS png
UNION ALL SELECT get_byte(png, 22) * 256 + get_byte(png, 23) FROM abacus_draw('tall', 800) AS png ORDER BY height;
DROP TABLE long, tall;
SELECT abacus_draw('field', attribute => 'depth');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, 100000);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, lower => '{0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, lower => '{0,0}', upper => '{0,0}');
SELECT abacus_draw('field', 64, exaggeration => -1);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('field', 64, max_edge => 'NaN');

SELECT abacus_version() = extversion AS same_version FROM pg_extension WHERE extname = 'abacus';
SHOW abacus.cache_size;
\set VERBOSITY sqlstate
SET abacus.cache_size = 0;
\set VERBOSITY default
-- every object of the extension has a comment; types that PostgreSQL makes by itself need none
SELECT pg_describe_object(classid, objid, 0)
FROM pg_depend AS d
WHERE refclassid = 'pg_extension'::regclass AND refobjid = (SELECT oid FROM pg_extension WHERE extname = 'abacus')
  AND deptype = 'e' AND classid <> 'pg_rewrite'::regclass
  AND obj_description(objid, classid::regclass::name) IS NULL
  AND NOT EXISTS (SELECT FROM pg_depend AS i WHERE i.classid = d.classid AND i.objid = d.objid AND i.deptype = 'i')
ORDER BY 1;

-- the extension moves to another schema, and works under any search_path
CREATE SCHEMA elsewhere;
ALTER EXTENSION abacus SET SCHEMA elsewhere;
SET search_path = pg_catalog;
SELECT elsewhere.abacus_triangulate('public.moved', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT (elsewhere.abacus_locate('public.moved', 0.2, 0.2)).v0 IS NOT NULL AS located;
SELECT count(*) FROM elsewhere.abacus_progress;
RESET search_path;
ALTER EXTENSION abacus SET SCHEMA public;
DROP SCHEMA elsewhere;

DROP FUNCTION look;
DROP TABLE field, moved;

-- The domain of a mesh: where its points are, whatever lies far away.
SET abacus.cache_size = '4MB';
CREATE VIEW metres AS SELECT i, 500000 + (i * 0.7548776662466927) % 1 * 1000 AS x,
    5400000 + (i * 0.5698402909980532) % 1 * 1000 AS y FROM generate_series(1, 20000) AS i;
CREATE FUNCTION crowded(mesh regclass) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
    n bigint;
BEGIN
    EXECUTE format('SELECT count(*) FROM %s WHERE part <> 0', mesh) INTO n;
    RETURN n;
END $$;

-- one garbage coordinate among them: no page shares its code with another one
SELECT abacus_triangulate('garbage', 'SELECT * FROM metres UNION ALL SELECT 0, -3.4028234663852886e38, -3.4028234663852886e38');
SELECT crowded('garbage');
SELECT name, value FROM abacus_stats('garbage') WHERE name IN ('vertices', 'outside');
SELECT * FROM abacus_check('garbage');
SELECT count(n.code) FROM metres, abacus_locate('garbage', x, y) AS l, abacus_walk('garbage', l, 0) AS n WHERE i % 100 = 0;
SELECT (abacus_locate('garbage', -3.4028234663852886e38, -3.4028234663852886e38)).v0;
-- staged as well
SELECT abacus_create('staged', 2);
SELECT abacus_stage('staged', 'SELECT 0, 1e300, 0 UNION ALL SELECT * FROM metres');
SELECT abacus_triangulate('staged');
SELECT crowded('staged');
-- and loaded
SELECT abacus_load('loaded', 'SELECT id, x, y FROM abacus_vertices(''garbage'')', 'SELECT v0, v1, v2 FROM abacus_simplices(''garbage'')');
SELECT crowded('loaded');
SELECT count(*) FROM (SELECT v0, v1, v2 FROM abacus_simplices('garbage') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('loaded')) AS lost;

-- a given domain that does not fit: pages of one code; walks know where to look
SELECT abacus_triangulate('vast', 'SELECT * FROM metres', lower => '{-1e30,-1e30}', upper => '{1e30,1e30}');
SELECT crowded('vast') > 50 AS crowded;
SELECT count(n.code) FROM metres, abacus_locate('vast', x, y) AS l, abacus_walk('vast', l, 0) AS n WHERE i % 100 = 0;
SELECT count(*) FROM abacus_stats('vast') WHERE name = 'outside';
CALL abacus_build('vast');
SELECT crowded('vast');
SELECT count(*) FROM abacus_stats('vast') WHERE name = 'outside';
SELECT * FROM abacus_check('vast');
SELECT count(*) FROM (SELECT v0, v1, v2 FROM abacus_simplices('vast') EXCEPT SELECT v0, v1, v2 FROM abacus_simplices('staged')) AS other;
CALL abacus_build('vast');

-- a mesh that began with the garbage recovers while it grows
SELECT abacus_triangulate('begun', 'VALUES (0, -3.4e38, -3.4e38), (-1, 500000, 5400000), (-2, 500500, 5400100)');
SELECT count(abacus_insert('begun', format('SELECT * FROM metres WHERE i BETWEEN %s AND %s', b * 4 - 3, b * 4))) FROM generate_series(1, 250) AS b;
SELECT crowded('begun');
SELECT * FROM abacus_check('begun');
DROP TABLE garbage, staged, loaded, vast, begun CASCADE;
DROP FUNCTION crowded;
DROP VIEW metres;

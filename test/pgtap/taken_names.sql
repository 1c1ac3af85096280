-- Tables with the names and types of those that belong to a mesh, but made by another role, or left by an earlier mesh: no part of it.
BEGIN;
SELECT no_plan();
SET LOCAL client_min_messages = warning;

CREATE ROLE pgtap_names_owner;
CREATE ROLE pgtap_names_other;
CREATE SCHEMA held;
GRANT CREATE, USAGE ON SCHEMA held TO pgtap_names_owner, pgtap_names_other;
CREATE TABLE held.point AS SELECT (25 * x + y)::bigint AS id, x::float8, y::float8, (x * y)::float8 AS h FROM generate_series(0, 24) AS x, generate_series(0, 24) AS y;
GRANT SELECT ON held.point TO pgtap_names_owner;
CREATE TABLE ran AS SELECT current_user AS as_user LIMIT 0;
GRANT INSERT ON ran TO PUBLIC;

-- prepared by a role that may make tables in the schema, with triggers
SET ROLE pgtap_names_owner;
SELECT abacus_triangulate('held.field', 'TABLE held.point');
SELECT abacus_triangulate('held.lined', 'TABLE held.point');
SELECT abacus_constrain('held.lined', 'VALUES (1, 1, 51), (1, 2, 451), (1, 3, 467), (1, 4, 67), (1, 5, 51)');
SET ROLE pgtap_names_other;
CREATE FUNCTION held.tell() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN INSERT INTO ran VALUES (current_user); RETURN new; END $$;
CREATE TABLE held.field_lines OF abacus_line_point;
CREATE TABLE held.lined_regions OF abacus_region_part;
CREATE TABLE held.lined_level_1_lines OF abacus_line_point;
CREATE TABLE held.thin_lines OF abacus_line_point;
CREATE TABLE held.field_steps OF abacus_step_values PARTITION BY LIST (step);
CREATE TABLE held.field_levels OF abacus_level;
CREATE FUNCTION held.arm(name regclass) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
	EXECUTE format('CREATE TRIGGER told BEFORE INSERT ON %s FOR EACH ROW EXECUTE FUNCTION held.tell()', name);
	EXECUTE format('GRANT ALL ON %s TO PUBLIC', name);
END $$;
SELECT held.arm(c.oid::regclass) FROM pg_class AS c WHERE relnamespace = 'held'::regnamespace AND relowner = 'pgtap_names_other'::regrole AND relkind IN ('r', 'p');
RESET ROLE;
CREATE TABLE change AS SELECT * FROM (VALUES
	($$SELECT abacus_constrain('held.field', 'VALUES (1, 1, 51), (1, 2, 451)')$$), ($$SELECT abacus_region('held.lined', 'VALUES (''farm'', 1)')$$),
	($$SELECT * FROM abacus_levels('held.lined', '{3}')$$), ($$SELECT abacus_thin('held.lined', 'held.thin', 3)$$), ($$SELECT * FROM abacus_levels('held.field', '{3}')$$),
	($$SELECT abacus_store('held.field', 1, 1, 0, 'SELECT id, x FROM abacus_share_vertices(''held.field'', 1, 0, 0)')$$)) AS c (sql);
GRANT SELECT ON change TO pgtap_names_owner;
SELECT throws_ok(sql, '42P07', NULL, 'a superuser: ' || sql) FROM change;
SET ROLE pgtap_names_owner;
SELECT throws_ok(sql, '42P07', NULL, 'the owner: ' || sql) FROM change;
SELECT is_empty($$SELECT * FROM abacus_lines('held.field')$$, 'nor are their rows read');
RESET ROLE;
SELECT is_empty('TABLE ran', 'no trigger has run');
DROP TABLE held.field_lines, held.lined_regions, held.lined_level_1_lines, held.thin_lines, held.field_steps, held.field_levels;
SET ROLE pgtap_names_owner;
SELECT lives_ok(sql, 'without them: ' || sql) FROM change;

-- left by an earlier mesh of the same owner, of which a restored one has lost the tables: only their names connected them
SELECT abacus_triangulate('held.bay', 'TABLE held.point');
SELECT abacus_constrain('held.bay', 'VALUES (1, 1, 51), (1, 2, 451), (1, 3, 467), (1, 4, 67), (1, 5, 51)');
SELECT abacus_region('held.bay', $$VALUES ('farm', 1)$$);
SELECT abacus_levels('held.bay', '{3}');
SELECT abacus_store('held.bay', 1, 1, 0, $$SELECT id, x FROM abacus_share_vertices('held.bay', 1, 0, 0)$$);
RESET ROLE;
CREATE FUNCTION pg_temp.forget(mesh regclass) RETURNS void LANGUAGE sql AS $$
	DELETE FROM pg_depend WHERE classid = 'pg_class'::regclass AND refclassid = 'pg_class'::regclass AND refobjid = mesh AND deptype = 'a' $$;
CREATE FUNCTION pg_temp.parts(mesh regclass) RETURNS text LANGUAGE sql AS $$
	SELECT string_agg(objid::regclass::text, ' ' ORDER BY objid::regclass::text) FROM pg_depend
	WHERE classid = 'pg_class'::regclass AND refclassid = 'pg_class'::regclass AND refobjid = mesh AND deptype = 'a' $$;
SELECT pg_temp.parts('held.bay') AS parts \gset
SELECT pg_temp.forget('held.bay');
SELECT results_eq($$SELECT region, triangles > 0 FROM abacus_regions('held.bay')$$, $$VALUES ('farm', true)$$, 'restored: the tables are found by their names');
SET ROLE pgtap_names_owner;
SELECT abacus_set_srid('held.bay', abacus_srid('held.bay'));
RESET ROLE;
SELECT is(pg_temp.parts('held.bay'), :'parts', 'setting the SRID it has binds all tables');
SELECT is_empty($$SELECT * FROM abacus_check('held.bay')$$, 'which are sound');
SELECT pg_temp.forget('held.bay');
SET ROLE pgtap_names_owner;
DROP TABLE held.bay, held.bay_vertices;
SELECT abacus_triangulate('held.bay', 'VALUES (1, 0, 0, 1), (2, 10, 0, 2), (3, 10, 10, 3), (4, 0, 10, 4), (5, 5, 5.5, 5)', '{h}');
SELECT is_empty($$SELECT * FROM abacus_lines('held.bay')$$, 'a new mesh has no line of an earlier one');
SELECT is_empty($$SELECT * FROM abacus_regions('held.bay')$$, 'nor a region');
SELECT is_empty($$SELECT * FROM abacus_steps('held.bay')$$, 'nor a step');
SELECT throws_ok($$SELECT abacus_level('held.bay', 10)$$, '55000', NULL, 'nor a level');
SELECT throws_ok($$SELECT abacus_constrain('held.bay', 'VALUES (7, 1, 1), (7, 2, 5)')$$, '42P07', NULL, 'nor does it take the tables');
SELECT is_empty($$SELECT * FROM abacus_check('held.bay')$$, 'it is sound');
RESET ROLE;

-- operators of others, which the caller's search_path finds before those of PostgreSQL that take other types
CREATE FUNCTION held.seize(oid, integer) RETURNS boolean LANGUAGE plpgsql AS $$ BEGIN INSERT INTO ran VALUES (current_user); RETURN $1 OPERATOR(pg_catalog.=) $2; END $$;
CREATE FUNCTION held.seize(text, text) RETURNS boolean LANGUAGE plpgsql AS $$ BEGIN INSERT INTO ran VALUES (current_user); RETURN $1 OPERATOR(pg_catalog.=) $2; END $$;
CREATE OPERATOR held.= (LEFTARG = oid, RIGHTARG = integer, FUNCTION = held.seize);
CREATE OPERATOR held.= (LEFTARG = text, RIGHTARG = text, FUNCTION = held.seize);
SELECT set_config('search_path', 'held, pg_catalog, ' || current_setting('search_path'), true);
SELECT abacus_level('held.lined', 10), count(*) FROM abacus_contours('held.lined', 1, max_error => 10);
SELECT abacus_tiles('held.lined', world => '{0,0,40}', attribute => 'h');
SELECT abacus_levels_refresh('held.lined');
RESET search_path;
SELECT is_empty('TABLE ran', 'operators of others are not called');

-- an octree
SELECT abacus_octree_create('held.tree', 2, '{0,0}', '{1,1}', '{v}');
SELECT pg_temp.forget('held.tree');
SELECT abacus_set_srid('held.tree', abacus_srid('held.tree'));
SELECT is(pg_temp.parts('held.tree'), 'held.tree_vertices', 'an octree is bound in the same way');

-- a table of lines of a restored mesh that has another owner
SELECT pg_temp.forget('held.lined');
ALTER TABLE held.lined_lines OWNER TO pgtap_names_other;
SELECT throws_ok($$SELECT * FROM abacus_lines('held.lined')$$, '42P01', NULL, 'a restored table of another owner is not the mesh''s');
SELECT abacus_set_srid('held.lined', abacus_srid('held.lined'));
ALTER TABLE held.lined_lines OWNER TO pgtap_names_owner;
SELECT is(count(*), 5::bigint, 'of the same owner it is, also after a change') FROM abacus_lines('held.lined');
SELECT abacus_set_srid('held.lined', abacus_srid('held.lined'));
SELECT is(pg_temp.parts('held.lined'), 'held.lined_level_1 held.lined_levels held.lined_lines held.lined_regions held.lined_vertices', 'then all are bound');

-- tables that were restored alone, beside a mesh that has its others
SET ROLE pgtap_names_owner;
SELECT abacus_store('held.lined', 1, 1, 0, $$SELECT id, x FROM abacus_share_vertices('held.lined', 1, 0, 0)$$);
RESET ROLE;
SELECT pg_temp.parts('held.lined') AS parts \gset
DELETE FROM pg_depend WHERE classid = 'pg_class'::regclass AND refobjid = 'held.lined'::regclass AND deptype = 'a'
	AND objid IN ('held.lined_lines'::regclass, 'held.lined_regions'::regclass, 'held.lined_steps'::regclass, 'held.lined_levels'::regclass);
SET ROLE pgtap_names_owner;
SELECT throws_ok($$SELECT * FROM abacus_lines('held.lined')$$, '42P01', NULL, 'a table that was restored alone is not found by its name');
SELECT throws_ok($$SELECT abacus_constrain('held.lined', 'VALUES (2, 1, 1), (2, 2, 5)')$$, '42P01', NULL, 'lines are not added beside those that are missing');
SELECT throws_ok($$SELECT abacus_level('held.lined', 10)$$, '55000', NULL, 'nor are levels');
SELECT throws_ok($$SELECT abacus_levels('held.lined', '{9}')$$, '42P07', NULL, 'others are not made beside them');
SELECT is_empty($$SELECT * FROM abacus_steps('held.lined')$$, 'nor are steps');
SELECT abacus_set_srid('held.lined', abacus_srid('held.lined'));
RESET ROLE;
SELECT is(pg_temp.parts('held.lined'), :'parts', 'setting the SRID that the mesh has binds them again');
SET ROLE pgtap_names_owner;
SELECT is(count(*), 5::bigint, 'their lines are there') FROM abacus_lines('held.lined');
SELECT is(abacus_level('held.lined', 10), 'held.lined_level_1'::regclass, 'their level is');
SELECT results_eq($$SELECT step FROM abacus_steps('held.lined')$$, 'VALUES (1::bigint)', 'their step is');
SELECT is_empty($$SELECT * FROM abacus_check('held.lined')$$, 'the mesh is sound');
GRANT SELECT, INSERT, UPDATE, DELETE ON held.lined, held.lined_vertices TO pgtap_names_other;
SET ROLE pgtap_names_other;
SELECT lives_ok($$SELECT abacus_set_srid('held.lined', abacus_srid('held.lined'))$$, 'who may change the mesh alone still sets its SRID');
SET ROLE pgtap_names_owner;
DROP TABLE held.lined_regions;
SELECT throws_ok($$SELECT abacus_region('held.lined', 'VALUES (''yard'', 1)')$$, '42P01', NULL, 'regions are not added to those that were dropped');
CREATE TABLE held.line AS SELECT 2::bigint AS line, 1 AS position, 1::bigint AS point;
DROP TABLE held.lined_lines;
SELECT throws_ok($$SELECT abacus_track_lines('held.lined', 'held.line')$$, '42P01', NULL, 'lines that were dropped do not follow a table');
SELECT throws_ok($$SELECT abacus_constrain('held.lined', 'VALUES (2, 1, 1), (2, 2, 5)')$$, '42P01', NULL, 'lines are not added to those that were dropped');
SELECT throws_ok($$SELECT abacus_unconstrain('held.lined', 'VALUES (1)')$$, '42P01', NULL, 'nor taken from them');

-- what an earlier mesh has left is not adopted for lines that the mesh does not have
CREATE TABLE held.field_regions OF abacus_region_part;
SELECT abacus_set_srid('held.field', abacus_srid('held.field'));
SELECT is_empty($$SELECT * FROM abacus_regions('held.field')$$, 'a mesh without regions takes no table of regions');
RESET ROLE;
SELECT unalike(pg_temp.parts('held.field'), '%regions%', 'nor is it bound');

-- the vertex table of a level, made by another role
SELECT pg_temp.forget('held.field_level_1');
ALTER TABLE held.field_level_1_vertices OWNER TO pgtap_names_other;
SET ROLE pgtap_names_other;
CREATE TRIGGER told BEFORE INSERT OR DELETE ON held.field_level_1_vertices FOR EACH STATEMENT EXECUTE FUNCTION held.tell();
GRANT ALL ON held.field_level_1_vertices TO PUBLIC;
RESET ROLE;
SELECT throws_ok($$SELECT abacus_levels_refresh('held.field')$$, '42P01', NULL, 'a vertex table of another owner is not taken');
ALTER TABLE held.field_level_1_vertices OWNER TO pgtap_names_owner;
ALTER TABLE held.field_level_1 OWNER TO pgtap_names_other;
SELECT throws_ok($$SELECT abacus_levels_refresh('held.field')$$, '42501', NULL, 'nor a level of another owner');
SELECT is_empty('TABLE ran', 'no trigger of another has run');

SELECT * FROM finish();
ROLLBACK;

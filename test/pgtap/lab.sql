-- The extension abacus_lab: its functions, its requirements and the functions that it takes over; odd
-- arguments.
BEGIN;
SELECT no_plan();
CREATE EXTENSION abacus_lab;

CREATE TEMP TABLE wanted (name text, arguments text, result text, volatility "char", strict boolean, parallel "char");
INSERT INTO wanted VALUES
    ('abacus_quake', 'frequency double precision, points_per_wavelength double precision DEFAULT 8, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT vs double precision, OUT vp double precision, OUT density double precision', 'SETOF record', 'i', true, 's'),
    ('abacus_goose', 'mesh text, query text, dimension integer DEFAULT 2, OUT name text, OUT value double precision, OUT description text', 'SETOF record', 'v', false, 'u');
CREATE TEMP VIEW member AS
SELECT p.* FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.classid = 'pg_proc'::regclass AND d.deptype = 'e'
     JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'abacus_lab';
SELECT set_eq(
    $$ SELECT proname::text COLLATE "default", pg_get_function_arguments(oid), pg_get_function_result(oid), provolatile, proisstrict, proparallel
       FROM member $$,
    'TABLE wanted', 'signatures and marks');
SELECT is_empty('SELECT proname FROM member WHERE prosecdef OR obj_description(oid) IS NULL', 'with comments, and with the caller''s rights');
SELECT is((SELECT count(*) FROM pg_depend d JOIN pg_extension e ON e.oid = d.refobjid WHERE e.extname = 'abacus_lab'), 2::bigint, 'nothing else');
SELECT is(lab.extversion, abacus.extversion, 'one version, as one module') FROM pg_extension lab, pg_extension abacus
WHERE lab.extname = 'abacus_lab' AND abacus.extname = 'abacus';
SELECT throws_ok('DROP EXTENSION abacus', '2BP01', NULL, 'it needs abacus');

-- if a function with the name already exists
DROP EXTENSION abacus_lab;
CREATE FUNCTION mine(frequency float8, points_per_wavelength float8 DEFAULT 8,
                     OUT id bigint, OUT x float8, OUT y float8, OUT z float8, OUT vs float8, OUT vp float8, OUT density float8)
RETURNS SETOF record AS '$libdir/abacus', 'abacus_sql_quake' LANGUAGE c IMMUTABLE STRICT PARALLEL SAFE;
ALTER FUNCTION mine RENAME TO abacus_quake;
CREATE VIEW looks AS SELECT * FROM abacus_quake(1e-6, 1);
CREATE EXTENSION abacus_lab;
SELECT is((SELECT prorows FROM member WHERE proname = 'abacus_quake'), 1000000::real, 'what 0.1.0 left is taken up, and made anew');
SELECT is((SELECT count(*) FROM looks), 324::bigint, 'a view goes on');
SELECT throws_ok('DROP EXTENSION abacus_lab', '2BP01', NULL, 'and is not lost by accident');
DROP VIEW looks;
DROP EXTENSION abacus_lab;
SELECT hasnt_function('abacus_quake', 'a member from then on');

CREATE ROLE abacus_lab_owner;
CREATE FUNCTION abacus_quake(frequency float8, points_per_wavelength float8,
                             OUT id bigint, OUT x float8, OUT y float8, OUT z float8, OUT vs float8, OUT vp float8, OUT density float8)
RETURNS SETOF record AS '$libdir/abacus', 'abacus_sql_quake' LANGUAGE c;
ALTER FUNCTION abacus_quake OWNER TO abacus_lab_owner;
SELECT throws_ok('CREATE EXTENSION abacus_lab', '55000', NULL, 'whose owner could replace it, is not taken up');
DROP FUNCTION abacus_quake;
CREATE FUNCTION abacus_quake(frequency float8, points_per_wavelength float8,
                             OUT id bigint, OUT x float8, OUT y float8, OUT z float8, OUT vs float8, OUT vp float8, OUT density float8)
RETURNS SETOF record AS 'SELECT 1, 2, 3, 4, 5, 6, 7' LANGUAGE sql;
SELECT throws_ok('CREATE EXTENSION abacus_lab', '55000', NULL, 'nor is what only has its name');
DROP FUNCTION abacus_quake;
CREATE EXTENSION abacus_lab;

CREATE FUNCTION pg_temp.state(command text) RETURNS text LANGUAGE plpgsql AS $$
BEGIN
    EXECUTE command;
    RETURN '00000';
EXCEPTION WHEN OTHERS THEN
    RETURN SQLSTATE;
END $$;
-- points of earthquake sets
SELECT is_empty('SELECT * FROM abacus_quake(NULL)', 'quake of NULL');
SELECT is_empty('SELECT * FROM abacus_quake(0.1, NULL)', 'quake with NULL points per wavelength');
SELECT is(pg_temp.state(format('SELECT abacus_quake(%s)', a)), '22023', 'quake of ' || a)
FROM (VALUES ('0'), ('-0.1'), ('''NaN'''), ('''Infinity'''), ('''-Infinity'''), ('263'), ('1e308'),
             ('1, 0'), ('1, -8'), ('1, ''NaN'''), ('1, ''Infinity'''), ('1e308, 1e308')) AS a (a);
SELECT is(pg_temp.state('SELECT abacus_quake(262) LIMIT 1'), '00000', 'quake of the highest frequency');
SELECT is((SELECT count(*) FROM abacus_quake(f, p)), 324::bigint, format('quake of %s Hz with %s points', f, p))
FROM (VALUES (5e-324, 8), (1e-300, 1e-300), (1e-6, 1), (1e305, 1e-308), (1e-308, 1e305), (1.7e308, 5e-324)) AS a (f, p);

SELECT * FROM finish();
ROLLBACK;

-- Points of the earthquake data sets.

-- Up to 0.1.0 the function was a part of the extension abacus, whose update leaves it where views
-- and the like depend on it. It is taken up: CREATE OR REPLACE is allowed for members only. What
-- others than superusers own they could replace, so that is refused there, as is what is no function
-- of the module.
DO $$
DECLARE
    signature text := format('%I.abacus_quake(double precision, double precision)', current_schema());
BEGIN
    IF EXISTS (SELECT FROM pg_proc AS p JOIN pg_roles AS r ON r.oid = proowner JOIN pg_language AS l ON l.oid = prolang
               WHERE p.oid = to_regprocedure(signature) AND rolsuper AND lanname = 'c' AND prosrc = 'abacus_sql_quake'
                   AND NOT EXISTS (SELECT FROM pg_depend WHERE classid = 'pg_proc'::regclass AND objid = p.oid AND deptype = 'e')) THEN
        EXECUTE 'ALTER EXTENSION abacus_lab ADD FUNCTION ' || signature;
    END IF;
END $$;

CREATE OR REPLACE FUNCTION abacus_quake(
    frequency double precision,
    points_per_wavelength double precision DEFAULT 8,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT vs double precision,
    OUT vp double precision,
    OUT density double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_quake'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE ROWS 1000000;
COMMENT ON FUNCTION abacus_quake(double precision, double precision) IS
    'the corners of an octree over a sedimentary basin that resolves seismic waves of a frequency, with the ground there. The basin is 100 km x 100 km x 37.5 km. Rows come in Z-order; in a select list they stream. Units: frequency in Hz; x, y, z in m; vs and vp in m/s; density in kg/m3. Errors: 22023 a frequency or a number of points that is not above 0 and finite';

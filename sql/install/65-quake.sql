-- Points of the earthquake data sets.

CREATE FUNCTION abacus_quake(
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
    'corners of an octree over a basin of 100 km x 100 km x 37.5 km that resolves seismic waves of a frequency (Hz), in Z-order, with the ground there (m, m/s, kg/m3); in a select list they stream';

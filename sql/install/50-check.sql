-- Verifying a mesh and its figures.

CREATE FUNCTION abacus_check(
    mesh regclass,
    max_faults integer DEFAULT 1000,
    OUT fault text,
    OUT code bigint,
    OUT part bigint,
    OUT message text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_check'
LANGUAGE C STABLE PARALLEL SAFE ROWS 1;
COMMENT ON FUNCTION abacus_check(regclass, integer) IS
    'verifies the mesh exactly and returns its faults: no row if it is sound; a notice tells how many simplices are flat in doubles';

CREATE FUNCTION abacus_stats(
    mesh regclass,
    OUT name text,
    OUT value double precision,
    OUT description text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_stats'
LANGUAGE C VOLATILE STRICT PARALLEL RESTRICTED ROWS 40;
COMMENT ON FUNCTION abacus_stats(regclass) IS
    'counts, sizes and counters of a mesh; session_... are those of this session''s own reading';

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
    'verifies a mesh or an octree exactly and returns its faults. No row if it is sound. A notice says how many simplices are flat in doubles. Errors: 42809 neither a mesh nor an octree, 22004 max_faults NULL; faults are rows';

CREATE FUNCTION abacus_stats(
    mesh regclass,
    OUT name text,
    OUT value double precision,
    OUT description text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_stats'
LANGUAGE C VOLATILE STRICT PARALLEL RESTRICTED ROWS 40;
COMMENT ON FUNCTION abacus_stats(regclass) IS
    'counts, sizes and counters of a mesh or an octree. Names with session_ are those of this session''s own reading. Units: counts, bytes and nanoseconds, as the names say. Errors: 42809 neither a mesh nor an octree';

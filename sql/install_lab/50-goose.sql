-- The dissertation's chapter 2, to compare with.

CREATE FUNCTION abacus_goose(
    mesh text,
    query text,
    dimension integer DEFAULT 2,
    OUT name text,
    OUT value double precision,
    OUT description text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_goose'
LANGUAGE C VOLATILE PARALLEL UNSAFE ROWS 25;
COMMENT ON FUNCTION abacus_goose(text, text, integer) IS
    'for comparison: triangulates the points of a query by searching an R-tree. The result is a table of one row a simplex. Returns what that cost. Shapes: the query returns id, x, y[, z]. Units: counts, bytes and nanoseconds, as the names say. Errors: those of abacus_create and abacus_stage';

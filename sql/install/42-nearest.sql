-- The vertices nearest to a place.

CREATE FUNCTION abacus_nearest_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_nearest_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_nearest_rows(internal) IS 'planner support of abacus_nearest';

CREATE FUNCTION abacus_nearest(
    mesh regclass,
    x double precision,
    y double precision,
    k integer DEFAULT 1,
    OUT vertex bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_nearest'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1 SUPPORT abacus_nearest_rows;
COMMENT ON FUNCTION abacus_nearest(regclass, double precision, double precision, integer) IS
    'the k vertices nearest to a place in the plane, nearest first. Shapes: attributes in the order of the mesh. Units: the place and distance in those of the coordinates. Errors: 22023 k below 1, a coordinate that is not finite, z missing or given in the plane';

CREATE FUNCTION abacus_nearest(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    k integer DEFAULT 1,
    OUT vertex bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_nearest'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1 SUPPORT abacus_nearest_rows;
COMMENT ON FUNCTION abacus_nearest(regclass, double precision, double precision, double precision, integer) IS
    'the k vertices nearest to a place in space, nearest first. Shapes: attributes in the order of the mesh. Units: the place and distance in those of the coordinates. Errors: 22023 k below 1, a coordinate that is not finite, z missing or given in the plane';

CREATE FUNCTION abacus_nearest(
    mesh regclass,
    query text,
    k integer DEFAULT 1,
    OUT id bigint,
    OUT rank bigint,
    OUT vertex bigint,
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_nearest_places'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_nearest(regclass, text, integer) IS
    'the k vertices nearest to each place of a query. Shapes: the query returns id, x, y[, z], or id and a point of PostGIS. Units: distance in those of the coordinates. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite, 22023 k below 1';

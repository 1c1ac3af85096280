-- Values of attributes between the vertices.

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_interpolate(regclass, double precision, double precision, text, text, text, double precision) IS
    'the value of an attribute at a place in a mesh of dimension 2, by the method linear, natural or nearest; NULL outside the mesh, unless outside is nearest, and where a value is missing';

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_interpolate(regclass, double precision, double precision, double precision, text, text, text, double precision) IS
    'the value of an attribute at a place in a mesh of dimension 3, by the method linear, natural or nearest; NULL outside the mesh, unless outside is nearest, and where a value is missing';

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    query text,
    attributes text[] DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_interpolate(regclass, text, text[], text, text, double precision) IS
    'the values of attributes at the places of a query (id, x, y[, z]), as abacus_interpolate of each place finds them';

-- In quotes the attributes could be a coordinate, and PostgreSQL would call that ambiguous. Where there is a form
-- with a text it takes that.
CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    query text,
    attributes text,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_interpolate(regclass, text, text, text, text, double precision) IS
    'the same with the attributes as text, or the name of one';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    x double precision,
    y double precision,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights'
LANGUAGE C STABLE PARALLEL SAFE COST 500 ROWS 3;
COMMENT ON FUNCTION abacus_weights(regclass, double precision, double precision, text, text, double precision) IS
    'the vertices that abacus_interpolate takes the value at a place of a mesh of dimension 2 from, and their weights, which sum to 1';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights'
LANGUAGE C STABLE PARALLEL SAFE COST 500 ROWS 4;
COMMENT ON FUNCTION abacus_weights(regclass, double precision, double precision, double precision, text, text, double precision) IS
    'the vertices that abacus_interpolate takes the value at a place of a mesh of dimension 3 from, and their weights, which sum to 1';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    query text,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    OUT id bigint,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 300000;
COMMENT ON FUNCTION abacus_weights(regclass, text, text, text, double precision) IS
    'the vertices, with their weights, that abacus_interpolate takes the values at the places of a query (id, x, y[, z]) from';

CREATE FUNCTION abacus_gradient(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_gradient'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_gradient(regclass, double precision, double precision, text, double precision) IS
    'the gradient of an attribute in the triangle around a place, exact and rounded once; NULL outside the mesh and where a value is missing';

CREATE FUNCTION abacus_gradient(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_gradient'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_gradient(regclass, double precision, double precision, double precision, text, double precision) IS
    'the gradient of an attribute in the tetrahedron around a place, exact and rounded once; NULL outside the mesh and where a value is missing';

CREATE FUNCTION abacus_slope(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT slope double precision,
    OUT aspect double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_slope'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_slope(regclass, double precision, double precision, text, double precision) IS
    'how steep an attribute is in the triangle around a place, and where it goes down, in degrees; aspect is clockwise from north, NULL where it is level';

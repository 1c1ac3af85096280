-- Values of attributes between the vertices.

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_interpolate(regclass, double precision, double precision, text, text, text, double precision, text, bigint) IS
    'the value of an attribute at a place in the plane. The method is linear, natural or nearest. NULL outside the mesh, unless outside is nearest, and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Units: the place and max_edge in those of the coordinates, the value in those of the attribute. Errors: 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 22023 an unknown method, a bad max_edge, z missing or too many, a NaN; 55000 natural in a mesh that is not Delaunay; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_interpolate(regclass, double precision, double precision, double precision, text, text, text, double precision, text, bigint) IS
    'the value of an attribute at a place in space. The method is linear, natural or nearest. NULL outside the mesh, unless outside is nearest, and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Units: the place and max_edge in those of the coordinates, the value in those of the attribute. Errors: 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 22023 an unknown method, a bad max_edge, z missing or too many, a NaN; 55000 natural in a mesh that is not Delaunay; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    query text,
    attributes text[] DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    step bigint DEFAULT NULL,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_interpolate(regclass, text, text[], text, text, double precision, text, bigint) IS
    'the values of attributes at the places of a query. They are those of abacus_interpolate at each place. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: the query returns id, x, y[, z], or id and a point of PostGIS; "values" has a value or NULL for each of attributes. Units: max_edge in those of the coordinates, "values" in those of the attributes. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region; 42704 no such step, 55000 one that is not whole';

-- In quotes the attributes could be a coordinate, and PostgreSQL would call that ambiguous. Where there is a form
-- with a text it takes that.
CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    query text,
    attributes text,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    step bigint DEFAULT NULL,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_interpolate(regclass, text, text, text, text, double precision, text, bigint) IS
    'the same with the attributes as text, or the name of one';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    x double precision,
    y double precision,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights'
LANGUAGE C STABLE PARALLEL SAFE COST 500 ROWS 3;
COMMENT ON FUNCTION abacus_weights(regclass, double precision, double precision, text, text, double precision, text) IS
    'the vertices that the value at a place in the plane comes from, and their weights. The weights sum to 1. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: the place and max_edge in those of the coordinates, weights are shares of 1. Errors: 22023 as abacus_interpolate; 55000 natural in a mesh that is not Delaunay; 42704 no such region';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights'
LANGUAGE C STABLE PARALLEL SAFE COST 500 ROWS 4;
COMMENT ON FUNCTION abacus_weights(regclass, double precision, double precision, double precision, text, text, double precision, text) IS
    'the vertices that the value at a place in space comes from, and their weights. The weights sum to 1. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: the place and max_edge in those of the coordinates, weights are shares of 1. Errors: 22023 as abacus_interpolate; 55000 natural in a mesh that is not Delaunay; 42704 no such region';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    query text,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT id bigint,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 300000;
COMMENT ON FUNCTION abacus_weights(regclass, text, text, text, double precision, text) IS
    'the vertices that the values at the places of a query come from, and their weights. The weights of a place sum to 1. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: the query returns id, x, y[, z], or id and a point of PostGIS. Units: max_edge in those of the coordinates, weights are shares of 1. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite; 55000 natural in a mesh that is not Delaunay; 42704 no such region';

CREATE FUNCTION abacus_gradient(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_gradient'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_gradient(regclass, double precision, double precision, text, double precision, text) IS
    'the derivatives of an attribute in the triangle around a place. They are exact and rounded once. NULL outside the mesh and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: a derivative for each axis. Units: the place and max_edge in those of the coordinates, derivatives in those of the attribute by those of the coordinates. Errors: 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 22023 as abacus_interpolate; 42704 no such region';

CREATE FUNCTION abacus_gradient(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_gradient'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_gradient(regclass, double precision, double precision, double precision, text, double precision, text) IS
    'the derivatives of an attribute in the tetrahedron around a place. They are exact and rounded once. NULL outside the mesh and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: a derivative for each axis. Units: the place and max_edge in those of the coordinates, derivatives in those of the attribute by those of the coordinates. Errors: 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 22023 as abacus_interpolate; 42704 no such region';

CREATE FUNCTION abacus_slope(
    mesh regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT slope double precision,
    OUT aspect double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_slope'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_slope(regclass, double precision, double precision, text, double precision, text) IS
    'how steep an attribute is around a place, and which way it goes down. aspect is clockwise from north, and NULL where it is level. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: the place and max_edge in those of the coordinates, slope and aspect in degrees. Errors: 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 22023 as abacus_interpolate; 42704 no such region';

-- Functions of the extension abacus with a point in place of coordinates.

CREATE FUNCTION abacus_locate(mesh regclass, place geometry)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, geometry) IS
    'the simplex that contains a point. NULL outside the mesh. Errors: 22023 another SRID, no point, or one without z in space';

CREATE FUNCTION abacus_star(mesh regclass, place geometry)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_star_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 6;
COMMENT ON FUNCTION abacus_star(regclass, geometry) IS
    'all simplices that contain a point. Around a vertex they are its star. Errors: 22023 another SRID, no point, or one without z in space';

CREATE FUNCTION abacus_nearest(
    mesh regclass,
    place geometry,
    k integer DEFAULT 1,
    OUT vertex bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_nearest_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1 SUPPORT abacus_nearest_rows;
COMMENT ON FUNCTION abacus_nearest(regclass, geometry, integer) IS
    'the k vertices nearest to a point, nearest first. Shapes: attributes in the order of the mesh. Units: distance in those of the coordinates. Errors: 22023 another SRID, no point, one without z in space, k below 1';

CREATE FUNCTION abacus_interpolate(
    mesh regclass,
    place geometry,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    step bigint DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_interpolate_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_interpolate(regclass, geometry, text, text, text, double precision, text, bigint) IS
    'the value of an attribute at a point. The method is linear, natural or nearest. NULL outside the mesh, unless outside is nearest, and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Units: max_edge in those of the coordinates, the value in those of the attribute. Errors: 22023 another SRID, no point, or one without z in space; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region; 42704 no such step, 55000 one that is not whole';

CREATE FUNCTION abacus_weights(
    mesh regclass,
    place geometry,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT vertex bigint,
    OUT weight double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_weights_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 500 ROWS 3;
COMMENT ON FUNCTION abacus_weights(regclass, geometry, text, text, double precision, text) IS
    'the vertices that the value at a point comes from, and their weights. The weights sum to 1. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates, weights are shares of 1. Errors: 22023 another SRID, no point, or one without z in space; 42704 no such region';

CREATE FUNCTION abacus_gradient(
    mesh regclass,
    place geometry,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_gradient_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_gradient(regclass, geometry, text, double precision, text) IS
    'the derivatives of an attribute in the simplex around a point. NULL outside the mesh and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: a derivative for each axis. Units: max_edge in those of the coordinates, derivatives in those of the attribute by those of the coordinates. Errors: 22023 another SRID, no point, or one without z in space; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION abacus_slope(
    mesh regclass,
    place geometry,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT slope double precision,
    OUT aspect double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_slope_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_slope(regclass, geometry, text, double precision, text) IS
    'how steep an attribute is around a point, and which way it goes down. aspect is clockwise from north, and NULL where it is level. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates, slope and aspect in degrees. Errors: 22023 another SRID or no point; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION abacus_visible(
    mesh regclass,
    observer geometry,
    target geometry,
    attribute text DEFAULT NULL,
    observer_height double precision DEFAULT 0,
    target_height double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT visible boolean,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_visible_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_visible(regclass, geometry, geometry, text, double precision, double precision, double precision, text) IS
    'whether a target is seen from an observer over a terrain. If not, x, y and z are the first place that blocks the sight. Both stand on the ground, or above it. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: places and max_edge in those of the coordinates, heights in those of the attribute. Errors: 22023 another SRID or no point; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

-- Of two texts in quotes PostgreSQL could not tell whether they are arrays or geometries. They are arrays.
CREATE FUNCTION abacus_visible(
    mesh regclass,
    observer text,
    target text,
    attribute text DEFAULT NULL,
    observer_height double precision DEFAULT 0,
    target_height double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT visible boolean,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000
BEGIN ATOMIC
    SELECT s.visible, s.x, s.y, s.z
    FROM abacus_visible(mesh, observer::double precision[], target::double precision[], attribute, observer_height,
                        target_height, max_edge, within) AS s;
END;
COMMENT ON FUNCTION abacus_visible(regclass, text, text, text, double precision, double precision, double precision, text) IS
    'the same, with arrays as text';

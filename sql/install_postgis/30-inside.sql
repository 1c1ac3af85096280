-- What the functions that follow are made of. They are not meant to be called.

CREATE FUNCTION _abacus_facts(
    mesh regclass,
    attribute text,
    OUT srid integer,
    OUT dimension integer,
    OUT attribute_number integer)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_facts'
LANGUAGE C STABLE PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_facts(regclass, text) IS
    'inside abacus_postgis: what geometries of a mesh need: its SRID, its dimension, and the number of an attribute';

CREATE FUNCTION _abacus_corner(mesh regclass, srid integer, corner double precision[])
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_corner'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_corner(regclass, integer, double precision[]) IS
    'inside abacus_postgis: a corner of the box around a geometry, as an argument of functions that take a window';

CREATE FUNCTION _abacus_lower(mesh regclass, bounds geometry)
RETURNS double precision[]
LANGUAGE sql STABLE PARALLEL SAFE COST 1000
RETURN _abacus_corner(mesh, ST_SRID(bounds), ARRAY[ST_XMin(bounds), ST_YMin(bounds),
    CASE WHEN ST_ZMFlag(bounds) >= 2 THEN ST_ZMin(bounds) ELSE '-Infinity'::double precision END]);
COMMENT ON FUNCTION _abacus_lower(regclass, geometry) IS
    'inside abacus_postgis: the least corner of the box around a geometry';

CREATE FUNCTION _abacus_upper(mesh regclass, bounds geometry)
RETURNS double precision[]
LANGUAGE sql STABLE PARALLEL SAFE COST 1000
RETURN _abacus_corner(mesh, ST_SRID(bounds), ARRAY[ST_XMax(bounds), ST_YMax(bounds),
    CASE WHEN ST_ZMFlag(bounds) >= 2 THEN ST_ZMax(bounds) ELSE 'Infinity'::double precision END]);
COMMENT ON FUNCTION _abacus_upper(regclass, geometry) IS
    'inside abacus_postgis: the greatest corner of the box around a geometry';

CREATE FUNCTION _abacus_area(mesh regclass, area geometry)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_area'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_area(regclass, geometry) IS
    'inside abacus_postgis: a geometry as it is, or an error if it is not an area of a mesh';

CREATE FUNCTION _abacus_place(mesh regclass, place geometry)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_point'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_place(regclass, geometry) IS
    'inside abacus_postgis: the coordinates of a point';

CREATE FUNCTION _abacus_path(mesh regclass, line geometry)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_path'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_path(regclass, geometry) IS
    'inside abacus_postgis: the corners of a line, one after the other';

CREATE FUNCTION _abacus_cell(
    corners double precision[],
    "values" double precision[],
    attribute integer,
    srid integer)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_cell_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 50;
COMMENT ON FUNCTION _abacus_cell(double precision[], double precision[], integer, integer) IS
    'inside abacus_postgis: the geometry of a row of abacus_cells';

CREATE FUNCTION _abacus_part(
    part geometry,
    corners double precision[],
    "values" double precision[],
    attribute integer)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_cell_part'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION _abacus_part(geometry, double precision[], double precision[], integer) IS
    'inside abacus_postgis: polygons within a triangle of abacus_cells, with the attribute as z; NULL where it is missing at a corner';

CREATE FUNCTION _abacus_point(
    x double precision,
    y double precision,
    z double precision,
    srid integer)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_point_geometry'
LANGUAGE C STABLE PARALLEL SAFE COST 50;
COMMENT ON FUNCTION _abacus_point(double precision, double precision, double precision, integer) IS
    'inside abacus_postgis: a point, without z if it is NULL';

CREATE FUNCTION _abacus_line(
    places double precision[],
    dimension integer,
    srid integer,
    closes boolean DEFAULT false)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_line_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION _abacus_line(double precision[], integer, integer, boolean) IS
    'inside abacus_postgis: a line through places, one after the other, and back to the first';

CREATE FUNCTION _abacus_polygon(places double precision[], dimension integer, srid integer)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_polygon_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION _abacus_polygon(double precision[], integer, integer) IS
    'inside abacus_postgis: the polygon of a ring of places, the first of which is not repeated';

CREATE FUNCTION _abacus_triangles(corners double precision[], srid integer)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_triangles_geometry'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION _abacus_triangles(double precision[], integer) IS
    'inside abacus_postgis: a triangle in space, or a TIN of several';

CREATE FUNCTION _abacus_nest(rings geometry)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_geometry_nest'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION _abacus_nest(geometry) IS
    'inside abacus_postgis: polygons of rings, counterclockwise around what is inside and clockwise around holes';

CREATE FUNCTION _abacus_edges(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT path double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_edge_lines'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION _abacus_edges(regclass, double precision[], double precision[], double precision, text) IS
    'inside abacus_postgis: abacus_edges with the places of their ends';

-- Geometries over a terrain.

CREATE FUNCTION abacus_drape(
    mesh regclass,
    geom geometry,
    attribute text DEFAULT NULL,
    densify boolean DEFAULT false,
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL)
RETURNS geometry
AS 'MODULE_PATHNAME', 'abacus_sql_drape'
LANGUAGE C STABLE PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_drape(regclass, geometry, text, boolean, text, double precision, text) IS
    'points, lines or polygons with an attribute of a mesh in the plane as z. With densify, they get a place wherever they cross an edge. z is NaN outside the mesh, unless outside is nearest, and where a value is missing. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates, z in those of the attribute. Errors: 22023 curves and surfaces, another SRID, a mesh of dimension 3, a coordinate that is not finite; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION _abacus_polygon_text(mesh regclass, within text)
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_polygon_text'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION _abacus_polygon_text(regclass, text) IS
    'inside abacus_postgis: the polygon that within is, as it is; NULL for a region; an error for all that questions to the mesh refuse';

-- The planner evaluates each branch of a CASE whose arguments it knows, also the one that is not taken. So a text
-- becomes a geometry only behind a function that the planner leaves to the executor.
CREATE FUNCTION _abacus_part_within(mesh regclass, area geometry, within text)
RETURNS geometry
LANGUAGE sql STABLE PARALLEL SAFE
BEGIN ATOMIC
    SELECT COALESCE(ST_CollectionExtract(ST_Intersection(area, ST_SetSRID(_abacus_polygon_text(mesh, within)::geometry, ST_SRID(area))), 3), area);
END;
COMMENT ON FUNCTION _abacus_part_within(regclass, geometry, text) IS
    'inside abacus_postgis: the part of an area within a polygon; all of it within a region';

CREATE FUNCTION abacus_clip(
    mesh regclass,
    area geometry,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT whole boolean,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT p.code, p.v0, p.v1, p.v2, p.whole,
           CASE WHEN p.whole THEN _abacus_cell(p.corners, p."values", p.attribute_number, p.srid)
                WHEN p.attribute_number IS NULL THEN p.part
                ELSE _abacus_part(p.part, p.corners, p."values", p.attribute_number) END
    FROM (SELECT t.*, CASE WHEN NOT t.whole THEN ST_CollectionExtract(ST_Intersection(t.cell, t.area), 3) END AS part
          FROM (SELECT c.code, c.v0, c.v1, c.v2, c.corners, c."values", c.cell, c.attribute_number, c.srid, a.area, ST_Contains(a.area, c.cell) AS whole
                FROM (SELECT _abacus_part_within(mesh, _abacus_area(mesh, area), within) AS area OFFSET 0) AS a,
                     LATERAL (SELECT d.*, f.attribute_number, f.srid, _abacus_cell(d.corners, d."values", NULL, f.srid) AS cell
                              FROM _abacus_facts(mesh, attribute) AS f,
                                   abacus_cells(mesh, _abacus_lower(mesh, a.area), _abacus_upper(mesh, a.area), max_edge, within => within) AS d
                              OFFSET 0) AS c
                WHERE NOT ST_IsEmpty(a.area) AND ST_Intersects(a.area, c.cell)
                OFFSET 0) AS t
          OFFSET 0) AS p
    WHERE p.whole OR NOT ST_IsEmpty(p.part);
END;
COMMENT ON FUNCTION abacus_clip(regclass, geometry, text, double precision, text) IS
    'the parts of the triangles of a mesh in the plane that lie within polygons. Triangles wholly inside stay as they are; others are cut at the border, with an attribute as z. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates. Errors: 22023 no valid polygon, another SRID, a mesh of dimension 3; 42703 no such attribute; 42704 no such region';

-- Regions, which end at fixed edges.

CREATE TYPE abacus_region_part AS (
    region text, number integer, part bigint, line bigint, x double precision, y double precision,
    lower double precision[], upper double precision[]);
COMMENT ON TYPE abacus_region_part IS 'row of the table of regions of a mesh: an outline or a seed of a region';
COMMENT ON COLUMN abacus_region_part.region IS 'name of the region';
COMMENT ON COLUMN abacus_region_part.number IS 'its number, which its triangles have';
COMMENT ON COLUMN abacus_region_part.part IS 'number of the outline or seed in its region';
COMMENT ON COLUMN abacus_region_part.line IS 'line that is an outline; NULL for a seed';
COMMENT ON COLUMN abacus_region_part.x IS 'where the seed is; NULL for an outline';
COMMENT ON COLUMN abacus_region_part.y IS 'the same';
COMMENT ON COLUMN abacus_region_part.lower IS 'least corner of a box around the region';
COMMENT ON COLUMN abacus_region_part.upper IS 'its greatest corner';

CREATE FUNCTION abacus_region(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_region'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_region(regclass, text) IS
    'adds regions to a mesh in the plane: sets of triangles that end at fixed edges. Outlines are lines of the mesh; inside is what an odd number of them goes around. Seeds fill what can be reached from them without crossing a fixed edge. Regions follow the mesh: points and lines may come and go, but lines that are outlines must stay. An outline that is given twice counts once, with a NOTICE. Returns the number of regions. Shapes: the query returns region (text) and line, or region, x and y. Units: x and y in those of the coordinates. Errors: 42804 other columns, 22004 NULL, 22023 an unknown line, an outline that is not closed, a seed on a fixed edge or outside, a seed from which the hull can be reached, a triangle in two regions, 42710 a region that is there, 55000 a mesh without lines, in space or that cannot be changed, 42501 the first regions given by another than the owner. Source: even-odd rule (J. Foley et al., Computer Graphics, 1996); flooding from seeds as in Triangle (J. Shewchuk, 1996)';

CREATE FUNCTION abacus_unregion(mesh regclass, region text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_unregion'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_unregion(regclass, text) IS
    'removes a region from a mesh. Its triangles and lines stay. Errors: 42704 no such region, 55000 a mesh in space, whose lines wait, or that cannot be changed';

CREATE FUNCTION abacus_region_at(mesh regclass, x double precision, y double precision)
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_region_at'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_region_at(regclass, double precision, double precision) IS
    'the region that has the triangle which abacus_locate() finds at a place; NULL outside of all regions, and outside of the mesh. Units: x and y in those of the coordinates. Errors: 42809 not a mesh, 22023 NaN, a mesh in space, 42501 no privilege on the table of regions';

CREATE FUNCTION abacus_regions(
    mesh regclass,
    OUT region text,
    OUT number integer,
    OUT triangles bigint,
    OUT area double precision,
    OUT edges bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_regions'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100;
COMMENT ON FUNCTION abacus_regions(regclass) IS
    'the regions of a mesh, by name: the number that their triangles have, how many triangles, their area, and how many edges their borders have. The area is the exact sum, rounded once. Reads all pages. Units: area in square units of the coordinates. Errors: 42809 not a mesh, 42501 no privilege on the table of regions';

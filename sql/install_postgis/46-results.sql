-- What functions of the extension abacus return, as geometries.

CREATE FUNCTION abacus_cells_geom(
    mesh regclass,
    bounds geometry DEFAULT NULL,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT geom geometry,
    OUT "values" double precision[])
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT c.code, c.v0, c.v1, c.v2, c.v3, _abacus_cell(c.corners, c."values", f.attribute_number, f.srid), c."values"
    FROM _abacus_facts(mesh, attribute) AS f,
         abacus_cells(mesh, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds), max_edge, within => within) AS c
    WHERE ST_IsEmpty(bounds) IS NOT TRUE;
END;
COMMENT ON FUNCTION abacus_cells_geom(regclass, geometry, text, double precision, text) IS
    'the simplices of a mesh, or those that meet the box around a geometry. Triangles are polygons, with an attribute as z; tetrahedra are closed surfaces. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: "values"[i][attribute] of corner i, from 1. Units: max_edge in those of the coordinates. Errors: 22023 another SRID; 42703 no such attribute; 42704 no such region';

CREATE FUNCTION abacus_vertices_geom(
    mesh regclass,
    bounds geometry DEFAULT NULL,
    OUT id bigint,
    OUT geom geometry,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT v.id, _abacus_point(v.x, v.y, v.z, f.srid), v.attributes, v.vertex
    FROM _abacus_facts(mesh, NULL) AS f, abacus_vertices(mesh) AS v
    WHERE bounds IS NULL
    UNION ALL
    SELECT v.id, _abacus_point(v.x, v.y, v.z, f.srid), v.attributes, v.vertex
    FROM _abacus_facts(mesh, NULL) AS f, abacus_vertices(mesh, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds)) AS v
    WHERE NOT ST_IsEmpty(bounds);
END;
COMMENT ON FUNCTION abacus_vertices_geom(regclass, geometry) IS
    'all points of a mesh, or its vertices in the box around a geometry. Shapes: attributes in the order of the mesh. Errors: 22023 another SRID';

CREATE FUNCTION abacus_edges_geom(
    mesh regclass,
    bounds geometry DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT e.v0, e.v1, e.length, _abacus_line(e.path, f.dimension, f.srid)
    FROM _abacus_facts(mesh, NULL) AS f,
         _abacus_edges(mesh, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds), max_edge, within) AS e
    WHERE ST_IsEmpty(bounds) IS NOT TRUE;
END;
COMMENT ON FUNCTION abacus_edges_geom(regclass, geometry, double precision, text) IS
    'the edges of a mesh, or those that meet the box around a geometry, each once. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge and length in those of the coordinates. Errors: 22023 another SRID or a bad max_edge; 42704 no such region';

CREATE FUNCTION abacus_contours_geom(
    mesh regclass,
    level_interval double precision DEFAULT 100,
    level_base double precision DEFAULT 0,
    fixed_levels double precision[] DEFAULT '{}',
    polygonize boolean DEFAULT false,
    attribute text DEFAULT NULL,
    bounds geometry DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    max_error double precision DEFAULT NULL,
    OUT id bigint,
    OUT value double precision,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT c.id, c.value, _abacus_line(c.path, 2, f.srid)
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_contours(mesh, level_interval, level_base, fixed_levels, false, attribute,
                         _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds), max_edge, within => within,
                         max_error => max_error) AS c
    WHERE polygonize IS NOT TRUE AND ST_IsEmpty(bounds) IS NOT TRUE
    UNION ALL
    SELECT c.id, min(c.value), ST_Multi(_abacus_nest(ST_Collect(_abacus_line(c.path, 2, f.srid))))
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_contours(mesh, level_interval, level_base, fixed_levels, true, attribute,
                         _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds), max_edge, within => within,
                         max_error => max_error) AS c
    WHERE polygonize AND ST_IsEmpty(bounds) IS NOT TRUE
    GROUP BY c.id;
END;
COMMENT ON FUNCTION abacus_contours_geom(regclass, double precision, double precision, double precision[], boolean, text, geometry, double precision, text, double precision) IS
    'the contours of an attribute in a mesh in the plane, or in the box around a geometry, as whole lines. With polygonize, the bands between levels, a multipolygon each. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. max_error reads the coarsest level of abacus_levels whose error is not greater. Shapes: fixed_levels is an array of levels. Units: levels and max_error in those of the attribute, max_edge in those of the coordinates. Errors: those of abacus_contours; 22023 another SRID; 42704 no such region';

CREATE FUNCTION abacus_profile_geom(
    mesh regclass,
    line geometry,
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT distance double precision,
    OUT value double precision,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT p.distance, p.value, _abacus_point(p.x, p.y, p.z, f.srid)
    FROM _abacus_facts(mesh, NULL) AS f, abacus_profile(mesh, _abacus_path(mesh, line), attribute, max_edge, within) AS p;
END;
COMMENT ON FUNCTION abacus_profile_geom(regclass, geometry, text, double precision, text) IS
    'an attribute along a line. A row stands at each corner of the line and wherever it crosses an edge, in space a facet; value is NULL where the line leaves or enters the mesh. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: distance and max_edge in those of the coordinates, value in those of the attribute. Errors: those of abacus_profile; 22023 another SRID or no line; 42704 no such region';

CREATE FUNCTION abacus_voronoi_geom(
    mesh regclass,
    bounds geometry DEFAULT NULL,
    OUT vertex bigint,
    OUT bounded boolean,
    OUT area double precision,
    OUT volume double precision,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT v.vertex, v.bounded, v.area, v.volume, _abacus_polygon(v.ring, 2, f.srid)
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_voronoi(mesh, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds)) AS v
    WHERE ST_IsEmpty(bounds) IS NOT TRUE;
END;
COMMENT ON FUNCTION abacus_voronoi_geom(regclass, geometry) IS
    'the Voronoi cell of each vertex of a mesh, or the parts of the cells within the box around a geometry. In space geom is NULL; facets have one. Units: area in the square of those of the coordinates, volume in their cube. Errors: those of abacus_voronoi; 22023 another SRID';

CREATE FUNCTION abacus_voronoi_facets_geom(
    mesh regclass,
    bounds geometry DEFAULT NULL,
    OUT vertex bigint,
    OUT neighbour bigint,
    OUT bounded boolean,
    OUT size double precision,
    OUT geom geometry)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT v.vertex, v.neighbour, v.bounded, v.size,
           CASE f.dimension WHEN 2 THEN _abacus_line(v.ring, 2, f.srid) ELSE _abacus_polygon(v.ring, 3, f.srid) END
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_voronoi_facets(mesh, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds)) AS v
    WHERE ST_IsEmpty(bounds) IS NOT TRUE;
END;
COMMENT ON FUNCTION abacus_voronoi_facets_geom(regclass, geometry) IS
    'the facets between neighbouring Voronoi cells of a mesh: lines, in space polygons. Units: size in those of the coordinates, in space in their square. Errors: those of abacus_voronoi_facets; 22023 another SRID';

CREATE FUNCTION abacus_hull_geom(mesh regclass, max_edge double precision DEFAULT NULL, within text DEFAULT NULL)
RETURNS geometry
LANGUAGE sql STABLE PARALLEL SAFE COST 1000000
BEGIN ATOMIC
    SELECT coalesce(_abacus_nest(ST_Collect(_abacus_line(r.places, 2, f.srid, true)) FILTER (WHERE f.dimension = 2)),
                    _abacus_triangles(array_agg(r.places ORDER BY r.ring) FILTER (WHERE f.dimension = 3), min(f.srid)))
    FROM _abacus_facts(mesh, NULL) AS f,
         (SELECT h.ring, array_agg(CASE WHEN h.z IS NULL THEN ARRAY[h.x, h.y] ELSE ARRAY[h.x, h.y, h.z] END ORDER BY h.position) AS places
          FROM abacus_hull(mesh, max_edge, within) AS h GROUP BY h.ring) AS r;
END;
COMMENT ON FUNCTION abacus_hull_geom(regclass, double precision, text) IS
    'the convex hull of a mesh, or the outline of its simplices without longer edges. Polygons with holes, in space a TIN. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates. Errors: those of abacus_hull; 42704 no such region';

CREATE FUNCTION abacus_alpha_shape_geom(
    mesh regclass,
    alpha double precision,
    allow_holes boolean DEFAULT NULL)
RETURNS geometry
LANGUAGE sql STABLE PARALLEL SAFE COST 1000000
BEGIN ATOMIC
    SELECT coalesce(_abacus_nest(ST_Collect(_abacus_line(r.places, 2, f.srid, true)) FILTER (WHERE f.dimension = 2)),
                    _abacus_triangles(array_agg(r.places ORDER BY r.ring) FILTER (WHERE f.dimension = 3), min(f.srid)))
    FROM _abacus_facts(mesh, NULL) AS f,
         (SELECT h.ring, array_agg(CASE WHEN h.z IS NULL THEN ARRAY[h.x, h.y] ELSE ARRAY[h.x, h.y, h.z] END ORDER BY h.position) AS places
          FROM abacus_alpha_shape(mesh, alpha, allow_holes) AS h GROUP BY h.ring) AS r;
END;
COMMENT ON FUNCTION abacus_alpha_shape_geom(regclass, double precision, boolean) IS
    'the simplices whose circumradius has a square of at most alpha. Polygons with holes, in space a TIN around them. Units: alpha in the square of those of the coordinates. Errors: those of abacus_alpha_shape';

CREATE FUNCTION abacus_isosurface_geom(
    mesh regclass,
    value double precision,
    attribute text DEFAULT NULL,
    carry text DEFAULT NULL,
    bounds geometry DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT geom geometry,
    OUT "values" double precision[])
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT s.v0, s.v1, s.v2, _abacus_triangles(s.corners, f.srid), s."values"
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_isosurface(mesh, value, attribute, carry, _abacus_lower(mesh, bounds), _abacus_upper(mesh, bounds), max_edge) AS s
    WHERE ST_IsEmpty(bounds) IS NOT TRUE;
END;
COMMENT ON FUNCTION abacus_isosurface_geom(regclass, double precision, text, text, geometry, double precision) IS
    'the triangles of the surface in a mesh in space on which an attribute has a value. Shapes: "values"[i] of corner i, from 1. Units: value in those of the attribute, max_edge in those of the coordinates. Errors: those of abacus_isosurface; 22023 another SRID';

CREATE FUNCTION abacus_section_geom(
    mesh regclass,
    through geometry,
    normal double precision[],
    attribute text DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT code bigint,
    OUT geom geometry,
    OUT "values" double precision[])
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT s.code, _abacus_polygon(s.polygon, 3, f.srid), s."values"
    FROM _abacus_facts(mesh, NULL) AS f,
         abacus_section(mesh, _abacus_place(mesh, through), normal, attribute, max_edge) AS s;
END;
COMMENT ON FUNCTION abacus_section_geom(regclass, geometry, double precision[], text, double precision) IS
    'the polygons in which a plane cuts the tetrahedra of a mesh. The plane goes through a point and has a normal. values has an attribute at the corners. Shapes: normal is {x, y, z}; "values"[i] of corner i, from 1. Units: max_edge in those of the coordinates, normal of any length. Errors: those of abacus_section; 22023 another SRID or no point';

-- What the points of a mesh look like.

CREATE FUNCTION abacus_voronoi(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    OUT vertex bigint,
    OUT bounded boolean,
    OUT area double precision,
    OUT volume double precision,
    OUT ring double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_voronoi'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_voronoi(regclass, double precision[], double precision[]) IS
    'the Voronoi cell of each vertex of a mesh, or the parts of the cells within a window. Shapes: lower and upper are {x, y}, in space {x, y, z}; ring is {{x, y}, ...}, counterclockwise. Units: lengths in those of the coordinates, area in their square, volume in their cube. Errors: 22023 a bad window, 55000 the mesh is not Delaunay';

CREATE FUNCTION abacus_voronoi_facets(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    OUT vertex bigint,
    OUT neighbour bigint,
    OUT bounded boolean,
    OUT size double precision,
    OUT ring double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_voronoi_facets'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_voronoi_facets(regclass, double precision[], double precision[]) IS
    'the facets between neighbouring Voronoi cells of a mesh, or their parts within a window. Shapes: lower and upper are {x, y}, in space {x, y, z}; ring is {{x, y}, ...} or {{x, y, z}, ...}. Units: lengths in those of the coordinates, size in them, or in space in their square. Errors: 22023 a bad window, 55000 the mesh is not Delaunay';

CREATE FUNCTION abacus_hull(
    mesh regclass,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT ring bigint,
    OUT "position" bigint,
    OUT vertex bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_hull'
LANGUAGE C STABLE PARALLEL SAFE COST 100000 ROWS 1000;
COMMENT ON FUNCTION abacus_hull(regclass, double precision, text) IS
    'the border of a mesh, or of its simplices without longer edges. Rings of vertices, in space triangles. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge and places in those of the coordinates. Errors: 22023 a bad max_edge, 53400 no room for temporary files; 42704 no such region';

CREATE FUNCTION abacus_alpha_shape(
    mesh regclass,
    alpha double precision,
    allow_holes boolean DEFAULT NULL,
    OUT ring bigint,
    OUT "position" bigint,
    OUT vertex bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_alpha_shape'
LANGUAGE C STABLE PARALLEL SAFE COST 100000 ROWS 1000;
COMMENT ON FUNCTION abacus_alpha_shape(regclass, double precision, boolean) IS
    'the border of the simplices whose circumradius has a square of at most alpha. Rings of vertices, in space triangles. Units: alpha in the square of those of the coordinates. Errors: 22023 alpha not above 0, 22004 alpha NULL, 55000 the mesh is not Delaunay, 54000 too many cavities for work_mem, 53400 no room for temporary files';

CREATE FUNCTION abacus_spanning_tree(
    mesh regclass,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_spanning_tree'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000000 ROWS 1000 SUPPORT abacus_vertices_rows;
COMMENT ON FUNCTION abacus_spanning_tree(regclass) IS
    'the minimum spanning tree: the shortest edges that join all vertices of a mesh, shortest first. Units: length in those of the coordinates. Errors: 54000 too many vertices at once for work_mem, 53400 no room for temporary files';

-- Parts of a mesh.

CREATE FUNCTION abacus_window_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_window_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_window_rows(internal) IS 'planner support of functions that take a window';

CREATE FUNCTION abacus_simplices(mesh regclass, lower double precision[], upper double precision[], within text DEFAULT NULL)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_in_box'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_simplices(regclass, double precision[], double precision[], text) IS
    'the simplices that meet a window, from its least to its greatest corner. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42704 no such region';

CREATE FUNCTION abacus_simplices(mesh regclass, center double precision[], radius double precision, within text DEFAULT NULL)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_in_ball'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_simplices(regclass, double precision[], double precision, text) IS
    'the simplices that meet a ball. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: center is {x, y}, in space {x, y, z}. Units: center and radius in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension, 22004 a NULL center or radius; 42704 no such region';

CREATE FUNCTION abacus_simplices(mesh regclass, within text)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_within'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000;
COMMENT ON FUNCTION abacus_simplices(regclass, text) IS
    'the triangles of a region of a mesh. Errors: 42704 no such region';

-- In '{0,0}', '{9,9}' the second could be a corner or a radius, and PostgreSQL would call that ambiguous. Where
-- there is a form with a text it takes that: here, and in those like it below, the text is the corner.
CREATE FUNCTION abacus_simplices(mesh regclass, lower double precision[], upper text, within text DEFAULT NULL)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_in_box'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_simplices(regclass, double precision[], text, text) IS
    'the same for a window, with its upper corner as text';

CREATE FUNCTION abacus_cells(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    label text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    within text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[],
    OUT "values" double precision[],
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_cells'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_cells(regclass, double precision[], double precision[], double precision, text, double precision[], text) IS
    'the simplices of a mesh or of a window, with the coordinates and attributes of their corners, and their labels. With label and range, those whose label is in the range. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}; corners[i][axis] and "values"[i][attribute] of corner i, from 1; range is {least, greatest}; labels as abacus_labels names them. Units: lower, upper, corners and max_edge in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42703 no such label, 22023 a range that descends; 42704 no such region';

CREATE FUNCTION abacus_cells(
    mesh regclass,
    center double precision[],
    radius double precision,
    max_edge double precision DEFAULT NULL,
    label text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    within text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[],
    OUT "values" double precision[],
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_cells_in_ball'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_cells(regclass, double precision[], double precision, double precision, text, double precision[], text) IS
    'the simplices that meet a ball, with the coordinates and attributes of their corners, and their labels. With label and range, those whose label is in the range. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: center is {x, y}, in space {x, y, z}; corners[i][axis] and "values"[i][attribute] of corner i, from 1; range is {least, greatest}; labels as abacus_labels names them. Units: center, radius, corners and max_edge in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42703 no such label, 22023 a range that descends, 22004 a NULL center or radius; 42704 no such region';

CREATE FUNCTION abacus_cells(
    mesh regclass,
    lower double precision[],
    upper text,
    max_edge double precision DEFAULT NULL,
    label text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    within text DEFAULT NULL,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[],
    OUT "values" double precision[],
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_cells'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_cells(regclass, double precision[], text, double precision, text, double precision[], text) IS
    'the same for a window, with its upper corner as text';

CREATE FUNCTION abacus_range_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_range_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_range_rows(internal) IS 'planner support of abacus_vertices with a window or a range';

CREATE FUNCTION abacus_vertices(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    attribute text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_vertices'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_range_rows;
COMMENT ON FUNCTION abacus_vertices(regclass, double precision[], double precision[], text, double precision[]) IS
    'all points of a mesh, or the vertices in a window. With attribute and range, those whose attribute is in the range. Column vertex is the id of the vertex that stands for the point: its own, unless an equal point came first; of points that wait to be inserted it is NULL, and sequence is their order. Shapes: lower and upper are {x, y}, in space {x, y, z}; range is {least, greatest}; attributes in the order of the mesh. Units: lower, upper and places in those of the coordinates, range in those of the attribute. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42703 no such attribute, 22023 a range that descends';

CREATE FUNCTION abacus_vertices(
    mesh regclass,
    lower double precision[],
    upper text,
    attribute text DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_vertices'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_range_rows;
COMMENT ON FUNCTION abacus_vertices(regclass, double precision[], text, text, double precision[]) IS
    'the same for a window, with its upper corner as text';

CREATE FUNCTION abacus_vertices(
    mesh regclass,
    center double precision[],
    radius double precision,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_vertices_in_ball'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_vertices(regclass, double precision[], double precision) IS
    'the vertices in a ball. Shapes: center is {x, y}, in space {x, y, z}; attributes in the order of the mesh. Units: center, radius and places in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension, 22004 a NULL center or radius';

-- With the ends of the range by position. They have names, since pg_dump writes the body anew, by names.
CREATE FUNCTION abacus_vertices(
    mesh regclass,
    attribute text,
    range_lower double precision,
    range_upper double precision,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT v.sequence, v.id, v.x, v.y, v.z, v.attributes, v.vertex
    FROM abacus_vertices(mesh, lower, upper, attribute, ARRAY[range_lower, range_upper]) AS v;
END;
COMMENT ON FUNCTION abacus_vertices(regclass, text, double precision, double precision, double precision[], double precision[]) IS
    'the vertices of a mesh, or of a window, whose attribute is in a range. Shapes: lower and upper are {x, y}, in space {x, y, z}; range is {least, greatest}; attributes in the order of the mesh. Units: lower, upper and places in those of the coordinates, range in those of the attribute. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42703 no such attribute, 22023 a range that descends';

CREATE FUNCTION abacus_vertices(
    mesh regclass,
    attribute text,
    range_lower text,
    range_upper text,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
LANGUAGE sql STABLE PARALLEL SAFE COST 10000 ROWS 1000
BEGIN ATOMIC
    SELECT v.sequence, v.id, v.x, v.y, v.z, v.attributes, v.vertex
    FROM abacus_vertices(mesh,
        CASE WHEN range_lower LIKE '{%' THEN attribute::double precision[] ELSE lower END,
        CASE WHEN range_lower LIKE '{%' THEN range_lower::double precision[] ELSE upper END,
        CASE WHEN range_lower LIKE '{%' THEN range_upper ELSE attribute END,
        CASE WHEN range_lower LIKE '{%' THEN lower ELSE ARRAY[range_lower, range_upper]::double precision[] END) AS v;
END;
COMMENT ON FUNCTION abacus_vertices(regclass, text, text, text, double precision[], double precision[]) IS
    'the same, with the ends of the range as text; if the third argument is an array in quotes, as the second is then, they are a window, an attribute and its range';

CREATE FUNCTION abacus_edges(
    mesh regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    fixed boolean DEFAULT false,
    within text DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT lines bigint[],
    OUT kind text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_edges'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_edges(regclass, double precision[], double precision[], double precision, boolean, text) IS
    'the edges of a mesh, or those that meet a window, each once. With fixed, only fixed edges, with the lines that they are on; their kind is hard if one of these is. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: lower, upper, max_edge and length in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42704 no such region';

CREATE FUNCTION abacus_edges(
    mesh regclass,
    center double precision[],
    radius double precision,
    max_edge double precision DEFAULT NULL,
    fixed boolean DEFAULT false,
    within text DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT lines bigint[],
    OUT kind text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_edges_in_ball'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_edges(regclass, double precision[], double precision, double precision, boolean, text) IS
    'the edges that meet a ball, each once. With fixed, only fixed edges, with the lines that they are on; their kind is hard if one of these is. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: center is {x, y}, in space {x, y, z}. Units: center, radius, max_edge and length in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension, 22004 a NULL center or radius; 42704 no such region';

CREATE FUNCTION abacus_edges(
    mesh regclass,
    lower double precision[],
    upper text,
    max_edge double precision DEFAULT NULL,
    fixed boolean DEFAULT false,
    within text DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT length double precision,
    OUT lines bigint[],
    OUT kind text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_edges'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_window_rows;
COMMENT ON FUNCTION abacus_edges(regclass, double precision[], text, double precision, boolean, text) IS
    'the same for a window, with its upper corner as text';

CREATE FUNCTION abacus_star(mesh regclass, x double precision, y double precision)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_star'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 6;
COMMENT ON FUNCTION abacus_star(regclass, double precision, double precision) IS
    'all triangles that contain a place. Around a vertex they are its star. Units: the place in those of the coordinates. Errors: 22023 a NaN, z missing or given in the plane';

CREATE FUNCTION abacus_star(mesh regclass, x double precision, y double precision, z double precision)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_star'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 24;
COMMENT ON FUNCTION abacus_star(regclass, double precision, double precision, double precision) IS
    'all tetrahedra that contain a place. Around a vertex they are its star. Units: the place in those of the coordinates. Errors: 22023 a NaN, z missing or given in the plane';

CREATE FUNCTION abacus_neighbours(mesh regclass, simplex abacus_simplex, steps integer)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_neighbours'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 20;
COMMENT ON FUNCTION abacus_neighbours(regclass, abacus_simplex, integer) IS
    'a simplex and all that can be reached from it across at most so many facets, nearest first. Errors: 22023 steps below 0; those of abacus_walk';

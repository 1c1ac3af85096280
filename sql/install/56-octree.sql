-- Quadtrees and octrees.

CREATE TYPE abacus_octant AS (code bigint, level integer, lower double precision[], upper double precision[], attributes double precision[]);
COMMENT ON TYPE abacus_octant IS 'leaf of a quadtree or an octree: a box with its lower sides and without its upper ones';
COMMENT ON COLUMN abacus_octant.code IS 'Morton code of its lower corner on the grid of the finest level';
COMMENT ON COLUMN abacus_octant.level IS 'how often the domain was halved: 0 is all of it';
COMMENT ON COLUMN abacus_octant.lower IS 'its lower corner';
COMMENT ON COLUMN abacus_octant.upper IS 'its upper corner';
COMMENT ON COLUMN abacus_octant.attributes IS 'its attributes, in the order in which the octree was made with them';

CREATE FUNCTION abacus_octree_create(
    octree text,
    dimension integer,
    lower double precision[],
    upper double precision[],
    attributes text[] DEFAULT '{}',
    levels integer DEFAULT NULL)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_octree_create'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_create(text, integer, double precision[], double precision[], text[], integer) IS
    'makes a quadtree (dimension 2) or an octree (3) over a domain, with one leaf. levels is the finest level that a leaf may have. Shapes: attributes has up to 100 names; lower and upper are {x, y}, for an octree {x, y, z}. Units: lower and upper in those of the coordinates. Errors: those of abacus_create; 22023 a domain longer than a double precision';

CREATE FUNCTION abacus_octree_from_points(octree regclass, query text, most_in_leaf integer)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_points'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_points(regclass, text, integer) IS
    'splits leaves until none has more than so many points of a query. Returns the number of leaves. Shapes: the query returns id, x, y[, z]. Errors: 22023 a place outside the domain; 42809 not an octree; those of abacus_insert about the query';

CREATE FUNCTION abacus_octree_from_size(octree regclass, query text, samples integer DEFAULT 1)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_size'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_size(regclass, text, integer) IS
    'splits leaves that are longer than a query allows. Asks at the centre of an octant; with samples, at the centres of so many equal parts along each axis, and takes the least size. A NOTICE counts leaves longer than a size that was returned for a place in them. Returns the number of leaves. Shapes: the query takes $1, $2[, $3], arrays of the coordinates of places, and one more array of the longest edges of the octants around them; it returns one array of sizes, in the same order. Units: sizes and edges in those of the coordinates. Errors: 22023 samples not from 1 to 16; 42804 anything but one array of the right length; 42809 not an octree';

CREATE FUNCTION abacus_octree_from_rows(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_rows'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_rows(regclass, text) IS
    'loads a linear octree into a new one, leaf by leaf. Returns the number of leaves. Shapes: the query returns code, level and a value for each attribute. Errors: 22023 leaves that overlap or leave a gap, 55000 the octree has been split, 42809 not an octree';

CREATE FUNCTION abacus_octree_refine(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_refine'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_refine(regclass, text) IS
    'splits leaves until those at the places of a query have at least these levels. Returns the number of leaves. Shapes: the query returns level, x, y[, z]. Errors: 22023 a place outside the domain or a level that leaves may not have; 42809 not an octree';

CREATE FUNCTION abacus_octree_coarsen(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_coarsen'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_coarsen(regclass, text) IS
    'merges leaves until those at the places of a query have at most these levels. Returns the number of leaves. Shapes: the query returns level, x, y[, z]. Errors: 22023 a place outside the domain or a bad level; 42809 not an octree';

CREATE FUNCTION abacus_octree_update(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_update'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_update(regclass, text) IS
    'gives leaves their attributes. Returns how many leaves got some. Shapes: the query returns code and a value for each attribute. Errors: 22023 a code that no octant has, 55000 no attributes, 42809 not an octree';

CREATE FUNCTION abacus_octree_balance(octree regclass, across text DEFAULT 'corners')
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_balance'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_balance(regclass, text) IS
    'splits leaves, as few as possible, until neighbours differ by one level at most. across says which leaves are neighbours: across faces, edges or corners. Returns the number of leaves. Errors: 22023 across other than faces, edges or corners; 42809 not an octree';

CREATE FUNCTION abacus_octant_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_octant_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_octant_rows(internal) IS 'planner support of functions that return leaves of an octree';

CREATE FUNCTION abacus_octree_locate(octree regclass, x double precision, y double precision)
RETURNS abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octree_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_octree_locate(regclass, double precision, double precision) IS
    'the leaf of a quadtree that contains a place. NULL outside the domain. Shapes: lower and upper of the leaf are {x, y}, of an octree {x, y, z}. Units: the place in those of the coordinates. Errors: 22023 a NaN, z missing or too many; 42809 not an octree';

CREATE FUNCTION abacus_octree_locate(octree regclass, x double precision, y double precision, z double precision)
RETURNS abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octree_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_octree_locate(regclass, double precision, double precision, double precision) IS
    'the leaf of an octree that contains a place. NULL outside the domain. Shapes: lower and upper of the leaf are {x, y}, of an octree {x, y, z}. Units: the place in those of the coordinates. Errors: 22023 a NaN, z missing or too many; 42809 not an octree';

CREATE FUNCTION abacus_octree_locate(
    octree regclass,
    query text,
    OUT id bigint,
    OUT code bigint,
    OUT level integer,
    OUT lower double precision[],
    OUT upper double precision[],
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_locate_places'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_octree_locate(regclass, text) IS
    'the leaves that contain the places of a query. NULL outside the domain. Shapes: the query returns id, x, y[, z]; lower and upper are {x, y}, of an octree {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite, 42809 not an octree';

CREATE FUNCTION abacus_octants(
    octree regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS SETOF abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octants'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octants(regclass, double precision[], double precision[]) IS
    'the leaves of an octree, or those that meet a window, along the curve. Shapes: lower and upper are {x, y}, of an octree {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension; 42809 not an octree';

CREATE FUNCTION abacus_octants(octree regclass, center double precision[], radius double precision)
RETURNS SETOF abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octants_in_ball'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octants(regclass, double precision[], double precision) IS
    'the leaves of an octree that meet a ball, along the curve. Shapes: center is {x, y}, of an octree {x, y, z}. Units: center and radius in those of the coordinates. Errors: 22023 a bad window or max_edge, 2202E an array of another length than the dimension, 22004 a NULL center or radius, 53400 no room for temporary files; 42809 not an octree';

-- As for meshes, what is in quotes is a corner, not a radius.
CREATE FUNCTION abacus_octants(octree regclass, lower double precision[], upper text)
RETURNS SETOF abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octants'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octants(regclass, double precision[], text) IS
    'the same for a window, with its upper corner as text';

CREATE FUNCTION abacus_octree_nearest(
    octree regclass,
    x double precision,
    y double precision,
    k integer DEFAULT 1,
    OUT code bigint,
    OUT level integer,
    OUT lower double precision[],
    OUT upper double precision[],
    OUT attributes double precision[],
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_nearest'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1 SUPPORT abacus_nearest_rows;
COMMENT ON FUNCTION abacus_octree_nearest(regclass, double precision, double precision, integer) IS
    'the k leaves of a quadtree nearest to a place, nearest first. Shapes: lower and upper are {x, y}, of an octree {x, y, z}. Units: the place and distance in those of the coordinates. Errors: 22023 k below 1, a coordinate that is not finite, z missing or too many; 42809 not an octree';

CREATE FUNCTION abacus_octree_nearest(
    octree regclass,
    x double precision,
    y double precision,
    z double precision,
    k integer DEFAULT 1,
    OUT code bigint,
    OUT level integer,
    OUT lower double precision[],
    OUT upper double precision[],
    OUT attributes double precision[],
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_nearest'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1 SUPPORT abacus_nearest_rows;
COMMENT ON FUNCTION abacus_octree_nearest(regclass, double precision, double precision, double precision, integer) IS
    'the k leaves of an octree nearest to a place, nearest first. Shapes: lower and upper are {x, y}, of an octree {x, y, z}. Units: the place and distance in those of the coordinates. Errors: 22023 k below 1, a coordinate that is not finite, z missing or too many; 42809 not an octree';

CREATE FUNCTION abacus_octree_nearest(
    octree regclass,
    query text,
    k integer DEFAULT 1,
    OUT id bigint,
    OUT rank bigint,
    OUT code bigint,
    OUT distance double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_nearest_places'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_octree_nearest(regclass, text, integer) IS
    'the k leaves nearest to each place of a query. Shapes: the query returns id, x, y[, z]. Units: distance in those of the coordinates. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite, 22023 k below 1; 42809 not an octree';

CREATE FUNCTION abacus_octree_interpolate(
    octree regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_octree_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_octree_interpolate(regclass, double precision, double precision, text) IS
    'the value of an attribute at a place of a quadtree. It is continuous from leaf to leaf. NULL outside the domain, and where a value is missing. Units: the place in those of the coordinates, the value in those of the attribute. Errors: 42703 no such attribute, 42702 none named where the octree has several, 55000 none at all; 22023 a NaN, z missing or too many';

CREATE FUNCTION abacus_octree_interpolate(
    octree regclass,
    x double precision,
    y double precision,
    z double precision,
    attribute text DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_octree_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_octree_interpolate(regclass, double precision, double precision, double precision, text) IS
    'the value of an attribute at a place of an octree. It is continuous from leaf to leaf. NULL outside the domain, and where a value is missing. Units: the place in those of the coordinates, the value in those of the attribute. Errors: 42703 no such attribute, 42702 none named where the octree has several, 55000 none at all; 22023 a NaN, z missing or too many';

CREATE FUNCTION abacus_octree_interpolate(
    octree regclass,
    query text,
    attributes text[] DEFAULT NULL,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_octree_interpolate(regclass, text, text[]) IS
    'the values of attributes at the places of a query. They are those of abacus_octree_interpolate at each place. Shapes: the query returns id, x, y[, z]; "values" has a value or NULL for each of attributes. Units: "values" in those of the attributes. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite; 42703 no such attribute, 42702 none named where the octree has several, 55000 none at all';

-- As of meshes, in quotes.
CREATE FUNCTION abacus_octree_interpolate(
    octree regclass,
    query text,
    attributes text,
    OUT id bigint,
    OUT "values" double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_interpolate_places'
LANGUAGE C VOLATILE PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_octree_interpolate(regclass, text, text) IS
    'the same with the attributes as text, or the name of one';

CREATE FUNCTION abacus_octree_neighbours(
    octree regclass,
    octant bigint,
    OUT axis integer,
    OUT side integer,
    OUT code bigint,
    OUT level integer,
    OUT lower double precision[],
    OUT upper double precision[],
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_neighbours'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 6;
COMMENT ON FUNCTION abacus_octree_neighbours(regclass, bigint) IS
    'the leaves that share a piece of a face with a leaf, which is given by its code. axis is 1, 2 or 3; side is -1 (below) or 1 (above). Shapes: lower and upper are {x, y}, of an octree {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 22023 a code that no octant has, 42809 not an octree';

CREATE FUNCTION abacus_octree_nodes(
    octree regclass,
    OUT node bigint,
    OUT point double precision[],
    OUT anchors bigint[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_nodes'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octree_nodes(regclass) IS
    'the corners of the leaves of a balanced octree, numbered from 0 along the curve. A node that hangs has anchors: the 2 or 4 nodes in whose middle it lies. Shapes: point is {x, y}, of an octree {x, y, z}; anchors are 2 or 4 numbers, NULL unless the node hangs. Units: point in those of the coordinates. Errors: 55000 the octree is not balanced, 53400 no room for temporary files, 42809 not an octree';

CREATE FUNCTION abacus_octree_elements(
    octree regclass,
    OUT element bigint,
    OUT nodes bigint[],
    OUT code bigint,
    OUT level integer,
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_elements'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octree_elements(regclass) IS
    'the leaves of a balanced octree, numbered from 0 along the curve, by the numbers of their corners. Shapes: nodes are 4 numbers, of an octree 8, x fastest. Errors: 55000 the octree is not balanced, 53400 no room for temporary files, 42809 not an octree';

CREATE FUNCTION abacus_octree_tetrahedra(octree regclass, OUT element bigint, OUT nodes bigint[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_tetrahedra'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octree_tetrahedra(regclass) IS
    'a balanced octree as a conforming mesh of tetrahedra, a quadtree as one of triangles. element is the leaf that each belongs to. Shapes: nodes are 3 numbers, of an octree 4. Errors: those of abacus_octree_nodes';

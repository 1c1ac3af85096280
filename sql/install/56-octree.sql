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
    'makes a quadtree (dimension 2) or an octree (3) over a domain, with one leaf; levels: the finest that a leaf may have';

CREATE FUNCTION abacus_octree_from_points(octree regclass, query text, most_in_leaf integer)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_points'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_points(regclass, text, integer) IS
    'splits leaves until none has more than so many points of a query (id, x, y[, z]); returns the number of leaves';

CREATE FUNCTION abacus_octree_from_size(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_size'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_size(regclass, text) IS
    'splits leaves that are longer than a query says: it gets the centers of many as arrays $1, $2[, $3] and returns an array of sizes; returns the number of leaves';

CREATE FUNCTION abacus_octree_from_rows(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_from_rows'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_from_rows(regclass, text) IS
    'loads a linear octree, leaf by leaf (code, level[, attribute...]), into a new octree; returns the number of leaves';

CREATE FUNCTION abacus_octree_refine(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_refine'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_refine(regclass, text) IS
    'splits leaves until those at the places of a query (level, x, y[, z]) are of these levels or finer; returns the number of leaves';

CREATE FUNCTION abacus_octree_coarsen(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_coarsen'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_coarsen(regclass, text) IS
    'merges leaves until those at the places of a query (level, x, y[, z]) are of these levels or coarser; returns the number of leaves';

CREATE FUNCTION abacus_octree_update(octree regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_update'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_update(regclass, text) IS
    'gives leaves attributes: rows (code, attribute...) of a query; returns how many leaves there were';

CREATE FUNCTION abacus_octree_balance(octree regclass, across text DEFAULT 'corners')
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_octree_balance'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_octree_balance(regclass, text) IS
    'splits leaves, as few as can be, until those that touch across faces, edges or corners differ by one level at most; returns the number of leaves';

CREATE FUNCTION abacus_octant_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_octant_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_octant_rows(internal) IS 'planner support of functions that return leaves of an octree';

CREATE FUNCTION abacus_octree_locate(octree regclass, x double precision, y double precision)
RETURNS abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octree_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_octree_locate(regclass, double precision, double precision) IS
    'the leaf of a quadtree that has a place; NULL outside the domain';

CREATE FUNCTION abacus_octree_locate(octree regclass, x double precision, y double precision, z double precision)
RETURNS abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octree_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_octree_locate(regclass, double precision, double precision, double precision) IS
    'the leaf of an octree that has a place; NULL outside the domain';

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
    'the leaves of an octree that have the places of a query (id, x, y[, z]); NULL outside the domain';

CREATE FUNCTION abacus_octants(
    octree regclass,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS SETOF abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octants'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octants(regclass, double precision[], double precision[]) IS
    'the leaves of an octree, or those that meet a window, along the curve';

CREATE FUNCTION abacus_octants(octree regclass, center double precision[], radius double precision)
RETURNS SETOF abacus_octant
AS 'MODULE_PATHNAME', 'abacus_sql_octants_in_ball'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 1000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octants(regclass, double precision[], double precision) IS
    'the leaves of an octree that come at most as near to a center as a radius, along the curve';

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
    'the k leaves of a quadtree nearest to a place, nearest first';

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
    'the k leaves of an octree nearest to a place, nearest first';

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
    'the k leaves of an octree nearest to each of the places of a query (id, x, y[, z])';

CREATE FUNCTION abacus_octree_interpolate(
    octree regclass,
    x double precision,
    y double precision,
    attribute text DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_octree_interpolate'
LANGUAGE C STABLE PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_octree_interpolate(regclass, double precision, double precision, text) IS
    'the value of an attribute at a place of a quadtree, continuous from leaf to leaf; NULL outside the domain, and where a value is missing';

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
    'the value of an attribute at a place of an octree, continuous from leaf to leaf; NULL outside the domain, and where a value is missing';

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
    'the values of attributes at the places of a query (id, x, y[, z]), as abacus_octree_interpolate of each place finds them';

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
    'the leaves that share a piece of a face with a leaf, given by its code: axis 1, 2 or 3, side -1 (below) or 1 (above)';

CREATE FUNCTION abacus_octree_nodes(
    octree regclass,
    OUT node bigint,
    OUT point double precision[],
    OUT anchors bigint[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_nodes'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octree_nodes(regclass) IS
    'the corners of the leaves of a balanced octree, numbered from 0 along the curve; anchors: of one that hangs the 2 or 4 nodes that it lies in the middle of';

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
    'the leaves of an octree, numbered from 0 along the curve, by the numbers of their 4 or 8 corners, x fastest';

CREATE FUNCTION abacus_octree_tetrahedra(octree regclass, OUT element bigint, OUT nodes bigint[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_octree_tetrahedra'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100000 SUPPORT abacus_octant_rows;
COMMENT ON FUNCTION abacus_octree_tetrahedra(regclass) IS
    'a balanced octree as a conforming mesh of tetrahedra, a quadtree as one of triangles, by the numbers of their nodes; element: the leaf that each is of';

-- Asking a mesh.

CREATE FUNCTION abacus_locate(mesh regclass, x double precision, y double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision) IS
    'the triangle that contains a place. NULL outside the mesh. Units: the place in those of the coordinates. Errors: 22023 z missing, or given in the plane; a coordinate that is NaN';

CREATE FUNCTION abacus_locate(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision, double precision) IS
    'the tetrahedron that contains a place. NULL outside the mesh. Units: the place in those of the coordinates. Errors: 22023 z missing, or given in the plane; a coordinate that is NaN';

CREATE FUNCTION abacus_locate(
    mesh regclass,
    query text,
    OUT id bigint,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT labels double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_locate_places'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100000;
COMMENT ON FUNCTION abacus_locate(regclass, text) IS
    'the simplices that contain the places of a query. NULL outside the mesh. Shapes: the query returns id, x, y[, z], or id and a point of PostGIS. Errors: 22023 not a single SELECT, 42804 other columns, 22004 a NULL id or coordinate, 22023 one that is not finite';

CREATE FUNCTION abacus_walk(mesh regclass, simplex abacus_simplex, facet integer)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_walk'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_walk(regclass, abacus_simplex, integer) IS
    'the neighbour of a simplex across one of its facets. Facet i is opposite vertex i, from 0. NULL at the boundary of the mesh. Errors: 22023 no such simplex or facet, or several; 22004 a NULL within the simplex';

CREATE FUNCTION abacus_simplices_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_simplices_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_simplices_rows(internal) IS 'planner support of abacus_simplices';

CREATE FUNCTION abacus_simplices(mesh regclass)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices'
LANGUAGE C STABLE STRICT PARALLEL SAFE ROWS 100000 SUPPORT abacus_simplices_rows;
COMMENT ON FUNCTION abacus_simplices(regclass) IS
    'all simplices of a mesh. They come page by page along the curve. Errors: 42809 not a mesh';

CREATE FUNCTION abacus_vertices_rows(internal) RETURNS internal
AS 'MODULE_PATHNAME', 'abacus_sql_vertices_rows'
LANGUAGE C STRICT;
COMMENT ON FUNCTION abacus_vertices_rows(internal) IS 'planner support of abacus_vertices';

CREATE FUNCTION abacus_attributes(
    mesh regclass,
    OUT "position" integer,
    OUT name text,
    OUT "least" double precision,
    OUT "greatest" double precision,
    OUT nulls bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_attributes'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100000 ROWS 4;
COMMENT ON FUNCTION abacus_attributes(regclass) IS
    'the attributes of a mesh or an octree, with their ranges. Column position is that in abacus_vertices().attributes; least and greatest are over all points; nulls says how many points have none. Units: least and greatest in those of the attribute. Errors: 42809 neither a mesh nor an octree';

CREATE FUNCTION abacus_add_attribute(mesh regclass, attribute text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_add_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_add_attribute(regclass, text) IS
    'gives a mesh one more attribute, which is NULL for all points. It is the last one. abacus_update gives it values. Errors: those of abacus_delete; 42701 there is one already, 42602 a bad name, 54000 more than 1,000';

CREATE FUNCTION abacus_drop_attribute(mesh regclass, attribute text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_drop_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_drop_attribute(regclass, text) IS
    'drops an attribute of a mesh. Those after it move up by one position. Refused while its owner or the caller has published the mesh. Errors: those of abacus_delete; 42703 no such attribute, 2BP01 foreign tables show the mesh';

CREATE FUNCTION abacus_rename_attribute(mesh regclass, attribute text, name text)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_rename_attribute'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_rename_attribute(regclass, text, text) IS
    'renames an attribute of a mesh. Errors: 42703 no such attribute, 42701 the name is taken, 42602 empty or too long';

CREATE FUNCTION abacus_srid(mesh regclass)
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_srid'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_srid(regclass) IS
    'the spatial reference system of a mesh or an octree, as PostGIS numbers it. 0 if it has none. Errors: 42809 neither a mesh nor an octree';

CREATE FUNCTION abacus_set_srid(mesh regclass, srid integer)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_set_srid'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_set_srid(regclass, integer) IS
    'sets the spatial reference system of a mesh or an octree. The coordinates stay as they are. Errors: 22023 below 0 or above 999999, 42501 no privilege';

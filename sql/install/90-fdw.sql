-- A mesh as relations: foreign tables of its cells and its points.

CREATE FUNCTION abacus_fdw_handler()
RETURNS fdw_handler
AS 'MODULE_PATHNAME', 'abacus_sql_fdw_handler'
LANGUAGE C STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_fdw_handler() IS 'handler of the foreign-data wrapper abacus';

CREATE FUNCTION abacus_fdw_validator(options text[], catalog oid)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_fdw_validator'
LANGUAGE C STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_fdw_validator(text[], oid) IS 'validator of the foreign-data wrapper abacus';

CREATE FUNCTION abacus_published(mesh regclass)
RETURNS boolean
AS 'MODULE_PATHNAME', 'abacus_sql_published'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_published(regclass) IS
    'true; a constraint of a foreign table that abacus_publish() has made names the mesh by it';

CREATE FOREIGN DATA WRAPPER abacus HANDLER abacus_fdw_handler VALIDATOR abacus_fdw_validator;
COMMENT ON FOREIGN DATA WRAPPER abacus IS 'cells and points of meshes as rows';

CREATE SERVER abacus FOREIGN DATA WRAPPER abacus;
COMMENT ON SERVER abacus IS 'the meshes of this database';
GRANT USAGE ON FOREIGN SERVER abacus TO PUBLIC;

CREATE FUNCTION abacus_publish(
    mesh regclass,
    cells text DEFAULT NULL,
    points text DEFAULT NULL,
    schema text DEFAULT NULL,
    geometry boolean DEFAULT NULL,
    srid integer DEFAULT NULL,
    z text DEFAULT NULL)
RETURNS regclass[]
AS 'MODULE_PATHNAME', 'abacus_sql_publish'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_publish(regclass, text, text, text, boolean, integer, text) IS
    'makes foreign tables of the cells and of the points of a mesh, <mesh>_cells and <mesh>_points unless other names are given; where PostGIS is installed they have geometries, with an attribute as Z if z names one; columns of attributes that are dropped later cannot be read any more';

CREATE FUNCTION abacus_unpublish(mesh regclass)
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_unpublish'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_unpublish(regclass) IS
    'drops the foreign tables of a mesh that abacus_publish() has made for the caller; returns how many';

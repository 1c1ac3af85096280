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
    'true; a constraint of a foreign table, or a condition of a view, that abacus_publish() has made names the mesh by it';

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
    z text DEFAULT NULL,
    fixed_edges text DEFAULT NULL,
    breaklines text DEFAULT NULL)
RETURNS regclass[]
AS 'MODULE_PATHNAME', 'abacus_sql_publish'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_publish(regclass, text, text, text, boolean, integer, text, text, text) IS
    'makes foreign tables of the cells and the points of a mesh, and in the plane views of its fixed edges and its lines. They are <mesh>_cells, <mesh>_points, <mesh>_fixed_edges and <mesh>_breaklines unless other names are given. Cells of a mesh with regions have the name of theirs. Where PostGIS is installed they have geometries, with the attribute z as Z. Columns of attributes that are dropped later cannot be read any more. A mesh with levels gets a table of the cells of each as well, <mesh>_cells_1 and so on. Views with these names that show the mesh stay as they are. Returns the tables and views. Shapes: an array of the two tables, in the plane of the two views as well, and those of the levels. Errors: 42809 not a mesh, 42703 no such attribute, 55000 geometry without PostGIS, 22023 another srid than the mesh has, or z of a mesh in space, 42P07 a table of that name';

CREATE FUNCTION abacus_unpublish(mesh regclass)
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_unpublish'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_unpublish(regclass) IS
    'drops the foreign tables and views of a mesh, and of its levels, that abacus_publish() has made and that the caller owns. Returns how many. Errors: 42809 not a mesh';

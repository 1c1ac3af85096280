-- Levels of detail: coarser meshes beside a mesh.

CREATE TYPE abacus_level AS (
    level integer, mesh regclass, attribute text, max_error double precision, greatest double precision, stamp bigint);
COMMENT ON TYPE abacus_level IS 'row of the table of the levels of a mesh, which are coarser meshes';
COMMENT ON COLUMN abacus_level.level IS 'its number from 1, the finest';
COMMENT ON COLUMN abacus_level.mesh IS 'the coarser mesh';
COMMENT ON COLUMN abacus_level.attribute IS 'the attribute that is the surface';
COMMENT ON COLUMN abacus_level.max_error IS 'the error that was allowed';
COMMENT ON COLUMN abacus_level.greatest IS 'greatest error of all vertices of the full mesh that were left out';
COMMENT ON COLUMN abacus_level.stamp IS 'number of the full mesh''s last change before';

CREATE FUNCTION abacus_levels(
    mesh regclass,
    errors double precision[],
    attribute text DEFAULT NULL,
    OUT level integer,
    OUT level_mesh regclass,
    OUT error double precision,
    OUT vertices bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_levels'
LANGUAGE C VOLATILE PARALLEL UNSAFE ROWS 8;
COMMENT ON FUNCTION abacus_levels(regclass, double precision[], text) IS
    'makes levels of detail of a mesh: for each error a coarser mesh beside it, <mesh>_level_1 and so on, as abacus_thin makes them of the full mesh. The table <mesh>_levels lists them. They go when the mesh is dropped. Returns the number of each level, its mesh, its greatest error and how many vertices it has. Shapes: errors is an array of errors that increase. Units: errors in those of the attribute. Errors: those of abacus_thin; 22004 NULL, 22023 errors that are negative, not finite or do not increase, or none; 42501 not the owner, 42P07 levels or a mesh of that name already there';

CREATE FUNCTION abacus_levels_refresh(
    mesh regclass,
    OUT level integer,
    OUT level_mesh regclass,
    OUT error double precision,
    OUT vertices bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_levels_refresh'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE ROWS 8;
COMMENT ON FUNCTION abacus_levels_refresh(regclass) IS
    'makes the levels of a mesh anew, with the same errors, from the mesh as it is now. Until the commit others read the former ones. The meshes stay, with their privileges and published tables; they are then those that abacus_levels would make. Returns the same as abacus_levels. Shapes: a row for each level. Units: error in those of the attribute. Errors: those of abacus_thin; 42501 not the owner, or no right to make temporary tables; 55000 no levels, 42P01 a level was dropped';

CREATE FUNCTION abacus_levels_drop(mesh regclass)
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_levels_drop'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_levels_drop(regclass) IS
    'drops the levels of a mesh and their table. Returns how many levels. Errors: 42501 not the owner, 55000 no levels, 2BP01 other objects depend on a level';

CREATE FUNCTION abacus_level(mesh regclass, max_error double precision)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_level'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION abacus_level(regclass, double precision) IS
    'the coarsest level of a mesh whose greatest error is at most max_error, or the mesh itself if there is none. Units: max_error in those of the attribute. Errors: 22023 a max_error that is negative or NaN, 55000 no levels, 42P01 the level was dropped';

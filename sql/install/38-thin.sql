-- Thinning a mesh to a stated error.

CREATE TYPE abacus_thinning AS (
    mesh text, stamp bigint, attribute text, max_error double precision, keep text, target bigint,
    greatest double precision, reached bigint);
COMMENT ON TYPE abacus_thinning IS 'row of the table that says how a mesh was thinned';
COMMENT ON COLUMN abacus_thinning.mesh IS 'the mesh that it was thinned from';
COMMENT ON COLUMN abacus_thinning.stamp IS 'number of that mesh''s last change before';
COMMENT ON COLUMN abacus_thinning.attribute IS 'the attribute that is the surface';
COMMENT ON COLUMN abacus_thinning.max_error IS 'the error that was allowed';
COMMENT ON COLUMN abacus_thinning.keep IS 'what was kept on wish';
COMMENT ON COLUMN abacus_thinning.target IS 'vertices at most; NULL: any number';
COMMENT ON COLUMN abacus_thinning.greatest IS 'greatest error of all vertices that were left out; NULL until the mesh is done';
COMMENT ON COLUMN abacus_thinning.reached IS 'number of the thinned mesh''s last change, until it is done: whether others have changed it since its last round';

CREATE FUNCTION abacus_thin(
    mesh regclass,
    new_mesh text,
    max_error double precision,
    attribute text DEFAULT NULL,
    keep text DEFAULT NULL,
    target bigint DEFAULT NULL)
RETURNS double precision
AS 'MODULE_PATHNAME', 'abacus_sql_thin'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_thin(regclass, text, double precision, text, text, bigint) IS
    'makes a mesh of some vertices of another one, such that every vertex left out is within max_error of the new surface. The new mesh is the Delaunay triangulation of the vertices that are kept, with the lines of the other one if it has any. It begins with the corners of the hull, and grows by rounds, in which the worst vertex of each simplex comes in. keep names what must stay: border, lines, border and lines, none, or a query of ids. With target the new mesh stops at so many vertices, whatever the error. Returns the greatest error, infinite beyond the range of doubles, which the table <new_mesh>_thinning keeps. Vertices without a value are left out, and labels, markers and regions do not come along, with a NOTICE; a mesh with holes gives one without, with a WARNING. Shapes: keep, if it is a query, returns ids of vertices. Units: max_error and the result in those of the attribute. Errors: those of abacus_create; 22004 NULL, 22023 an error that is negative or not finite, a target below 1, vertices with values that span no simplex, an unknown word in keep; 42703 no such attribute, 55000 a mesh without simplices, without attributes, with several vertices at one place or not finished by abacus_thin_build, a vertex of a line without a value; 42804 other columns. Source: M. Garland and P. Heckbert, Fast Polygonal Approximation of Terrains and Height Fields (1995)';

CREATE PROCEDURE abacus_thin_build(
    mesh regclass,
    new_mesh text,
    max_error double precision,
    attribute text DEFAULT NULL,
    keep text DEFAULT NULL,
    target bigint DEFAULT NULL)
AS 'MODULE_PATHNAME', 'abacus_sql_thin_build'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_thin_build(regclass, text, double precision, text, text, bigint) IS
    'does what abacus_thin does, and commits after each round. Called again with the same arguments after a failure, it goes on from the last round. The new mesh is the same. Until it is done, its row in <new_mesh>_thinning has no greatest error. Shapes: keep, if it is a query, returns ids of vertices. Units: max_error in those of the attribute. Errors: those of abacus_thin; 2D000 where it cannot commit, 55000 one of the two meshes was changed meanwhile';

-- A mesh that follows a table.

CREATE FUNCTION abacus_tracked()
RETURNS trigger
AS 'MODULE_PATHNAME', 'abacus_sql_tracked'
LANGUAGE C;
COMMENT ON FUNCTION abacus_tracked() IS
    'trigger that keeps a mesh in step with a table; made by abacus_track()';

CREATE FUNCTION abacus_track(
    mesh regclass,
    "table" regclass,
    columns text[] DEFAULT NULL,
    synchronize boolean DEFAULT false,
    deferred boolean DEFAULT false)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_track'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_track(regclass, regclass, text[], boolean, boolean) IS
    'keeps a mesh in step with a table from now on, by triggers. An empty mesh gets the rows of the table; another must have them or, with synchronize, is made equal. With deferred, the mesh is changed once, at commit. Meanwhile its points and attributes cannot be changed by hand. Returns the number of points in the mesh. Shapes: columns names id, x, y[, z] and the attributes, or id, a geometry and the attributes. Errors: 42809 what cannot be followed, 42501 not the table''s owner, 55000 the mesh differs from the table, 25001 not READ COMMITTED, 0A000 row-level security or a virtual column, 42703 no such column';

CREATE FUNCTION abacus_untrack(mesh regclass, "table" regclass)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_untrack'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_untrack(regclass, regclass) IS
    'ends abacus_track: drops its triggers. The owner of the table or of the mesh may call it. The mesh stays as it is, and can be changed by hand again. Errors: 42704 the mesh does not follow the table, 42501 neither is the caller''s';

CREATE FUNCTION abacus_tracked_lines()
RETURNS trigger
AS 'MODULE_PATHNAME', 'abacus_sql_tracked_lines'
LANGUAGE C;
COMMENT ON FUNCTION abacus_tracked_lines() IS
    'trigger that keeps a mesh in step with a table of lines; made by abacus_track_lines()';

CREATE FUNCTION abacus_track_lines(
    mesh regclass,
    "table" regclass,
    columns text[] DEFAULT NULL,
    kind text DEFAULT 'hard',
    z text DEFAULT NULL,
    synchronize boolean DEFAULT false)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_track_lines'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_track_lines(regclass, regclass, text[], text, text, boolean) IS
    'keeps the fixed edges of a mesh in step with a table of lines from now on, by triggers, at commit. A mesh without lines gets those of the table; another must have them or, with synchronize, gets the lines that differ. Meanwhile its lines cannot be changed by hand. A corner of a geometry where the mesh has no point becomes a vertex, with a negative id, as long as a line has it. Returns the number of lines. Shapes: columns names line and a geometry of PostGIS, whose Z becomes the attribute z, or line, position, point[, part], where points are ids of the table that the mesh follows, or else of the mesh; kind is hard, soft, or the column that says it. Errors: those of abacus_track and abacus_constrain, when the mesh catches up';

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
    'keeps the mesh in step with the table from now on, by triggers; columns: names of id, x, y[, z][, attribute...]; an empty mesh gets the rows of the table, another must have them or, with synchronize, is made equal; deferred: the mesh is changed once, at commit; its points and attributes cannot be changed by hand meanwhile; returns the number of points in the mesh';

CREATE FUNCTION abacus_untrack(mesh regclass, "table" regclass)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_untrack'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_untrack(regclass, regclass) IS
    'ends abacus_track(): drops its triggers, for the owner of the table or of the mesh; the mesh stays as it is, and can be changed by hand again';

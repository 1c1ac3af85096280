\echo Use "CREATE EXTENSION abacus" to load this file. \quit
-- Pages: a base type for their bytes and the row types of the two tables of a mesh.

CREATE TYPE abacus_page;

CREATE FUNCTION abacus_page_in(cstring) RETURNS abacus_page
AS 'MODULE_PATHNAME', 'abacus_sql_page_in'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_in(cstring) IS 'I/O';

CREATE FUNCTION abacus_page_out(abacus_page) RETURNS cstring
AS 'MODULE_PATHNAME', 'abacus_sql_page_out'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_out(abacus_page) IS 'I/O';

CREATE FUNCTION abacus_page_recv(internal) RETURNS abacus_page
AS 'MODULE_PATHNAME', 'abacus_sql_page_recv'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_recv(internal) IS 'I/O';

CREATE FUNCTION abacus_page_send(abacus_page) RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_page_send'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_send(abacus_page) IS 'I/O';

CREATE TYPE abacus_page (
    INPUT = abacus_page_in,
    OUTPUT = abacus_page_out,
    RECEIVE = abacus_page_recv,
    SEND = abacus_page_send,
    INTERNALLENGTH = VARIABLE,
    ALIGNMENT = double,
    STORAGE = plain
);
COMMENT ON TYPE abacus_page IS 'bytes of one page of a mesh, written and read by Abacus';

CREATE FUNCTION abacus_page_from_bytea(bytea) RETURNS abacus_page
AS 'MODULE_PATHNAME', 'abacus_sql_page_from_bytea'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_from_bytea(bytea) IS 'cast from bytea';

CREATE FUNCTION abacus_page_to_bytea(abacus_page) RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_page_to_bytea'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION abacus_page_to_bytea(abacus_page) IS 'cast to bytea';

CREATE CAST (bytea AS abacus_page) WITH FUNCTION abacus_page_from_bytea(bytea);
COMMENT ON CAST (bytea AS abacus_page) IS 'takes any bytes; Abacus checks them when it reads them';

CREATE CAST (abacus_page AS bytea) WITH FUNCTION abacus_page_to_bytea(abacus_page);
COMMENT ON CAST (abacus_page AS bytea) IS 'bytes of the page';

CREATE TYPE abacus_simplex_page AS (code bigint, part bigint, page abacus_page);
COMMENT ON TYPE abacus_simplex_page IS
    'row of a mesh: a page of simplices, keyed by the start of its interval of the curve; (-1, 0) is the header';
COMMENT ON COLUMN abacus_simplex_page.code IS 'locational code, lower end of the page''s interval';
COMMENT ON COLUMN abacus_simplex_page.part IS 'continues the code where more simplices than fit a page share one';
COMMENT ON COLUMN abacus_simplex_page.page IS 'the page';

CREATE TYPE abacus_vertex_page AS (first bigint, page abacus_page);
COMMENT ON TYPE abacus_vertex_page IS 'row of the vertex table of a mesh: a page of staged points';
COMMENT ON COLUMN abacus_vertex_page.first IS 'sequence number of the page''s first point';
COMMENT ON COLUMN abacus_vertex_page.page IS 'the page';
-- The simplex as SQL sees it.

CREATE TYPE abacus_simplex AS (code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint);
COMMENT ON TYPE abacus_simplex IS
    'triangle (counterclockwise) or tetrahedron (right hand around v0, v1, v2, thumb to v3): ids of its vertices; facet i is opposite vertex i';
COMMENT ON COLUMN abacus_simplex.code IS 'locational code, by which the simplex is found again';
COMMENT ON COLUMN abacus_simplex.v0 IS 'id of vertex 0';
COMMENT ON COLUMN abacus_simplex.v1 IS 'id of vertex 1';
COMMENT ON COLUMN abacus_simplex.v2 IS 'id of vertex 2';
COMMENT ON COLUMN abacus_simplex.v3 IS 'id of vertex 3; NULL in two dimensions';
-- Making a mesh.

CREATE FUNCTION abacus_create(
    mesh text,
    dimension integer,
    attributes text[] DEFAULT '{}',
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_create'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_create(text, integer, text[], double precision[], double precision[]) IS
    'makes an empty mesh: the table of this name and <name>_vertices; without lower and upper the domain comes from the first points';

CREATE FUNCTION abacus_stage(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_stage'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_stage(regclass, text) IS
    'stages the points of a query (id, x, y[, z][, attribute...]) for triangulation; returns how many';

CREATE FUNCTION abacus_triangulate(mesh regclass)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(regclass) IS
    'inserts all staged points into the Delaunay triangulation; returns the number of simplices';

CREATE FUNCTION abacus_triangulate(
    mesh text,
    query text,
    attributes text[] DEFAULT NULL,
    dimension integer DEFAULT 2,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_triangulate_query'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_triangulate(text, text, text[], integer, double precision[], double precision[]) IS
    'makes a mesh, stages the points of the query and triangulates them; attributes are named after the query''s columns unless given';

CREATE PROCEDURE abacus_build(mesh regclass, batch bigint DEFAULT 1000000)
AS 'MODULE_PATHNAME', 'abacus_sql_build'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_build(regclass, bigint) IS
    'inserts all staged points into the Delaunay triangulation and commits after each batch of that many; called again after a failure, it goes on from the last batch';
-- Asking a mesh.

CREATE FUNCTION abacus_locate(mesh regclass, x double precision, y double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision) IS
    'the triangle of a mesh of dimension 2 that contains the point; NULL outside the convex hull';

CREATE FUNCTION abacus_locate(
    mesh regclass,
    x double precision,
    y double precision,
    z double precision)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_locate'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_locate(regclass, double precision, double precision, double precision) IS
    'the tetrahedron of a mesh of dimension 3 that contains the point; NULL outside the convex hull';

CREATE FUNCTION abacus_walk(mesh regclass, simplex abacus_simplex, facet integer)
RETURNS abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_walk'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_walk(regclass, abacus_simplex, integer) IS
    'the neighbour of a simplex across its facet opposite vertex i; NULL at the convex hull';

CREATE FUNCTION abacus_simplices(mesh regclass)
RETURNS SETOF abacus_simplex
AS 'MODULE_PATHNAME', 'abacus_sql_simplices'
LANGUAGE C STABLE STRICT PARALLEL RESTRICTED ROWS 100000;
COMMENT ON FUNCTION abacus_simplices(regclass) IS
    'all simplices, page by page along the curve';

CREATE FUNCTION abacus_vertices(
    mesh regclass,
    OUT sequence bigint,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[],
    OUT vertex bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_vertices'
LANGUAGE C STABLE STRICT PARALLEL RESTRICTED ROWS 100000;
COMMENT ON FUNCTION abacus_vertices(regclass) IS
    'all staged points in insertion order; vertex is the id of the vertex that stands for the point (its own unless an equal point came first), NULL before triangulation';
-- Verifying a mesh and its figures.

CREATE FUNCTION abacus_check(
    mesh regclass,
    max_faults integer DEFAULT 1000,
    OUT fault text,
    OUT code bigint,
    OUT part bigint,
    OUT message text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_check'
LANGUAGE C STABLE STRICT PARALLEL RESTRICTED ROWS 1;
COMMENT ON FUNCTION abacus_check(regclass, integer) IS
    'verifies the mesh exactly and returns its faults: no row if it is sound';

CREATE FUNCTION abacus_stats(
    mesh regclass,
    OUT name text,
    OUT value double precision,
    OUT description text)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_stats'
LANGUAGE C VOLATILE STRICT PARALLEL RESTRICTED ROWS 40;
COMMENT ON FUNCTION abacus_stats(regclass) IS
    'counts, sizes and counters of a mesh; session_... are those of this session''s own reading';
-- Pictures.

CREATE FUNCTION abacus_draw(
    mesh regclass,
    width integer DEFAULT 1024,
    height integer DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    attribute text DEFAULT NULL,
    edges boolean DEFAULT true,
    exaggeration double precision DEFAULT 0,
    max_edge double precision DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw'
LANGUAGE C STABLE PARALLEL RESTRICTED COST 1000000;
COMMENT ON FUNCTION abacus_draw(regclass, integer, integer, double precision[], double precision[], text, boolean, double precision, double precision) IS
    'a PNG of the mesh, or of the window from lower to upper; an attribute gives colour and, with exaggeration above 0, hill shading';

CREATE FUNCTION abacus_draw_section(
    mesh regclass,
    through double precision[],
    normal double precision[],
    width integer DEFAULT 1024,
    height integer DEFAULT NULL,
    attribute text DEFAULT NULL,
    edges boolean DEFAULT true,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    exaggeration double precision DEFAULT 1,
    max_edge double precision DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw_section'
LANGUAGE C STABLE PARALLEL RESTRICTED COST 1000000;
COMMENT ON FUNCTION abacus_draw_section(regclass, double precision[], double precision[], integer, integer, text, boolean, double precision[], double precision[], double precision, double precision) IS
    'a PNG of the section of a mesh of dimension 3 by the plane through a point with a normal, or of its part within the box from lower to upper; an attribute gives colour; heights are multiplied by exaggeration';
-- Points of the earthquake data sets.

CREATE FUNCTION abacus_quake(
    frequency double precision,
    points_per_wavelength double precision DEFAULT 8,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT vs double precision,
    OUT vp double precision,
    OUT density double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_quake'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE ROWS 1000000;
COMMENT ON FUNCTION abacus_quake(double precision, double precision) IS
    'corners of an octree over a basin of 100 km x 100 km x 37.5 km that resolves seismic waves of a frequency (Hz), in Z-order, with the ground there (m, m/s, kg/m3); in a select list they stream';
CREATE FUNCTION abacus_version()
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_version'
LANGUAGE C IMMUTABLE PARALLEL SAFE;
COMMENT ON FUNCTION abacus_version() IS 'version of the loaded module';
-- Live figures of the builds that run in any session.
--
-- The slots are those that src/pg/progress.c fills. Like the progress views
-- of PostgreSQL it shows figures of other users' sessions only to members of
-- pg_read_all_stats.

CREATE VIEW abacus_progress AS
WITH build AS (
    SELECT s.pid,
           CASE WHEN s.datid = d.oid THEN s.relid END AS relid,
           s.param11 AS phase,
           s.param13 AS done,
           nullif(s.param12, 0) AS total,
           extract(epoch FROM clock_timestamp()) - 946684800 - s.param18 / 1e6 AS phase_seconds,
           extract(epoch FROM clock_timestamp()) - 946684800 - s.param19 / 1e6 AS seconds,
           s.param2 AS pages_read,
           s.param3 AS pages_written
    FROM pg_catalog.pg_stat_get_progress_info('CREATE INDEX') AS s,
         pg_catalog.pg_database AS d
    WHERE d.datname = current_database()
      AND s.param20 = 107075168597363 -- 0x616261637573, "abacus"
)
SELECT pid,
       relid::regclass AS mesh,
       CASE phase
           WHEN 0 THEN 'starting'
           WHEN 1 THEN 'reading'
           WHEN 2 THEN 'sorting'
           WHEN 3 THEN 'staging'
           WHEN 4 THEN 'inserting'
           WHEN 5 THEN 'flushing'
           WHEN 6 THEN 'checking'
       END AS phase,
       done,
       total,
       (done / nullif(phase_seconds, 0))::double precision AS per_second,
       make_interval(secs => ((total - done) * phase_seconds / nullif(done, 0))::double precision)
           AS time_left,
       make_interval(secs => seconds::double precision) AS elapsed,
       pages_read,
       pages_written
FROM build;
COMMENT ON VIEW abacus_progress IS 'live figures of the builds and checks that run in any session';
COMMENT ON COLUMN abacus_progress.pid IS 'process id of the session';
COMMENT ON COLUMN abacus_progress.mesh IS 'the mesh; a number while its creation is not committed, NULL in another database';
COMMENT ON COLUMN abacus_progress.phase IS 'starting, reading, sorting, staging, inserting, flushing or checking';
COMMENT ON COLUMN abacus_progress.done IS 'points (checking: pages) done in this phase';
COMMENT ON COLUMN abacus_progress.total IS 'of how many; NULL if not known';
COMMENT ON COLUMN abacus_progress.per_second IS 'mean rate in this phase';
COMMENT ON COLUMN abacus_progress.time_left IS 'in this phase, at that rate';
COMMENT ON COLUMN abacus_progress.elapsed IS 'since the function began';
COMMENT ON COLUMN abacus_progress.pages_read IS 'pages read back into the cache';
COMMENT ON COLUMN abacus_progress.pages_written IS 'pages written';
GRANT SELECT ON abacus_progress TO PUBLIC;

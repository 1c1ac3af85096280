-- One mesh over several servers.

CREATE TYPE abacus_shard_generation AS (
    generation bigint,
    phase text,
    source text,
    token text,
    servers text[],
    dimension integer,
    attributes text[],
    lower double precision[],
    upper double precision[],
    "least" double precision[],
    "greatest" double precision[],
    borders bigint[],
    points bigint,
    rounds integer,
    sent bigint,
    simplices bigint,
    names_given boolean,
    domain_given boolean,
    srid integer,
    versions bigint[]);
COMMENT ON TYPE abacus_shard_generation IS
    'row of the coordinator''s table of a mesh over several servers: what one build has made of it; readers see the newest row whose phase is published';
COMMENT ON COLUMN abacus_shard_generation.generation IS 'number of the build, from 0';
COMMENT ON COLUMN abacus_shard_generation.phase IS 'how far it is: new, spread, triangulated or published';
COMMENT ON COLUMN abacus_shard_generation.source IS 'digest of its queries: a call with the same ones goes on';
COMMENT ON COLUMN abacus_shard_generation.token IS 'part of the names of its meshes on the servers';
COMMENT ON COLUMN abacus_shard_generation.servers IS 'foreign servers, one for each shard';
COMMENT ON COLUMN abacus_shard_generation.dimension IS '2 or 3';
COMMENT ON COLUMN abacus_shard_generation.attributes IS 'names of the attributes';
COMMENT ON COLUMN abacus_shard_generation.lower IS 'lower corner of the domain';
COMMENT ON COLUMN abacus_shard_generation.upper IS 'upper corner of the domain';
COMMENT ON COLUMN abacus_shard_generation."least" IS 'least coordinates of all points';
COMMENT ON COLUMN abacus_shard_generation."greatest" IS 'greatest coordinates of all points';
COMMENT ON COLUMN abacus_shard_generation.borders IS 'locational codes at which the next shard begins';
COMMENT ON COLUMN abacus_shard_generation.points IS 'points of all shards';
COMMENT ON COLUMN abacus_shard_generation.rounds IS 'rounds of the exchange in which vertices were sent, and the last one, in which none were';
COMMENT ON COLUMN abacus_shard_generation.sent IS 'vertices that shards have sent each other';
COMMENT ON COLUMN abacus_shard_generation.simplices IS 'simplices of the mesh';
COMMENT ON COLUMN abacus_shard_generation.names_given IS 'whether the names were given when the mesh was created';
COMMENT ON COLUMN abacus_shard_generation.domain_given IS 'whether the domain was given when the mesh was created';
COMMENT ON COLUMN abacus_shard_generation.srid IS 'spatial reference system of the points; 0: not known';
COMMENT ON COLUMN abacus_shard_generation.versions IS 'how many changes of the published mesh each shard has had';

CREATE FUNCTION abacus_shard_create(
    mesh text,
    servers text[],
    dimension integer DEFAULT 2,
    attributes text[] DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_shard_create'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_create(text, text[], integer, text[], double precision[], double precision[]) IS
    'makes a mesh over several servers, without points: a table of this name, which knows its servers. They are reached over foreign servers of postgres_fdw or dblink and user mappings of the caller. Attributes are named after the columns of the query unless names are given. Shapes: servers has a foreign server for each shard; lower and upper are {x, y}, in space {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 42P07 the name is taken, 42704 no such server, 42501 no privilege, 42809 a foreign server of another wrapper, 55000 a server without abacus, 08001 no connection, 2F003 a password is missing, 22023 a bad dimension or domain';

CREATE PROCEDURE abacus_shard_build(mesh regclass, query text)
AS 'MODULE_PATHNAME', 'abacus_sql_shard_build'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_shard_build(regclass, text) IS
    'triangulates the points of a query over the servers of a mesh. Commits after each phase; called again after a failure, it goes on. Readers see the former points until it ends. Shapes: the query returns id, x, y[, z] and the attributes, by position; it is run twice. Errors: those of abacus_triangulate; 42809 not a mesh over several servers, 42501 not its owner, 2D000 where it cannot commit, 08000 a connection is lost; errors of a server as it reports them';

CREATE PROCEDURE abacus_shard_build(mesh regclass, queries text[])
AS 'MODULE_PATHNAME', 'abacus_sql_shard_build_each'
LANGUAGE C;
COMMENT ON PROCEDURE abacus_shard_build(regclass, text[]) IS
    'the same with a query for each server, which is run there. Of equal points the first is the vertex, in the order of the queries. Shapes: as many queries as servers, each as above, with the same columns; each is run once. Errors: as above; 22023 another number of queries or another SRID, 42804 other columns';

CREATE FUNCTION abacus_shard_drop(mesh regclass)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_shard_drop'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_drop(regclass) IS
    'drops a mesh over several servers, with its tables there: they go when the transaction commits. A warning names those that remain, because a server cannot be reached then. Errors: 42809 not a mesh over several servers, 42501 not its owner, 08001 no connection, 0A000 in a savepoint after another one, or before PREPARE TRANSACTION';

CREATE FUNCTION abacus_shard_resolve(mesh regclass)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_shard_resolve'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 100000;
COMMENT ON FUNCTION abacus_shard_resolve(regclass) IS
    'ends changes of a mesh over several servers that a failure has left prepared on its servers, and returns how many there were. They are committed if the transaction on the coordinator was, else rolled back; those of transactions in progress are left alone. Errors: 42809 not a mesh over several servers, 42501 no privilege, also of the user of the user mapping, who must be the one of the change or a superuser, 08001 no connection';

CREATE FUNCTION abacus_shards(
    mesh regclass,
    OUT shard integer,
    OUT server text,
    OUT shard_mesh text,
    OUT "first" bigint,
    OUT "end" bigint,
    OUT state text,
    OUT doing text,
    OUT points bigint,
    OUT guests bigint,
    OUT bytes bigint)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shards'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 100000 ROWS 4;
COMMENT ON FUNCTION abacus_shards(regclass) IS
    'the shards of a mesh over several servers, of its newest build. Column shard_mesh is the mesh on the server; first and "end" are the codes that the shard owns, the latter excluded; state is the phase of the build, or absent; doing is what a change of the mesh does now, or the name under which one is prepared, which keeps others waiting; guests are vertices of other shards. Units: bytes of all tables there. Errors: 42809 not a mesh over several servers';

-- What the coordinator calls on the servers.

CREATE FUNCTION abacus_shard_survey(
    query text,
    dimension integer,
    own integer,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    OUT points bigint,
    OUT attributes text[],
    OUT "least" double precision[],
    OUT "greatest" double precision[],
    OUT srid integer,
    OUT sample double precision[])
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_survey'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_survey(text, integer, integer, double precision[], double precision[]) IS
    'for the coordinator of a mesh over several servers: how many points a query has, in which box, the names of their attributes, their SRID, and a sample. The rows are kept in a temporary table of the coordinator, abacus_points. Shapes: the query as of abacus_stage; sample has the coordinates of its points, one after the other. Units: those of the coordinates. Errors: those of abacus_stage; 42P01 no such table';

CREATE FUNCTION abacus_shard_split(
    attributes integer,
    lower double precision[],
    upper double precision[],
    borders bigint[],
    own integer)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_shard_split'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_split(integer, double precision[], double precision[], bigint[], integer) IS
    'for the coordinator of a mesh over several servers: sorts out the kept points that other shards own, and returns how many these are. Shapes: attributes is their number; lower and upper are {x, y}, in space {x, y, z}; borders are codes that ascend. Units: those of the coordinates. Errors: 42P01 no points are kept, 22023 a bad array, XX001 bytes that cannot be points';

CREATE FUNCTION abacus_shard_stage(
    mesh regclass,
    borders bigint[],
    own integer,
    "least" double precision[],
    "greatest" double precision[])
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_shard_stage'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_stage(regclass, bigint[], integer, double precision[], double precision[]) IS
    'for the coordinator of a mesh over several servers: stages those of the kept points that a shard owns, in the order of the queries, and returns how many these are. Shapes: borders are codes that ascend; least and greatest are corners of a box around all points. Units: those of the coordinates. Errors: 42P01 no points are kept, 22023 a point outside that box, XX001 bytes that cannot be points, or a point of another shard';

CREATE FUNCTION abacus_shard_owner(
    lower double precision[],
    upper double precision[],
    borders bigint[],
    place double precision[])
RETURNS integer
AS 'MODULE_PATHNAME', 'abacus_sql_shard_owner'
LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION abacus_shard_owner(double precision[], double precision[], bigint[], double precision[]) IS
    'for the coordinator of a mesh over several servers: which shard owns a place, from 0. Shapes: lower, upper and place are {x, y}, in space {x, y, z}. Units: those of the coordinates. Errors: 22023 a coordinate that is not finite, or a bad array';

CREATE FUNCTION abacus_shard_begin(
    mesh text,
    dimension integer,
    attributes text[],
    lower double precision[],
    upper double precision[],
    srid integer DEFAULT 0)
RETURNS regclass
AS 'MODULE_PATHNAME', 'abacus_sql_shard_begin'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_begin(text, integer, text[], double precision[], double precision[], integer) IS
    'for the coordinator of a mesh over several servers: makes the mesh of a shard, as abacus_create does, over the domain of all shards. It may be flat. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: those of the coordinates. Errors: those of abacus_create';

CREATE FUNCTION abacus_shard_take(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_shard_take'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_shard_take(regclass, text) IS
    'for the coordinator of a mesh over several servers: inserts points, as abacus_insert does, and keeps the domain. Returns how many the query gave. Shapes: the query as of abacus_insert. Errors: those of abacus_insert';

CREATE FUNCTION abacus_shard_exports(
    mesh regclass,
    borders bigint[],
    own integer,
    "least" double precision[],
    "greatest" double precision[],
    OUT shard integer,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_exports'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100000 ROWS 10000;
COMMENT ON FUNCTION abacus_shard_exports(regclass, bigint[], integer, double precision[], double precision[]) IS
    'for the coordinator of a mesh over several servers: the vertices of a shard that other shards need, and which shard. A vertex may come several times. Shapes: borders are codes that ascend; least and greatest are corners of a box around all points. Units: those of the coordinates. Errors: 22023 a point outside that box, or bad borders';

CREATE FUNCTION abacus_shard_exports_around(
    mesh regclass,
    borders bigint[],
    own integer,
    "least" double precision[],
    "greatest" double precision[],
    query text,
    OUT shard integer,
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT attributes double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_exports_around'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100;
COMMENT ON FUNCTION abacus_shard_exports_around(regclass, bigint[], integer, double precision[], double precision[], text) IS
    'for the coordinator of a mesh over several servers: of the vertices of a shard that other shards need, those that simplices around some vertices call for. Shapes: the query returns id, x, y[, z] of these, by position. Units: those of the coordinates. Errors: as of abacus_shard_exports';

CREATE FUNCTION abacus_shard_change(
    mesh regclass,
    query text,
    how text,
    "first" bigint,
    "last" bigint,
    with_simplices boolean,
    OUT created boolean,
    OUT code bigint,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT v3 bigint,
    OUT corners double precision[],
    OUT points bigint,
    OUT more bigint,
    OUT duplicates bigint,
    OUT gained bigint,
    OUT is_all_new boolean)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_change'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE COST 1000 ROWS 100;
COMMENT ON FUNCTION abacus_shard_change(regclass, text, text, bigint, bigint, boolean) IS
    'for the coordinator of a mesh over several servers: inserts points into a shard, or deletes them, and keeps the domain. The last row has what happened: points of the query or deleted, points and duplicates more than before, simplices gained with codes from the first to the last, and whether the shard had no simplices before or has none now. With with_simplices, rows before it are the simplices created and removed. Shapes: the query as of abacus_insert; how is delete or, of abacus_insert, keep, replace or error; corners as of abacus_insert_returning. Errors: those of abacus_insert and abacus_delete';

CREATE FUNCTION abacus_shard_settled(
    mesh regclass,
    "first" bigint,
    "last" bigint,
    ids bigint[],
    places double precision[],
    OUT id bigint,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_settled'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 1000;
COMMENT ON FUNCTION abacus_shard_settled(regclass, bigint, bigint, bigint[], double precision[]) IS
    'for the coordinator of a mesh over several servers: those of the places whose simplices a shard knows as they are in the whole mesh. Shapes: places has the coordinates of one place after the other. Units: those of the coordinates. Errors: 22023 arrays of other lengths';

CREATE FUNCTION abacus_shard_count(
    mesh regclass,
    borders bigint[],
    own integer,
    "least" double precision[],
    "greatest" double precision[])
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_shard_count'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_shard_count(regclass, bigint[], integer, double precision[], double precision[]) IS
    'for the coordinator of a mesh over several servers: how many simplices a shard owns. Shapes: borders are codes that ascend; least and greatest are corners of a box around all points. Units: those of the coordinates. Errors: 22023 a point outside that box, or bad borders';

CREATE FUNCTION abacus_shard_pages(
    mesh regclass,
    kind integer,
    "first" bigint,
    "last" bigint,
    from_code bigint,
    from_part bigint,
    bytes integer,
    OUT code bigint,
    OUT part bigint,
    OUT page bytea)
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_pages'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 1000 ROWS 10;
COMMENT ON FUNCTION abacus_shard_pages(regclass, integer, bigint, bigint, bigint, bigint, integer) IS
    'for the coordinator of a mesh over several servers: what a shard has of the mesh of all shards, as pages of about so many bytes, one at least. Shapes: kind is 0 for simplices and 3 for attributes that are apart; the shard owns the codes from first to last; the first page is the one that owns the key (from_code, from_part). The last row has no page, but the key at which the pages end. Units: bytes. Errors: 22023 another kind or a negative code, 42809 not a mesh';

CREATE FUNCTION abacus_shard_facts(
    mesh regclass,
    "first" bigint,
    "last" bigint,
    OUT simplices bigint,
    OUT ghosts bigint,
    OUT vertices bigint,
    OUT stamp bigint)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_shard_facts'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION abacus_shard_facts(regclass, bigint, bigint) IS
    'for the coordinator of a mesh over several servers: what a shard owns, counted. Shapes: simplices and ghosts (facets of the hull) have codes from first to last; vertices are those of the mesh of the shard, with those that others own; stamp is that of its state. Errors: 42809 not a mesh';

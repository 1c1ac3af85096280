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
    'row of a mesh: a page of simplices, keyed by the start of its interval of the curve; (-1, 0) is the header, and those from (-1, 1) on have its names, if there are very many; where code is less, a page of attributes of vertices that are apart from the simplices, of labels of simplices or of markers of their facets';
COMMENT ON COLUMN abacus_simplex_page.code IS
    'locational code, lower end of the page''s interval; of attributes their group and the code''s upper bits, less 2^63';
COMMENT ON COLUMN abacus_simplex_page.part IS
    'continues the code where more simplices than fit a page share one; of attributes the code''s lower bits and a hash';
COMMENT ON COLUMN abacus_simplex_page.page IS 'the page';

CREATE TYPE abacus_vertex_page AS (first bigint, part bigint, page abacus_page);
COMMENT ON TYPE abacus_vertex_page IS
    'row of the vertex table of a mesh: a page of points that wait to be inserted (of a mesh that is not Delaunay, of its vertices), or, where first is negative, of points equal to a vertex';
COMMENT ON COLUMN abacus_vertex_page.first IS
    'sequence number of the page''s first point; of points equal to a vertex the locational code, less 2^63';
COMMENT ON COLUMN abacus_vertex_page.part IS 'continues the code: serial number of a point; 0 where points wait';
COMMENT ON COLUMN abacus_vertex_page.page IS 'the page';

-- Meshes made elsewhere, labels of simplices, markers of facets.

CREATE FUNCTION abacus_load(
    mesh text,
    vertices text,
    simplices text,
    attributes text[] DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    reorient boolean DEFAULT true,
    retriangulate boolean DEFAULT false,
    labels text[] DEFAULT NULL,
    facets text DEFAULT NULL,
    split_nodes boolean DEFAULT false)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_load'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_load(text, text, text, text[], double precision[], double precision[], boolean, boolean, text[], text, boolean) IS
    'makes a mesh of a triangulation made elsewhere, Delaunay or not, from queries for vertices (id, x, y[, z][, attribute...]) and simplices (v0, v1, v2[, v3][, label...]), and for markers of facets (v0, v1[, v2], marker); checks it exactly, triangulates its vertices anew if that is wanted and it is not Abacus'' own, keeps vertices at one place apart by their ids if that is wanted, and returns the number of simplices';

CREATE FUNCTION abacus_label(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_label'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_label(regclass, text) IS
    'gives simplices labels, numbers by name: for each row (code, v0, v1, v2[, v3], columns named after labels) the simplex with this code and these vertices; returns how many rows there were';

CREATE FUNCTION abacus_inherit_labels(mesh regclass, inherit boolean DEFAULT true)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_inherit_labels'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_inherit_labels(regclass, boolean) IS
    'whether from now on a new simplex of a mesh gets the labels of the simplex that its centroid lay in; otherwise it has none';

CREATE FUNCTION abacus_labels(mesh regclass)
RETURNS text[]
AS 'MODULE_PATHNAME', 'abacus_sql_labels'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_labels(regclass) IS
    'the names of the labels that simplices of a mesh may have, in the order of abacus_cells().labels';

CREATE FUNCTION abacus_labels(mesh regclass, simplex abacus_simplex)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_labels_of'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_labels(regclass, abacus_simplex) IS
    'the labels of a simplex; NULL in a mesh without labels';

CREATE FUNCTION abacus_mark(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_mark'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_mark(regclass, text) IS
    'gives facets integer markers: for each row (code, v0, v1, v2[, v3], facet, marker) the facet opposite that vertex of the simplex, on both of its sides; NULL takes a marker away; returns how many rows there were';

CREATE FUNCTION abacus_facets(
    mesh regclass,
    INOUT marker integer DEFAULT NULL,
    OUT v0 bigint,
    OUT v1 bigint,
    OUT v2 bigint,
    OUT corners double precision[])
RETURNS SETOF record
AS 'MODULE_PATHNAME', 'abacus_sql_facets'
LANGUAGE C STABLE PARALLEL SAFE COST 10000 ROWS 1000;
COMMENT ON FUNCTION abacus_facets(regclass, integer) IS
    'the facets of a mesh with a marker, or with this one, each once, by marker and along the curve';

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
    split_nodes boolean DEFAULT false,
    lines text DEFAULT NULL,
    inherit boolean DEFAULT false)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_load'
LANGUAGE C VOLATILE PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_load(text, text, text, text[], double precision[], double precision[], boolean, boolean, text[], text, boolean, text, boolean) IS
    'makes a mesh of a triangulation made elsewhere, Delaunay or not. Checks it exactly. With retriangulate, one that is not Abacus'' own becomes the triangulation of its vertices. Labels and markers stay with simplices and facets that are in both; with inherit, new simplices get the labels of those that their centroids lay in. With split_nodes, vertices at one place are kept apart by their ids. With lines, their edges are fixed, and a triangulation that is Delaunay but for them can be changed. Returns the number of simplices. Shapes: vertices returns id, x, y[, z] and attributes, simplices v0, v1, v2[, v3] and labels, facets v0, v1[, v2], marker, lines line, v0, v1; lower and upper are {x, y}, in space {x, y, z}. Units: lower and upper in those of the coordinates. Errors: 22023 no triangulation, with what is wrong by ids; 55000 lines in space; those of abacus_create and abacus_stage';

CREATE FUNCTION abacus_label(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_label'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_label(regclass, text) IS
    'gives simplices labels, which are named numbers. Each row names a simplex by its code and vertices. Returns how many rows there were. Shapes: the query returns code, v0, v1, v2[, v3] and columns named after labels. Errors: 22023 no such simplex, or several; 42701 a name twice, or an attribute''s; 42804 other columns; 54000 more than 115 labels';

CREATE FUNCTION abacus_inherit_labels(mesh regclass, inherit boolean DEFAULT true)
RETURNS void
AS 'MODULE_PATHNAME', 'abacus_sql_inherit_labels'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_inherit_labels(regclass, boolean) IS
    'decides whether new simplices of a mesh inherit the labels of the simplex that their centroid lay in. Otherwise they have none. Errors: 55000 a mesh without labels';

CREATE FUNCTION abacus_labels(mesh regclass)
RETURNS text[]
AS 'MODULE_PATHNAME', 'abacus_sql_labels'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION abacus_labels(regclass) IS
    'the names of the labels that simplices of a mesh may have. Their order is that of abacus_cells().labels. Shapes: an array of names. Errors: 42809 not a mesh';

CREATE FUNCTION abacus_labels(mesh regclass, simplex abacus_simplex)
RETURNS double precision[]
AS 'MODULE_PATHNAME', 'abacus_sql_labels_of'
LANGUAGE C STABLE STRICT PARALLEL SAFE COST 500;
COMMENT ON FUNCTION abacus_labels(regclass, abacus_simplex) IS
    'the labels of a simplex. NULL in a mesh without labels. Shapes: an array of values, as abacus_labels names them. Errors: 22023 no such simplex, 22004 a NULL in it';

CREATE FUNCTION abacus_mark(mesh regclass, query text)
RETURNS bigint
AS 'MODULE_PATHNAME', 'abacus_sql_mark'
LANGUAGE C VOLATILE STRICT PARALLEL UNSAFE;
COMMENT ON FUNCTION abacus_mark(regclass, text) IS
    'gives facets integer markers. Each row names a simplex and the facet opposite that vertex; both sides of the facet have the marker. NULL removes a marker. Returns how many rows there were. Shapes: the query returns code, v0, v1, v2[, v3], facet, marker; facet counts from 0. Errors: 22023 no such simplex or facet, or several, or no integer; 42804 other columns';

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
    'the facets of a mesh that have a marker, or this marker. Each comes once, by marker and along the curve. Shapes: corners[i][axis] of corner i, from 1; v2 is NULL in the plane. Units: corners in those of the coordinates. Errors: 42809 not a mesh';

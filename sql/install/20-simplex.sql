-- The simplex as SQL sees it.

CREATE TYPE abacus_simplex AS (code bigint, v0 bigint, v1 bigint, v2 bigint, v3 bigint);
COMMENT ON TYPE abacus_simplex IS
    'triangle (counterclockwise) or tetrahedron (right hand around v0, v1, v2, thumb to v3): ids of its vertices; facet i is opposite vertex i';
COMMENT ON COLUMN abacus_simplex.code IS 'locational code, by which the simplex is found again';
COMMENT ON COLUMN abacus_simplex.v0 IS 'id of vertex 0';
COMMENT ON COLUMN abacus_simplex.v1 IS 'id of vertex 1';
COMMENT ON COLUMN abacus_simplex.v2 IS 'id of vertex 2';
COMMENT ON COLUMN abacus_simplex.v3 IS 'id of vertex 3; NULL in two dimensions';

-- From 0.1.0: what has changed and cannot be said by CREATE OR REPLACE.

-- Its meshes are of another format, which is not read any more.
DO $$
DECLARE
    meshes text := (SELECT string_agg(oid::regclass::text, ', ' ORDER BY oid::regclass::text) FROM pg_class
                    WHERE reloftype IN ('abacus_simplex_page'::regtype::oid, 'abacus_vertex_page'::regtype::oid));
BEGIN
    IF meshes IS NOT NULL THEN
        RAISE EXCEPTION 'cannot update meshes of Abacus 0.1.0'
            USING ERRCODE = 'object_not_in_prerequisite_state',
                  DETAIL = 'There are the tables ' || meshes || '.',
                  HINT = 'Read their points with the module of 0.1.0 (abacus_vertices), drop them, update, and build them anew.';
    END IF;
END $$;

COMMENT ON TYPE abacus_simplex_page IS
    'row of a mesh: a page of simplices, keyed by the start of its interval of the curve; (-1, 0) is the header, and those from (-1, 1) on have its names, if there are very many; where code is less, a page of attributes of vertices that are apart from the simplices, of labels of simplices or of markers of their facets';
COMMENT ON COLUMN abacus_simplex_page.code IS
    'locational code, lower end of the page''s interval; of attributes their group and the code''s upper bits, less 2^63';
COMMENT ON COLUMN abacus_simplex_page.part IS
    'continues the code where more simplices than fit a page share one; of attributes the code''s lower bits and a hash';

DROP TYPE abacus_vertex_page;
CREATE TYPE abacus_vertex_page AS (first bigint, part bigint, page abacus_page);
COMMENT ON TYPE abacus_vertex_page IS
    'row of the vertex table of a mesh: a page of points that wait to be inserted (of a mesh that is not Delaunay, of its vertices), or, where first is negative, of points equal to a vertex';
COMMENT ON COLUMN abacus_vertex_page.first IS
    'sequence number of the page''s first point; of points equal to a vertex the locational code, less 2^63';
COMMENT ON COLUMN abacus_vertex_page.part IS 'continues the code: serial number of a point; 0 where points wait';
COMMENT ON COLUMN abacus_vertex_page.page IS 'the page';

-- The earthquake points are in the extension abacus_lab now. Views and the like that use them keep
-- the function, and abacus_lab takes it up (sql/install_lab). A WARNING: less is not shown here.
ALTER EXTENSION abacus DROP FUNCTION abacus_quake(double precision, double precision);
DO $$
DECLARE
    users text;
BEGIN
    BEGIN
        DROP FUNCTION abacus_quake(double precision, double precision);
    EXCEPTION WHEN dependent_objects_still_exist THEN
        GET STACKED DIAGNOSTICS users = PG_EXCEPTION_DETAIL;
    END;
    RAISE WARNING 'abacus_quake() is no longer in the extension abacus, but in abacus_lab'
        USING DETAIL = CASE WHEN users IS NULL THEN 'No object uses it, so it was dropped.'
                            ELSE 'It stays outside of any extension, since objects use it: ' || users END,
              HINT = format('To have it, and abacus_goose(): CREATE EXTENSION abacus_lab SCHEMA %I;', current_schema());
END $$;
-- The drawing functions take the range of the colours, too.
DROP FUNCTION abacus_draw(regclass, integer, integer, double precision[], double precision[], text, boolean, double precision, double precision);
DROP FUNCTION abacus_draw_section(regclass, double precision[], double precision[], integer, integer, text, boolean, double precision[], double precision[], double precision, double precision);
-- It takes a window and the range of an attribute, too.
DROP FUNCTION abacus_vertices(regclass);
-- It takes lines, too.
DROP FUNCTION abacus_triangulate(text, text, text[], integer, double precision[], double precision[]);

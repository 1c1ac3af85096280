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
    max_edge double precision DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    ramp text DEFAULT NULL,
    contours double precision DEFAULT NULL,
    legend text DEFAULT NULL,
    scale_bar text DEFAULT NULL,
    transparent boolean DEFAULT false,
    light double precision[] DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw(regclass, integer, integer, double precision[], double precision[], text, boolean, double precision, double precision, double precision[], text, double precision, text, text, boolean, double precision[]) IS
    'a PNG of the mesh or quadtree, or of the window from lower to upper; an attribute gives colour, from the first value of range to the second, and, with exaggeration above 0, hill shading; contours are drawn at the multiples of a value, a legend with its unit or title, a scale bar with the unit of coordinates';

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
    max_edge double precision DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    ramp text DEFAULT NULL,
    contours double precision DEFAULT NULL,
    legend text DEFAULT NULL,
    scale_bar text DEFAULT NULL,
    transparent boolean DEFAULT false)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw_section'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw_section(regclass, double precision[], double precision[], integer, integer, text, boolean, double precision[], double precision[], double precision, double precision, double precision[], text, double precision, text, text, boolean) IS
    'a PNG of the section of a mesh of dimension 3, or of an octree, by the plane through a point with a normal, or of its part within the box from lower to upper; an attribute gives colour, from the first value of range to the second; heights are multiplied by exaggeration; contours, legend and scale bar as for abacus_draw';

CREATE FUNCTION abacus_draw_volume(
    mesh regclass,
    eye double precision[] DEFAULT NULL,
    toward double precision[] DEFAULT NULL,
    up double precision[] DEFAULT NULL,
    field_of_view double precision DEFAULT NULL,
    width integer DEFAULT 1024,
    height integer DEFAULT NULL,
    attribute text DEFAULT NULL,
    mode text DEFAULT 'mean',
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    range double precision[] DEFAULT NULL,
    ramp text DEFAULT NULL,
    legend text DEFAULT NULL,
    transparent boolean DEFAULT false)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw_volume'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw_volume(regclass, double precision[], double precision[], double precision[], double precision, integer, integer, text, text, double precision[], double precision[], double precision, double precision[], text, text, boolean) IS
    'a PNG of what rays through a mesh of dimension 3, or through its part within the box from lower to upper, meet of an attribute: its mean, max, min or sum; without an attribute how far they go inside';

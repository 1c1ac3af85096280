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
    light double precision[] DEFAULT NULL,
    within text DEFAULT NULL,
    regions boolean DEFAULT false,
    lines boolean DEFAULT false,
    max_error double precision DEFAULT NULL,
    contour_labels boolean DEFAULT false,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw(regclass, integer, integer, double precision[], double precision[], text, boolean, double precision, double precision, double precision[], text, double precision, text, text, boolean, double precision[], text, boolean, boolean, double precision, boolean, bigint) IS
    'a PNG of a mesh in the plane or of a quadtree, or of a window of it. An attribute gives colour, from the first value of range to the second, and, with exaggeration above 0, hill shading. Contours are drawn at the multiples of a value; legend is a unit or a title, scale_bar the unit of the coordinates. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. regions tints each region in a colour of its own, and draws its border and the fixed edges in it; lines draws all fixed edges, soft ones thinner. max_error draws the coarsest level of abacus_levels whose error is not greater. contour_labels widens each fifth contour and writes its value on it. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: lower and upper are {x, y}; range is {first, last}; light is {direction, height}. Units: width and height in pixels; lower, upper and max_edge in those of the coordinates; range, contours and max_error in those of the attribute; light in degrees. Errors: 22023 a mesh of dimension 3, a size, window, factor, range, ramp, contours or light out of range; 2202E other lengths; 42703 no such attribute; 42704 no such region; 55000 max_error without levels; 42704 no such step, 55000 one that is not whole';

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
    transparent boolean DEFAULT false,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw_section'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw_section(regclass, double precision[], double precision[], integer, integer, text, boolean, double precision[], double precision[], double precision, double precision, double precision[], text, double precision, text, text, boolean, bigint) IS
    'a PNG of the section of a mesh in space, or of an octree, by a plane. The plane goes through a point and has a normal; lower and upper are a box. An attribute gives colour, from the first value of range to the second. exaggeration multiplies heights; contours, legend and scale bar as for abacus_draw. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: through, normal, lower and upper are {x, y, z}; range is {first, last}. Units: width and height in pixels; through, lower, upper and max_edge in those of the coordinates; range and contours in those of the attribute. Errors: 22023 a mesh of dimension 2, a normal of zero, a size, window, range, ramp or contours out of range; 2202E other lengths; 42703 no such attribute; 42704 no such step, 55000 one that is not whole';

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
    transparent boolean DEFAULT false,
    step bigint DEFAULT NULL)
RETURNS bytea
AS 'MODULE_PATHNAME', 'abacus_sql_draw_volume'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_draw_volume(regclass, double precision[], double precision[], double precision[], double precision, integer, integer, text, text, double precision[], double precision[], double precision, double precision[], text, text, boolean, bigint) IS
    'a PNG of what rays through a mesh in space meet of an attribute: its mean, max, min or sum. Without an attribute it shows how far the rays go inside. lower and upper are a box. step reads the values of a step of abacus_store, which must be whole, in place of the attributes; attribute is then the number of a value, from 1 on. Shapes: eye, toward, up, lower and upper are {x, y, z}; range is {first, last}. Units: width and height in pixels; eye, toward, lower, upper and max_edge in those of the coordinates; field_of_view in degrees; range in those of the attribute. Errors: 22023 a mesh of dimension 2, an eye, up, field_of_view, size, window, range, mode or ramp that will not do; 2202E other lengths; 42703 no such attribute; 42704 no such step, 55000 one that is not whole';

-- Areas and volumes.

CREATE FUNCTION abacus_volume(
    mesh regclass,
    base double precision,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, double precision, text, double precision[], double precision[], double precision, text) IS
    'cut and fill over a base: the volumes of a surface above it (cut) and below it (fill). area is that of the mesh or window, surface that of the surface. In space area is the volume, surface the area where the attribute has the value of the base, cut the volume where it is at least that, fill where it is less. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: base in those of the attribute; lower, upper and max_edge in those of the coordinates; area in their square, volumes in that times those of the attribute; in space area and volumes in their cube. Errors: 22023 a base that is not finite, a bad window, two meshes not both of dimension 2; 2202E other lengths; 22003 a result out of range; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

CREATE FUNCTION abacus_volume(
    mesh regclass,
    other regclass,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    other_attribute text DEFAULT NULL,
    within text DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume_between'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, regclass, text, double precision[], double precision[], double precision, text, text) IS
    'cut and fill between two meshes: the volumes where the first surface is higher (cut) and where the other is (fill). area is where both have a surface, and surface that of the first there. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: base in those of the attribute; lower, upper and max_edge in those of the coordinates; area in their square, volumes in that times those of the attribute; in space area and volumes in their cube. Errors: 22023 a base that is not finite, a bad window, two meshes not both of dimension 2; 2202E other lengths; 22003 a result out of range; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

-- A quoted name without a type would be taken for a base. A quoted number is one.
CREATE FUNCTION abacus_volume(
    mesh regclass,
    other text,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    other_attribute text DEFAULT NULL,
    within text DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume_between_named'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, text, text, double precision[], double precision[], double precision, text, text) IS
    'the same, with the name of the other mesh, or a base, as text';

CREATE FUNCTION abacus_compare(
    mesh regclass,
    other regclass,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    other_attribute text DEFAULT NULL,
    within text DEFAULT NULL,
    OUT "greatest" double precision,
    OUT x double precision,
    OUT y double precision,
    OUT z double precision,
    OUT mean double precision,
    OUT mean_absolute double precision,
    OUT rms double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_compare'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_compare(regclass, regclass, text, double precision[], double precision[], double precision, text, text) IS
    'how two meshes differ where both have values: those of the first less those of the other, over the overlay of their simplices. greatest is the difference with the greatest absolute value and x, y, z where it is, z being NULL in the plane; mean, mean_absolute and rms are weighted by area, in space by volume. All are NULL if the meshes have no part in common. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Shapes: lower and upper are {x, y}, in space {x, y, z}. Units: lower, upper, max_edge, x, y and z in those of the coordinates, all else in those of the attribute. Errors: 22023 a bad window, meshes of different dimensions; 2202E other lengths; 22003 a result out of range; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

-- Areas and volumes.

CREATE FUNCTION abacus_volume(
    mesh regclass,
    base double precision,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, double precision, text, double precision[], double precision[], double precision) IS
    'the area of a mesh or window, that of the surface of an attribute over it, and the volumes that the surface has above a base (cut) and below it (fill); in space the volume, the area of the surface where the attribute has the value of the base, and the volumes where it is at least that, and less';

CREATE FUNCTION abacus_volume(
    mesh regclass,
    other regclass,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    other_attribute text DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume_between'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, regclass, text, double precision[], double precision[], double precision, text) IS
    'the area where two meshes have a surface each, that of the first surface there, and the volumes where the first is higher (cut) and where the other is (fill)';

-- A quoted name without a type would be taken for a base. A quoted number is one.
CREATE FUNCTION abacus_volume(
    mesh regclass,
    other text,
    attribute text DEFAULT NULL,
    lower double precision[] DEFAULT NULL,
    upper double precision[] DEFAULT NULL,
    max_edge double precision DEFAULT NULL,
    other_attribute text DEFAULT NULL,
    OUT area double precision,
    OUT surface double precision,
    OUT cut double precision,
    OUT fill double precision,
    OUT net double precision)
RETURNS record
AS 'MODULE_PATHNAME', 'abacus_sql_volume_between_named'
LANGUAGE C STABLE PARALLEL SAFE COST 1000000;
COMMENT ON FUNCTION abacus_volume(regclass, text, text, double precision[], double precision[], double precision, text) IS
    'the same, with the name of the other mesh, or a base, as text';

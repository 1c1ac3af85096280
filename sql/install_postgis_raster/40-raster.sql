-- A mesh as a raster of PostGIS.

-- The values of a raster whose rows go down and whose columns go right, as abacus_raster has them, and of
-- any other one pixel by pixel: an array of rows. The planner, which does not know the raster, takes it for a million
-- pixels; compiling the expressions for these would take longer than most rasters do.
CREATE FUNCTION _abacus_pixels(
    mesh regclass,
    template raster,
    attribute text,
    method text,
    outside text,
    max_edge double precision,
    within text)
RETURNS double precision[]
LANGUAGE sql STABLE PARALLEL SAFE COST 1000000 SET jit = off
RETURN CASE
    WHEN ST_SkewX(template) = 0 AND ST_SkewY(template) = 0 AND ST_ScaleX(template) > 0 AND ST_ScaleY(template) < 0 THEN
        (SELECT array_agg(r."values" ORDER BY r."row")
         FROM abacus_raster(mesh, _abacus_lower(mesh, ST_Envelope(template)), _abacus_upper(mesh, ST_Envelope(template)),
                            ST_Width(template), ST_Height(template), attribute, method, outside, max_edge, within) AS r)
    ELSE
        (SELECT array_agg(r."values" ORDER BY r."row")
         FROM (SELECT y AS "row",
                      array_agg(abacus_interpolate(mesh,
                                    ST_SetSRID(ST_MakePoint(ST_RasterToWorldCoordX(template, x, y) + (ST_ScaleX(template) + ST_SkewX(template)) / 2,
                                                            ST_RasterToWorldCoordY(template, x, y) + (ST_SkewY(template) + ST_ScaleY(template)) / 2),
                                               ST_SRID(template)), attribute, method, outside, max_edge, within) ORDER BY x) AS "values"
               FROM generate_series(1, ST_Height(template)) AS y, generate_series(1, ST_Width(template)) AS x
               GROUP BY y) AS r)
END;
COMMENT ON FUNCTION _abacus_pixels(regclass, raster, text, text, text, double precision, text) IS
    'inside abacus_postgis_raster: the values at the centres of the pixels of a raster, row by row';

CREATE FUNCTION abacus_raster(
    mesh regclass,
    template raster,
    attribute text DEFAULT NULL,
    method text DEFAULT 'linear',
    outside text DEFAULT 'null',
    max_edge double precision DEFAULT NULL,
    within text DEFAULT NULL)
RETURNS raster
LANGUAGE sql STABLE PARALLEL SAFE COST 1000000
RETURN CASE WHEN NOT ST_IsEmpty(template) AND _abacus_area(mesh, ST_Envelope(template)) IS NOT NULL THEN
    ST_SetValues(ST_AddBand(ST_MakeEmptyRaster(template), 1, '64BF', '-1.7976931348623157e308'::double precision, '-1.7976931348623157e308'::double precision),
                 1, 1, 1, _abacus_pixels(mesh, template, attribute, method, outside, max_edge, within)) END;
COMMENT ON FUNCTION abacus_raster(regclass, raster, text, text, text, double precision, text) IS
    'an attribute of a mesh in the plane as a raster with the pixels of another one. A value is that of abacus_interpolate at the centre of a pixel; no data where there is none. within is the name of a region of the mesh, or a polygon as WKT, EWKT or hexadecimal EWKB; all else is as outside of the mesh. Units: max_edge in those of the coordinates, pixels in those of the attribute. Errors: 22023 another SRID or a mesh of dimension 3; 42703 no such attribute, 42702 none named where the mesh has several, 55000 none at all; 42704 no such region';

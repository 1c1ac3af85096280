#!/bin/bash
# PostGIS's ST_SetZ and ST_SetM copy the no-data value of a raster into geometries as a height.
#
# Version     PostGIS 3.3.2 (Debian 12: postgresql-15-postgis-3 3.3.2+dfsg-1+b1), PostgreSQL 15
# Behaviour   Where the pixel has no data, a vertex gets the no-data value, -9999 here, as its Z or M, with both
#             ways to resample. ST_Value is NULL at the same place. Outside the raster, Z is NaN, with a NOTICE.
# Output      LINESTRING(0.5 3.5 1,2.5 2.5 -9999,3.5 3.5 4)
# Expected    NaN, as outside the raster. With -9999, ST_ZMin, slopes and lengths are wrong without a sign.
# Way out     ST_Value of each vertex (ST_DumpPoints), which is NULL there.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_postgis
start_server
psql -Xqd postgres -c "CREATE EXTENSION postgis; CREATE EXTENSION postgis_raster;
    CREATE TABLE terrain AS SELECT ST_SetValues(
        ST_AddBand(ST_MakeEmptyRaster(4, 4, 0, 4, 1, -1, 0, 0), '64BF'::text, 0, -9999), 1, 1, 1,
        ARRAY[[1, 2, 3, 4], [2, 3, -9999, 5], [3, 4, 5, 6], [4, 5, 6, 7]]::float8[]) AS r;"

# What this expression is for the raster r.
value() {
    psql -XqAtd postgres -P null=NULL -c "SELECT $1 FROM terrain"
}

expect "version" "3.3.2" "$(value 'postgis_lib_version()')"
line="'LINESTRING(0.5 3.5, 2.5 2.5, 3.5 3.5)'::geometry"
expect "ST_Value" NULL "$(value "ST_Value(r, 'POINT(2.5 2.5)'::geometry)")"
expect "ST_SetZ" "LINESTRING(0.5 3.5 1,2.5 2.5 -9999,3.5 3.5 4)" "$(value "ST_AsEWKT(ST_SetZ(r, $line))")"
expect "ST_SetZ, bilinear" "LINESTRING(0.5 3.5 1,2.5 2.5 -9999,3.5 3.5 4)" "$(value "ST_AsEWKT(ST_SetZ(r, $line, 'bilinear'))")"
expect "ST_SetM" "LINESTRINGM(0.5 3.5 1,2.5 2.5 -9999,3.5 3.5 4)" "$(value "ST_AsEWKT(ST_SetM(r, $line))")"
expect "lowest point" -9999 "$(value "ST_ZMin(ST_SetZ(r, $line))")"
expect "outside" "POINT(9 9 NaN)" "$(value "ST_AsEWKT(ST_SetZ(r, 'POINT(9 9)'::geometry))" 2>/dev/null)"
expect "ST_Value of the vertices" '1|NULL|4' "$(psql -XqAtd postgres -P null=NULL -R '|' \
    -c "SELECT ST_Value(r, geom) FROM terrain, ST_DumpPoints($line) ORDER BY path")"

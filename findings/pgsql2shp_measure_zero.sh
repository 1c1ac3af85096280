#!/bin/bash
# Points with heights come back from a Shapefile of pgsql2shp with the measure 0.
#
# Version     PostGIS 3.3.2 (Debian 12: postgis 3.3.2+dfsg-1+b1), read by GDAL 3.6.2 (gdal-bin)
# Behaviour   The shapes with heights of the format, such as PointZ, may have a measure for each vertex as well, or the number
#             that says that there is none. pgsql2shp writes 0, a valid measure, so GDAL and shp2pgsql make four dimensions of
#             three. The column from which the rows came refuses them. ogr2ogr writes the same point without a measure.
# Output      POINT Z (1 2 3) comes back as POINT ZM (1 2 3 0)
# Expected    POINT Z (1 2 3)
# Way out     shp2pgsql -t 3DZ, ogr2ogr -dim XYZ, or a Shapefile of ogr2ogr.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_postgis postgis=3.3.2+dfsg-1+b1 gdal-bin=3.6.2+dfsg-1+b2
start_server
programs=$tmp/usr/bin
export PROJ_LIB=$tmp/usr/share/proj GDAL_DATA=$tmp/usr/share/gdal
psql -Xqd postgres -c "CREATE EXTENSION postgis" \
    -c "CREATE TABLE sites AS SELECT 1 AS id, 'POINT Z (1 2 3)'::geometry(PointZ) AS place"
mkdir "$tmp/files" && cd "$tmp/files"

# read_by_gdal FILE, read_by_postgis FILE [OPTION...]: the first point.
read_by_gdal() {
    "$programs/ogrinfo" -al "$1" | sed -n 's/^ *\(POINT.*\)/\1/p'
}

read_by_postgis() {
    "$programs/shp2pgsql" "${@:2}" "$1" again 2>/dev/null | psql -XqAtd postgres >/dev/null
    value "ST_AsText(geom) FROM again"
}

"$programs/pgsql2shp" -u owner -f sites postgres sites >/dev/null 2>&1
echo '{"type": "Point", "coordinates": [1, 2, 3]}' >point.json
"$programs/ogr2ogr" -q other.shp point.json

expect "version" "3.3.2, GDAL 3.6.2" \
    "$(value "PostGIS_Lib_Version()"), $("$programs/ogrinfo" --version | grep -oE 'GDAL [0-9.]+')"
expect "written by ogr2ogr, read by GDAL" "POINT Z (1 2 3)" "$(read_by_gdal other.shp)"
expect "written by pgsql2shp, read by GDAL" "POINT ZM (1 2 3 0)" "$(read_by_gdal sites.shp)"
expect "... by PostGIS" "POINT ZM (1 2 3 0)" "$(read_by_postgis sites.shp)"
expect "... into the column that it came from" "Geometry has M dimension but column does not" \
    "$(psql -Xqd postgres -c "INSERT INTO sites SELECT gid, geom FROM again" 2>&1 | sed -n 's/^ERROR:  //p')"
expect "... by shp2pgsql -t 3DZ" "POINT Z (1 2 3)" "$(read_by_postgis sites.shp -d -t 3DZ)"
